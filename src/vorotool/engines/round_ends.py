"""Round ends of a skeleton: twigs to corners that follow one another, at junctions near each other.

A node of a skeleton where many arcs meet falls apart if a corner moves a little: what ends there is told from all twigs
within half a radius. An end begins where all arcs of a junction but one are twigs, beside each other at edges without
tips. It grows over the one arc that is left to the next junction, if that is near enough, and has one twig, or one
other such end, beside it at an edge without tips, and only one arc more. The corner of that twig must turn at least
half as much as the least corner of the end: walls that bend a little are none of it.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.corner_twigs import Branches, Pairs, Twigs
from vorotool.geometry.skeleton_tables import connected_roots

Numbers = NDArray[np.intp]

NEAR = 0.5
"""In radii of the junction that an end grows to: how far other junctions of the end may be from it."""


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


@dataclass(frozen=True, eq=False)
class RoundEnds:
    """Twigs in runs: those beside each other; and the branches between the twigs of one run.

    Parameters
    ----------
    run : (t,) integer array
        Twigs of one run have the same number.
    inner : (k,) integer array
        Branches between them.
    """

    run: Numbers
    inner: Numbers


def grown_runs(branches: Branches, radius: NDArray[np.float64], twigs: Twigs, pairs: Pairs) -> RoundEnds:
    """Join twigs beside each other, at one junction, or at several that are near each other.

    Parameters
    ----------
    branches : Branches
        Inside polygons.
    radius : (v,) float64 array
        Of nodes.
    twigs, pairs : Twigs, Pairs
        Of these branches, but for polygons around a circle.

    Examples
    --------
    >>> from vorotool import skeleton_exact
    >>> from vorotool.engines.corner_twigs import branches_inside, corner_twigs, pairs_of
    >>> skeleton = skeleton_exact([[0, 0], [10, 0], [10, 4], [0, 4], [-0.1, 1.5]])  # two edges at the left end
    >>> branches = branches_inside(skeleton)
    >>> twigs = corner_twigs(skeleton, branches)
    >>> ends = grown_runs(branches, skeleton.radius, twigs, pairs_of(skeleton, twigs))
    >>> np.bincount(ends.run).tolist(), len(ends.inner)
    ([3, 0, 0, 2], 1)
    """
    joins = pairs[pairs.is_blunt & (twigs.node[pairs.one] == twigs.node[pairs.other])]
    run = connected_roots(np.stack([joins.one, joins.other], axis=1), len(twigs))
    growth = _Growth(branches, radius, twigs, pairs)
    grown = [end for end in growth.grow(run) if end.inner]
    for end in sorted(grown, key=lambda end: len(end.twigs)):  # one that was joined by another before that
        run[end.twigs] = min(end.twigs)
    return RoundEnds(run, np.array(sorted({k for end in grown for k in end.inner}), dtype=np.intp))


@dataclass(eq=False)
class _Growth:
    branches: Branches
    radius: NDArray[np.float64]
    twigs: Twigs
    pairs: Pairs
    waiting: dict[int, _End] = field(default_factory=dict)
    """Ends that lead to a junction where another one may come."""

    def __post_init__(self) -> None:
        nodes, is_twig = len(self.branches.degree), np.zeros(len(self.branches.length), dtype=bool)
        is_twig[self.twigs.branch] = True
        ends = self.branches.ends
        others = np.flatnonzero(~is_twig)
        self.twig_count = np.bincount(self.twigs.node, minlength=nodes)
        self.twig_sum = _sums(self.twigs.node, np.arange(len(self.twigs)), nodes)
        self.branch_sum = _sums(ends[others].reshape(-1), np.repeat(others, 2), nodes)
        self.blunt = set(self.pairs.edge[self.pairs.is_blunt].tolist())

    def grow(self, run: Numbers) -> list[_End]:
        """All ends, as far as they go."""
        todo, done = self._begun(run), []
        while todo:
            end = todo.pop()
            larger = self._grown(end)
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
            edges, count = np.unique(self.twigs.edges[twigs], return_counts=True)
            outer = set(edges[count == 1].tolist())
            cosine = float(self.twigs.cosine[twigs].max())
            ends.append(_End(twigs.tolist(), [], outer, int(node[first[k]]), int(branch[k]), 0.0, cosine))
        return ends

    def _grown(self, end: _End) -> _End | None:
        """With what is at the next junction, if that belongs to it."""
        one, other = self.branches.ends[end.branch].tolist()
        node = other if one == end.node else one
        depth = end.depth + float(self.branches.length[end.branch])
        if self.branches.degree[node] != 3 or depth > NEAR * self.radius[node] or one == other:
            return None
        on = int(self.branch_sum[node]) - end.branch
        if self.twig_count[node] == 1:
            twig = int(self.twig_sum[node])
            cosine = float(self.twigs.cosine[twig])
            if cosine > 0 and 2 * cosine * cosine - 1 > end.cosine:  # it turns by less than half the least angle
                return None
            beside = _End([twig], [], set(self.twigs.edges[twig].tolist()), node, on, 0.0, cosine)
            return self._joined([end], beside, node, on, depth)
        if self.twig_count[node] == 0:
            waiting = self.waiting.pop(node, None)
            if waiting is None:
                self.waiting[node] = end
                return None
            depth = max(depth, waiting.depth + float(self.branches.length[waiting.branch]))
            return self._joined([end, waiting], waiting, node, on - waiting.branch, depth)
        return None

    def _joined(self, ends: list[_End], beside: _End, node: int, on: int, depth: float) -> _End | None:
        """Both, if they are beside each other at an edge without tips."""
        end = ends[0]
        common = end.edges & beside.edges
        if len(common) != 1 or not common <= self.blunt or depth > NEAR * self.radius[node]:
            return None
        inner = [*end.inner, *beside.inner, *(joined.branch for joined in ends)]
        cosine = max(end.cosine, beside.cosine)
        return _End([*end.twigs, *beside.twigs], inner, end.edges ^ beside.edges, node, on, depth, cosine)


def _sums(node: Numbers, values: Numbers, nodes: int) -> Numbers:
    """The sum of values at each node: three of them at most are used, which doubles hold exactly."""
    return np.bincount(node, values, nodes).astype(np.intp)
