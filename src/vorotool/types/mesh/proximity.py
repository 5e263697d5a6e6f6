"""Graphs of points that are near to each other: parts of a triangulation."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.types import fields as f
from vorotool.types.fields import record
from vorotool.types.mesh.triangulation import ALL, Mesh, Triangulation, lengths_of
from vorotool.types.values import Geometric, Graph, Pictured, Tabular, Value, counted, placed

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
        return placed(", ".join(sizes), self.crs)
