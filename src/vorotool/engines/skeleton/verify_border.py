"""Checks of skeletons: by distances, and by areas where the border is open."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.common import fail, first_wrong
from vorotool.engines.skeleton.site_distances import SitePlaces
from vorotool.engines.skeleton.verify_regions import AREA, AREA_ULPS, areas_beside, face_measures
from vorotool.numeric.arrays import Floats, Indices
from vorotool.numeric.numbers import distinct
from vorotool.numeric.parallel import Progress
from vorotool.types.polygons.planar_graph import PlanarGraph
from vorotool.types.skeleton.skeleton import Skeleton


def _is_on_border(skeleton: Skeleton, graph: PlanarGraph) -> tuple[NDArray[np.bool_], Indices]:
    """(m,) which segments are on a side of the frame, and (m,) the axis that this side is across."""
    assert skeleton.frame is not None
    x, y, w, h = skeleton.frame
    ends = graph.coordinates()[graph.segments]
    on_side = [(ends[:, :, axis] == value).all(axis=1) for axis, value in ((0, x), (0, x + w), (1, y), (1, y + h))]
    return np.logical_or.reduce(on_side), np.where(on_side[0] | on_side[1], 0, 1)


def without_border(skeleton: Skeleton, graph: PlanarGraph) -> PlanarGraph:
    """Give what is left of a planar graph without the segments on the border, and points where only these end."""
    is_cut, _ = _is_on_border(skeleton, graph)
    count = len(graph.points)
    kept = np.bincount(graph.segments[~is_cut].ravel(), minlength=count) > 0
    kept |= np.bincount(graph.segments[is_cut].ravel(), minlength=count) == 0
    number = np.cumsum(kept) - 1
    return replace(
        graph,
        points=graph.points[kept],
        segments=number[graph.segments[~is_cut]].astype(np.int32),
        point_vertex=graph.point_vertex[kept],
        source_starts=np.zeros(np.count_nonzero(~is_cut) + 1, dtype=np.int32),
        source_edge=graph.source_edge[:0],
        segment_faces=graph.segment_faces[~is_cut],
        point_holes=graph.point_holes[:0],
    )


def check_cut_regions(skeleton: Skeleton, graph: PlanarGraph, left: PlanarGraph, sites: SitePlaces) -> None:
    """Raise unless arcs end in corners or on the border, and all area is between the axis and its feet."""
    at = first_wrong((skeleton.degree == 1) & (skeleton.radius > 0) & ~skeleton.on_frame)
    if at is not None:
        fail(
            f"the skeleton ends at node {at}, {tuple(skeleton.vertices[at].tolist())}, which is neither a corner nor "
            "on the border"
        )
    count = len(skeleton.polygons)
    summed = np.bincount(skeleton.polygon, areas_beside(skeleton, sites), count)
    summed += np.bincount(*_areas_at_border(skeleton, graph, left), count)
    first = np.full(graph.faces, -1)
    first[graph.is_inside] = graph.face_polygon[graph.face_starts[:-1][graph.is_inside]]
    of_face, around = face_measures(graph)
    inner = first >= 0
    area, perimeter = (np.bincount(first[inner], values[inner], count) for values in (of_face, around))
    allowed = AREA * area + AREA_ULPS * np.spacing(sites.largest) * perimeter
    reaches = np.zeros(count, dtype=bool)  # what has no outline but the border has no feet
    beside = first[np.unique(left.segment_faces)]
    reaches[beside[beside >= 0]] = True
    at = first_wrong(reaches & ~(np.abs(summed - area) <= allowed))
    if at is not None:
        fail(f"the regions around the arcs and the border in polygon {at} sum to {summed[at]}, not to {area[at]}")


def _areas_at_border(skeleton: Skeleton, graph: PlanarGraph, left: PlanarGraph) -> tuple[Indices, Floats]:
    """Of stretches of the border in polygons, between cuts, the polygon and the area to the nearest site."""
    import shapely

    rows = _stretches(skeleton, graph, left)
    if not len(rows) or not len(left.points):
        return np.zeros(0, dtype=np.int64), np.zeros(0)
    polygon, a, b = rows[:, 0].astype(np.int64), rows[:, 1:3], rows[:, 3:5]
    places = left.coordinates()
    lone = np.flatnonzero(np.bincount(left.segments.ravel(), minlength=len(places)) == 0)
    shapes = [*shapely.linestrings(places[left.segments]), *shapely.points(places[lone])]
    ends = np.concatenate([places[left.segments], np.repeat(places[lone][:, None], 2, axis=1)])
    tree = shapely.STRtree(shapes)
    _, near = tree.query_nearest(shapely.points((a + b) / 2), all_matches=False)
    feet = [_feet(ends[near], place) for place in (a, b)]
    one, other = feet[1] - a, feet[0] - b  # diagonals
    return polygon, np.abs(one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0]) / 2


def _feet(ends: Floats, place: Floats) -> Floats:
    way = ends[:, 1] - ends[:, 0]
    square = (way * way).sum(axis=1)
    t = np.divide(((place - ends[:, 0]) * way).sum(axis=1), square, out=np.zeros(len(way)), where=square > 0)
    feet: Floats = ends[:, 0] + np.clip(t, 0, 1)[:, None] * way
    return feet


def _stretches(skeleton: Skeleton, graph: PlanarGraph, left: PlanarGraph) -> Floats:
    """(k, 5) the polygon and both ends: segments on the border, cut where the nearest site may change."""
    is_cut, axis = _is_on_border(skeleton, graph)
    coordinates, inside = graph.coordinates(), graph.is_inside
    nodes = np.flatnonzero(skeleton.touches_frame)
    ways = left.coordinates()[left.segments]
    rows = []
    for segment in np.flatnonzero(is_cut).tolist():
        faces = graph.segment_faces[segment]
        inner = faces[inside[faces]]
        if not len(inner):
            continue
        a, b = coordinates[graph.segments[segment]]
        along = 1 - int(axis[segment])
        low, high = sorted((float(a[along]), float(b[along])))
        own = (left.segment_faces == inner[0]).any(axis=1)
        cuts = np.concatenate([skeleton.vertices[nodes, along], _across_ends(ways[own], float(a[1 - along]), along)])
        ticks = np.unique(np.concatenate([[low, high], cuts[(cuts > low) & (cuts < high)]]))
        ends = np.repeat(a[None], len(ticks), axis=0)
        ends[:, along] = ticks
        polygon = int(graph.face_polygon[graph.face_starts[inner[0]]])
        rows.append(np.column_stack([np.full(len(ticks) - 1, polygon), ends[:-1], ends[1:]]))
    return np.concatenate([np.zeros((0, 5)), *rows])


def _across_ends(edges: Floats, level: float, along: int) -> Floats:
    """Where lines across edges at their ends meet a side of the frame, which is at a level of the other axis."""
    way = edges[:, 1] - edges[:, 0]
    found = []
    for end in (0, 1):
        rise = (edges[:, end, 1 - along] - level) * way[:, 1 - along]
        slope = way[:, along]
        found.append((edges[:, end, along] + rise / np.where(slope == 0, np.inf, slope))[slope != 0])
    return np.concatenate(found)


_INSIDE = (0.25, 0.5, 0.75)
"""Where arcs are looked at between their ends, in the parameter of the Bezier curve."""


def _inner_places(skeleton: Skeleton, t: float) -> Floats:
    source, target = skeleton.vertices[skeleton.arcs].swapaxes(0, 1)
    control = np.where(skeleton.is_parabola[:, None], skeleton.control, (source + target) / 2)
    places: Floats = np.square(1 - t) * source + 2 * t * (1 - t) * control + t * t * target
    return places


def check_equal_distances(skeleton: Skeleton, sites: SitePlaces) -> None:
    """Raise unless nodes are as far from the sites of their arcs as they say, and the insides of arcs from both."""
    for end in (0, 1):
        node = skeleton.arcs[:, end]
        for hand in (0, 1):
            site = skeleton.sites[:, hand]
            distance = sites.distances(site, skeleton.vertices[node])
            at = first_wrong(~(np.abs(distance - skeleton.radius[node]) <= sites.tolerance))
            if at is not None:
                k = int(node[at])
                fail(
                    f"node {k} at {tuple(skeleton.vertices[k].tolist())} is {distance[at]} from site {site[at]}, "
                    f"but its radius is {skeleton.radius[k]}"
                )
    for t in _INSIDE:
        place = _inner_places(skeleton, t)
        left, right = (sites.distances(skeleton.sites[:, hand], place) for hand in (0, 1))
        # moved along the curve by the rounding of a far control point, a place is still on it
        at = first_wrong(~(np.abs(left - right) <= sites.tolerance * _looseness(skeleton, sites)))
        if at is not None:
            fail(
                f"arc {at} is {left[at]} from site {skeleton.sites[at, 0]} and {right[at]} from {skeleton.sites[at, 1]}"
            )


def _looseness(skeleton: Skeleton, sites: SitePlaces) -> Floats:
    """How much more than at nodes distances may differ inside an arc: a far control point is rounded in its own ulp."""
    source = skeleton.vertices[skeleton.arcs[:, 0]]
    way = np.where(skeleton.is_parabola[:, None], skeleton.control - source, 0)
    looseness: Floats = 1 + np.sqrt((way * way).sum(axis=1)) / sites.largest
    return looseness


def check_nothing_nearer(
    skeleton: Skeleton, sites: SitePlaces, graph: PlanarGraph, threads: int, progress: Progress
) -> None:
    """Nodes and places inside arcs: no site within their distance from their own."""
    inner = [_inner_places(skeleton, t) for t in _INSIDE]
    nodes = distinct(skeleton.arcs)
    places = np.concatenate([skeleton.vertices[nodes], *inner])
    distance = np.concatenate(
        [skeleton.radius[nodes], *(sites.distances(skeleton.sites[:, 0], place) for place in inner)]
    )
    lattice = np.ascontiguousarray((places - graph.origin) / graph.scale)
    reach = np.ascontiguousarray(distance / graph.scale)
    nearest = graph.scale * _core.spatial.clearances(graph.points, graph.segments, lattice, reach, threads, progress)
    at = first_wrong(nearest < distance - sites.tolerance)
    if at is not None:
        what = f"node {nodes[at]}" if at < len(nodes) else f"arc {(at - len(nodes)) % len(skeleton)}"
        fail(f"{what}: a site is {nearest[at]} from {tuple(places[at].tolist())}, nearer than {distance[at]}")
