"""The largest discs inside polygons, and all that cannot grow: read off their skeletons."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.from_skeleton.disc_places import Candidates, DiscPlaces, Plateaus, node_candidates
from vorotool.engines.skeleton.clearance import clearance_course, is_maximum, plateaus
from vorotool.engines.skeleton.site_distances import SitePlaces
from vorotool.engines.skeleton_api import skeleton_exact
from vorotool.errors import UsageError
from vorotool.numeric.arrays import Numbers, starts_of, within
from vorotool.numeric.checks import checked_flag
from vorotool.numeric.numbers import whole_number
from vorotool.numeric.parallel import Progress
from vorotool.types.skeleton.discs import Discs
from vorotool.types.skeleton.skeleton import INTERIOR, Skeleton

if TYPE_CHECKING:
    from vorotool.typing import FeaturesChoice, PolygonsLike


def largest_discs(
    polygons: PolygonsLike,
    *,
    count: int | None = None,
    local: bool = False,
    features: FeaturesChoice = "separate",
    strict: bool = False,
    threads: int = 0,
    progress: Progress = None,
) -> Discs:
    """Find the largest discs inside each feature (poles of inaccessibility), exact to rounding.

    Centers are on the axis of a feature: its skeleton, which is computed exactly. There is no tolerance. Radii that
    differ by less than rounding are the same; of such discs the one with the smallest x comes first, and of these that
    with the smallest y. Between parallel edges the largest discs fill a segment: its middle stands for all of them.

    Parameters
    ----------
    polygons : PolygonSet, shapely geometry, GeoSeries, GeoDataFrame, GeoJSON, (n, 2) array, …, or a list of these
        As for `vorotool.skeleton_exact`.
    count : int, optional
        How many of each feature, by default 1: first the largest, then the largest of the axis that is disjoint from
        those before, and so on. Discs may touch. Of a segment between parallel edges on which some discs are not
        disjoint, all others are candidates.
    local : bool
        Instead all discs that are larger than those around them, by default as many as there are. They may overlap.
    features : {"separate", "together"}
        As for `vorotool.skeleton_exact`.
    strict : bool
        Refuse polygons that need repair.
    threads : int
        Number of threads; 0 uses all.
    progress : callable, optional
        Called with the fraction done of each step.

    Returns
    -------
    Discs
        Feature by feature, those of each from the largest; none of a feature without an inside.

    Raises
    ------
    InputError, LimitError
        As for `vorotool.skeleton_exact`.
    UsageError
        If the count is not a positive integer.

    Warns
    -----
    VorotoolWarning
        As for `vorotool.skeleton_exact`.

    Examples
    --------
    >>> discs = largest_discs([[0, 0], [4, 0], [0, 3]])
    >>> discs.xy.tolist(), discs.radius.tolist()
    ([[1.0, 1.0]], [1.0])
    >>> largest_discs([[0, 0], [9, 0], [9, 2], [0, 2]], count=3).xy.tolist()
    [[4.5, 1.0], [1.0, 1.0], [6.5, 1.0]]
    """
    check_count(count)
    skeleton = skeleton_exact(polygons, features=features, strict=strict, threads=threads, progress=progress)
    return discs_of_skeleton(skeleton, count=count, local=local, threads=threads)


def check_count(count: int | None) -> None:
    """Raise UsageError for what is no number of discs."""
    if count is not None and whole_number(count, "the count") < 1:
        raise UsageError(f"the count is {count}: use an integer above 0")


def discs_of_skeleton(skeleton: Skeleton, *, count: int | None = None, local: bool = False, threads: int = 0) -> Discs:
    """Give the largest discs whose centers are on a skeleton inside polygons; arguments as of `largest_discs`."""
    own = skeleton.polygons.feature
    assert own is not None
    is_inside = skeleton.side == INTERIOR
    feature = np.where(is_inside, own[skeleton.polygon] if len(own) else -1, -1).astype(np.intp)
    axis = Axis(skeleton, feature, threads)
    if checked_flag(local, "local"):
        found = axis.maxima().in_order()
        rank = within(np.bincount(found.feature)) if len(found) else np.zeros(0, dtype=np.intp)
        kept = np.flatnonzero(rank < (len(rank) if count is None else count))
        return axis.discs(found[kept], rank[kept], local=True)
    return axis.discs(*axis.largest(1 if count is None else count), local=False)


class Axis:
    """The skeleton inside features, with the places that may be centers."""

    def __init__(self, skeleton: Skeleton, feature: Numbers, threads: int) -> None:
        self.skeleton, self.feature = skeleton, feature
        self.sites = SitePlaces(skeleton)
        self.course = clearance_course(skeleton, threads=threads)
        self.plateau = plateaus(skeleton, self.course)
        self.segments = Plateaus.of(skeleton, self.plateau)
        self.nodes = node_candidates(skeleton, self.feature)
        self.middles = self.segments.middles(skeleton, self.course.slope, self.nodes)

    @property
    def rounding(self) -> float:
        """Discs that overlap by less are taken to touch."""
        return 2 * self.sites.tolerance

    def maxima(self) -> Candidates:
        """All that cannot grow."""
        chosen = is_maximum(self.skeleton, self.course, self.plateau) & (self.middles.feature >= 0)
        return self.middles[np.flatnonzero(chosen)]

    def first(self) -> Candidates:
        """What may be the largest disc of each feature."""
        return self.maxima()

    def is_allowed(self, _candidates: Candidates) -> NDArray[np.bool_] | None:
        """Which places may be centers; None if all may."""
        return None

    @property
    def is_whole(self) -> NDArray[np.bool_]:
        """(p,) plateaus that may be centers everywhere."""
        return np.asarray(self.middles.feature >= 0)

    def more(self) -> Candidates | None:
        """Give candidates that are no nodes."""
        return None

    def largest(self, count: int) -> tuple[Candidates, Numbers]:
        """Discs that are disjoint, and the rank of each in its feature, from 0."""
        left = self.first()
        taken = [left[left.largest(self.rounding)]]
        more = _MoreDiscs(self) if count > 1 else None
        while more is not None and len(taken) < count and len(taken[-1]):
            left = more.after(taken)
            taken.append(left[left.largest(self.rounding)])
        found = taken[0]
        for each in taken[1:]:
            found = found.joined(each)
        rank = np.repeat(np.arange(len(taken)), [len(each) for each in taken])
        order = np.lexsort((rank, found.feature))
        return found[order], rank[order]

    def discs(self, found: Candidates, rank: Numbers, *, local: bool) -> Discs:
        """Give discs with their feet."""
        disc, site = self._touched(found)
        kept = self.distinct(disc, site)
        disc, site = disc[kept], site[kept]
        return Discs(
            found.xy,
            found.radius,
            self.skeleton.polygon[found.arc],
            (rank + 1).astype(np.int32),
            starts_of(np.bincount(disc, minlength=len(found))),
            self.sites.feet(site, found.xy[disc]),
            site,
            self.skeleton.site_table,
            self.skeleton.polygons,
            local,
            self.skeleton.features,
        )

    def _touched(self, found: Candidates) -> tuple[Numbers, NDArray[np.int32]]:
        """Discs and the sites that each touches, ascending."""
        skeleton = self.skeleton
        own = np.repeat(np.arange(len(found)), 2)
        is_inner = np.repeat(found.node < 0, 2)
        pairs = [np.stack([own[is_inner], skeleton.sites[found.arc].ravel()[is_inner]])]
        disc_at = np.full(len(skeleton.vertices), -1)
        disc_at[found.node[found.node >= 0]] = np.flatnonzero(found.node >= 0)
        for k in (0, 1):
            disc = disc_at[skeleton.arcs[:, k]]
            at = np.flatnonzero(disc >= 0)
            pairs += [np.stack([disc[at], skeleton.sites[at, hand]]) for hand in (0, 1)]
        disc, site = np.unique(np.concatenate(pairs, axis=1), axis=1).astype(np.intp)
        return disc, site.astype(np.int32)

    def distinct(self, disc: Numbers, site: NDArray[np.int32]) -> NDArray[np.bool_]:
        """Leave out edges that are touched at an end which is a site, too."""
        ends = self.sites.ends[site]
        keys = np.column_stack([np.repeat(disc, 2), ends.reshape(-1, 2)])
        place = np.unique(keys, axis=0, return_inverse=True)[1].reshape(-1, 2)
        is_edge = self.sites.is_edge[site]
        is_vertex = np.zeros(len(keys), dtype=bool)
        is_vertex[place[~is_edge, 0]] = True
        return np.asarray(~(is_edge & is_vertex[place].any(axis=1)))


class _MoreDiscs:
    """What is left of the axis beside discs that were taken."""

    def __init__(self, axis: Axis) -> None:
        skeleton = axis.skeleton
        self.axis = axis
        self.places = DiscPlaces(skeleton, np.flatnonzero(axis.feature >= 0))
        self.rows = np.arange(len(self.places.arcs))
        is_node = axis.segments.first == axis.segments.last
        self.whole = np.flatnonzero(~is_node & axis.is_whole)
        is_open = np.ones(len(axis.middles), dtype=bool)
        is_open[self.whole] = False
        left = axis.nodes[np.flatnonzero(is_open[axis.plateau] & (axis.nodes.feature >= 0))]
        more = axis.more()
        self.left = self._centers(left if more is None else left.joined(more))

    def after(self, taken: list[Candidates]) -> Candidates:
        """Give what may be the next disc of each feature."""
        last = taken[-1]
        at = self._of_features(last)
        disc = at[self.left.feature]
        self.left = self.left[np.flatnonzero((disc >= 0) & self._is_apart(self.left, last, disc))]
        new = self._ends_of_touched(last, at).joined(self._on_arcs(last, at))
        for each in taken:
            new = new[np.flatnonzero(self._is_apart(new, each, self._of_features(each)[new.feature]))]
        self.left = self.left.joined(self._centers(new))
        whole = self.axis.middles[self.whole]
        return self.left.joined(whole[np.flatnonzero(at[whole.feature] >= 0)])

    def _centers(self, some: Candidates) -> Candidates:
        """Those of discs of some size, where centers may be."""
        some = some[np.flatnonzero(some.radius > self.axis.rounding)]
        allowed = self.axis.is_allowed(some)
        return some if allowed is None else some[np.flatnonzero(allowed)]

    def _of_features(self, discs: Candidates) -> Numbers:
        """The disc of each feature; -1 where there is none."""
        found = np.full(int(self.axis.feature.max(initial=0)) + 1, -1, dtype=np.intp)
        found[discs.feature] = np.arange(len(discs))
        return found

    def _is_apart(self, some: Candidates, discs: Candidates, disc: Numbers) -> NDArray[np.bool_]:
        """Whether each is disjoint from the disc of its feature."""
        way = some.xy - discs.xy[disc]
        apart = np.sqrt((way * way).sum(axis=1)) - (some.radius + discs.radius[disc])
        return np.asarray(apart >= -self.axis.rounding)

    def _ends_of_touched(self, last: Candidates, at: Numbers) -> Candidates:
        """Nodes of plateaus that were whole until the last discs."""
        axis = self.axis
        own = axis.middles[self.whole]
        disc = at[own.feature]
        ends = axis.skeleton.vertices[np.stack([axis.segments.first[self.whole], axis.segments.last[self.whole]])]
        way = ends[1] - ends[0]
        away = last.xy[disc] - ends[0]
        share = np.clip((away * way).sum(axis=1) / np.maximum((way * way).sum(axis=1), np.finfo(float).tiny), 0, 1)
        rest = away - share[:, None] * way
        apart = np.sqrt((rest * rest).sum(axis=1)) - (own.radius + last.radius[disc])
        touched = (disc >= 0) & (apart < -axis.rounding)
        is_new = np.zeros(len(axis.middles), dtype=bool)
        is_new[self.whole[touched]] = True
        self.whole = self.whole[~touched]
        return axis.nodes[np.flatnonzero(is_new[axis.plateau])]

    def _on_arcs(self, last: Candidates, at: Numbers) -> Candidates:
        """Places on arcs whose discs touch the last ones."""
        arcs = self.places.arcs[self.rows]
        feature = self.axis.feature[arcs]
        disc = at[feature]
        self.rows, arcs, feature, disc = (values[disc >= 0] for values in (self.rows, arcs, feature, disc))
        covered, row, u = self.places.touching(self.rows, last.xy[disc], last.radius[disc])
        found = self.places.measures[self.rows[row]]
        made = Candidates(found.place(u), found.radius(u), feature[row], arcs[row], np.full(len(row), -1))
        self.rows = np.delete(self.rows, covered)
        return made
