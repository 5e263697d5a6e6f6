"""A page that shows cells or labels, with the id and the values of the one that is pointed at: one file, by itself."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, BinaryIO, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vorotool.errors import LimitError
from vorotool.numeric.ragged import starts_of
from vorotool.products.formats import AS_SVG
from vorotool.render.canvas.palettes import cell_color
from vorotool.render.label_images.crack_outline import crack_loops
from vorotool.render.pages.page_data import Extent, json_value, packed, write_page
from vorotool.types.axis import is_up
from vorotool.types.mesh.cells import CellSet
from vorotool.types.points.label_image import LabelImage
from vorotool.types.spacing import SQUARE, PixelSides
from vorotool.types.table import Table
from vorotool.types.voronoi.shapes import cell_rings
from vorotool.types.voronoi.voronoi_map import VoronoiMap

MOST_CELLS, MOST_VERTICES = 100_000, 3_000_000
"""Some 30 MB of data: browsers draw so many in about a second."""

PAGE = "cells_page.html"

_FINE = 2.0**-12
"""How far lines may be from curves: of the larger side of the frame."""


class Shapes(NamedTuple):
    """Outlines of cells or of labels."""

    xy: NDArray[np.float64]  # (n, 2) float64 array: vertices
    rings: NDArray[np.integer]  # (r + 1,) integer array: where each ring begins among them, and n
    shapes: NDArray[np.integer]  # (k + 1,) integer array: where each shape begins among the rings, and r
    ids: Sequence[str]
    bounds: tuple[float, float, float, float]  # what the page shows
    y_up: bool = False  # y goes upwards


def shapes_of_cells(cells: CellSet) -> Shapes:
    """Give the outlines of cells."""
    rings, polygons, of_cells = cells.nesting
    ids = [str(label) for label in cells.label_array.tolist()]
    up = is_up(cells)
    return Shapes(cells.coordinates, rings, np.asarray(polygons)[np.asarray(of_cells)], ids, cells.frame.sides, up)


def shapes_of_map(cells: VoronoiMap) -> Shapes:
    """Give the outlines of the cells of a Voronoi map, with lines instead of curves."""
    x, y, w, h = cells.frame
    xy, rings = cell_rings(cells, _FINE * max(w, h))
    ids = [str(label) for label in (range(1, len(cells) + 1) if cells.ids is None else cells.ids)]
    up = is_up(cells.polygons)
    return Shapes(xy, rings, cells.polygon_starts[cells.cell_starts], ids, (x, y, x + w, y + h), up)


def shapes_of_labels(labels: NDArray[Any], *, y_up: bool = False, sides: PixelSides = SQUARE) -> Shapes:
    """Give the outlines of the labels of an image along the cracks between its pixels; 0 is none."""
    found = list(crack_loops(labels))
    loops = [loop for _, own in found for loop in own]
    xy = np.array([place for loop in loops for place in loop], dtype=np.float64).reshape(-1, 2)
    ids = [str(label) for label, _ in found]
    rings = starts_of(np.array([len(loop) for loop in loops], dtype=np.int64))
    shapes = starts_of(np.array([len(own) for _, own in found], dtype=np.int64))
    down, across = map(float, sides.lengths)
    height, width = labels.shape
    return Shapes(xy * (across, down), rings, shapes, ids, (0.0, 0.0, width * across, height * down), y_up)


def write_cells_html(out: BinaryIO, shapes: Shapes, classes: ArrayLike, columns: Mapping[str, Sequence[Any]]) -> None:
    """Write a page on which the cell that is pointed at is named, with its values."""
    check_html_size(len(shapes.ids), len(shapes.xy))
    classes, extent = np.asarray(classes), Extent(shapes.bounds[:2], shapes.bounds[2:], y_up=shapes.y_up)
    data = {
        **extent.sides,
        "xy": extent.places(shapes.xy),
        "rings": packed(shapes.rings, "<i4"),
        "shapes": packed(shapes.shapes, "<i4"),
        "classes": packed(classes, "<i4"),
        **named_cells(shapes.ids, classes, columns),
    }
    write_page(out, PAGE, data)


def named_cells(ids: Sequence[str], classes: NDArray[Any], columns: Mapping[str, Sequence[Any]]) -> dict[str, Any]:
    """Give the colors of cells, their ids and their values."""
    return {
        "colors": [cell_color(number) for number in range(int(classes.max(initial=0)) + 1)],
        "ids": list(ids),
        "columns": [{"name": name, "values": [json_value(each) for each in own]} for name, own in columns.items()],
    }


def write_labels_html(
    out: BinaryIO,
    image: LabelImage,
    colors: tuple[NDArray[Any], NDArray[Any]],
    table: Table,
    more: Mapping[str, Sequence[Any]] | None = None,
    *,
    y_up: bool,
) -> None:
    """Write a page that names the region that is pointed at, with its row of a table."""
    shapes = shapes_of_labels(image.labels, y_up=y_up, sides=image.sides)
    write_cells_html(out, shapes, colors[1], columns_of(table, colors[0]) | dict(more or {}))


def columns_of(table: Table, labels: NDArray[Any]) -> dict[str, Sequence[Any]]:
    """Give the rows of some labels."""
    rows = {int(label): row for row, label in enumerate(table["label"])}
    chosen = [rows[int(label)] for label in labels]
    return {name: [table[name][row] for row in chosen] for name in table if name != "label"}


def check_html_size(cells: int, vertices: int = 0) -> None:
    """Refuse a page that no browser would draw."""
    for count, most, what in ((cells, MOST_CELLS, "cells"), (vertices, MOST_VERTICES, "vertices of cells")):
        if count > most:
            raise LimitError(f"{count} {what} are too many for a page, at most {most}: use {AS_SVG} or png")
