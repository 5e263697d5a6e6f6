"""Tables of a Voronoi map: its borders, pairs of neighbours, and one row a cell."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from threading import Lock
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.geometry.table import Computed, Lookup, Table
from vorotool.geometry.voronoi.site_shapes import site_distances
from vorotool.geometry.voronoi.voronoi_map import VoronoiMap

KINDS = ["line", "parabola", "circle"]
"""Of arcs."""


def kinds_of(cells: VoronoiMap) -> NDArray[np.int32]:
    """(a,) the kind of each arc, a number among `KINDS`.

    Examples
    --------
    >>> from vorotool import voronoi
    >>> kinds_of(voronoi([[0, 0]])).tolist()
    [0, 0, 0, 0]
    """
    kinds: NDArray[np.int32] = np.where(cells.is_circle, 2, cells.is_parabola).astype(np.int32)
    return kinds


def border_table(cells: VoronoiMap) -> Table:
    """Give one row an arc between two cells.

    Parameters
    ----------
    cells : VoronoiMap
        Rows are in the order of its arcs; those with one cell only are left out.

    Returns
    -------
    Table
        ``label_a, label_b, kind, x0, y0, x1, y1, cx, cy, length, arc, r0, r1``: the labels of the cells, from 1, the
        smaller first; the ends; the control point of a parabola; the number of the arc, from 0; the distances from both
        sites at the ends, which do not exist on enclosures.

    Examples
    --------
    >>> from vorotool import voronoi
    >>> border_table(voronoi([[0, 0], [4, 0]], frame=(0, 0, 4, 2)))["length"].tolist()
    [2.0]
    """
    arc = np.flatnonzero(cells.is_border)
    low, high = np.sort(cells.sites[arc], axis=1).T
    source, target = np.ascontiguousarray(cells.arcs[arc].T)
    x, y = np.ascontiguousarray(cells.vertices.T)
    cx, cy = np.ascontiguousarray(cells.control[arc].T)
    return Table(
        {
            "label_a": low + 1,
            "label_b": high + 1,
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
        }
    )


def neighbour_pairs(cells: VoronoiMap) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """(n, 2) pairs of cells that share a border of positive length, ascending, and (n,) its length."""
    arc = np.flatnonzero(cells.is_border & (cells.length > 0))
    pair = np.sort(cells.sites[arc], axis=1).astype(np.int64)
    key, row = np.unique(pair[:, 0] * max(len(cells), 1) + pair[:, 1], return_inverse=True)
    pairs = np.stack(np.divmod(key, max(len(cells), 1)), axis=1)
    length: NDArray[np.float64] = np.bincount(row, cells.length[arc], minlength=len(key)).astype(np.float64)
    return pairs, length


def neighbour_table(cells: VoronoiMap) -> Table:
    """Give one row a pair of cells that share a border; cells that meet in places only are none.

    Parameters
    ----------
    cells : VoronoiMap
        With the cells.

    Returns
    -------
    Table
        ``label_a, label_b, border_length, distance``: labels from 1, the smaller first; the distance is that between
        the two sites, 0 where they touch.

    Examples
    --------
    >>> from vorotool import voronoi
    >>> lattice = [[0, 0], [2, 0], [0, 2], [2, 2]]
    >>> neighbour_table(voronoi(lattice, frame=(-1, -1, 4, 4)))["label_b"].tolist()
    [2, 3, 4, 4]
    """
    pairs, length = neighbour_pairs(cells)
    low, high = np.ascontiguousarray(pairs.T) + 1
    distance = _when_asked(lambda: site_distances(cells, pairs), len(pairs))
    return Table({"label_a": low, "label_b": high, "border_length": length, "distance": distance})


def cell_table(cells: VoronoiMap) -> Table:
    """Give one row a cell.

    Parameters
    ----------
    cells : VoronoiMap
        Rows are in the order of its sites.

    Returns
    -------
    Table
        ``label, id, area, perimeter, neighbours, own_area, max_distance, components``, and the columns of the input:
        label i is that of cell i - 1, and there is an id if the input has some. The own area is what the cell has of
        the polygons of its site, the distance the largest from the site within the cell, NaN of an empty one, and
        components are its polygons.

    Examples
    --------
    >>> from vorotool import voronoi
    >>> cell_table(voronoi([[0, 0], [4, 0]], frame=(0, 0, 4, 2)))["neighbours"].tolist()
    [1, 1]
    """
    pairs, _ = neighbour_pairs(cells)
    columns: dict[str, Any] = {"label": np.arange(1, len(cells) + 1)}
    if cells.ids is not None:
        columns["id"] = list(cells.ids)
    columns |= {
        "area": cells.areas,
        "perimeter": cells.perimeters,
        "neighbours": np.bincount(pairs.ravel(), minlength=len(cells)),
        "own_area": _when_asked(lambda: cells.own_areas, len(cells)),
        "max_distance": _when_asked(lambda: cells.reaches, len(cells)),
        "components": cells.components,
    }
    return Table(columns).with_properties(cells.properties)


def _when_asked(function: Callable[[], NDArray[np.float64]], size: int) -> Computed:
    """A column that is computed as a whole, once, by the first thread that asks for rows of it."""
    lock, once = Lock(), cache(function)

    def rows_of(rows: slice) -> NDArray[np.float64]:
        with lock:
            return once()[rows]

    return Computed(rows_of, size)
