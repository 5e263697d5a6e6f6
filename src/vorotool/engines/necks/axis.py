"""Where the clearance is least along a skeleton, and how the skeleton goes on from there on both sides."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.skeleton.clearance import clearance_course, plateaus
from vorotool.numeric.arrays import Indices
from vorotool.numeric.parallel import Progress
from vorotool.plain import plain
from vorotool.types.skeleton.arc_measures import ClearanceCourse
from vorotool.types.skeleton.skeleton import Skeleton


@plain(eq=False)
class Ways:
    """The two ways that lead on from each neck."""

    # (n, 2) int64 array: the arc that each way begins with: the same twice where the neck is inside an arc
    arc: Indices
    # (n, 2) int64 array: which end of it, or of the half of it that the way takes, is at the neck: 0 the source, 1
    # the target
    end: Indices
    # (n, 2) float64 array: the place half-way along a plateau of several nodes; NaN of other necks
    middle: NDArray[np.float64]
    top: Indices  # (n, 2) int64 array: the plateau up to which the clearance grows along each way

    def __len__(self) -> int:
        return len(self.arc)

    @property
    def is_inside(self) -> NDArray[np.bool_]:
        """(n,) whether each neck is inside an arc, not at a node."""
        return np.equal(self.arc[:, 0], self.arc[:, 1])

    def taken(self, chosen: NDArray[np.bool_] | Indices) -> Ways:
        """Those of some necks."""
        return Ways(self.arc[chosen], self.end[chosen], self.middle[chosen], self.top[chosen])


@plain(eq=False)
class Flow:
    """How the clearance grows from plateau to plateau, most of which are single nodes."""

    course: ClearanceCourse
    plateau: NDArray[np.int32]  # (v,) int32 array: that of each node
    top: Indices  # (p,) int64 array: the local maximum that the clearance grows to from each plateau


def clearance_flow(skeleton: Skeleton, *, threads: int = 0, progress: Progress = None) -> Flow:
    """Follow the clearance upwards from everywhere."""
    course = clearance_course(skeleton, threads=threads, progress=progress)
    plateau = plateaus(skeleton, course)
    top = np.arange(int(plateau.max(initial=-1)) + 1)
    source, target = plateau[skeleton.arcs].T.astype(np.int64)
    rises, falls = (_has(course, signs) for signs in ((1, -1), (-1, 1)))
    top[source[rises]] = target[rises]
    top[target[falls]] = source[falls]
    while True:
        further = top[top]
        if (further == top).all():
            return Flow(course, plateau, top)
        top = further


def ways_from_necks(skeleton: Skeleton, flow: Flow) -> Ways:
    """Find the necks: places inside arcs, and plateaus from which the clearance grows both ways."""
    inside = np.flatnonzero(_has(flow.course, (-1, -1)))
    between, between_end = _rising_pairs(skeleton, flow)
    arc = np.concatenate([np.stack([inside, inside], axis=1), between])
    end = np.concatenate([np.tile([1, 0], (len(inside), 1)), between_end])
    top = flow.top[flow.plateau[skeleton.arcs[arc, 1 - end]]]
    made = Ways(arc, end, np.full((len(arc), 2), np.nan), top)
    node = skeleton.arcs[arc, end]
    is_long = ~made.is_inside & (node[:, 0] != node[:, 1])
    _to_middles(skeleton, flow, made, np.flatnonzero(is_long))
    return made


def _has(course: ClearanceCourse, signs: tuple[int, int]) -> NDArray[np.bool_]:
    found: NDArray[np.bool_] = (course.slope == signs).all(axis=1)
    return found


def _rising_pairs(skeleton: Skeleton, flow: Flow) -> tuple[Indices, Indices]:
    """(n, 2) arcs along which the clearance grows from plateaus that it does not shrink from, and their ends there."""
    slope, plateau = flow.course.slope, flow.plateau[skeleton.arcs]
    falls = np.zeros(len(flow.top), dtype=bool)
    falls[plateau[slope < 0]] = True
    falls[flow.plateau[skeleton.radius == 0]] = True
    arc, end = np.nonzero((slope > 0) & ~falls[plateau])
    own = plateau[arc, end]
    order = np.lexsort((end, arc, own))
    first = np.flatnonzero(np.diff(own[order]) == 0)
    pairs = order[np.stack([first, first + 1], axis=1)]
    return arc[pairs], end[pairs]


def _to_middles(skeleton: Skeleton, flow: Flow, ways: Ways, long: Indices) -> None:
    """Have necks on plateaus of several nodes half-way along these: they are straight lines between parallel edges."""
    if not len(long):
        return
    neck = np.full(len(flow.top), -1)
    ends = skeleton.arcs[ways.arc[long], ways.end[long]]
    neck[flow.plateau[ends[:, 0]]] = np.arange(len(long))
    flat = np.flatnonzero(_has(flow.course, (0, 0)))
    flat = flat[neck[flow.plateau[skeleton.arcs[flat, 0]]] >= 0]
    own = neck[flow.plateau[skeleton.arcs[flat, 0]]]
    begin, way = skeleton.vertices[ends[:, 0]], skeleton.vertices[ends[:, 1]] - skeleton.vertices[ends[:, 0]]
    places = skeleton.vertices[skeleton.arcs[flat]] - begin[own, None]
    along = (places * way[own, None]).sum(axis=2) / np.square(way).sum(axis=1)[own, None]
    beyond = np.maximum(np.abs(along.mean(axis=1) - 0.5) - np.abs(along[:, 1] - along[:, 0]) / 2, 0)
    order = np.lexsort((along.min(axis=1), beyond, own))
    chosen = order[np.flatnonzero(np.diff(own[order], prepend=-1))]
    is_forward = (along[chosen, 0] <= along[chosen, 1]).astype(np.int64)
    ways.arc[long] = flat[chosen, None]
    ways.end[long] = np.stack([is_forward, 1 - is_forward], axis=1)
    ways.middle[long] = begin + way / 2
