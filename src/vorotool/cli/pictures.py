"""Pictures, for the commands that draw them: of label images, and from layers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool.geometry.label_image import LabelImage

if TYPE_CHECKING:
    from vorotool.render.layers import Backdrop, Layer, Page

BAND_ROWS = 256
"""Rows of a picture that are composed at a time."""

LARGEST_TABLE = 1 << 20
"""Entries that a table of colours by label may have in any case; beyond, it must be mostly used."""


def write_label_picture(
    out: BinaryIO,
    image: LabelImage,
    colours: tuple[NDArray[Any], NDArray[Any]],
    *,
    fmt: str,
    layers: Sequence[str],
    width: int = 1000,
    y_up: bool = False,
    backdrop: Backdrop | None = None,
    threads: int = 0,
) -> None:
    """Draw a label image as SVG or as a palette PNG of its own size, or over an image.

    Parameters
    ----------
    out : binary file
        Where to write.
    image : LabelImage
        With seeds, if these are drawn.
    colours : pair of (k,) integer arrays
        The labels that occur, increasing, and the colour class of each: what `region_colours` gives.
    fmt : {"png", "svg"}
        Kind of picture.
    layers : sequence of str
        Of cells, diagram (PNG), labels (SVG) and seeds.
    width : int
        Pixels across an SVG.
    y_up : bool
        Draw the last row on top.
    backdrop : Backdrop, optional
        The image, whose size the picture has.
    threads : int
        0 uses all.
    """
    if y_up:
        image = image.flipped()
    if fmt == "svg":
        from vorotool.render.label_svg import write_label_svg

        by_label = dict(zip(colours[0].tolist(), colours[1].tolist(), strict=True))
        write_label_svg(out, image, colour_of_label=by_label, width=width, layers=layers, backdrop=backdrop)
    else:
        _write_png(out, image, colours, layers, backdrop, threads)


def _write_png(
    out: BinaryIO,
    image: LabelImage,
    colours: tuple[NDArray[Any], NDArray[Any]],
    layers: Sequence[str],
    backdrop: Backdrop | None,
    threads: int,
) -> None:
    from vorotool.engines.regions import voronoi_diagram
    from vorotool.formats.png import write_png
    from vorotool.render.label_png import over_image, picture_bands
    from vorotool.render.palettes import picture_palette

    palette = picture_palette(int(colours[1].max(initial=0)))
    starts = range(0, image.shape[0], BAND_ROWS)
    diagram = voronoi_diagram(image, threads=threads).view(bool) if "diagram" in layers else None
    number, colour_of_number = _numbering(*colours)
    bands = picture_bands(
        (number(image.labels[row : row + BAND_ROWS]) for row in starts),
        shape=image.shape,
        palette=palette,
        colour_of_label=colour_of_number,
        diagram=None if diagram is None else (diagram[row : row + BAND_ROWS] for row in starts),
        seeds=image.seeds,
        frame=image.frame,
        layers=layers,
    )
    if backdrop is not None:
        assert image.frame is not None  # LabelImage has filled it in
        made = over_image(bands, backdrop, palette, image.frame)
        write_png(out, [made], backdrop.pixels.shape[:2], rgb=True, threads=threads)
        return
    write_png(out, bands, image.shape, bit_depth=palette.bit_depth, palette=palette.colours, threads=threads)


def _numbering(
    labels: NDArray[Any], classes: NDArray[Any]
) -> tuple[Callable[[NDArray[Any]], NDArray[Any]], NDArray[Any]]:
    """Numbers that a table of colours is indexed by: the labels, or their ranks from 1 where labels are sparse."""
    largest = int(labels.max(initial=0))
    if largest > 4 * len(labels) + LARGEST_TABLE:
        known = np.append(0, labels)
        return lambda band: np.searchsorted(known, band), np.append(0, classes)
    by_label = np.zeros(largest + 1, classes.dtype)
    by_label[labels] = classes
    return np.asarray, by_label


def write_layers(out: BinaryIO, layers: Sequence[Layer], page: Page, *, fmt: str, threads: int = 0) -> None:
    """Draw layers as SVG or PNG.

    Parameters
    ----------
    out : binary file
        Where to write.
    layers : sequence of Layer
        What to draw, from below.
    page : Page
        Where it lies.
    fmt : {"svg", "png"}
        Kind of picture.
    threads : int
        0 uses all.
    """
    if fmt == "svg":
        from vorotool.render.layers_svg import write_layers_svg

        write_layers_svg(out, layers, page, threads=threads)
    else:
        from vorotool.formats.png import write_png
        from vorotool.render.layers_png import layer_bands

        write_png(out, layer_bands(layers, page), (page.height, page.width), rgb=True, threads=threads)
