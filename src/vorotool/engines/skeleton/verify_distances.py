"""Checks of skeletons by distances: nodes and arcs lie between their sites, and no site is nearer."""

from __future__ import annotations

import numpy as np

from vorotool import _core
from vorotool.engines.common.faults import fail, first_wrong
from vorotool.engines.skeleton.site_distances import Floats, SitePlaces
from vorotool.numeric.progress import Progress
from vorotool.numeric.sorted_sets import distinct
from vorotool.types.polygons.planar_graph import PlanarGraph
from vorotool.types.skeleton.skeleton import Skeleton

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
