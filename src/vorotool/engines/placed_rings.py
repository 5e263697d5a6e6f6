"""The rings of polygons as a planar graph has them, and what each of its sites is there."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.geometry.planar_graph import PlanarGraph
from vorotool.geometry.polygons import LINE, PolygonSet
from vorotool.geometry.skeleton import EDGE, VERTEX, SiteTable


def placed_polygons(graph: PlanarGraph, *, threads: int = 0) -> tuple[PolygonSet, SiteTable]:
    """Give the rings as they were used: vertices on the lattice, edges cut where the segments of the graph are.

    Edges without length are left out. What bounds nothing stays in the rings, which the even-odd rule allows, but is no
    site. So polygons and rings have the numbers of the input.

    Parameters
    ----------
    graph : PlanarGraph
        Of polygons.
    threads : int
        0 uses all.

    Returns
    -------
    polygons : PolygonSet
        With the ids and properties of the input.
    sites : SiteTable
        Points of the graph, then segments.

    Examples
    --------
    >>> from vorotool.engines.planar_graph import planar_graph
    >>> polygons, sites = placed_polygons(planar_graph([[0, 0], [4, 0], [4, 4]]))
    >>> polygons.xy.tolist(), sites.index.tolist()
    ([[0.0, 0.0], [4.0, 0.0], [4.0, 4.0]], [0, 1, 2, 0, 1, 2])
    """
    given = graph.polygons
    assert given is not None
    if not any(graph.repairs.values()):
        return _only_placed(graph, given, threads)
    return _cut(graph, given, threads)


def _only_placed(graph: PlanarGraph, given: PolygonSet, threads: int) -> tuple[PolygonSet, SiteTable]:
    """Without repairs each edge is one segment, and vertices are points."""
    vertex = np.concatenate([graph.point_vertex, graph.source_edge[graph.source_start[:-1]]])
    ring = _ring_of_vertex(given.ring_start)[vertex]
    index = vertex - given.ring_start[ring]
    table = _table(len(graph.points), len(graph), given, ring, index, index)
    if graph.largest_move == 0:
        return given, table
    lattice, *_ = _core.place_on_lattice(given.xy, threads, None)
    return _with_rings(given, graph.coordinates(lattice), given.ring_start), table


def _cut(graph: PlanarGraph, given: PolygonSet, threads: int) -> tuple[PolygonSet, SiteTable]:
    lattice, *_ = _core.place_on_lattice(given.xy, threads, None)
    ring_of = _ring_of_vertex(given.ring_start)
    following = _following(given)
    numbers = _PointNumbers(graph.points)
    segment = np.repeat(np.arange(len(graph)), np.diff(graph.source_start))
    edge = np.concatenate([graph.source_edge, graph.source_edge])  # that has a segment with an end at the point
    point = np.concatenate([graph.segments[segment, 0], graph.segments[segment, 1]])
    place = graph.points[point]
    is_new = (place != lattice[edge]).any(axis=1) & (place != lattice[following[edge]]).any(axis=1)
    kept = _with_length(given, lattice, following)
    # vertices of the new rings: by edge of the input, and along it
    edges = np.concatenate([kept, edge[is_new]])
    places = np.concatenate([lattice[kept], place[is_new]]).astype(np.int64)
    way = (lattice[following[edges]].astype(np.int64) - lattice[edges]) * (places - lattice[edges])
    order = np.lexsort((places[:, 1], places[:, 0], way.sum(axis=1), edges))
    edges, places = edges[order], places[order]
    is_first = np.ones(len(edges), dtype=bool)  # an end of two segments is one vertex
    is_first[1:] = (edges[1:] != edges[:-1]) | (places[1:] != places[:-1]).any(axis=1)
    edges, places = edges[is_first], places[is_first]
    starts = np.searchsorted(ring_of[edges], np.arange(len(given.ring_start))).astype(np.int64)
    polygons = _with_rings(given, graph.coordinates(places), starts)
    # sites: the first vertex at each point, and on each segment's first edge the end that comes first
    at = numbers.of(places)
    vertex = np.full(len(graph.points), len(edges), dtype=np.int64)
    np.minimum.at(vertex, at[at >= 0], np.flatnonzero(at >= 0))
    found = np.lexsort((at, edges))
    key = edges[found] * (len(graph.points) + 1) + at[found] + 1
    first_edge = graph.source_edge[graph.source_start[:-1]].astype(np.int64)
    wanted = first_edge[:, None] * (len(graph.points) + 1) + graph.segments + 1
    rank = np.searchsorted(key, wanted)
    # the end of the whole edge may be no vertex of it, but of the next edge: the other one counts then
    exists = key[np.minimum(rank, len(key) - 1)] == wanted
    rows = np.where(exists, found[np.minimum(rank, len(key) - 1)], len(edges)).min(axis=1)
    row = np.concatenate([vertex, rows])
    ring = ring_of[edges[row]]
    is_own = np.concatenate([(places[vertex] == lattice[edges[vertex]]).all(axis=1), np.ones(len(graph), dtype=bool)])
    source = np.where(is_own, edges[row] - given.ring_start[ring], -1)
    return polygons, _table(len(graph.points), len(graph), given, ring, row - starts[ring], source)


def _table(
    points: int,
    segments: int,
    given: PolygonSet,
    ring: NDArray[np.int64],
    index: NDArray[np.int64],
    source: NDArray[np.int64],
) -> SiteTable:
    polygon = given.ring_polygon[ring]
    kind = np.repeat(np.array([VERTEX, EDGE], dtype=np.int8), [points, segments])
    return SiteTable(kind, polygon, ring - given.polygon_start[polygon], index, source)  # type: ignore[arg-type]


def _with_rings(given: PolygonSet, xy: NDArray[np.float64], starts: NDArray[np.int64]) -> PolygonSet:
    return PolygonSet(
        xy,
        starts,
        given.ring_kind,
        given.ring_polygon,
        given.ids,
        given.feature,
        given.properties,
        given.y_up,
        given.crs,
    )


def _ring_of_vertex(starts: NDArray[np.int64]) -> NDArray[np.int64]:
    return np.repeat(np.arange(len(starts) - 1), np.diff(starts))


def _following(given: PolygonSet) -> NDArray[np.int64]:
    """(n,) the next vertex of the ring; of the last of a line, itself."""
    following = np.arange(1, len(given.xy) + 1)
    last = given.ring_start[1:] - 1
    following[last] = np.where(given.ring_kind == LINE, last, given.ring_start[:-1])
    return following


def _with_length(given: PolygonSet, lattice: NDArray[np.int32], following: NDArray[np.int64]) -> NDArray[np.int64]:
    """Vertices at which an edge with a length begins, or a line ends; one of a ring without any."""
    has_length = (lattice != lattice[following]).any(axis=1)
    has_length[given.ring_start[1:][given.ring_kind == LINE] - 1] = True
    lengths = np.add.reduceat(has_length.astype(np.int64), given.ring_start[:-1])
    has_length[given.ring_start[:-1][lengths == 0]] = True
    return np.flatnonzero(has_length)


class _PointNumbers:
    """Finds lattice points by their coordinates."""

    def __init__(self, points: NDArray[np.int32]) -> None:
        keys = self._keys(points)
        self._order = np.argsort(keys)
        self._keys_in_order = keys[self._order]

    @staticmethod
    def _keys(points: NDArray[np.integer]) -> NDArray[np.int64]:
        return (points[:, 0].astype(np.int64) << 32) + points[:, 1]

    def of(self, places: NDArray[np.integer]) -> NDArray[np.int64]:
        """(k,) the number of the point at each place, or -1."""
        if not len(self._order):
            return np.full(len(places), -1, dtype=np.int64)
        keys = self._keys(places)
        rank = np.minimum(np.searchsorted(self._keys_in_order, keys), len(self._order) - 1)
        return np.where(self._keys_in_order[rank] == keys, self._order[rank], -1)
