"""Tables of a Voronoi map: its borders, pairs of neighbours, and one row a cell."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.geometry.table import Lookup, Table
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
        ``arc, label_a, label_b, kind, x0, y0, r0, x1, y1, r1, cx, cy, length``: the labels of the cells, from 1, the
        smaller first; the ends with the distances from both sites there; the control point of a parabola.

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
            "arc": arc,
            "label_a": low + 1,
            "label_b": high + 1,
            "kind": Lookup(KINDS, kinds_of(cells)[arc]),
            "x0": Lookup(x, source),
            "y0": Lookup(y, source),
            "r0": Lookup(cells.radius, source),
            "x1": Lookup(x, target),
            "y1": Lookup(y, target),
            "r1": Lookup(cells.radius, target),
            "cx": cx,
            "cy": cy,
            "length": cells.length[arc],
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
        ``label_a, label_b, border_length``: labels from 1, the smaller first.

    Examples
    --------
    >>> from vorotool import voronoi
    >>> lattice = [[0, 0], [2, 0], [0, 2], [2, 2]]
    >>> neighbour_table(voronoi(lattice, frame=(-1, -1, 4, 4)))["label_b"].tolist()
    [2, 3, 4, 4]
    """
    pairs, length = neighbour_pairs(cells)
    low, high = np.ascontiguousarray(pairs.T) + 1
    return Table({"label_a": low, "label_b": high, "border_length": length})


def cell_table(cells: VoronoiMap) -> Table:
    """Give one row a cell.

    Parameters
    ----------
    cells : VoronoiMap
        Rows are in the order of its sites.

    Returns
    -------
    Table
        ``label, id, area, perimeter, neighbours, components``, and the columns of the input: label i is that of cell
        i - 1, there is an id if the input has some, and components are the polygons of a cell.

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
        "components": cells.components,
    }
    return Table(columns).with_properties(cells.properties)
