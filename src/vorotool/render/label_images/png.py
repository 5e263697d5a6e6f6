"""PNG pictures of label images: palette indices composed band by band from layers."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.arrays import ranges
from vorotool.render.canvas.glyphs import text_cells
from vorotool.render.canvas.layers import checked_layers
from vorotool.render.canvas.styles import PicturePalette
from vorotool.types.pixels import Frame
from vorotool.types.points.seed_set import SeedSet

LAYERS = ("cells", "diagram", "objects", "seeds", "labels")


def picture_bands(
    bands: Iterable[NDArray[Any]],
    *,
    shape: tuple[int, int],
    palette: PicturePalette,
    color_of_label: NDArray[Any],
    diagram: Iterable[NDArray[np.bool_]] | None = None,
    marks: Sequence[tuple[int, NDArray[np.bool_]]] = (),
    seeds: SeedSet | None = None,
    outlines: NDArray[np.bool_] | None = None,
    frame: Frame | None = None,
    names: Names | None = None,
    layers: Iterable[str] = LAYERS,
) -> Iterator[NDArray[np.uint8]]:
    """Compose rows of palette indices: cells below, the diagram over them, seeds and names on top."""
    wanted = checked_layers(layers, LAYERS)
    classes = np.asarray(color_of_label).astype(np.uint8)
    masks = iter(diagram) if diagram is not None and "diagram" in wanted else None
    has_discs = bool(seeds) and outlines is None and "seeds" in wanted
    discs = _Discs(seeds, frame or Frame(0, 0, shape[1], shape[0])) if seeds and has_discs else None
    letters = _Letters(names, palette) if names is not None and "labels" in wanted else None
    top = 0
    for labels in bands:
        picture = classes[labels] if "cells" in wanted else np.zeros(labels.shape, np.uint8)
        for value, pixels in marks:
            picture[pixels[top : top + len(labels)]] = value
        if masks is not None:
            picture[next(masks)] = palette.line
        if outlines is not None and "seeds" in wanted:
            picture[outlines[top : top + len(labels)]] = palette.seed
        if discs is not None:
            if palette.has_halos:
                discs.draw(picture, top, palette.halo, wider=1.0)
            discs.draw(picture, top, palette.seed)
        if letters is not None:
            letters.draw(picture, top)
        top += len(labels)
        yield picture


def over_image(
    bands: Iterable[NDArray[np.uint8]], pixels: NDArray[np.uint8], palette: PicturePalette, frame: Frame
) -> NDArray[np.uint8]:
    """Draw a picture over an image: areas half see-through, lines and seeds not."""
    made = pixels.copy()
    height, width = made.shape[:2]
    left, right = (min(max(x, 0), width) for x in (frame.x, frame.x + frame.width))
    row = frame.y
    for band in bands:
        top, bottom = (min(max(y, 0), height) for y in (row, row + len(band)))
        index = band[top - row : bottom - row, left - frame.x : right - frame.x]
        beneath = made[top:bottom, left:right]
        color = palette.colors[index]
        mixed = ((beneath.astype(np.uint16) + color + 1) // 2).astype(np.uint8)
        is_line = np.isin(index, palette.opaque)
        beneath[...] = np.where(is_line[..., None], color, np.where(index[..., None] > 0, mixed, beneath))
        row += len(band)
    return made


def around(lines: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Give the pixels beside those of lines, corner to corner, too: an edge that shows them on any ground."""
    made = lines.copy()
    for step in (np.s_[1:, :], np.s_[:, 1:]):
        back = tuple(slice(None, -1) if part.start else part for part in step)
        grown = made.copy()
        grown[step] |= made[back]
        grown[back] |= made[step]
        made = grown
    return made & ~lines


def widened(lines: NDArray[np.bool_], width: float) -> NDArray[np.bool_]:
    """Make lines of a pixel so many pixels wide, to the nearest whole number; of none there is nothing."""
    if width == 0:
        return np.zeros_like(lines)
    made = lines
    for number in range(1, max(1, round(width))):
        grown = made.copy()
        if number % 2:  # to the left and above first, then to the right and below
            grown[:-1] |= made[1:]
            made = grown.copy()
            made[:, :-1] |= grown[:, 1:]
        else:
            grown[1:] |= made[:-1]
            made = grown.copy()
            made[:, 1:] |= grown[:, :-1]
    return made


def disc_radius(shape: tuple[int, int], count: int) -> float:
    """Radius of a seed's disc in pixels: 1/250 of the smaller side, but less where that would fill cells."""
    height, width = shape
    spacing = math.sqrt(width * height / max(count, 1))
    return min(max(1.0, min(shape) / 250), max(0.5, spacing / 8))


class Names(NamedTuple):
    """Names of regions, and the (k, 2) column and row of the pixel on which each is centered."""

    texts: Sequence[str]
    places: NDArray[np.int64]


class _Letters:
    """Pixels of names, sorted by row, so that each band looks at its own only; halos come before letters."""

    def __init__(self, names: Names, palette: PicturePalette) -> None:
        owner, cells, is_ink = text_cells(names.texts)
        x, y = (names.places[owner] + cells).T
        order = np.lexsort((is_ink, y))
        self.x, self.y = x[order], y[order]
        self.value = np.where(is_ink[order], palette.ink, palette.letter_edge).astype(np.uint8)

    def draw(self, picture: NDArray[np.uint8], top: int) -> None:
        """Set the pixels of a band; what is outside is left out."""
        rows, width = picture.shape
        part = slice(*np.searchsorted(self.y, [top, top + rows]))
        x, y, value = self.x[part], self.y[part] - top, self.value[part]
        inside = (x >= 0) & (x < width)
        picture[y[inside], x[inside]] = value[inside]


class _Discs:
    """Discs around seeds, sorted by row, so that each band looks at its own only."""

    def __init__(self, seeds: SeedSet, frame: Frame) -> None:
        x, y = seeds.x / seeds.scale - frame.x, seeds.y / seeds.scale - frame.y
        self.radius = disc_radius(frame.shape, len(seeds))
        order = np.argsort(y, kind="stable")
        self.x, self.y = x[order], y[order]

    def draw(self, picture: NDArray[np.uint8], top: int, value: int, *, wider: float = 0.0) -> None:
        """Set the pixels whose centers lie in a disc; the smallest discs still mark the nearest pixel."""
        rows, width = picture.shape
        radius = self.radius + wider
        reach = math.ceil(radius) + 1
        first, last = np.searchsorted(self.y, [top - reach, top + rows + reach])
        x, y = self.x[first:last], self.y[first:last]
        self._set(picture, np.floor(x + 0.5), np.floor(x + 0.5), np.floor(y + 0.5) - top, value)
        for offset in range(-reach, reach + 1):
            row = np.floor(y) + offset
            square = radius * radius - np.square(row - y)
            half = np.sqrt(np.maximum(square, 0.0))
            hit = square >= 0
            left, right = np.ceil(x - half)[hit], np.floor(x + half)[hit]
            self._set(picture, np.maximum(left, 0), np.minimum(right, width - 1), row[hit] - top, value)

    @staticmethod
    def _set(
        picture: NDArray[np.uint8],
        left: NDArray[np.float64],
        right: NDArray[np.float64],
        row: NDArray[np.float64],
        value: int,
    ) -> None:
        """Fill spans of pixels, ends included; what is outside the picture is left out."""
        rows, width = picture.shape
        inside = (row >= 0) & (row < rows) & (left <= right) & (right >= 0) & (left < width)
        start = left[inside].astype(np.int64)
        lengths = right[inside].astype(np.int64) - start + 1
        picture[np.repeat(row[inside].astype(np.int64), lengths), ranges(start, lengths)] = value
