"""Places of the axis that may be centers of the largest discs."""

from __future__ import annotations

from dataclasses import fields, replace

import numpy as np
from numpy.typing import NDArray

from vorotool.plain import plain
from vorotool.types.skeleton.skeleton import Skeleton

Floats = NDArray[np.float64]
Numbers = NDArray[np.intp]

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
