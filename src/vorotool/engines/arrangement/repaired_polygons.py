"""Polygons as engines use them: repaired, on the lattice, with the planar graph of their rings and its regions."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.frozen import frozen
from vorotool.numeric.arrays import Indices, connected_roots, dots, mask_of, owners, ranges, starts_of
from vorotool.types.polygons.planar_graph import PlanarGraph
from vorotool.types.polygons.polygon_set import HOLE, LINE, SHELL, PolygonSet
from vorotool.types.polygons.shapely_geometry import RingArrays
from vorotool.types.skeleton.segment_voronoi import EDGE, VERTEX, SiteTable


def given_shapes(graph: PlanarGraph) -> tuple[PolygonSet, NDArray[np.int32]]:
    """Return what a graph was made of, and where the lattice has the vertices."""
    assert graph.polygons is not None
    assert graph.vertices is not None
    return graph.polygons, graph.vertices


@frozen(eq=False)
class PlacedShapes:
    """Polygons as they are used."""

    polygons: PolygonSet  # placed rings; where there were repairs, the borders of each connected part of a polygon
    sites: SiteTable  # points of the graph, then segments
    face_polygon: NDArray[np.int32]  # (f,) int32 array: the first of `polygons` that each face lies in; -1 outside
    # (p,) int64 array: the polygon of the input that each of `polygons` is, or is a part of
    source: NDArray[np.int64]


def placed_shapes(graph: PlanarGraph, *, is_repaired: NDArray[np.bool_] | None = None) -> PlacedShapes:
    """Give the rings as they were used."""
    given, places = given_shapes(graph)
    vertex = np.concatenate([graph.point_vertex, graph.source_edge[graph.source_starts[:-1]]]).astype(np.int64)
    moved = given.moved(graph.coordinates(places)) if graph.largest_move > 0 else given
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
    ring = owners(np.diff(polygons.ring_starts), dtype=np.int32)[vertex]
    index = (vertex - polygons.ring_starts[ring]).astype(np.int32)
    none = vertex < 0
    ring[none], index[none] = -1, -1
    return ring, index


class PolygonRegions:
    """The region of each pair of a face and a polygon that it lies in, as a number."""

    def __init__(self, graph: PlanarGraph) -> None:
        polygon = graph.face_polygon.astype(np.int64)
        self._width = int(polygon.max(initial=0)) + 1
        face = owners(np.diff(graph.face_starts))
        self._keys = face * self._width + polygon  # ascending: polygons of a face are
        left, right = graph.segment_faces.astype(np.int64).T
        beside = np.flatnonzero(graph.is_inside[left] & graph.is_inside[right])
        counts = np.diff(graph.face_starts)[left[beside]]
        entry = ranges(graph.face_starts[left[beside]], counts)
        wanted = np.repeat(right[beside], counts) * self._width + polygon[entry]
        rank = np.minimum(np.searchsorted(self._keys, wanted), max(len(self._keys) - 1, 0))
        same = self._keys[rank] == wanted if len(self._keys) else np.zeros(0, dtype=bool)
        self._root = connected_roots(np.stack([entry[same], rank[same]], axis=1), len(self._keys))
        self.of_first = self._root[graph.face_starts[:-1][graph.is_inside]]
        """Of each face inside, in the first of its polygons."""

    def __len__(self) -> int:
        """Give one more than the largest number."""
        return len(self._keys)

    def of(self, face: NDArray[np.integer], polygon: NDArray[np.integer]) -> Indices:
        """Regions of faces in polygons that these lie in."""
        return self._root[np.searchsorted(self._keys, face.astype(np.int64) * self._width + polygon)]


@frozen
class _Rings:
    """Points and segments along rings, one after the other; the kind and the input polygon of each ring."""

    sizes: NDArray[Any]
    kind: NDArray[Any]
    source: NDArray[Any]
    point: NDArray[Any]
    segment: NDArray[Any]


def repaired_polygons(graph: PlanarGraph) -> RepairedPolygons:
    """Polygons as their planar graph has them: what a skeleton is made of, and refers to."""
    given, places = given_shapes(graph)
    borders, lines = _borders(graph), _lines(graph, given)
    rings = _merged(borders, lines, borders.source, lines.source)
    holes = flat_holes(given, places)  # what coincides on the lattice, too
    if holes.any():
        rings = _with_flat_holes(graph, given, rings, holes)
    starts_polygon = rings.kind != HOLE
    source = rings.source[starts_polygon]
    counts = np.bincount(np.cumsum(starts_polygon) - 1)
    made = RingArrays(graph.coordinates_as_given[rings.point], rings.sizes, rings.kind, counts)
    polygons = made.polygons(given, source, connectivity=None)
    if graph.largest_move:
        polygons = polygons.moved(graph.coordinates()[rings.point])
    return RepairedPolygons(polygons, source.astype(np.int32), rings.point, rings.segment)


def _borders(graph: PlanarGraph) -> _Rings:
    core = _core.kernel.PlanarGraph(graph.points, graph.segments, graph.segment_faces)
    found = _core.arrangement.boundary_rings(core, graph.face_starts, graph.face_polygon, None)
    return _Rings(
        np.diff(found["start"]),
        np.where(found["is_hole"] != 0, HOLE, SHELL),
        found["part_polygon"][found["ring_part"]],
        found["point"],
        found["segment"],
    )


def _lines(graph: PlanarGraph, given: PolygonSet) -> _Rings:
    """Each line from its first vertex along the pieces of its edges."""
    lines = np.flatnonzero(given.ring_kind == LINE)
    segment = owners(graph.source_count)
    edge = graph.source_edge
    ring = np.searchsorted(given.ring_starts, edge, side="right") - 1
    on_line = given.ring_kind[ring] == LINE
    segment, edge, ring = segment[on_line], edge[on_line], ring[on_line]
    vertices = given_shapes(graph)[1].astype(np.int64)
    along = vertices[edge + 1] - vertices[edge]
    ends = graph.segments[segment]
    pieces = graph.points[ends].astype(np.int64)
    is_back = dots(pieces[:, 1] - pieces[:, 0], along) < 0
    ends[is_back] = ends[is_back, ::-1]
    # both coordinates are monotone along an edge
    keys = graph.points[ends[:, 0]] * np.sign(along)
    order = np.lexsort((keys[:, 1], keys[:, 0], edge))
    count = np.bincount(np.searchsorted(lines, ring), minlength=len(lines))
    first = _first_points(graph, vertices[given.ring_starts[lines]])
    at = starts_of(count)[:-1]
    return _Rings(
        count + 1,
        np.full(len(lines), LINE),
        given.ring_polygon[lines],
        np.insert(ends[order, 1], at, first),
        np.insert(segment[order], at + count, -1),
    )


def _first_points(graph: PlanarGraph, places: NDArray[np.int64]) -> NDArray[Any]:
    """The point of the graph at each of these places, where there is one."""
    keys = graph.points[:, 0].astype(np.int64) * 2**31 + graph.points[:, 1]
    order = np.argsort(keys, kind="stable")
    return order[np.searchsorted(keys, places[:, 0] * 2**31 + places[:, 1], sorter=order)]


def _merged(a: _Rings, b: _Rings, keys_a: NDArray[Any], keys_b: NDArray[Any]) -> _Rings:
    """Put the rings in the order of keys, those of equal ones as they are."""
    sizes = np.concatenate([a.sizes, b.sizes])
    source = np.concatenate([a.source, b.source])
    order = np.argsort(np.concatenate([keys_a, keys_b]), kind="stable")
    index = ranges(starts_of(sizes)[order], sizes[order])
    return _Rings(
        sizes[order],
        np.concatenate([a.kind, b.kind])[order],
        source[order],
        np.concatenate([a.point, b.point])[index].astype(np.int32),
        np.concatenate([a.segment, b.segment])[index].astype(np.int32),
    )


def _with_flat_holes(graph: PlanarGraph, given: PolygonSet, rings: _Rings, is_flat: NDArray[np.bool_]) -> _Rings:
    """Add the holes that are points or segments to the part of their polygon in which they lie."""
    flat, face = _flat_rings(graph, given, is_flat)
    part = np.cumsum(rings.kind != HOLE) - 1
    edge_part = np.repeat(part, rings.sizes)
    on_border = np.repeat(rings.kind != LINE, rings.sizes)
    inner = _inner_faces(graph, rings.point[on_border], rings.segment[on_border])
    regions = PolygonRegions(graph)
    of_region = np.full(len(regions), -1, dtype=np.int64)
    of_region[regions.of(inner, np.repeat(rings.source, rings.sizes)[on_border])] = edge_part[on_border]
    return _merged(rings, flat, part, of_region[regions.of(face, flat.source)])


def _flat_rings(graph: PlanarGraph, given: PolygonSet, is_flat: NDArray[np.bool_]) -> tuple[_Rings, NDArray[Any]]:
    """Holes of two points for each segment of one that lies in its polygon, and of one point; and their faces."""
    segment = owners(graph.source_count)
    ring = np.searchsorted(given.ring_starts, graph.source_edge, side="right") - 1
    pairs = np.unique(np.stack([segment, given.ring_polygon[ring]], axis=1)[is_flat[ring]], axis=0)
    width = max(len(given), 1)
    keys = owners(np.diff(graph.face_starts)) * width + graph.face_polygon
    sides = graph.segment_faces[pairs[:, 0]].astype(np.int64)
    own = pairs[np.isin(sides * width + pairs[:, 1:], keys).all(axis=1)]
    points, faces, polygons = np.unique(graph.point_holes, axis=0).T
    sizes = np.repeat([2, 1], [len(own), len(points)])
    flat = _Rings(
        sizes,
        np.full(len(sizes), HOLE),
        np.concatenate([own[:, 1], polygons]),
        np.concatenate([graph.segments[own[:, 0]].ravel(), points]),
        np.concatenate([np.repeat(own[:, 0], 2), np.full(len(points), -1)]),
    )
    return flat, np.concatenate([graph.segment_faces[own[:, 0], 0], faces])


def inner_faces(graph: PlanarGraph, used: RepairedPolygons) -> tuple[NDArray[Any], NDArray[Any]]:
    """The face left of each edge of the rings of used polygons, and the polygon of the input that it is of."""
    edges = _border_edges(used)
    faces = _inner_faces(graph, used.point[edges], used.segment[edges])
    return faces, used.source[_polygons_of_edges(used)[edges]]


def parts_of_edges(used: RepairedPolygons) -> NDArray[Any]:
    """The used polygon of each of these edges."""
    return _polygons_of_edges(used)[_border_edges(used)]


def _border_edges(used: RepairedPolygons) -> NDArray[Any]:
    return np.flatnonzero((used.segment >= 0) & ~used.polygons.is_line[_polygons_of_edges(used)])


def _polygons_of_edges(used: RepairedPolygons) -> NDArray[np.int32]:
    return np.repeat(used.polygons.ring_polygon, np.diff(used.polygons.ring_starts))


def _inner_faces(graph: PlanarGraph, point: NDArray[Any], segment: NDArray[Any]) -> NDArray[Any]:
    """The face on the left of each segment, as seen from a point at its end."""
    is_forward = graph.segments[segment, 0] == point
    return graph.segment_faces[segment, np.where(is_forward, 0, 1)]


@frozen(eq=False)
class RepairedPolygons:
    """The rings of a planar graph, and where each vertex and edge is in it."""

    # coordinates after placement, in input units; `PolygonSet.part` counts the parts of a feature of the input
    polygons: PolygonSet
    source: NDArray[np.int32]  # (p,) int32 array: the polygon of the input that each comes from
    point: NDArray[np.int32]  # (n,) int32 array: the point of the graph at each vertex
    # (n,) int32 array: the segment of the graph from each vertex to the next one of its ring; -1 at the end of a line
    segment: NDArray[np.int32]


def flat_holes(polygons: PolygonSet, places: NDArray[Any] | None = None) -> NDArray[np.bool_]:
    """(r,) whether a ring is a hole with vertices at one or two places."""
    hole = np.flatnonzero(polygons.ring_kind == HOLE)
    flat = hole[_are_flat(polygons, polygons.xy if places is None else places, hole)]
    return mask_of(flat, len(polygons.ring_kind))


def with_flat_shells_as_lines(polygons: PolygonSet) -> PolygonSet:
    """Take polygons that are a point or a segment for lines: they are sites, and have no inside."""
    shell = polygons.polygon_starts[:-1]
    is_alone = np.diff(polygons.polygon_starts) == 1
    flat = shell[is_alone & np.equal(polygons.ring_kind[shell], SHELL)]
    flat = flat[_are_flat(polygons, polygons.xy, flat)]
    if not flat.size:
        return polygons
    kind = polygons.ring_kind.copy()
    kind[flat] = LINE
    return replace(polygons, ring_kind=kind)


def _are_flat(polygons: PolygonSet, places: NDArray[Any], ring: Indices) -> NDArray[np.bool_]:
    """(k,) whether some rings have vertices at one or two places."""
    first, size = polygons.ring_starts[ring], polygons.ring_starts[ring + 1] - polygons.ring_starts[ring]
    a, b, c = (places[first + size * third // 3] for third in range(3))
    is_flat = ~((a != b).any(axis=1) & (b != c).any(axis=1) & (c != a).any(axis=1))
    unknown = np.flatnonzero(is_flat)
    if unknown.size:
        first, size = first[unknown], size[unknown]
        is_flat[unknown] = ~_have_three_places(places[ranges(first, size)], starts_of(size)[:-1], owners(size))
    return is_flat


def _have_three_places(places: NDArray[Any], first: Indices, ring: Indices) -> NDArray[np.bool_]:
    is_other = (places != places[first][ring]).any(axis=1)
    vertex = np.where(is_other, np.arange(len(ring)), len(ring))
    second = np.minimum.reduceat(vertex, first)
    second = np.where(second < len(ring), second, first)  # of one place it is the first
    is_third = is_other & (places != places[second][ring]).any(axis=1)
    return np.bincount(ring[is_third], minlength=len(first)) > 0
