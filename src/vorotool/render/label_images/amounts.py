"""Pictures of an amount in each pixel, in colors from dark to light."""

from __future__ import annotations

from dataclasses import replace
from typing import BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool.formats.images.png_writer import write_png
from vorotool.render.canvas.color_scales import color_bar, scale_colors
from vorotool.render.canvas.insets import insets
from vorotool.render.canvas.layers import Backdrop, ImagePage
from vorotool.render.canvas.palettes import WHITE
from vorotool.render.canvas.png import layer_bands
from vorotool.render.canvas.styles import PictureStyle
from vorotool.types.skeleton.thickness import ThicknessImage

COLORS = 255
"""Of amounts; with the ground their numbers fit in a byte."""


def write_thickness_png(
    out: BinaryIO, image: ThicknessImage, style: PictureStyle, *, unit: str | None = None, threads: int = 0
) -> None:
    """Draw the pixels in colors from dark, which is thin, to light."""
    largest = image.largest
    indices, palette = amount_indices(image.values, largest), amount_palette(style.ground)
    if not style.has_insets:
        has_alpha = style.ground is None
        write_png(out, [indices], indices.shape, bit_depth=8, palette=palette, has_alpha=has_alpha, threads=threads)
        return
    bare = replace(style, has_legend=False)
    pixels = with_color_bar(palette[indices], bare, largest if style.has_legend else 0.0, unit)
    write_png(out, [pixels.reshape(len(pixels), -1)], indices.shape, rgb=True, threads=threads)


def amount_indices(values: NDArray[np.float64], largest: float) -> NDArray[np.uint8]:
    """Give the number of each pixel's color: 0 where there is no amount, else from 1 to `COLORS`."""
    indices = np.zeros(values.shape, np.uint8)
    for row in range(0, len(values), 256):  # what is made beside it stays small
        band = values[row : row + 256]
        ranks = np.minimum(band * (COLORS / largest), COLORS - 1) + 1 if largest else band
        indices[row : row + 256] = np.where(band > 0, ranks, 0)
    return indices


def amount_palette(ground: str | None) -> NDArray[np.uint8]:
    """Give the colors of these numbers, the ground first: white where it is nothing."""
    first = np.array([list(bytes.fromhex((ground or WHITE)[1:]))], dtype=np.uint8)
    return np.concatenate([first, scale_colors(COLORS)])


def with_color_bar(
    pixels: NDArray[np.uint8], style: PictureStyle, largest: float, unit: str | None
) -> NDArray[np.uint8]:
    """Draw the bar of the colors, and a scale bar, over a picture."""
    page = ImagePage(Backdrop(pixels, bytes))
    page.style = style
    over = [*(color_bar(largest, unit, page) if largest > 0 else []), *insets([], page)]
    made: NDArray[np.uint8] = np.concatenate(list(layer_bands([], page, insets=over)))
    return made.reshape(pixels.shape)
