"""The largest discs inside polygons, and all that cannot grow: read off their skeletons."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.skeleton.clearance import SitePlaces, clearance_course, is_maximum, plateaus
from vorotool.engines.skeleton_api import skeleton_exact
from vorotool.errors import UsageError
from vorotool.frozen import frozen
from vorotool.numeric.arrays import Columns, Floats, Numbers, dots, mask_of, norms, starts_of, within
from vorotool.numeric.checks import checked_flag
from vorotool.numeric.numbers import shown_number, whole_number
from vorotool.numeric.parallel import Progress
from vorotool.types.skeleton.arc_measures import ArcMeasures
from vorotool.types.skeleton.discs import Discs
from vorotool.types.skeleton.segment_voronoi import EDGE
from vorotool.types.skeleton.skeleton import INTERIOR, Skeleton

if TYPE_CHECKING:
    from vorotool.typing import FeaturesChoice, PolygonsLike

_ENDS = ((0, 0), (0, 2), (2, 2))
"""Of a linear function, whose square has the products of its values there as Bernstein coefficients."""

_STEPS = 3
"""Of Newton's method, which starts at the rounded root of a quadratic polynomial."""


class DiscPlaces:
    """Where discs on some arcs of a skeleton touch others."""

    def __init__(self, skeleton: Skeleton, arcs: NDArray[np.intp]) -> None:
        self.arcs, self.measures = arcs, skeleton.measures(arcs)
        sites = skeleton.sites[arcs]
        is_edge = skeleton.site_table.kind[sites] == EDGE
        self.is_line = is_edge.all(axis=1)
        self.is_parting = ~is_edge.any(axis=1)
        vertex = np.where(is_edge[:, 0], sites[:, 1], sites[:, 0])
        self.vertex = skeleton.site_ends[vertex, 0]
        m = self.measures
        self._radii = np.stack([m.r0, np.where(m.is_parabola, m.r0 + m.along * m.slope0 / 2, (m.r0 + m.r1) / 2), m.r1])

    def touching(
        self, rows: NDArray[np.intp], center: Floats, radius: Floats
    ) -> tuple[NDArray[np.intp], NDArray[np.intp], Floats]:
        """Tell where discs on arcs touch given ones."""
        coefficients, rest = self._polynomial(rows, center, radius)
        least, most = coefficients.min(axis=0), coefficients.max(axis=0)
        covered = np.flatnonzero((least > 0) & ~self.is_parting[rows])
        crossed = np.flatnonzero((most > 0) & (least <= 0))
        roots = bernstein_roots(*coefficients[:, crossed])
        hand, place = np.nonzero((roots > 0) & (roots < 1))
        at, u = crossed[place], roots[hand, place]
        kept = rest[0, at] * (1 - u) + rest[1, at] * u >= 0
        at, u = at[kept], u[kept]
        return covered, at, self._refined(rows[at], u, center[at], radius[at])

    def _polynomial(self, rows: NDArray[np.intp], center: Floats, radius: Floats) -> tuple[Floats, Floats]:
        """Bernstein coefficients of what is positive where discs overlap; at both ends what must not be negative."""
        m, r = self.measures[rows], self._radii[:, rows]
        places = np.stack([m.source, m.control, m.target])
        away, both = places - center, r + radius
        on_lines = np.stack([both[i] * both[j] - dots(away[i], away[j]) for i, j in _ENDS])
        vertex = self.vertex[rows]
        way = center - vertex
        known = (dots(way, way) - radius * radius) / 2
        left = known - dots(places - vertex, way)
        on_parabolas = radius * r - left
        x = np.stack([m.slope0, m.slope0, m.slope1])
        squares = radius * radius * m.half * m.half
        apart = np.stack([squares * (1 + x[i] * x[j]) - left[i] * left[j] for i, j in _ENDS])
        is_line, is_parting = self.is_line[rows], self.is_parting[rows]
        found = np.where(is_line, on_lines, np.where(is_parting, apart, on_parabolas))
        return found, np.where(is_parting, left[[0, 2]], 1.0)

    def _refined(self, rows: NDArray[np.intp], u: Floats, center: Floats, radius: Floats) -> Floats:
        """Newton's method on the distance itself, where it brings discs nearer to touching."""
        m = self.measures[rows]
        excess, slope = _excess(m, u, center, radius)
        for _ in range(_STEPS):
            step = np.divide(excess, slope, out=np.zeros_like(u), where=slope != 0)
            moved = np.clip(u - step, 0, 1)
            new, new_slope = _excess(m, moved, center, radius)
            better = np.abs(new) < np.abs(excess)
            if not better.any():
                break
            u, excess = np.where(better, moved, u), np.where(better, new, excess)
            slope = np.where(better, new_slope, slope)
        return u


def _excess(m: ArcMeasures, u: Floats, center: Floats, radius: Floats) -> tuple[Floats, Floats]:
    """By how much a disc at u is farther from the given one than touching, and its derivative."""
    away = m.place(u) - center
    distance = norms(away)
    control = m.control
    v = u[:, None]
    moving = 2 * ((1 - v) * (control - m.source) + v * (m.target - control))
    ratio = np.divide(dots(away, moving), distance, out=np.zeros_like(distance), where=distance > 0)
    return distance - (m.radius(u) + radius), ratio - _growth(m, u)


def _growth(m: ArcMeasures, u: Floats) -> Floats:
    """How fast the radius grows with u."""
    bend = m.slope1 - m.slope0
    slope = m.slope0 + u * bend
    parting = m.half * slope * bend / np.sqrt(1 + slope * slope)
    return np.where(m.is_parabola, m.along * slope, np.where(m.is_parting, parting, m.r1 - m.r0))


def bernstein_roots(first: Floats, middle: Floats, last: Floats) -> Floats:
    """(2, n) real roots of first (1 - u)^2 + 2 middle u (1 - u) + last u^2, without cancellation; NaN where none is."""
    b = middle - first
    a = first - 2 * middle + last
    square = middle * middle - first * last
    with np.errstate(invalid="ignore", divide="ignore"):
        root = np.sqrt(np.where(square >= 0, square, np.nan))
        q = -(b + np.where(b >= 0, root, -root))
        return np.stack([q / a, first / q])


TIE = 2.0**-48
"""Of a radius: those that differ by less are the same, as they are right to 10 roundings."""


@frozen(eq=False)
class Candidates(Columns):
    """Places with the discs around them."""

    xy: Floats  # (n, 2) and (n,) float64 array: the discs
    radius: Floats  # (n, 2) and (n,) float64 array: the discs
    feature: Numbers  # (n,) int array: whose they are
    arc: Numbers  # (n,) int array: the arc that each is on; the node that it is, or -1
    node: Numbers  # (n,) int array: the arc that each is on; the node that it is, or -1

    def __len__(self) -> int:
        return len(self.radius)

    def largest(self, rounding: float) -> Numbers:
        """Give the first of each feature: of the largest ones with the smallest x, of these with the smallest y."""
        order = np.argsort(self.feature, kind="stable")
        for values, slack in ((-self.radius, TIE * self.radius), (self.xy[:, 0], rounding), (self.xy[:, 1], rounding)):
            order = _least(order, self.feature, values, np.broadcast_to(slack, values.shape))
        first = np.flatnonzero(np.diff(self.feature[order], prepend=-1))
        return order[first]

    def in_order(self) -> Candidates:
        """By features, then from the largest, by x and y."""
        return self[np.lexsort((self.xy[:, 1], self.xy[:, 0], -self.radius, self.feature))]


def _least(order: Numbers, feature: Numbers, values: Floats, slack: Floats) -> Numbers:
    """Those whose value is the least of their feature, or more by no more than a slack."""
    start = np.flatnonzero(np.diff(feature[order], prepend=-1))
    if not len(start):
        return order
    own = np.repeat(np.arange(len(start)), np.diff(start, append=len(order)))
    least = np.minimum.reduceat(values[order], start)
    return order[values[order] <= least[own] + slack[order]]


@frozen(eq=False)
class Plateaus:
    """Segments on which the clearance is the same everywhere, and nodes, which are segments without length."""

    number: NDArray[np.int32]  # (v,) int32 array: the plateau of each node
    first: Numbers  # (p,) int array: its ends: the nodes with the smallest and the largest x, of several y
    last: Numbers  # (p,) int array: its ends: the nodes with the smallest and the largest x, of several y

    @classmethod
    def of(cls, skeleton: Skeleton, number: NDArray[np.int32]) -> Plateaus:
        """Find the ends of plateaus, numbered by `vorotool.engines.skeleton.clearance.plateaus`."""
        order = np.lexsort((skeleton.vertices[:, 1], skeleton.vertices[:, 0], number))
        start = np.flatnonzero(np.diff(number[order], prepend=-1))
        return cls(number, order[start], order[np.append(start[1:], len(order)) - 1] if len(start) else start)

    def middles(self, skeleton: Skeleton, course_slope: NDArray[np.int8], of_node: Candidates) -> Candidates:
        """(p,) give the middle of each; of a node by itself that node."""
        made = of_node[self.first]
        ends = skeleton.vertices[np.stack([self.first, self.last])]
        long = self.first != self.last
        xy = np.where(long[:, None], (ends[0] + ends[1]) / 2, ends[0])
        node = np.where(long, -1, made.node)
        arc = made.arc.copy()
        flat = np.flatnonzero((course_slope == 0).all(axis=1))
        own = self.number[skeleton.arcs[flat, 0]]
        way = ends[1][own] - ends[0][own]
        away = [dots(skeleton.vertices[skeleton.arcs[flat, k]] - xy[own], way) for k in (0, 1)]
        inside = away[0] * away[1] <= 0
        arc[own[inside]] = flat[inside]
        for k in (0, 1):
            at = away[k] == 0
            node[own[at]] = np.where(long[own[at]], skeleton.arcs[flat[at], k], node[own[at]])
        return replace(made, xy=xy, arc=arc, node=node)


def node_candidates(skeleton: Skeleton, feature: Numbers) -> Candidates:
    """(v,) all nodes."""
    count = len(skeleton.vertices)
    arc = np.zeros(count, dtype=np.intp)
    for k in (1, 0):
        arc[skeleton.arcs[::-1, k]] = np.arange(len(skeleton) - 1, -1, -1)
    return Candidates(skeleton.vertices, skeleton.radius, feature[arc], arc, np.arange(count))


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
        raise UsageError(f"the count is {shown_number(count)}: use an integer above 0")


def discs_of_skeleton(skeleton: Skeleton, *, count: int | None = None, local: bool = False, threads: int = 0) -> Discs:
    """Give the largest discs whose centers are on a skeleton inside polygons; arguments as of `largest_discs`."""
    own = skeleton.polygons.feature
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
            np.append(self.skeleton.polygon, np.int32(-1))[found.arc],  # of what is on no arc: none
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
        is_vertex = mask_of(place[~is_edge, 0], len(keys))
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
        apart = norms(some.xy - discs.xy[disc]) - (some.radius + discs.radius[disc])
        return np.asarray(apart >= -self.axis.rounding)

    def _ends_of_touched(self, last: Candidates, at: Numbers) -> Candidates:
        """Nodes of plateaus that were whole until the last discs."""
        axis = self.axis
        own = axis.middles[self.whole]
        disc = at[own.feature]
        ends = axis.skeleton.vertices[np.stack([axis.segments.first[self.whole], axis.segments.last[self.whole]])]
        way = ends[1] - ends[0]
        away = last.xy[disc] - ends[0]
        share = np.clip(dots(away, way) / np.maximum(dots(way, way), np.finfo(float).tiny), 0, 1)
        apart = norms(away - share[:, None] * way) - (own.radius + last.radius[disc])
        touched = (disc >= 0) & (apart < -axis.rounding)
        is_new = mask_of(self.whole[touched], len(axis.middles))
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
