"""A planar straight-line graph on the lattice, and the Voronoi diagram of its points and open segments."""

from __future__ import annotations

from dataclasses import field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError
from vorotool.frozen import frozen
from vorotool.numeric.checks import set_rows

LATTICE_LIMIT = 2**30 - 1
"""Largest magnitude of a coordinate: products of differences fit in 64 bits."""

_SHAPES = {
    "points": (np.int32, 2),
    "segments": (np.int32, 2),
    "vertices": (np.float64, 2),
    "radius": (np.float64, 0),
    "vertex_starts": (np.int32, 0),
    "vertex_sites": (np.int32, 0),
    "edges": (np.int32, 2),
    "edge_sites": (np.int32, 2),
}


@frozen(eq=False)
class SegmentVoronoiDiagram:
    """The Voronoi diagram of n points and m open segments, in lattice units."""

    points: NDArray[np.int32]  # (n, 2) int32 array: distinct points, at most `LATTICE_LIMIT` in magnitude
    # (m, 2) int32 array: ends of each segment. Segments meet at shared ends only, and no point lies inside one
    segments: NDArray[np.int32]
    # (v, 2) float64 array: centers of the discs that touch three sites or more and hold none inside
    vertices: NDArray[np.float64]
    # (v,) float64 array: their radii; 0 at a point where segments meet, which then is the vertex
    radius: NDArray[np.float64]
    # (v + 1,) int32 array: the sites of vertex i are `vertex_sites[vertex_starts[i]:vertex_starts[i + 1]]`
    vertex_starts: NDArray[np.int32]
    # (k,) int32 array: all sites that the disc touches and whose cells meet there, counter-clockwise from the
    # smallest number. A point whose segments leave no gap of 180 degrees has no cell
    vertex_sites: NDArray[np.int32]
    # (e, 2) int32 array: source and target of each edge; -1 at infinity, as source only of lines without a vertex.
    # Edges between a segment and its own end are included, edges of length zero are not
    edges: NDArray[np.int32]
    edge_sites: NDArray[np.int32]  # (e, 2) int32 array: the sites left and right of source -> target
    counts: dict[str, Any] = field(default_factory=dict)  # statistics of the computation

    def __post_init__(self) -> None:
        for name, (dtype, width) in _SHAPES.items():
            set_rows(self, name, dtype, width)
        for name, count in (
            ("radius", len(self.vertices)),
            ("vertex_starts", len(self.vertices) + 1),
            ("edge_sites", len(self.edges)),
        ):
            if len(getattr(self, name)) != count:
                raise InputError(f"{name} must have {count} rows, but has {len(getattr(self, name))}")

    def __len__(self) -> int:
        return len(self.vertices)

    def sites_of(self, vertex: int) -> NDArray[np.int32]:
        """Sites around a vertex, counter-clockwise from the smallest number."""
        return self.vertex_sites[self.vertex_starts[vertex] : self.vertex_starts[vertex + 1]]
