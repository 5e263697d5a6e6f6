"""Ends of a skeleton: where it forks to both corners of one edge, or fans out into a round end.

Two twigs of one junction are *beside each other* if they have an edge in common, and neither of its corners is a tip
(`vorotool.engines.centerlines.twigs.is_blunt`), which the skeleton leads into. Twigs beside each other make
runs. A run of two is the *fork* of their edge; a run of more is a *round end*, also over several junctions near each
other, as below. Where all arcs of a junction are twigs, the polygon is around a circle: see `_forks_of_stars`. Where a
run goes all around a polygon with more than four edges, all spokes are much the same and none is an end: the centerline
is led from the farthest corner straight through the middle. A twig beside no other, at a junction between cycles, is no
end if its corner is much like both beside it: one of a plate with holes.

A node of a skeleton where many arcs meet falls apart if a corner moves a little: what ends there is told from all twigs
within half a radius. A round end begins where all arcs of a junction but one are twigs, beside each other at edges
without tips. It grows over the one arc that is left to the next junction, if that is near enough, and all its arcs but
one are of twigs and of other such ends, each beside the others at an edge without tips; the one may lead to a tip. The
corner of such a twig must turn at least half as much as the least corner of the end: walls that bend a little are none
of it.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.centerlines.twigs import (
    TIE,
    Branches,
    Pairs,
    Twigs,
    around_edges,
    branches_inside,
    corner_twigs,
    is_blunt,
    pairs_of,
    shortest,
    with_pruned_twigs,
)
from vorotool.engines.skeleton.parts import with_straight_arcs
from vorotool.frozen import frozen
from vorotool.numeric.arrays import Booleans, Floats, Numbers, connected_roots, norms, starts_of
from vorotool.types.skeleton.segment_voronoi import ends_of_sites
from vorotool.types.skeleton.skeleton import INTERIOR, Skeleton


@frozen(eq=False)
class Unforked:
    """A skeleton whose forks are led to the middles of their edges."""

    # that which is given, and behind its arcs *leads*: straight lines from forks to the middles of their edges
    skeleton: Skeleton
    # (k,) integer array: its arcs inside polygons, without the twigs of forks and all but the longest twig of round
    # ends, and the leads
    arcs: Numbers
    # (a,) bool array: whether each arc of the skeleton is a lead, or the twig that is left of a round end
    is_lead: NDArray[np.bool_]
    # (a,) bool array: whether each arc of the skeleton is a lead, or the twig that is left of a round end
    is_round: NDArray[np.bool_]
    # (a,) float64 array: lengths; of leads those of the longer twig of the fork, by which paths are compared
    reach: Floats
    # (v,) integer array: the nodes themselves; of the middle of an edge the smaller one of the leaves at its corners
    first_leaf: Numbers


def forked(skeleton: Skeleton) -> Unforked:
    """A skeleton as it is, without leads."""
    nothing = np.zeros(len(skeleton), dtype=bool)
    nodes = np.arange(len(skeleton.vertices))
    return Unforked(skeleton, np.flatnonzero(skeleton.side == INTERIOR), nothing, nothing, skeleton.length, nodes)


def unforked(skeleton: Skeleton) -> Unforked:
    """Lead the forks of a skeleton to the middles of their edges."""
    known, nodes = len(skeleton), len(skeleton.vertices)
    skeleton = with_pruned_twigs(skeleton)
    branches = branches_inside(skeleton)
    twigs = corner_twigs(skeleton, branches)
    pairs = pairs_of(skeleton, twigs)
    star_forks, is_settled = _forks_of_stars(skeleton, branches, twigs, pairs)
    plain = pairs[~is_settled[twigs.node[pairs.one]] & ~is_settled[twigs.node[pairs.other]]]
    ends = grown_runs(branches, skeleton.radius, twigs, plain)
    size = np.bincount(ends.run, minlength=len(twigs))[ends.run]
    at_one = twigs.node[plain.one] == twigs.node[plain.other]
    forks = plain[at_one & plain.is_blunt & (size[plain.one] == 2)].joined(star_forks)
    forks = forks[twigs.node[forks.one] < nodes]  # others hang on what was pruned
    around = np.where(is_settled[twigs.node] & (branches.degree[twigs.node] > MOST_WITH_ENDS), twigs.node, -1)
    around = np.where(np.isin(ends.run, ends.closed), len(branches.degree) + ends.run, around)
    farthest = _farthest_around(skeleton, twigs, around)
    is_round = (size > 2) & (size < branches.degree[twigs.node]) | np.isin(ends.run, ends.grown)
    in_round = np.flatnonzero(is_round & (around < 0))
    longest = _longest_of_runs(twigs, ends.run, in_round)
    others = np.setdiff1d(np.append(in_round, np.flatnonzero(around >= 0)), np.append(longest, farthest))
    is_end = is_round | (around >= 0)
    is_end[forks.one] = is_end[forks.other] = True
    others = np.append(others, np.flatnonzero(~is_end & are_passed(skeleton, branches, twigs)))
    removed = branches.arcs(
        np.concatenate([twigs.branch[forks.one], twigs.branch[forks.other], twigs.branch[others], ends.around])
    )
    of_round = _hanging_on(skeleton, branches.arcs(np.append(twigs.branch[longest], ends.inner)), nodes)
    pruned = np.setdiff1d(np.arange(known, len(skeleton)), np.append(of_round, branches.arcs(twigs.branch[farthest])))
    return _with_leads(skeleton, twigs, forks, np.append(removed, pruned), of_round)


# ---- polygons around a circle ---------------------------------------------------------------------
def _farthest_around(skeleton: Skeleton, twigs: Twigs, around: Numbers) -> Numbers:
    """Of twigs with the same number that is not -1, that to the corner farthest from the middle."""
    chosen = np.flatnonzero(around >= 0)
    chosen = chosen[np.lexsort((-skeleton.radius[twigs.node[chosen]], around[chosen]))]
    starts = np.flatnonzero(np.diff(around[chosen], prepend=-1))
    group = np.cumsum(np.isin(np.arange(len(chosen)), starts)) - 1
    distance = norms(skeleton.vertices[twigs.leaf[chosen]] - skeleton.vertices[twigs.node[chosen[starts]]][group])
    most = np.maximum.reduceat(distance, starts) if len(starts) else distance
    far = np.flatnonzero(distance >= most[group] * (1 - TIE))
    far = far[np.lexsort((*twigs.edges[chosen[far]].T[::-1], group[far]))]
    return chosen[far[np.diff(group[far], prepend=-1) > 0]]


def _forks_of_stars(
    skeleton: Skeleton, branches: Branches, twigs: Twigs, pairs: Pairs
) -> tuple[Pairs, NDArray[np.bool_]]:
    """Which pairs are forks where all arcs of a skeleton are twigs of one node; and the nodes that this settles."""
    degree = branches.degree
    is_star = (np.bincount(twigs.node, minlength=len(degree)) == degree) & (degree > 0)
    node = twigs.node[pairs.one]
    own = np.flatnonzero(is_star[node] & (node == twigs.node[pairs.other]))
    whole = np.bincount(node[own], minlength=len(degree)) == degree
    own = own[np.lexsort((pairs.edge[own], node[own]))]
    own = own[whole[node[own]]]
    is_round = np.bincount(node[own], pairs.is_blunt[own], len(degree)) == degree
    corners = own[(degree[node[own]] == 3) & is_round[node[own]]].reshape(-1, 3)
    least = corners[
        np.arange(len(corners)), shortest(ends_of_sites(skeleton.polygons, skeleton.site_table, pairs.edge[corners]))
    ]
    sides = own[degree[node[own]] == 4].reshape(-1, 2, 2)  # the first and the third edge are opposite
    is_first, is_second = (pairs.is_blunt[sides[:, :, k]].all(axis=1) for k in range(2))
    opposite = np.where(is_first[:, None], sides[:, :, 0], sides[:, :, 1])[is_first | is_second].reshape(-1)
    settled = is_round & is_star
    settled[node[opposite]] = True
    return pairs[np.concatenate([least, opposite])], settled


# ---- what is left ---------------------------------------------------------------------------------
def _with_leads(skeleton: Skeleton, twigs: Twigs, forks: Pairs, removed: Numbers, of_round: Numbers) -> Unforked:
    """Without some arcs, with leads for forks; arcs of round ends are marked."""
    known, count, nodes = len(skeleton), len(forks.edge), len(skeleton.vertices)
    ends = ends_of_sites(skeleton.polygons, skeleton.site_table, forks.edge)
    middle, node = ends[:, 0] / 2 + ends[:, 1] / 2, twigs.node[forks.one]
    is_gone, is_round = np.zeros((2, known + count), dtype=bool)
    is_gone[removed] = is_round[of_round] = True
    arc = np.append(np.flatnonzero(skeleton.side == INTERIOR), known + np.arange(count))
    leads, sites = np.stack([node, nodes + np.arange(count)], axis=1), np.stack([forks.edge] * 2, axis=1)
    made = with_straight_arcs(skeleton, middle, np.zeros(count), leads, sites, twigs.arc[forks.one])
    reach = np.maximum(twigs.length[forks.one], twigs.length[forks.other])
    leaf = np.minimum(twigs.leaf[forks.one], twigs.leaf[forks.other])
    return Unforked(
        made,
        arc[~is_gone[arc]],
        np.arange(known + count) >= known,
        is_round,
        np.concatenate([skeleton.length, reach]),
        np.concatenate([np.arange(nodes), leaf]),
    )


def _hanging_on(skeleton: Skeleton, arcs: Numbers, nodes: int) -> Numbers:
    """Those of some arcs that are connected, by these, with one of the first nodes."""
    root = connected_roots(skeleton.arcs[arcs], len(skeleton.vertices))
    return arcs[root[skeleton.arcs[arcs, 0]] < nodes]


def _longest_of_runs(twigs: Twigs, runs: Numbers, chosen: Numbers) -> Numbers:
    """Of some twigs the longest one of each run, the first of equal ones."""
    order = chosen[np.lexsort((chosen, -twigs.length[chosen], runs[chosen]))]
    return order[np.diff(runs[order], prepend=-1) > 0]


def are_passed(skeleton: Skeleton, branches: Branches, twigs: Twigs) -> Booleans:
    """Tell which twigs hang on a cycle, or between two, and lead into a corner much like both beside it."""
    polygons = skeleton.polygons
    has_holes = np.diff(polygons.polygon_starts) > 1
    own = np.flatnonzero(has_holes[skeleton.polygon[branches.first]])
    is_passed = _left_without_trees(branches, own)[twigs.node]
    start = skeleton.site_table.vertices(polygons, twigs.edges[is_passed])
    around = around_edges(polygons, start).reshape(-1, 4, 2)
    (ux, uy), (vx, vy), (wx, wy) = np.diff(around, axis=1).transpose(1, 2, 0)
    is_like = is_blunt(around) & ((ux * vy - uy * vx > 0) == (vx * wy - vy * wx > 0))
    is_passed[is_passed] = is_like.reshape(-1, 2).all(axis=1)
    return is_passed


def _left_without_trees(branches: Branches, own: Numbers) -> Booleans:
    """(v,) which nodes are left when branches that end there are taken off, of some, as long as there are any."""
    nodes = len(branches.degree)
    if not len(own):
        return np.zeros(nodes, dtype=bool)
    degree = np.bincount(branches.ends[own].reshape(-1), minlength=nodes)
    joined = np.zeros(nodes, dtype=np.intp)  # of all branches at a node: of the last one its number
    np.bitwise_xor.at(joined, branches.ends[own].reshape(-1), np.repeat(own, 2))
    leaves = np.flatnonzero(degree == 1).tolist()
    one, other = branches.ends.T.tolist()
    degrees, numbers = degree.tolist(), joined.tolist()
    while leaves:
        node = leaves.pop()
        if degrees[node] != 1:
            continue
        branch = numbers[node]
        near = one[branch] + other[branch] - node
        degrees[node] = 0
        degrees[near] -= 1
        numbers[near] ^= branch
        if degrees[near] == 1:
            leaves.append(near)
    return np.array(degrees) > 0


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


@frozen(eq=False)
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
        # sums at each node, which doubles hold exactly
        self.branch_sum = np.bincount(ends[others].reshape(-1), np.repeat(others, 2), nodes).astype(np.intp)
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
