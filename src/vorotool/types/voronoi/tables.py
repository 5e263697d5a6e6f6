"""Tables of a Voronoi map: its borders, pairs of neighbors, and one row a cell."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from threading import Lock
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.types.features import Rows
from vorotool.types.identity import with_ends
from vorotool.types.table import Computed, Lookup, Table
from vorotool.types.voronoi.site_shapes import site_distances
from vorotool.types.voronoi.voronoi_map import VoronoiMap

KINDS = ["line", "parabola", "circle"]
"""Of arcs."""


def kinds_of(cells: VoronoiMap) -> NDArray[np.int32]:
    """(a,) the kind of each arc, a number among `KINDS`."""
    kinds: NDArray[np.int32] = np.where(cells.is_circle, 2, cells.is_parabola).astype(np.int32)
    return kinds


def border_table(cells: VoronoiMap) -> Table:
    """Return one row an arc between two cells."""
    arc = np.flatnonzero(cells.is_border)
    low, high = np.sort(cells.sites[arc], axis=1).T
    source, target = np.ascontiguousarray(cells.arcs[arc].T)
    x, y = np.ascontiguousarray(cells.vertices.T)
    cx, cy = np.ascontiguousarray(cells.control[arc].T)
    return with_ends(
        {
            "label_a": cells.labels[low],
            "label_b": cells.labels[high],
            "kind": Lookup(KINDS, kinds_of(cells)[arc]),
            "x0": Lookup(x, source),
            "y0": Lookup(y, source),
            "x1": Lookup(x, target),
            "y1": Lookup(y, target),
            "cx": cx,
            "cy": cy,
            "length": cells.length[arc],
            "arc": arc,
            "r0": cells.radius[source],
            "r1": cells.radius[target],
        },
        cells.properties,
        {"a": low, "b": high},
    )


def neighbor_pairs(cells: VoronoiMap) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """(n, 2) pairs of cells that share a border of positive length, ascending, and (n,) its length."""
    arc = np.flatnonzero(cells.is_border & (cells.length > 0))
    pair = np.sort(cells.sites[arc], axis=1).astype(np.int64)
    key, row = np.unique(pair[:, 0] * max(len(cells), 1) + pair[:, 1], return_inverse=True)
    pairs = np.stack(np.divmod(key, max(len(cells), 1)), axis=1)
    length: NDArray[np.float64] = np.bincount(row, cells.length[arc], minlength=len(key)).astype(np.float64)
    return pairs, length


def neighbor_table(cells: VoronoiMap) -> Table:
    """Return one row a pair of cells that share a border; cells that meet in places only are none."""
    pairs, length = neighbor_pairs(cells)
    low, high = cells.labels[pairs.T]
    distance = _when_asked(lambda: site_distances(cells, pairs), len(pairs))
    columns = {"label_a": low, "label_b": high, "border_length": length, "distance": distance}
    return with_ends(columns, cells.properties, dict(zip("ab", pairs.T, strict=True)))


def cell_table(cells: VoronoiMap) -> Table:
    """Return one row a cell."""
    pairs, _ = neighbor_pairs(cells)
    columns: dict[str, Any] = {"label": cells.labels}
    if cells.ids is not None:
        columns["id"] = list(cells.ids)
    columns |= {
        "area": cells.areas,
        "perimeter": cells.perimeters,
        "neighbors": np.bincount(pairs.ravel(), minlength=len(cells)),
        "own_area": _when_asked(lambda: cells.own_areas, len(cells)),
        "max_distance": _when_asked(lambda: cells.reaches, len(cells)),
        "components": cells.components,
    }
    return Table(columns).with_properties(cells.other_columns)


def map_rows(cells: VoronoiMap, what: str | None) -> Rows | None:
    """Return the rows of a part, by default of the cells; None if these are to have their geometry."""
    if what == "cells":
        return None
    if what in ("edges", "neighbors"):
        return Rows(border_table(cells) if what == "edges" else neighbor_table(cells))
    return Rows(cell_table(cells), {}, cells, np.arange(len(cells)))


def _when_asked(function: Callable[[], NDArray[np.float64]], size: int) -> Computed:
    """A column that is computed as a whole, once, by the first thread that asks for rows of it."""
    lock, once = Lock(), cache(function)

    def rows_of(rows: slice) -> NDArray[np.float64]:
        with lock:
            return once()[rows]

    return Computed(rows_of, size)
