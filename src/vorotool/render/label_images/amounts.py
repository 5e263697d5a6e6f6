"""Pictures of an amount in each pixel: a scale from dark to light that is even to the eye, and the bar of it."""

from __future__ import annotations

from dataclasses import replace
from typing import BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool.formats.images.png_writer import write_png
from vorotool.render.canvas.insets import ADVANCE, box, insets, letter_size, rounded_length
from vorotool.render.canvas.layers import Backdrop, ImagePage, Layer, Page, Polygons, Texts
from vorotool.render.canvas.png import layer_bands
from vorotool.render.canvas.styles import FAINT, WHITE, PictureStyle, triples
from vorotool.types.skeleton.arc_measures import ThicknessImage

COLORS = 255
"""Of amounts; with the ground their numbers fit in a byte."""

_STOPS = ("440154", "472d7b", "3b528b", "2c728e", "21918c", "28ae80", "5ec962", "addc30", "fde725")
"""Viridis, of Smith and van der Walt, at even steps: its lightness grows evenly, for any color vision."""

STRIPS = 64
"""Of a bar."""

TICKS = 4
"""Numbers beside a bar at most, besides 0."""


def write_thickness_png(out: BinaryIO, image: ThicknessImage, style: PictureStyle, *, unit: str | None = None) -> None:
    """Draw the pixels in colors from dark, which is thin, to light; a scale bar and the bar of the colors over them."""
    largest = image.largest
    ground = triples([style.ground or WHITE])
    indices, palette = amount_indices(image.values, largest), np.concatenate([ground, scale_colors(COLORS)])
    if not style.has_insets:
        has_alpha = style.ground is None
        write_png(out, [indices], indices.shape, bit_depth=8, palette=palette, has_alpha=has_alpha)
        return
    page = ImagePage(Backdrop(palette[indices], bytes))
    page.style = replace(style, has_legend=False)
    bar = color_bar(largest, unit, page) if style.has_legend and largest > 0 else []
    over = [*bar, *insets([], page)]
    write_png(out, layer_bands([], page, insets=over), indices.shape, rgb=True)


def amount_indices(values: NDArray[np.float64], largest: float) -> NDArray[np.uint8]:
    """Give the number of each pixel's color: 0 where there is no amount, else from 1 to `COLORS`."""
    indices = np.zeros(values.shape, np.uint8)
    for row in range(0, len(values), 256):  # what is made beside it stays small
        band = values[row : row + 256]
        ranks = np.minimum(band * (COLORS / largest), COLORS - 1) + 1 if largest else band
        indices[row : row + 256] = np.where(band > 0, ranks, 0)
    return indices


def scale_colors(count: int) -> NDArray[np.uint8]:
    """Give (count, 3) colors from dark to light: red, green and blue."""
    stops = np.array([list(bytes.fromhex(stop)) for stop in _STOPS], dtype=np.float64)
    place = np.linspace(0, len(stops) - 1, count)
    below = np.minimum(place.astype(np.intp), len(stops) - 2)
    colors = stops[below] + (place - below)[:, None] * (stops[below + 1] - stops[below])
    return np.rint(colors).astype(np.uint8)


def color_bar(largest: float, unit: str | None, page: Page) -> list[Layer]:
    """Make a bar of the colors from 0 to the largest amount, in the upper right corner of a page."""
    size = letter_size(page)
    step = rounded_length(largest / 2)
    step = step if largest / step < TICKS else 2 * step
    ticks = [k * step for k in range(int(largest / step) + 1)]
    names = [f"{tick:.10g}" for tick in ticks]
    names[-1] += f" {unit}" if unit else ""
    gap, wide = 0.6 * size, 1.2 * size
    high = min(12 * size, max(page.height - 4 * gap, size))
    across = 3 * gap + wide + ADVANCE * size * max(map(len, names))
    left, top = page.width - across - gap, 2 * gap
    made: list[Layer] = [
        box("legend", (left, top - gap), (left + across, top + high + gap), WHITE, FAINT),
        _strips((left + gap, top), (wide, high)),
    ]
    places = np.array([[left + 2 * gap + wide, top + high * (1 - tick / largest)] for tick in ticks])
    return [*made, Texts("legend-names", places, names, size=size, is_centered=True, is_led=True)]


def _strips(corner: tuple[float, float], size: tuple[float, float]) -> Polygons:
    """The bar, light above, in strips of one color each."""
    edges = np.linspace(corner[1] + size[1], corner[1], STRIPS + 1)
    low, high = edges[:-1], edges[1:]
    left, right = np.full(STRIPS, corner[0]), np.full(STRIPS, corner[0] + size[0])
    points = np.stack([left, low, right, low, right, high, left, high], axis=1).reshape(-1, 2)
    names = ["#" + bytes(color).hex() for color in scale_colors(STRIPS)]
    corners = np.arange(4 * STRIPS, dtype=np.int32)
    return Polygons(
        "legend-scale", points, corners, np.arange(0, 4 * STRIPS + 1, 4), colors=names, color_of=np.arange(STRIPS)
    )
