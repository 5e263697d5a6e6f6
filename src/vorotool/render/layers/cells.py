"""The layers of a picture of Voronoi cells."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.ragged import following, owners, within
from vorotool.render.canvas.layers import Lines, Page, Polygons
from vorotool.render.canvas.palettes import EDGE, INK, cell_color
from vorotool.types.axis import is_up
from vorotool.types.mesh.cells import CellSet

LAYERS = ("cells", "diagram")
"""Filled cells, and their boundaries as lines."""


def cell_polygons(cells: CellSet, colors: NDArray[np.unsignedinteger], page: Page) -> Polygons:
    """Fill cells; their outlines get finer where cells are small."""
    rings, polygons, of_cells = cells.nesting
    cell = owners(np.diff(of_cells))
    part = within(np.diff(of_cells)) + 1
    labels = cells.label_array[cell]
    several = np.diff(of_cells)[cell] > 1
    ids = [
        f"cell-{label}-{k}" if many else f"cell-{label}"
        for label, k, many in zip(labels.tolist(), part.tolist(), several.tolist(), strict=True)
    ]
    return Polygons(
        "cells",
        cells.coordinates,
        np.arange(len(cells.coordinates), dtype=np.int32),
        rings,
        polygons,
        [cell_color(c) for c in range(int(colors.max(initial=0)) + 1)],
        np.asarray(colors)[cell],
        ids,
        EDGE,
        _line_width(cells, page),
    )


def cell_lines(cells: CellSet, page: Page) -> Lines:
    """Draw the boundaries of cells as lines, each side once where two cells share it."""
    _, index = np.unique(cells.coordinates, axis=0, return_inverse=True)
    rings = cells.nesting.rings
    first = np.full(int(index.max(initial=-1)) + 1, len(index), dtype=np.int32)
    np.minimum.at(first, index.reshape(-1), np.arange(len(index), dtype=np.int32))
    number = first[index.reshape(-1)]  # coincident vertices have that of the first one
    sides = np.unique(np.sort(np.stack([number, number[following(rings)]], axis=1), axis=1), axis=0)
    return Lines("diagram", cells.coordinates, sides, INK, _line_width(cells, page))


def cells_page(cells: CellSet, *, width: int = 1000) -> Page:
    """The page that shows the frame of cells; y upwards where the input says so."""
    return Page(cells.frame.sides, width=width, y_up=is_up(cells))


def _line_width(cells: CellSet, page: Page) -> float:
    return min(max(page.spacing(len(cells)) / 24, 0.1), 1.5)
