"""A planar straight-line graph on the lattice, and the Voronoi diagram of its points and open segments."""

from __future__ import annotations

from dataclasses import field, fields
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from vorotool.types import fields as f
from vorotool.types.fields import Record, record

if TYPE_CHECKING:
    from vorotool.types.polygons.polygon_set import PolygonSet

LATTICE_LIMIT = 2**30 - 1
"""Largest magnitude of a coordinate: products of differences fit in 64 bits."""

VERTEX, EDGE = 0, 1
"""Kinds of sites."""


@record
class SegmentVoronoiDiagram(Record):
    """The Voronoi diagram of n points and m open segments, in lattice units."""

    # (n, 2) int32 array: distinct points, at most `LATTICE_LIMIT` in magnitude
    points: NDArray[np.int32] = f.index("points", 2)
    # (m, 2) int32 array: ends of each segment. Segments meet at shared ends only, and no point lies inside one
    segments: NDArray[np.int32] = f.index("segments", 2)
    # (v, 2) float64 array: centers of the discs that touch three sites or more and hold none inside
    vertices: NDArray[np.float64] = f.position("vertices", 2)
    # (v,) float64 array: their radii; 0 at a point where segments meet, which then is the vertex
    radius: NDArray[np.float64] = f.length("vertices")
    # (v + 1,) int32 array: the sites of vertex i are `vertex_sites[vertex_starts[i]:vertex_starts[i + 1]]`
    vertex_starts: NDArray[np.int32] = f.numbers(np.int32, "vertices", rows_of="vertex_sites")
    # (k,) int32 array: all sites that the disc touches and whose cells meet there, counter-clockwise from the
    # smallest number. A point whose segments leave no gap of 180 degrees has no cell
    vertex_sites: NDArray[np.int32] = f.index("vertex_sites")
    # (e, 2) int32 array: source and target of each edge; -1 at infinity, as source only of lines without a vertex.
    # Edges between a segment and its own end are included, edges of length zero are not
    edges: NDArray[np.int32] = f.index("edges", 2)
    # (e, 2) int32 array: the sites left and right of source -> target
    edge_sites: NDArray[np.int32] = f.index("edges", 2)
    counts: dict[str, Any] = field(default_factory=dict)  # statistics of the computation

    def __len__(self) -> int:
        return len(self.vertices)

    def sites_of(self, vertex: int) -> NDArray[np.int32]:
        """Sites around a vertex, counter-clockwise from the smallest number."""
        return self.vertex_sites[self.vertex_starts[vertex] : self.vertex_starts[vertex + 1]]


# ---- what the sites of a skeleton are ------------------------------------------------------------
@record
class SiteTable(Record):
    """The elements of sites: a vertex of a polygon as it was used, or the open edge that begins at a vertex."""

    kind: NDArray[np.int8] = f.numbers(np.int8, "sites")  # (s,) int8 array: `VERTEX` or `EDGE`
    # (s,) int32 array: the polygon; its ring, 0 for the shell or a line; the vertex in the ring, or the one where the
    # edge begins
    polygon: NDArray[np.int32] = f.index("sites")
    # (s,) int32 array: the polygon; its ring, 0 for the shell or a line; the vertex in the ring, or the one where the
    # edge begins
    ring: NDArray[np.int32] = f.index("sites")
    # (s,) int32 array: the polygon; its ring, 0 for the shell or a line; the vertex in the ring, or the one where the
    # edge begins
    index: NDArray[np.int32] = f.index("sites")
    # (s,) int32 array: the ring of the input, counted over all polygons, and the vertex or edge there that it is, or
    # is a part of; -1 for a crossing of edges
    source_ring: NDArray[np.int32] = f.index("sites")
    # (s,) int32 array: the ring of the input, counted over all polygons, and the vertex or edge there that it is, or
    # is a part of; -1 for a crossing of edges
    source_index: NDArray[np.int32] = f.index("sites")
    # (s, 2, 2) float64 array: where sites are that need not be whole edges of the polygons, or their vertices: those
    # of what is outside, where features overlap. NaN for others
    ends: NDArray[np.float64] | None = f.position("sites", 2, 2, default=None)

    def __len__(self) -> int:
        return len(self.kind)

    def rings(self, polygons: PolygonSet, sites: Any = slice(None)) -> NDArray[np.int64]:
        """Rings of all polygons that some sites are on, or all."""
        return polygons.polygon_starts[self.polygon[sites]] + self.ring[sites]

    def vertices(self, polygons: PolygonSet, sites: Any = slice(None)) -> NDArray[np.int64]:
        """Vertices of all polygons that some sites are at, or begin at."""
        return polygons.ring_starts[self.rings(polygons, sites)] + self.index[sites]

    def taken(self, chosen: NDArray[np.intp]) -> SiteTable:
        """Some of the sites."""
        columns = (getattr(self, column.name) for column in fields(self))
        taken: list[Any] = [None if column is None else column[chosen] for column in columns]
        return SiteTable(*taken)


def ends_of_sites(polygons: PolygonSet, table: SiteTable, sites: Any = slice(None)) -> NDArray[np.float64]:
    """(…, 2, 2) the ends of all or some sites of polygons; a vertex has one place twice."""
    polygon, ring, index, kind = (
        column[sites] if isinstance(sites, slice) else column.take(sites)
        for column in (table.polygon, table.ring, table.index, table.kind)
    )
    first = polygons.ring_starts.take(polygons.polygon_starts.take(polygon) + ring) + index
    places = np.empty((*first.shape, 2), dtype=np.int64)
    places[..., 0] = first
    places[..., 1] = np.where(kind == EDGE, polygons.following.take(first), first)
    ends: NDArray[np.float64] = polygons.xy.take(places, axis=0)
    if table.ends is not None:
        own = table.ends[sites] if isinstance(sites, slice) else table.ends.take(sites, axis=0)
        ends = np.where(np.isnan(own), ends, own)
    return ends
