"""Places of the axis where a disc may be a largest one: it touches another, or its radius is extreme."""

from __future__ import annotations

from dataclasses import fields, replace

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.arrays import Floats, Numbers
from vorotool.plain import plain
from vorotool.types.skeleton.arc_measures import ArcMeasures
from vorotool.types.skeleton.skeleton import EDGE, Skeleton

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
        on_lines = np.stack([both[i] * both[j] - (away[i] * away[j]).sum(axis=1) for i, j in _ENDS])
        vertex = self.vertex[rows]
        way = center - vertex
        known = ((way * way).sum(axis=1) - radius * radius) / 2
        left = known - ((places - vertex) * way).sum(axis=2)
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
    distance = np.sqrt((away * away).sum(axis=1))
    control = m.control
    v = u[:, None]
    moving = 2 * ((1 - v) * (control - m.source) + v * (m.target - control))
    ratio = np.divide((away * moving).sum(axis=1), distance, out=np.zeros_like(distance), where=distance > 0)
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


@plain(eq=False)
class Candidates:
    """Places with the discs around them."""

    xy: Floats  # (n, 2) and (n,) float64 array: the discs
    radius: Floats  # (n, 2) and (n,) float64 array: the discs
    feature: Numbers  # (n,) int array: whose they are
    arc: Numbers  # (n,) int array: the arc that each is on; the node that it is, or -1
    node: Numbers  # (n,) int array: the arc that each is on; the node that it is, or -1

    def __len__(self) -> int:
        return len(self.radius)

    def __getitem__(self, chosen: NDArray[np.generic]) -> Candidates:
        return Candidates(*(getattr(self, each.name)[chosen] for each in fields(self)))

    def joined(self, others: Candidates) -> Candidates:
        """These and others."""
        both = (np.concatenate([getattr(self, each.name), getattr(others, each.name)]) for each in fields(self))
        return Candidates(*both)

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


@plain(eq=False)
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
        away = [((skeleton.vertices[skeleton.arcs[flat, k]] - xy[own]) * way).sum(axis=1) for k in (0, 1)]
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
