"""Options that several commands have one after the other."""

from __future__ import annotations

from vorotool.cli.options.picture_style import picture_style_options
from vorotool.cli.options.pixel_size import pixel_size_option
from vorotool.cli.options.shared import Decorator, batch_options, layers_option, shared, together


def site_options(layers: tuple[str, ...], *, has_style: bool = True) -> Decorator:
    """Add the options of commands whose input is points or an image, and whose pictures have these layers."""
    return together(
        shared("size", "window", "columns", "input-format", "input-layer", "input-crs", "crs"),
        shared("page", "seeds", "connectivity", "threshold", "invert", "min-area", "fill-holes"),
        result_options(layers, has_style=has_style),
    )


def result_options(layers: tuple[str, ...], *, has_style: bool = True) -> Decorator:
    """Add the options of results: of their pictures, which have these layers, of the work, and of many inputs.

    The looks of pictures can be chosen where they are made of layers.
    """
    return together(
        layers_option(layers),
        shared("overlay", "width", "y-up"),
        *([picture_style_options()] if has_style else []),
        shared("out-dir", "threads", "stats", "verify", "strict", "precision"),
        shared("max-pixels", "max-sites"),
        pixel_size_option(),
        batch_options(),
        shared("no-clobber", "no-properties", "safe-csv", "quiet", "verbose"),
    )
