"""Voronoi cells of points, and proximity graphs."""

from __future__ import annotations

from dataclasses import field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError
from vorotool.numeric.arrays import Floats, Nesting, divides, following, starts_of
from vorotool.numeric.curves.inverse_functions import hypotenuse
from vorotool.types import fields as f
from vorotool.types.box import Box
from vorotool.types.features import Areas, Rows
from vorotool.types.fields import UNSTATED, YAxis, record
from vorotool.types.mesh.triangulation import ALL, Mesh, Triangulation, lengths_of
from vorotool.types.points.point_set import OfPoints
from vorotool.types.table import Computed
from vorotool.types.values import Geometric, Graph, Pictured, Tabular, Value, counted


@record
class CellSet(OfPoints, Tabular, Geometric, Pictured):
    """Clipped Voronoi cells, one per point, in the order of the points.

    A cell that meets its frame nowhere, or in no area, is empty; so is that of a point which lies on an earlier one.

    Parameters
    ----------
    sites : (n, 2) float64 array
        The points.
    coordinates : (k, 2) float64 array
        Vertices, ring after ring; the first of a ring is not repeated. Shells are counter-clockwise (a positive
        shoelace sum), holes clockwise.
    starts : (r + 1,) int64 array
        Where each ring begins in `coordinates`, and the end.
    frame : Box
        What the cells were clipped to.
    polygon_starts : (p + 1,) int64 array, optional
        The first ring, its shell, of each polygon. Without it ring i is cell i: cells are convex, r = n.
    cell_starts : (n + 1,) int64 array, optional
        The first polygon of each cell; along with `polygon_starts`.
    labels : (n,) int64 array, optional
        The input's own labels. Without them point i has label i + 1.
    properties : dict of str to sequence, optional
        Other columns of the input, one value per point.
    y_axis : {"none", "up", "down"}
        Direction of y where the coordinates come from; "none" where nothing states it.
    crs : object, optional
        The ``crs`` member of a GeoJSON input.
    index : pandas Index, array or sequence, optional
        Names of the points in the input, such as the row index of a data frame: one entry per point.

    Raises
    ------
    InputError
        If the arrays do not fit together.

    Examples
    --------
    >>> cells = CellSet([[1, 1], [3, 1]], [[0, 0], [2, 0], [2, 2], [0, 2], [2, 0], [4, 0], [4, 2], [2, 2]], [0, 4, 8],
    ...                 Box(0, 0, 4, 2))
    >>> len(cells), cells.areas.tolist(), cells.perimeters.tolist()
    (2, [4.0, 4.0], [8.0, 8.0])
    >>> cells.to_shapely()[1].wkt
    'POLYGON ((2 0, 4 0, 4 2, 2 2, 2 0))'
    """

    maker = "voronoi_cells"
    _places = "sites"

    sites: NDArray[np.float64] = f.position("sites", 2)
    coordinates: NDArray[np.float64] = f.position("vertices", 2)
    starts: NDArray[np.int64] = f.numbers(np.int64, "starts")
    frame: Box = f.position()
    polygon_starts: NDArray[np.int64] | None = f.numbers(np.int64, "shells", default=None)
    cell_starts: NDArray[np.int64] | None = f.numbers(np.int64, "cells", default=None)
    labels: NDArray[np.int64] | None = f.numbers(np.int64, "sites", default=None)
    properties: dict[str, Any] = field(default_factory=dict)
    y_axis: YAxis = f.y_axis(default=UNSTATED)
    crs: Any = None
    index: Any = None

    def __post_init__(self) -> None:
        super().__post_init__()
        if (self.polygon_starts is None) != (self.cell_starts is None):
            raise InputError("polygon_starts and cell_starts go together: give both or none")
        count = len(self.coordinates)
        for name in ("starts", "polygon_starts", "cell_starts"):
            if getattr(self, name) is not None:
                object.__setattr__(self, name, _checked_starts(getattr(self, name), count, name))
                count = len(getattr(self, name)) - 1
        if count != len(self.sites):
            raise InputError(f"there are {count} cells, but {len(self.sites)} sites: give one cell per site")

    def __len__(self) -> int:
        return len(self.sites)

    @cached_property
    def nesting(self) -> Nesting:
        """Rings, polygons and cells by where each begins; no ring, and no polygon, is empty."""
        if self.polygon_starts is not None and self.cell_starts is not None:
            return Nesting(self.starts, self.polygon_starts, self.cell_starts)
        kept = np.diff(self.starts) > 0
        rings = np.concatenate([self.starts[:-1][kept], self.starts[-1:]])
        cells = starts_of(kept)
        return Nesting(rings, np.arange(len(rings), dtype=np.int64), cells)

    @property
    def is_empty(self) -> NDArray[np.bool_]:
        """(n,) whether each cell is empty."""
        return np.diff(self.starts if self.cell_starts is None else self.cell_starts) == 0

    @cached_property
    def areas(self) -> NDArray[np.float64]:
        """(n,) areas of the cells, 0 of empty ones.

        The error is about 1e-15 times the square of a ring's diameter.
        """
        return self._areas_of(slice(None))

    def _areas_of(self, rows: slice) -> NDArray[np.float64]:
        xy, rings, cells = self._part(rows)
        left, bottom, right, top = self.frame.sides
        exponent = int(np.frexp(max(right / 2 - left / 2, top / 2 - bottom / 2))[1])  # products do not overflow
        start = np.repeat(xy[rings[:-1]], np.diff(rings), axis=0)
        x, y = np.ldexp(xy - start, -exponent).T
        after = following(rings)
        with np.errstate(over="ignore"):
            return np.ldexp(_sums(x * y[after] - x[after] * y, cells), 2 * exponent - 1)

    @cached_property
    def perimeters(self) -> NDArray[np.float64]:
        """(n,) lengths of the boundaries, those of holes included; 0 of empty cells."""
        return self._perimeters_of(slice(None))

    def _perimeters_of(self, rows: slice) -> NDArray[np.float64]:
        xy, rings, cells = self._part(rows)
        with np.errstate(over="ignore"):  # beyond the largest double: infinite
            step = xy[following(rings)] - xy
            return _sums(hypotenuse(step[:, 0], step[:, 1]), cells)

    def _part(self, rows: slice) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.int64]]:
        """The vertices of some cells, and where each ring and each cell begins among them."""
        begin, end, _ = rows.indices(len(self))
        rings, polygons, cells = self.nesting
        own = rings[polygons[cells[begin]] : polygons[cells[end]] + 1]
        return self.coordinates[own[0] : own[-1]], own - own[0], self.cell_of_vertices[begin : end + 1] - own[0]

    @cached_property
    def cell_of_vertices(self) -> NDArray[np.int64]:
        """(n + 1,) where the vertices of each cell begin in `coordinates`, and the end."""
        rings, polygons, cells = self.nesting
        return rings[polygons[cells]]

    def _features(self, _what: str | None = None, _flatten: float | None = None) -> Rows:
        x, y = np.ascontiguousarray(self.sites.T)
        ours: dict[str, Any] = {"label": self.label_array}
        if "id" in self.properties:
            ours["id"] = self.properties["id"]
        measures = {"area": self._areas_of, "perimeter": self._perimeters_of}
        ours |= {"x": x, "y": y, **{name: Computed(function, len(self)) for name, function in measures.items()}}
        further = {name: column for name, column in self.properties.items() if name != "id"}
        areas = Areas(self.coordinates, self.nesting, in_box=self.polygon_starts is None)
        return Rows(ours, further, self, np.arange(len(self)), areas, ids=self.label_array)

    def _shown_places(self) -> list[Floats]:
        return [np.array(self.frame.sides).reshape(2, 2)]

    def _summary(self) -> str:
        empty = int(np.count_nonzero(self.is_empty))
        cells = counted(len(self), "cell") + (f" ({empty} empty)" if empty else "")
        return f"{cells}, {counted(len(self.coordinates), 'vertex', 'vertices')}"


def _checked_starts(values: Any, count: int, name: str) -> NDArray[np.int64]:
    array = np.ascontiguousarray(values, dtype=np.int64)
    if array.ndim != 1 or not divides(array, count):
        raise InputError(f"{name} must increase from 0 to {count}")
    return array


def _sums(values: NDArray[np.float64], starts: NDArray[np.int64]) -> NDArray[np.float64]:
    """Sum over the vertices of each cell."""
    sums = np.zeros(len(starts) - 1)
    kept = np.diff(starts) > 0
    if kept.any():
        sums[kept] = np.add.reduceat(values, starts[:-1][kept])
    return sums


KINDS = ("gabriel", "relative", "mst")
"""Gabriel graph, relative neighborhood graph, minimum spanning tree: each is part of the one before."""


@record
class ProximityGraph(Mesh, Value, Tabular, Geometric, Graph, Pictured):
    """Edges of a Delaunay triangulation whose ends are near to each other by some rule.

    Parameters
    ----------
    mesh : Triangulation
        Of the points.
    kind : {"gabriel", "relative", "mst"}
        The rule.
    edge_index : (k,) int32 array
        Which edges of the triangulation these are, increasing.

    Examples
    --------
    >>> from vorotool import proximity_graph
    >>> graph = proximity_graph([[0, 0], [4, 0], [0, 3], [1, 1]], "mst")
    >>> graph.edges.tolist(), graph.edge_lengths().round(2).tolist()
    ([[0, 3], [1, 3], [2, 3]], [1.41, 3.16, 2.24])
    """

    maker = "proximity_graph"

    mesh: Triangulation = f.nested()
    kind: str
    edge_index: NDArray[np.int32] = f.index("edges")

    def __len__(self) -> int:
        return len(self.edge_index)

    @property
    def points(self) -> NDArray[np.float64]:
        """(n, 2) coordinates, in the order of the input."""
        return self.mesh.points

    @property
    def edges(self) -> NDArray[np.int32]:
        """(k, 2) ends of the edges, the smaller index first."""
        return self.mesh.edges[self.edge_index]

    @property
    def triangles(self) -> NDArray[np.int32]:
        """(t, 3) triangles of the triangulation."""
        return self.mesh.triangles

    @property
    def label_array(self) -> NDArray[np.int64]:
        """(n,) labels of the points."""
        return self.mesh.label_array

    @property
    def properties(self) -> dict[str, Any]:
        """Further columns of the input, one value a point."""
        return self.mesh.properties

    @property
    def first_number(self) -> int:
        """Number of the first point in files of Triangle."""
        return self.mesh.first_number

    @cached_property
    def hull_edges(self) -> NDArray[np.bool_]:
        """(k,) whether each edge is a side of the hull."""
        return self.mesh.hull_edges[self.edge_index]

    def edge_lengths(self, rows: slice = ALL) -> NDArray[np.float64]:
        """(k,) lengths of the edges, or of some; relative error below 1e-15, infinite beyond the largest double."""
        return lengths_of(self.points, self.edges[rows])

    @cached_property
    def degrees(self) -> NDArray[np.int64]:
        """(n,) how many edges end at each point."""
        return np.bincount(self.edges.reshape(-1), minlength=len(self.points))

    def _summary(self) -> str:
        sizes = (self.kind, counted(len(self.points), "point"), counted(len(self), "edge"))
        return ", ".join(sizes)
