"""Options that several commands have one after the other."""

from __future__ import annotations

from vorotool.cli.options.areas import cleaning_options
from vorotool.cli.options.picture_style import picture_style_options
from vorotool.cli.options.pixel_size import pixel_size_option
from vorotool.cli.options.shared import Decorator, batch_options, layers_option, shared, together
from vorotool.cli.options.volumes import connectivity_option, frame_options


def site_options(layers: tuple[str, ...], *, has_scale: bool = True, has_volumes: bool = False) -> Decorator:
    """Add the options of commands whose input is points or an image, and whose pictures have these layers.

    Frames and components may be those of volumes.
    """
    return together(
        frame_options(has_volumes=has_volumes),
        shared("columns", "input-format", "input-layer", "input-crs", "crs", "page", "seeds"),
        connectivity_option(has_volumes=has_volumes),
        shared("threshold", "invert"),
        cleaning_options(),
        result_options(layers, has_scale=has_scale),
    )


def result_options(layers: tuple[str, ...], *, has_scale: bool = True) -> Decorator:
    """Add the options of results: of their pictures, which have these layers, of the work, and of many inputs.

    Pictures have a scale where they are made of lines and areas.
    """
    return together(
        layers_option(layers),
        shared("overlay", "width", "y-up"),
        picture_style_options(has_scale=has_scale),
        shared("out-dir", "threads", "stats", "verify", "strict", "decimals", "precision"),
        shared("max-pixels", "max-sites"),
        pixel_size_option(),
        batch_options(),
        shared("no-clobber", "overwrite", "with", "no-properties", "safe-csv", "quiet", "verbose"),
    )
