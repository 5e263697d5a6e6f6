"""Round ends of a skeleton: twigs to corners that follow one another, at junctions near each other.

A node of a skeleton where many arcs meet falls apart if a corner moves a little: what ends there is told from all twigs
within half a radius. An end begins where all arcs of a junction but one are twigs, beside each other at edges without
tips. It grows over the one arc that is left to the next junction, if that is near enough, and all its arcs but one are
of twigs and of other such ends, each beside the others at an edge without tips; the one may lead to a tip. The corner
of such a twig must turn at least half as much as the least corner of the end: walls that bend a little are none of it.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.centerlines.corner_twigs import Branches, Pairs, Twigs
from vorotool.numeric.arrays import Numbers, starts_of
from vorotool.plain import plain
from vorotool.types.skeleton.tables import connected_roots

NEAR = 0.5
"""In radii of the junction that an end grows to: how far other junctions of the end may be from it."""

MOST_WITH_ENDS = 4
"""Corners of polygons around a circle that have ends: triangles and quadrilaterals."""


@dataclass(eq=False)
class _End:
    """Twigs and inner branches; the edges on both sides; the node that it hangs on, and the branch on from there."""

    twigs: list[int]
    inner: list[int]
    edges: set[int]
    node: int
    branch: int
    depth: float
    cosine: float
    """Of the corner that turns least: the largest."""
    is_closed: bool = False
    """Whether it goes all around its polygon."""


@plain(eq=False)
class RoundEnds:
    """Twigs in runs: those beside each other; and the branches between the twigs of one run."""

    run: Numbers  # (t,) integer array: twigs of one run have the same number
    grown: Numbers  # (g,) integer array: those runs that are over several junctions
    closed: Numbers  # (c,) integer array: those of these that go all around a polygon
    inner: Numbers  # (k,) integer array: branches between the twigs of those that do not, and of those that do
    around: Numbers  # (k,) integer array: branches between the twigs of those that do not, and of those that do


def grown_runs(branches: Branches, radius: NDArray[np.float64], twigs: Twigs, pairs: Pairs) -> RoundEnds:
    """Join twigs beside each other, at one junction, or at several that are near each other."""
    joins = pairs[pairs.is_blunt & (twigs.node[pairs.one] == twigs.node[pairs.other])]
    run = connected_roots(np.stack([joins.one, joins.other], axis=1), len(twigs))
    growth = _Growth(branches, radius, twigs, pairs)
    grown = [end for end in growth.grow(run) if end.inner]
    for end in sorted(grown, key=lambda end: len(end.twigs)):  # one that was joined by another before that
        run[end.twigs] = min(end.twigs)
    inner = {k for end in grown for k in end.inner if not end.is_closed}
    around = {k for end in grown for k in end.inner if end.is_closed}
    numbers = {int(run[end.twigs[0]]) for end in grown}
    closed = {int(run[end.twigs[0]]) for end in grown if end.is_closed}
    return RoundEnds(
        run, *(np.array(sorted(values), dtype=np.intp) for values in (numbers, closed, inner - around, around))
    )


@dataclass(eq=False)
class _Growth:
    branches: Branches
    radius: NDArray[np.float64]
    twigs: Twigs
    pairs: Pairs
    waiting: dict[int, list[_End]] = field(default_factory=dict)
    """Ends that lead to a junction."""

    def __post_init__(self) -> None:
        nodes, is_twig = len(self.branches.degree), np.zeros(len(self.branches.length), dtype=bool)
        is_twig[self.twigs.branch] = True
        ends = self.branches.ends
        others = np.flatnonzero(~is_twig)
        self.twig_count = np.bincount(self.twigs.node, minlength=nodes)
        self.twig_order = np.argsort(self.twigs.node, kind="stable")
        self.twig_start = starts_of(self.twig_count)
        self.branch_sum = _sums(ends[others].reshape(-1), np.repeat(others, 2), nodes)
        self.blunt = set(self.pairs.edge[self.pairs.is_blunt].tolist())

    def grow(self, run: Numbers) -> list[_End]:
        """All ends, as far as they go."""
        todo, done = self._begun(run), []
        while todo:
            end = todo.pop()
            larger = self._grown(end) if end.branch >= 0 else None
            if larger is None:
                done.append(end)
            else:
                todo.append(larger)
        return done

    def _begun(self, run: Numbers) -> list[_End]:
        """Ends at single nodes that may grow: the next one is near."""
        size = np.bincount(run, minlength=len(run))[run]
        node = self.twigs.node
        whole = (size > 1) & (size == self.twig_count[node]) & (self.branches.degree[node] == size + 1)
        first = np.flatnonzero(whole & (run == np.arange(len(run))))
        branch = self.branch_sum[node[first]]
        near = self.branches.length[branch] <= NEAR * self.radius[self.branches.ends[branch]].max(axis=1)
        order = np.argsort(run, kind="stable")
        starts = np.searchsorted(run[order], first)
        ends = []
        for k in np.flatnonzero(near).tolist():
            twigs = order[starts[k] : starts[k] + size[first[k]]]
            outer: set[int] = set()
            for edge in self.twigs.edges[twigs][self.twigs.is_beside[twigs]].tolist():
                outer ^= {edge}  # those between two twigs are there twice
            cosine = max(self.twigs.cosine[twigs].tolist())
            ends.append(_End(twigs.tolist(), [], outer, int(node[first[k]]), int(branch[k]), 0.0, cosine))
        return ends

    def _grown(self, end: _End) -> _End | None:
        """With all that is at the next junction, if that belongs to it but for one arc; else it waits there."""
        one, other = self.branches.ends[end.branch].tolist()
        node = other if one == end.node else one
        if one == other or end.depth + self.branches.length[end.branch] > NEAR * self.radius[node]:
            return None
        waiting = self.waiting.setdefault(node, [])
        waiting.append(end)
        twigs = self.twig_order[self.twig_start[node] : self.twig_start[node + 1]].tolist()
        left = int(self.branches.degree[node]) - len(twigs) - len(waiting)
        if left > 1:
            return None
        on = int(self.branch_sum[node]) - sum(known.branch for known in waiting)
        parts = [*waiting[:-1], *(self._alone(twig, node) for twig in twigs)]
        return self._joined(end, parts, node, on if left else -1)

    def _alone(self, twig: int, node: int) -> _End:
        edges = set(self.twigs.edges[twig][self.twigs.is_beside[twig]].tolist())
        return _End([twig], [], edges, node, -1, 0.0, float(self.twigs.cosine[twig]))

    def _joined(self, end: _End, parts: list[_End], node: int, on: int) -> _End | None:
        """All parts, each beside what is joined before; where no branch leads on from the node, all but a tip."""
        depth = max(self._depth(part) for part in [end, *parts])
        made = _End(end.twigs, [*end.inner, end.branch], end.edges, node, on, depth, end.cosine)
        while parts:
            beside = next((part for part in parts if self._is_beside(made, part)), None)
            if beside is None:
                break
            parts = [part for part in parts if part is not beside]
            inner = [*made.inner, *beside.inner, *([] if beside.branch < 0 else [beside.branch])]
            cosine = max(made.cosine, beside.cosine)
            made = _End([*made.twigs, *beside.twigs], inner, made.edges ^ beside.edges, node, on, depth, cosine)
        if depth > NEAR * self.radius[node] or len(made.twigs) == len(end.twigs):
            return None
        if on >= 0:
            return None if parts else made
        if len(parts) != 1:
            return None
        (last,) = parts
        is_round = len(made.twigs) + len(last.twigs) > MOST_WITH_ENDS
        if is_round and made.edges == last.edges and made.edges <= self.blunt:
            inner = [*made.inner, *last.inner, *([] if last.branch < 0 else [last.branch])]
            return replace(made, twigs=[*made.twigs, *last.twigs], inner=inner, branch=-1, is_closed=True)
        is_tip = last.branch < 0 and not made.edges & last.edges & self.blunt
        return replace(made, branch=-1) if is_tip else None

    def _depth(self, part: _End) -> float:
        return part.depth + (float(self.branches.length[part.branch]) if part.branch >= 0 else 0.0)

    def _is_beside(self, end: _End, part: _End) -> bool:
        """Whether both have an edge without tips in common, and a single corner turns enough."""
        common = end.edges & part.edges
        if len(common) != 1 or not common <= self.blunt:
            return False
        if len(part.twigs) > 1 or part.cosine <= 0:
            return True
        return 2 * part.cosine * part.cosine - 1 <= end.cosine  # it turns by half the least angle, or more


def _sums(node: Numbers, values: Numbers, nodes: int) -> Numbers:
    """The sum of values at each node, which doubles hold exactly."""
    return np.bincount(node, values, nodes).astype(np.intp)
