"""Checks of skeletons by distances: nodes and arcs lie between their sites, and no site is nearer."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.errors import VerificationError
from vorotool.geometry.polygons.planar_graph import PlanarGraph
from vorotool.geometry.progress import Progress
from vorotool.geometry.skeleton.skeleton import EDGE, Skeleton

Floats = NDArray[np.float64]

ULPS = 32
"""Of the largest coordinate: by how much distances may differ. A node is right to 8 ulp of the radius and 2 of its
coordinates, in each of which the radius is at most the extent; placing it rounds once more; the distance is wrong by
four roundings. Inside an arc the control point's error counts half, along the tangents, which changes no distance but
in second order.

The coordinates of a node are doubles on the lattice, whose step is a power of two: relative to its origin. This is near
the middle of all that was placed there; where polygons are a small part of that, as when a hole ends far beyond its
shell, what they have largest is how far they are from it."""


def fail(message: str) -> None:
    """Raise VerificationError."""
    raise VerificationError(message)


def first_wrong(wrong: NDArray[np.bool_]) -> int | None:
    """Where the first of some faults is, if any."""
    at = np.flatnonzero(wrong)
    return int(at[0]) if at.size else None


def largest_coordinate(origin: tuple[float, float], *places: Floats) -> float:
    """The largest of some coordinates, and of those that they have from the origin of a lattice: see `ULPS`."""
    return max(float(np.abs(xy - near).max(initial=0.0)) for xy in places for near in ((0.0, 0.0), origin))


class SitePlaces:
    """The places of sites, and distances from them, as exact as those of the `whole` that the skeleton is a part of."""

    def __init__(self, skeleton: Skeleton, whole: SitePlaces | None = None) -> None:
        self.is_edge = skeleton.site_table.kind == EDGE
        self.ends = skeleton.site_ends
        self.largest = largest_coordinate(skeleton.origin, skeleton.polygons.xy, skeleton.vertices) or 1.0
        self.tolerance = ULPS * float(np.spacing(self.largest))
        if skeleton.gap:  # ends of shortened edges are on the lattice, within 0.71 steps of where they should be
            extent = float(np.ptp(skeleton.polygons.xy, axis=0).max())
            self.tolerance += max(extent * 2.0**-28, skeleton.scale)
        if whole is not None:
            self.largest, self.tolerance = max(self.largest, whole.largest), max(self.tolerance, whole.tolerance)

    def feet(self, site: NDArray[np.int32], place: Floats) -> Floats:
        """The nearest place on each closed site."""
        a, way = self.ends[site, 0], self.ends[site, 1] - self.ends[site, 0]
        square = (way * way).sum(axis=1)
        t = np.divide(((place - a) * way).sum(axis=1), square, out=np.zeros(len(site)), where=square > 0)
        feet: Floats = a + np.clip(t, 0, 1)[:, None] * way
        return np.where((t > 1)[:, None], self.ends[site, 1], feet)

    def distances(self, site: NDArray[np.int32], place: Floats) -> Floats:
        """How far each place is from its closed site."""
        way = place - self.feet(site, place)
        return np.asarray(np.sqrt((way * way).sum(axis=1)))


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
    nodes = np.unique(skeleton.arcs)
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
