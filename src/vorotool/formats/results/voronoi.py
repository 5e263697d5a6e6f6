"""Writing Voronoi maps, in every format that has a place for them."""

from __future__ import annotations

from typing import BinaryIO

import numpy as np

from vorotool.formats.polygons.polylines import GEOJSON_LINE, Wording, wkt_wording, write_polylines
from vorotool.formats.results.cells import CellShapes, write_shapes, written_cells
from vorotool.formats.results.voronoi_files import write_json, write_npz
from vorotool.formats.text.feature_collection import collection_opening
from vorotool.formats.text.tables import json_text, write_table
from vorotool.geometry.arguments.tables import listed
from vorotool.geometry.mesh.cells import Nesting
from vorotool.geometry.numbers import checked_flatten
from vorotool.geometry.ragged import owners, starts_of
from vorotool.geometry.voronoi.shapes import cell_rings, flattened_arcs
from vorotool.geometry.voronoi.tables import border_table, cell_table, neighbor_table
from vorotool.geometry.voronoi.voronoi_map import VoronoiMap
from vorotool.products.formats import TABLES

_TABLES = {"edges": border_table, "neighbors": neighbor_table, "table": cell_table}


def write_voronoi(
    out: BinaryIO,
    cells: VoronoiMap,
    fmt: str,
    *,
    what: str = "cells",
    flatten: float | None = None,
    precision: int | None = None,
    threads: int = 0,
) -> None:
    """Write the cells of a Voronoi map, its borders, or a row a cell or a pair of neighbors."""
    if what != "cells" and fmt in TABLES:
        write_table(out, _TABLES[what](cells), fmt, precision=precision, threads=threads)
    elif what != "cells":
        _write_borders(out, cells, fmt, checked_flatten(flatten), precision, threads)
    elif fmt == "json":
        write_json(out, cells, precision=precision, threads=threads)
    elif fmt == "npz":
        write_npz(out, cells, threads=threads)
    else:
        shapes = _shapes_of(cells, checked_flatten(flatten))
        write_shapes(out, shapes, fmt, precision=precision, threads=threads)


def _shapes_of(cells: VoronoiMap, tolerance: float | None) -> CellShapes:
    points, start = cell_rings(cells, tolerance)
    return CellShapes(
        {"label": cells.labels, "area": cells.areas, "perimeter": cells.perimeters},
        cells.other_columns,
        *written_cells(points, Nesting(start, cells.polygon_starts, cells.cell_starts)),
        cells.ids,
        cells.crs,
        cells.y_axis,
    )


_LEFT_OUT = frozenset(["x0", "y0", "x1", "y1", "cx", "cy", "r0", "r1", "arc"])
"""Columns of the table of borders that features do not have."""


# ---- borders -------------------------------------------------------------------------------------
def _write_borders(
    out: BinaryIO, cells: VoronoiMap, fmt: str, tolerance: float | None, precision: int | None, threads: int
) -> None:
    """One line a piece of a border, in the order of the table."""
    points, start = flattened_arcs(cells, tolerance)
    sizes = np.diff(start)
    shown = cells.is_border
    kept = shown[owners(sizes)]
    wording = wkt_wording(int(shown.sum())) if fmt == "wkt" else _border_wording(cells)
    write_polylines(out, points[kept], starts_of(sizes[shown])[:-1], wording, precision=precision, threads=threads)


def _border_wording(cells: VoronoiMap) -> Wording:
    table = border_table(cells)
    columns = {name: listed(table[name]) for name in table if name.removeprefix("voro_") not in _LEFT_OUT}
    rows = zip(*columns.values(), strict=True)
    openings = [
        f'{{"type":"Feature","properties":{json_text(dict(zip(columns, row, strict=True)))},'
        '"geometry":{"type":"LineString","coordinates":[['
        for row in rows
    ]
    opening = collection_opening(cells.crs, cells.y_axis) + b"\n"
    return Wording(
        opening,
        openings,
        "],[",
        ",",
        "]]}},\n",
        b"]}\n",
        *GEOJSON_LINE,
    )
