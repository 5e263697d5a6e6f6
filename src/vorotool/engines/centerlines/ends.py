"""Ends of a skeleton: where it forks to both corners of one edge, or fans out into a round end.

Two twigs of one junction are *beside each other* if they have an edge in common, and neither of its corners is a tip
(`vorotool.engines.centerlines.edge_comparisons.is_blunt`), which the skeleton leads into. Twigs beside each other make
runs. A run of two is the *fork* of their edge; a run of more is a *round end*, also over several junctions near each
other (`vorotool.engines.centerlines.round_ends`). Where all arcs of a junction are twigs, the polygon is around a
circle: see `_forks_of_stars`. Where a run goes all around a polygon with more than four edges, all spokes are much the
same and none is an end: the centerline is led from the farthest corner straight through the middle. A twig beside no
other, at a junction between cycles, is no end if its corner is much like both beside it: one of a plate with holes.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.centerlines.corner_twigs import Branches, Pairs, Twigs, branches_inside, corner_twigs, pairs_of
from vorotool.engines.centerlines.edge_comparisons import TIE, is_blunt, shortest
from vorotool.engines.centerlines.pruned_twigs import with_pruned_twigs
from vorotool.engines.centerlines.round_ends import MOST_WITH_ENDS, grown_runs
from vorotool.engines.skeleton.parts import with_straight_arcs
from vorotool.numeric.arrays import Booleans, Floats, Numbers
from vorotool.plain import plain
from vorotool.types.skeleton.skeleton import INTERIOR, Skeleton, ends_of_sites
from vorotool.types.skeleton.tables import connected_roots


@plain(eq=False)
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
    forks = plain[at_one & plain.is_blunt & (size[plain.one] == 2)].and_these(star_forks)
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
    off = skeleton.vertices[twigs.leaf[chosen]] - skeleton.vertices[twigs.node[chosen[starts]]][group]
    distance = np.sqrt((off * off).sum(axis=1))
    most = np.maximum.reduceat(distance, starts) if len(starts) else distance
    far = np.flatnonzero(distance >= most[group] * (1 - TIE))
    far = far[np.lexsort((*twigs.edges[chosen[far]].T[::-1], group[far]))]
    first: Numbers = chosen[far[np.diff(group[far], prepend=-1) > 0]]
    return first


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
    hanging: Numbers = arcs[root[skeleton.arcs[arcs, 0]] < nodes]
    return hanging


def _longest_of_runs(twigs: Twigs, runs: Numbers, chosen: Numbers) -> Numbers:
    """Of some twigs the longest one of each run, the first of equal ones."""
    order = chosen[np.lexsort((chosen, -twigs.length[chosen], runs[chosen]))]
    longest: Numbers = order[np.diff(runs[order], prepend=-1) > 0]
    return longest


def are_passed(skeleton: Skeleton, branches: Branches, twigs: Twigs) -> Booleans:
    """Tell which twigs hang on a cycle, or between two, and lead into a corner much like both beside it."""
    polygons, table = skeleton.polygons, skeleton.site_table
    has_holes = np.diff(polygons.polygon_starts) > 1
    own = np.flatnonzero(has_holes[skeleton.polygon[branches.first]])
    is_passed = _left_without_trees(branches, own)[twigs.node]
    edges = twigs.edges[is_passed]
    ring = polygons.polygon_starts[table.polygon[edges]] + table.ring[edges]
    start = polygons.ring_starts[ring] + table.index[edges]
    before = np.empty(len(polygons.xy), dtype=np.intp)
    before[polygons.following] = np.arange(len(before))
    end = polygons.following[start]
    around = polygons.xy[np.stack([before[start], start, end, polygons.following[end]], axis=-1)].reshape(-1, 4, 2)
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
    left: Booleans = np.array(degrees) > 0
    return left
