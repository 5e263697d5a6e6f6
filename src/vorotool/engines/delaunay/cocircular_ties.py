"""All Delaunay triangulations of cocircular points at once: what some of them have, and what all have."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.types.mesh.triangulation import Triangulation


class CocircularTies:
    """The polygons of cocircular points, which may be triangulated in any way."""

    def __init__(self, mesh: Triangulation) -> None:
        one, corner = np.nonzero(mesh.neighbors > np.arange(len(mesh))[:, None])
        other = mesh.neighbors[one, corner]
        a, b = (mesh.triangles[one, (corner + k) % 3] for k in (1, 2))
        apex = mesh.triangles[other].sum(axis=1, dtype=np.int64) - a - b
        quads = np.concatenate([mesh.triangles[one], apex[:, None]], axis=1)
        tie = _core.kernel.incircle(np.ascontiguousarray(mesh.points[quads])) == 0
        polygon = _components(len(mesh), one[tie], other[tie])
        self.unique_triangles = np.bincount(polygon, minlength=len(mesh))[polygon] == 1
        diagonals = np.sort(np.stack([a, b], axis=1)[tie], axis=1)
        self._edges, self._triangles = (
            {tuple(row) for row in np.sort(rows, axis=1).tolist()} for rows in (mesh.edges, mesh.triangles)
        )
        inner = {tuple(row) for row in diagonals.tolist()}
        self.unique_edges = np.array([tuple(row) not in inner for row in mesh.edges.tolist()], dtype=bool)
        self._polygons: dict[int, set[int]] = {}
        for number in np.flatnonzero(~self.unique_triangles).tolist():
            for v in mesh.triangles[number].tolist():
                self._polygons.setdefault(v, set()).add(int(polygon[number]))

    def has_edge(self, edge: tuple[int, ...]) -> bool:
        """Whether some Delaunay triangulation has an edge; indices in increasing order."""
        return edge in self._edges or bool(self._shared(edge))

    def has_triangle(self, triangle: tuple[int, ...]) -> bool:
        """Whether some Delaunay triangulation has a triangle; indices in increasing order."""
        return triangle in self._triangles or bool(self._shared(triangle))

    def _shared(self, vertices: tuple[int, ...]) -> set[int]:
        return set.intersection(*(self._polygons.get(v, set()) for v in vertices))


def _components(count: int, one: NDArray[Any], other: NDArray[Any]) -> NDArray[np.intp]:
    """Number of the component of each vertex of a graph: its smallest vertex."""
    number = np.arange(count)
    while True:
        least = np.minimum(number[one], number[other])
        before = number.copy()
        for end in (one, other):
            np.minimum.at(number, number[end], least)
            np.minimum.at(number, end, least)
        number = number[number]
        if np.array_equal(number, before):
            return number
