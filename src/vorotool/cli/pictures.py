"""Pictures of label images, for the commands that draw them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, BinaryIO

from numpy.typing import NDArray

from vorotool.geometry.label_image import LabelImage

BAND_ROWS = 256
"""Rows of a picture that are composed at a time."""


def write_label_picture(
    out: BinaryIO,
    image: LabelImage,
    colours: NDArray[Any],
    *,
    fmt: str,
    layers: Sequence[str],
    width: int = 1000,
    y_up: bool = False,
    threads: int = 0,
) -> None:
    """Draw a label image as SVG or as a palette PNG of its own size.

    Parameters
    ----------
    out : binary file
        Where to write.
    image : LabelImage
        With seeds, if these are drawn.
    colours : integer array
        Colour class of each label, 0 for none.
    fmt : {"png", "svg"}
        Kind of picture.
    layers : sequence of str
        Of cells, diagram (PNG), labels (SVG) and seeds.
    width : int
        Pixels across an SVG.
    y_up : bool
        Draw the last row on top.
    threads : int
        0 uses all.
    """
    if y_up:
        image = image.flipped()
    if fmt == "svg":
        from vorotool.render.label_svg import write_label_svg

        write_label_svg(out, image, colour_of_label=colours, width=width, layers=layers)
    else:
        _write_png(out, image, colours, layers, threads)


def _write_png(out: BinaryIO, image: LabelImage, colours: NDArray[Any], layers: Sequence[str], threads: int) -> None:
    from vorotool.engines.regions import voronoi_diagram
    from vorotool.formats.png import write_png
    from vorotool.render.label_png import picture_bands
    from vorotool.render.palettes import picture_palette

    palette = picture_palette(int(colours.max(initial=0)))
    starts = range(0, image.shape[0], BAND_ROWS)
    diagram = voronoi_diagram(image, threads=threads).view(bool) if "diagram" in layers else None
    bands = picture_bands(
        (image.labels[row : row + BAND_ROWS] for row in starts),
        shape=image.shape,
        palette=palette,
        colour_of_label=colours,
        diagram=None if diagram is None else (diagram[row : row + BAND_ROWS] for row in starts),
        seeds=image.seeds,
        frame=image.frame,
        layers=layers,
    )
    write_png(out, bands, image.shape, bit_depth=palette.bit_depth, palette=palette.colours, threads=threads)
