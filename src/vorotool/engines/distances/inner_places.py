"""Places inside polygons that are farther from a shape than all places around them: Voronoi vertices of the shape."""

from __future__ import annotations

import warnings
from itertools import combinations
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.arrangement.planar_graph import graph_for_skeletons
from vorotool.engines.distances.measured_shape import MeasuredShape
from vorotool.engines.segment_voronoi.segment_voronoi import segment_voronoi, unwanted_sides
from vorotool.errors import RepairWarning
from vorotool.numeric.ragged import ranges
from vorotool.types.distances.distances import PlacePair
from vorotool.types.polygons.planar_graph import PlanarGraph
from vorotool.types.skeleton.segment_voronoi import SegmentVoronoiDiagram

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]

SLACK = 4
"""Steps of the lattice, and moves onto it: what is rounded there changes a radius by less than two of both."""
NEWTON_STEPS = 5
MOST_SITES = 6
"""Of one vertex, of which all threes are tried."""


def farthest_inner_place(of: MeasuredShape, other: MeasuredShape, least: float, threads: int) -> PlacePair | None:
    """Find the place inside the polygons of a shape that is farthest from another shape."""
    if not _core.distances.may_go_farther_inside(of.core, other.core, least, None):
        return None
    with warnings.catch_warnings(action="ignore", category=RepairWarning):
        graph = graph_for_skeletons(other.polygons, threads=threads)
    sides = _sides_inside(graph) if other.is_filled else None
    diagram = segment_voronoi(graph.points, graph.segments, unwanted=sides, threads=threads)
    slack = SLACK * graph.largest_move + 2.0**-40 * graph.scale * float(np.abs(graph.points).max(initial=1))
    chosen = np.flatnonzero((diagram.radius > 0) & (diagram.radius * graph.scale + slack > least))
    if not len(chosen):
        return None
    places = _candidates(graph, diagram, chosen)
    inside = of.core.contained(places, threads, None).view(bool)
    places = places[inside]
    if not len(places):
        return None
    distance, on = other.core.reached(places, threads, None)
    at = int(distance.argmax())
    if distance[at] <= least:
        return None
    (x, y), (to_x, to_y) = places[at].tolist(), on[at].tolist()
    return PlacePair(float(distance[at]), (x, y), (to_x, to_y))


def _sides_inside(graph: PlanarGraph) -> NDArray[np.uint8]:
    """Sides of points and segments on which the diagram is not asked for, since they are inside polygons."""
    sides = unwanted_sides(graph, ~graph.is_inside)
    is_lone = np.ones(len(graph.points), dtype=bool)
    is_lone[graph.segments.ravel()] = False
    sides[: len(graph.points)][is_lone] = 0  # of these the graph does not say where they are
    return sides


def _candidates(graph: PlanarGraph, diagram: SegmentVoronoiDiagram, chosen: Indices) -> Floats:
    """Vertices of the diagram in input units, and where each three of their sites, as they were given, are as far."""
    about = np.array(graph.origin) + graph.scale * diagram.vertices[chosen]
    if graph.largest_move == 0:  # the lattice has the input as it is
        return about
    owner, triples = _triples(diagram, chosen)
    radius = graph.scale * diagram.radius[chosen[owner]]
    sites = _sites_as_given(graph, triples)
    made = _equally_far(about[owner], radius, *sites)
    return np.concatenate([about, made[np.isfinite(made).all(axis=1)]])


def _triples(diagram: SegmentVoronoiDiagram, chosen: Indices) -> tuple[Indices, Indices]:
    """All threes of the sites of each vertex, or of some of them: which of the vertices, and (t, 3) sites."""
    first = diagram.vertex_starts[chosen].astype(np.int64)
    count = np.diff(diagram.vertex_starts)[chosen].astype(np.int64)
    owners, triples = [], []
    for k in np.unique(count).tolist():
        own = np.flatnonzero(count == k)
        sites = diagram.vertex_sites[ranges(first[own], np.full(len(own), k))].reshape(-1, k)
        taken = np.unique(np.linspace(0, k - 1, min(k, MOST_SITES)).astype(np.int64))
        for three in combinations(taken.tolist(), 3):
            owners.append(own)
            triples.append(sites[:, list(three)])
    return np.concatenate(owners).astype(np.int64), np.concatenate(triples).astype(np.int64)


class _Sites(NamedTuple):
    """Sites as they were given: one end, the unit normal of a segment, and which are points."""

    at: Floats
    normal: Floats
    is_point: NDArray[np.bool_]


def _sites_as_given(graph: PlanarGraph, sites: Indices) -> _Sites:
    """Points at the vertices that they are, segments on the edges that they are part of."""
    given = graph.polygons
    assert given is not None
    count = len(graph.points)
    is_point = sites < count
    place = np.array(graph.origin) + graph.scale * graph.points
    known = graph.point_vertex >= 0
    place[known] = given.xy[graph.point_vertex[known]]
    edge = graph.source_edge[graph.source_starts[:-1]].astype(np.int64)
    segment = np.where(is_point, 0, sites - count)
    point = np.where(is_point, sites, 0)
    if not len(edge):
        return _Sites(place[point], np.zeros((*sites.shape, 2)), is_point)
    start, end = given.xy[edge[segment]], given.xy[given.following[edge[segment]]]
    way = end - start
    length = np.sqrt((way * way).sum(axis=-1, keepdims=True))
    normal = np.divide(way[..., ::-1] * (-1, 1), length, out=np.zeros_like(way), where=length > 0)
    return _Sites(np.where(is_point[..., None], place[point], start), normal, is_point)


def _equally_far(about: Floats, radius: Floats, at: Floats, normal: Floats, is_point: NDArray[np.bool_]) -> Floats:
    """Places near others that are equally far from three sites each, by Newton's method; NaN where it fails."""
    p, r = about.copy(), radius.copy()
    side = np.where(((p[:, None] - at) * normal).sum(axis=2) < 0, -1.0, 1.0)
    for _ in range(NEWTON_STEPS):
        away = p[:, None] - at
        length = np.sqrt((away * away).sum(axis=2))
        with np.errstate(all="ignore"):
            slope = np.where(is_point[..., None], away / length[..., None], normal * side[..., None])
            value = np.where(is_point, length, (away * slope).sum(axis=2)) - r[:, None]
            # the differences of the equations have no radius in them
            u, v = slope[:, 1] - slope[:, 0], slope[:, 2] - slope[:, 0]
            f, g = value[:, 0] - value[:, 1], value[:, 0] - value[:, 2]
            whole = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
            step = np.stack([f * v[:, 1] - g * u[:, 1], u[:, 0] * g - v[:, 0] * f], axis=1) / whole[:, None]
            r += value[:, 0] + (slope[:, 0] * step).sum(axis=1)
            p += step
    return p
