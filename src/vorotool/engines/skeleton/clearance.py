"""Distances from the sites of skeletons, and how the clearance goes along arcs: exact signs, plateaus, maxima."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.numeric.arrays import Floats, dots, norms
from vorotool.numeric.checks import checked_threads
from vorotool.numeric.parallel import Progress, Run
from vorotool.types.polygons.planar_graph import PlanarGraph
from vorotool.types.skeleton.arc_measures import ClearanceCourse
from vorotool.types.skeleton.segment_voronoi import EDGE, LATTICE_LIMIT
from vorotool.types.skeleton.skeleton import Skeleton

ULPS = 32
"""Of the largest coordinate: by how much distances may differ. A node is right to 8 ulp of the radius and 2 of its
coordinates, in each of which the radius is at most the extent; placing it rounds once more; the distance is wrong by
four roundings. Inside an arc the control point's error counts half, along the tangents, which changes no distance but
in second order.

The coordinates of a node are doubles on the lattice, whose step is a power of two: relative to its origin. This is near
the middle of all that was placed there; where polygons are a small part of that, as when a hole ends far beyond its
shell, what they have largest is how far they are from it."""


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
        square = dots(way, way)
        t = np.divide(dots(place - a, way), square, out=np.zeros(len(site)), where=square > 0)
        feet: Floats = a + np.clip(t, 0, 1)[:, None] * way
        return np.where((t > 1)[:, None], self.ends[site, 1], feet)

    def distances(self, site: NDArray[np.int32], place: Floats) -> Floats:
        """How far each place is from its closed site."""
        return norms(place - self.feet(site, place))


def clearances(places: Floats, reach: Floats, graph: PlanarGraph, run: Run) -> Floats:
    """(n,) distances of places from the nearest point or segment of a graph; infinite beyond a reach."""
    lattice = np.ascontiguousarray((places - graph.origin) / graph.scale)
    far = np.ascontiguousarray(reach / graph.scale)
    return graph.scale * _core.spatial.clearances(graph.points, graph.segments, lattice, far, **run)


def clearance_course(skeleton: Skeleton, *, threads: int = 0, progress: Progress = None) -> ClearanceCourse:
    """Tell along each arc where the clearance grows, where it is least and where it stays."""
    origin, step = np.asarray(skeleton.origin), skeleton.scale or 1.0
    on_lattice = np.rint((skeleton.site_ends_on(threads) - origin) / step)
    fits = bool((np.abs(on_lattice) <= LATTICE_LIMIT).all())
    slope, least = _core.skeleton.clearance_course(
        np.ascontiguousarray((skeleton.vertices - origin) / step),
        skeleton.radius / step,
        skeleton.arcs,
        skeleton.sites,
        np.clip(on_lattice, -LATTICE_LIMIT, LATTICE_LIMIT).astype(np.int32).reshape(-1, 4),
        SitePlaces(skeleton).tolerance / step,
        fits and skeleton.gap == 0 and skeleton.scale > 0,
        checked_threads(threads),
        progress,
    )
    return ClearanceCourse(slope, least)


def plateaus(skeleton: Skeleton, course: ClearanceCourse) -> NDArray[np.int32]:
    """(v,) the plateau of each node, numbered from 0: nodes that arcs of the same clearance join have the same."""
    flat = np.ascontiguousarray(skeleton.arcs[(course.slope == 0).all(axis=1)])
    joined = _core.graphs.connected_components(flat, len(skeleton.vertices))
    return np.unique(joined, return_inverse=True)[1].astype(np.int32).reshape(-1)


def is_maximum(skeleton: Skeleton, course: ClearanceCourse, plateau: NDArray[np.int32]) -> NDArray[np.bool_]:
    """(p,) whether the clearance shrinks along all ways that leave a plateau."""
    found = np.ones(int(plateau.max(initial=-1)) + 1, dtype=bool)
    found[plateau[skeleton.arcs[course.slope > 0]]] = False
    return found


def maxima(skeleton: Skeleton, course: ClearanceCourse) -> NDArray[np.bool_]:
    """(v,) whether a node is a local maximum of the clearance, or one of several nodes of a plateau that is."""
    plateau = plateaus(skeleton, course)
    return is_maximum(skeleton, course, plateau)[plateau]
