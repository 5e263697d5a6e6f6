"""Polygons and lines read back from their planar graph."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.arrangement.flat_rings import flat_holes
from vorotool.engines.arrangement.polygon_regions import PolygonRegions
from vorotool.numeric.ragged import owners, ranges, starts_of
from vorotool.numeric.row_index import index_of_rows
from vorotool.plain import plain
from vorotool.types.polygons.planar_graph import PlanarGraph
from vorotool.types.polygons.polygon_set import HOLE, LINE, SHELL, PolygonSet
from vorotool.types.polygons.repaired_polygons import RepairedPolygons


@plain
class _Rings:
    """Points and segments along rings, one after the other; the kind and the input polygon of each ring."""

    sizes: NDArray[Any]
    kind: NDArray[Any]
    source: NDArray[Any]
    point: NDArray[Any]
    segment: NDArray[Any]


def repaired_polygons(graph: PlanarGraph) -> RepairedPolygons:
    """Polygons as their planar graph has them: what a skeleton is made of, and refers to."""
    assert graph.polygons is not None
    assert graph.vertices is not None
    given = graph.polygons
    borders, lines = _borders(graph), _lines(graph, given)
    rings = _merged(borders, lines, borders.source, lines.source)
    holes = flat_holes(given, graph.vertices)  # what coincides on the lattice, too
    if holes.any():
        rings = _with_flat_holes(graph, given, rings, holes)
    starts_polygon = rings.kind != HOLE
    source = rings.source[starts_polygon]
    polygons = PolygonSet(
        graph.coordinates_as_given[rings.point],
        starts_of(rings.sizes),
        rings.kind,
        np.cumsum(starts_polygon) - 1,
        None if given.ids is None else [given.ids[i] for i in source.tolist()],
        None if given.feature is None else given.feature[source],
        {name: [values[i] for i in source.tolist()] for name, values in given.properties.items()},
        given.y_axis,
        given.crs,
        unit=given.unit,
        index=index_of_rows(given.index, source),
        frame=given.frame,
        page=given.page,
        is_drawing=given.is_drawing,
    )
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
    assert graph.vertices is not None
    vertices = graph.vertices.astype(np.int64)
    along = vertices[edge + 1] - vertices[edge]
    ends = graph.segments[segment]
    pieces = graph.points[ends].astype(np.int64)
    is_back = ((pieces[:, 1] - pieces[:, 0]) * along).sum(axis=1) < 0
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
    parts: NDArray[np.int32] = _polygons_of_edges(used)[_border_edges(used)]
    return parts


def _border_edges(used: RepairedPolygons) -> NDArray[Any]:
    return np.flatnonzero((used.segment >= 0) & ~used.polygons.is_line[_polygons_of_edges(used)])


def _polygons_of_edges(used: RepairedPolygons) -> NDArray[np.int32]:
    return np.repeat(used.polygons.ring_polygon, np.diff(used.polygons.ring_starts))


def _inner_faces(graph: PlanarGraph, point: NDArray[Any], segment: NDArray[Any]) -> NDArray[Any]:
    """The face on the left of each segment, as seen from a point at its end."""
    is_forward = graph.segments[segment, 0] == point
    faces: NDArray[np.int32] = graph.segment_faces[segment, np.where(is_forward, 0, 1)]
    return faces
