"""The rings of polygons as a planar graph has them, and what each of its sites and faces is there."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.arrangement.polygon_regions import PolygonRegions
from vorotool.engines.arrangement.repaired_polygons import inner_faces, parts_of_edges, repaired_polygons
from vorotool.numeric.ragged import owners
from vorotool.plain import plain
from vorotool.types.polygons.planar_graph import PlanarGraph
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.polygons.repaired_polygons import RepairedPolygons
from vorotool.types.polygons.ring_arrays import RingArrays
from vorotool.types.skeleton.skeleton import EDGE, VERTEX, SiteTable


@plain(eq=False)
class PlacedShapes:
    """Polygons as they are used."""

    polygons: PolygonSet  # placed rings; where there were repairs, the borders of each connected part of a polygon
    sites: SiteTable  # points of the graph, then segments
    face_polygon: NDArray[np.int32]  # (f,) int32 array: the first of `polygons` that each face lies in; -1 outside
    # (p,) int64 array: the polygon of the input that each of `polygons` is, or is a part of
    source: NDArray[np.int64]


def placed_shapes(
    graph: PlanarGraph, *, is_repaired: NDArray[np.bool_] | None = None, threads: int = 0
) -> PlacedShapes:
    """Give the rings as they were used."""
    given = graph.polygons
    assert given is not None
    assert graph.vertices is not None
    vertex = np.concatenate([graph.point_vertex, graph.source_edge[graph.source_starts[:-1]]]).astype(np.int64)
    moved = given.moved(graph.coordinates(graph.vertices)) if graph.largest_move > 0 else given
    if any(graph.repairs.values()):
        if is_repaired is None:
            return _of_borders(graph, given, vertex)
        return _of_some_borders(graph, moved, vertex, is_repaired)
    sites = _table(given, vertex, len(graph), given, vertex)
    return PlacedShapes(moved, sites, _first_polygons(graph), np.arange(len(given)))


def _of_borders(graph: PlanarGraph, given: PolygonSet, source: NDArray[np.int64]) -> PlacedShapes:
    used = repaired_polygons(graph)
    vertex = _vertices_of_sites(graph, used)
    sites = _table(used.polygons, vertex, len(graph), given, source)
    return PlacedShapes(used.polygons, sites, _first_parts(graph, used), used.source.astype(np.int64))


def _vertices_of_sites(graph: PlanarGraph, used: RepairedPolygons) -> NDArray[np.int64]:
    """(s,) the first vertex of used polygons at each site, or from which it leads; their number if there is none."""
    first_at = np.full(len(graph.points), len(used.point), dtype=np.int64)
    np.minimum.at(first_at, used.point, np.arange(len(used.point)))
    first_of = np.full(len(graph), len(used.point), dtype=np.int64)
    has_edge = np.flatnonzero(used.segment >= 0)
    np.minimum.at(first_of, used.segment[has_edge], has_edge)
    return np.concatenate([first_at, first_of])


def _of_some_borders(
    graph: PlanarGraph, given: PolygonSet, source: NDArray[np.int64], is_repaired: NDArray[np.bool_]
) -> PlacedShapes:
    """Rings of polygons that were repaired as they bound them, those of others as they were given."""
    used = repaired_polygons(graph)
    kept, parts = np.flatnonzero(~is_repaired), np.flatnonzero(is_repaired[used.source])
    sources = np.concatenate([kept, used.source[parts]])
    order = np.argsort(sources, kind="stable")
    both = RingArrays.joined([RingArrays.of(given), RingArrays.of(used.polygons)])
    arrays, _, vertices = both.taken(np.concatenate([kept, len(given) + parts])[order])
    polygons = arrays.polygons(given, sources[order])
    if graph.largest_move:
        as_given = np.concatenate([given.as_given.xy, used.polygons.as_given.xy])[vertices]
        polygons = replace(polygons, xy=as_given).moved(polygons.xy)
    place = np.full(len(both.xy) + 1, len(vertices), dtype=np.int64)  # of each vertex of both
    place[vertices] = np.arange(len(vertices))
    own = place[len(given.xy) + _vertices_of_sites(graph, used)]
    known = np.where(source >= 0, place[source], len(vertices))
    sites = _table(polygons, np.where(known < len(vertices), known, own), len(graph), given, source)
    number = np.full(len(both.rings), -1, dtype=np.int32)
    number[np.concatenate([kept, len(given) + parts])[order]] = np.arange(len(order))
    first, part = _first_polygons(graph), _first_parts(graph, used)
    is_part = (first >= 0) & is_repaired[first]
    face = np.where(is_part, number[len(given) + part], number[first])
    face[first < 0] = -1
    return PlacedShapes(polygons, sites, face, sources[order])


def _first_polygons(graph: PlanarGraph) -> NDArray[np.int32]:
    first = np.full(graph.faces, -1, dtype=np.int32)
    first[graph.is_inside] = graph.face_polygon[graph.face_starts[:-1][graph.is_inside]]
    return first


def _first_parts(graph: PlanarGraph, used: RepairedPolygons) -> NDArray[np.int32]:
    """The part of its first polygon that each face is in: faces are connected over segments that do not bound it."""
    regions = PolygonRegions(graph)
    of_region = np.full(len(regions), -1, dtype=np.int32)
    of_region[regions.of(*inner_faces(graph, used))] = parts_of_edges(used)
    first = np.full(graph.faces, -1, dtype=np.int32)
    first[graph.is_inside] = of_region[regions.of_first]
    return first


def _table(
    polygons: PolygonSet, vertex: NDArray[np.int64], segments: int, given: PolygonSet, source: NDArray[np.int64]
) -> SiteTable:
    """Sites by the vertices where they are or begin, among those used and those given (-1: none)."""
    ring, index = _places(polygons, vertex)
    # without repairs the vertices are those given
    source_ring, source_index = (ring, index) if polygons is given else _places(given, source)
    polygon = polygons.ring_polygon[ring]
    kind = np.full(len(vertex), VERTEX, dtype=np.int8)
    kind[len(vertex) - segments :] = EDGE
    first = polygons.polygon_starts.astype(np.int32)[polygon]
    return SiteTable(kind, polygon, ring - first, index, source_ring, source_index)


def _places(polygons: PolygonSet, vertex: NDArray[np.int64]) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """Rings of vertices, and where in these: -1 of those that are -1."""
    ring = _ring_of_vertex(polygons)[vertex]
    index = (vertex - polygons.ring_starts[ring]).astype(np.int32)
    none = vertex < 0
    ring[none], index[none] = -1, -1
    return ring, index


def _ring_of_vertex(polygons: PolygonSet) -> NDArray[np.int32]:
    return owners(np.diff(polygons.ring_starts), dtype=np.int32)
