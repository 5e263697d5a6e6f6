"""How the clearance goes along skeletons: exact signs along arcs, plateaus, and local maxima."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.skeleton.site_distances import SitePlaces
from vorotool.numeric.checks import checked_threads
from vorotool.numeric.parallel import Progress
from vorotool.types.skeleton.arc_measures import ClearanceCourse
from vorotool.types.skeleton.segment_voronoi import LATTICE_LIMIT
from vorotool.types.skeleton.skeleton import Skeleton


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
