"""Ends of a skeleton: where it forks to both corners of one edge, or fans out into a round end.

A *twig* leads from a leaf to a junction, between two edges with a corner in common. Two twigs of one junction are
*beside each other* if they have an edge in common and the angles at its corners differ by no more than a right angle:
otherwise the sharper corner is a tip, which the skeleton leads into. Twigs beside each other make runs. A run of two is
the *fork* of their edge; a run of more is a *round end*. Where all arcs of a junction are twigs, the polygon is around
a circle: see `_forks_of_stars`.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.boundary_rays import first_hits
from vorotool.engines.edge_comparisons import is_blunt, shortest
from vorotool.geometry.skeleton import EDGE, INTERIOR, Skeleton
from vorotool.geometry.skeleton_tables import connected_roots

Floats = NDArray[np.float64]
Numbers = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class Unforked:
    """A skeleton whose forks are led to the middles of their edges.

    Parameters
    ----------
    skeleton : Skeleton
        That which is given, and behind its arcs *leads*: straight lines from forks to the middles of their edges.
    arcs : (k,) integer array
        Its arcs inside polygons, without the twigs of forks and all but the longest twig of round ends, and the leads.
    is_lead, is_round : (a,) bool array
        Whether each arc of the skeleton is a lead, or the twig that is left of a round end.
    reach : (a,) float64 array
        Lengths; of leads those of the longer twig of the fork, by which paths are compared.
    first_leaf : (v,) integer array
        The nodes themselves; of the middle of an edge the smaller one of the leaves at its corners.
    """

    skeleton: Skeleton
    arcs: Numbers
    is_lead: NDArray[np.bool_]
    is_round: NDArray[np.bool_]
    reach: Floats
    first_leaf: Numbers


def forked(skeleton: Skeleton) -> Unforked:
    """A skeleton as it is, without leads.

    Parameters
    ----------
    skeleton : Skeleton
        Its arcs inside polygons are used.

    Examples
    --------
    >>> from vorotool import skeleton_exact
    >>> forked(skeleton_exact([[0, 0], [10, 0], [10, 4], [0, 4]])).arcs.tolist()
    [0, 1, 2, 3, 4]
    """
    nothing = np.zeros(len(skeleton), dtype=bool)
    nodes = np.arange(len(skeleton.vertices))
    return Unforked(skeleton, np.flatnonzero(skeleton.side == INTERIOR), nothing, nothing, skeleton.length, nodes)


def unforked(skeleton: Skeleton) -> Unforked:
    """Lead the forks of a skeleton to the middles of their edges.

    Parameters
    ----------
    skeleton : Skeleton
        Its arcs inside polygons are used.

    Examples
    --------
    >>> from vorotool import skeleton_exact
    >>> made = unforked(skeleton_exact([[0, 0], [10, 0], [10, 4], [0, 4]]))
    >>> made.skeleton.vertices[made.skeleton.arcs[made.arcs]].tolist()
    [[[2.0, 2.0], [8.0, 2.0]], [[2.0, 2.0], [0.0, 2.0]], [[8.0, 2.0], [10.0, 2.0]]]
    """
    twigs = _twigs(skeleton)
    pairs = _pairs(skeleton, twigs)
    blunt = is_blunt(_along(skeleton, pairs.edge, twigs.beside(pairs)))
    on_star = twigs.on_star[pairs.one]
    joins = blunt & ~on_star
    runs = connected_roots(np.stack([pairs.one, pairs.other], axis=1)[joins], len(twigs))
    size = np.bincount(runs, minlength=len(twigs))[runs]
    stars = np.flatnonzero(on_star)
    arcs = np.bincount(twigs.node, minlength=len(skeleton.vertices))[twigs.node[pairs.one[stars]]]
    of_stars = stars[_forks_of_stars(skeleton, pairs[stars], blunt[stars], arcs)]
    forks = pairs[np.sort(np.concatenate([np.flatnonzero(joins & (size[pairs.one] == 2)), of_stars]))]
    in_round = np.flatnonzero(size > 2)
    longest = _longest_of_runs(twigs, runs, in_round)
    removed = np.concatenate([forks.one, forks.other, np.setdiff1d(in_round, longest)])
    return _with_leads(skeleton, twigs, forks, removed, longest)


@dataclass(frozen=True, eq=False)
class _Twigs:
    """Branches from a leaf to a junction, between two edges that have a corner in common."""

    first: Numbers
    """Of the arcs of each."""
    last: Numbers
    leaf: Numbers
    node: Numbers
    """The junction."""
    edges: Numbers
    """(t, 2) sites."""
    length: Floats
    on_star: NDArray[np.bool_]
    """Whether all arcs at the junction are of twigs."""

    def __len__(self) -> int:
        return len(self.leaf)

    def beside(self, pairs: _Pairs) -> Numbers:
        """(p, 2) the edges beside that of each pair."""
        return np.stack([self.edges[twig].sum(axis=1) - pairs.edge for twig in (pairs.one, pairs.other)], axis=1)


@dataclass(frozen=True, eq=False)
class _Pairs:
    """Twigs of one junction with an edge in common, the one with the smaller number first."""

    one: Numbers
    other: Numbers
    edge: Numbers

    def __getitem__(self, chosen: NDArray[np.generic]) -> _Pairs:
        return _Pairs(self.one[chosen], self.other[chosen], self.edge[chosen])


def _twigs(skeleton: Skeleton) -> _Twigs:
    inside = np.flatnonzero(skeleton.side == INTERIOR)
    if not len(inside):
        nothing = np.empty(0, dtype=np.intp)
        pairs = nothing.reshape(0, 2)
        return _Twigs(nothing, nothing, nothing, nothing, pairs, np.empty(0), nothing.astype(bool))
    begins = np.flatnonzero(np.diff(skeleton.branch[inside], prepend=-1))
    first, last = inside[begins], inside[np.append(begins[1:], len(inside)) - 1]
    degree = np.bincount(skeleton.arcs[inside].reshape(-1), minlength=len(skeleton.vertices))
    ends = np.stack([skeleton.arcs[first, 0], skeleton.arcs[last, 1]]).astype(np.intp)
    is_leaf = degree[ends] == 1
    low, high = np.sort(skeleton.sites[inside], axis=1).T
    edges = np.stack([low[begins], high[begins]], axis=1).astype(np.intp)
    is_one = (np.maximum.reduceat(low, begins) == np.minimum.reduceat(low, begins)) & (
        np.maximum.reduceat(high, begins) == np.minimum.reduceat(high, begins)
    )
    chosen = np.flatnonzero((is_leaf[0] != is_leaf[1]) & is_one & (skeleton.site_table.kind[edges] == EDGE).all(axis=1))
    chosen = chosen[_has_corner(skeleton, edges[chosen])]
    leaf, node = np.where(is_leaf[0], ends, ends[::-1])[:, chosen]
    length = np.add.reduceat(skeleton.length[inside], begins)[chosen]
    on_star = (np.bincount(node, minlength=len(degree)) == degree)[node]
    return _Twigs(first[chosen], last[chosen], leaf, node, edges[chosen], length, on_star)


def _ends(skeleton: Skeleton, edges: Numbers) -> Floats:
    """(…, 2, 2) the ends of edges, without a gap."""
    return replace(skeleton, gap=0.0)._ends_of(edges) if skeleton.gap else skeleton._ends_of(edges)


def _has_corner(skeleton: Skeleton, edges: Numbers) -> NDArray[np.bool_]:
    """Whether two edges have an end in common."""
    ends = _ends(skeleton, edges)
    same: NDArray[np.bool_] = (ends[:, 0, :, None] == ends[:, 1, None]).all(axis=-1).any(axis=(1, 2))
    return same


def _pairs(skeleton: Skeleton, twigs: _Twigs) -> _Pairs:
    twig = np.repeat(np.arange(len(twigs)), 2)
    edge = twigs.edges.reshape(-1)
    node = twigs.node[twig]
    order = np.lexsort((twig, edge, node))
    follows = np.flatnonzero((np.diff(edge[order]) == 0) & (np.diff(node[order]) == 0))
    one = order[follows]
    return _Pairs(twig[one], twig[order[follows + 1]], edge[one])


# ---- which corners are tips -----------------------------------------------------------------------
def _along(skeleton: Skeleton, edge: Numbers, beside: Numbers) -> Floats:
    """(p, 4, 2) the ends of edges, between those ends of the edges beside each that are not there."""
    a, b = _ends(skeleton, edge).swapaxes(0, 1)
    others = _ends(skeleton, beside)
    is_at_b = (others[:, 0] == b[:, None]).all(axis=-1).any(axis=1)[:, None]  # the first edge beside
    near, far = np.where(is_at_b, b, a), np.where(is_at_b, a, b)
    return np.stack([_far_end(others[:, 0], a, b), near, far, _far_end(others[:, 1], a, b)], axis=1)


def _far_end(edges: Floats, a: Floats, b: Floats) -> Floats:
    """The end of each edge that is neither a nor b."""
    is_near = (edges == a[:, None]).all(axis=-1) | (edges == b[:, None]).all(axis=-1)
    far: Floats = np.where(is_near[:, :1], edges[:, 1], edges[:, 0])
    return far


# ---- polygons around a circle ---------------------------------------------------------------------
def _forks_of_stars(skeleton: Skeleton, pairs: _Pairs, blunt: NDArray[np.bool_], arcs: Numbers) -> Numbers:
    """Which pairs are forks where all arcs of a skeleton meet in one node; (p,) the number of these arcs.

    A triangle has one, at its shortest edge: from there the centerline leads to the corner opposite. A quadrilateral
    has two, at opposite edges. Of equal ones those of the first edge count. Polygons with more edges have none.
    """
    corners = np.flatnonzero(arcs == 3).reshape(-1, 3)
    least = corners[np.arange(len(corners)), shortest(_ends(skeleton, pairs.edge[corners]))]
    sides = np.flatnonzero(arcs == 4).reshape(-1, 2, 2)  # the first and the third edge are opposite
    is_first, is_second = (blunt[sides[:, 0, k]] & blunt[sides[:, 1, k]] for k in range(2))
    opposite = np.where(is_first[:, None], sides[:, :, 0], sides[:, :, 1])[is_first | is_second]
    return np.concatenate([least[blunt[least]], opposite.reshape(-1)])


# ---- what is left ---------------------------------------------------------------------------------
def _with_leads(skeleton: Skeleton, twigs: _Twigs, forks: _Pairs, removed: Numbers, round_ends: Numbers) -> Unforked:
    """Without some twigs; those of round ends are marked."""
    known, count, nodes = len(skeleton), len(forks.edge), len(skeleton.vertices)
    ends = _ends(skeleton, forks.edge)
    middle, node = ends[:, 0] / 2 + ends[:, 1] / 2, twigs.node[forks.one]
    way = middle - skeleton.vertices[node]
    mark = np.zeros((2, known + count), dtype=bool)
    for row, chosen in enumerate((removed, round_ends)):
        mark[row, _arcs_of(twigs, chosen)] = True
    is_lead = np.arange(known + count) >= known
    length = np.sqrt((way * way).sum(axis=1))
    made = replace(
        skeleton,
        vertices=np.concatenate([skeleton.vertices, middle]),
        radius=np.concatenate([skeleton.radius, np.zeros(count)]),
        arcs=np.concatenate([skeleton.arcs, np.stack([node, nodes + np.arange(count)], axis=1)]),
        control=np.concatenate([skeleton.control, np.full((count, 2), np.nan)]),
        sites=np.concatenate([skeleton.sites, np.stack([forks.edge] * 2, axis=1)]),
        polygon=np.concatenate([skeleton.polygon, skeleton.polygon[twigs.first[forks.one]]]),
        side=np.concatenate([skeleton.side, np.full(count, INTERIOR, dtype=np.int8)]),
        branch=np.concatenate([skeleton.branch, skeleton.branch.max(initial=-1) + 1 + np.arange(count)]),
        length=np.concatenate([skeleton.length, length]),
        error_bound=np.concatenate([skeleton.error_bound, skeleton.error_bound[twigs.first[forks.one]]]),
    )
    reach = np.maximum(twigs.length[forks.one], twigs.length[forks.other])
    leaf = np.minimum(twigs.leaf[forks.one], twigs.leaf[forks.other])
    return Unforked(
        made,
        np.flatnonzero((made.side == INTERIOR) & ~mark[0]),
        is_lead,
        mark[1],
        np.concatenate([skeleton.length, reach]),
        np.concatenate([np.arange(nodes), leaf]),
    )


def _arcs_of(twigs: _Twigs, chosen: Numbers) -> Numbers:
    """The arcs of some twigs: those of a branch follow one another."""
    size = twigs.last[chosen] + 1 - twigs.first[chosen]
    start = np.cumsum(size) - size
    return np.repeat(twigs.first[chosen] - start, size) + np.arange(size.sum())


def _longest_of_runs(twigs: _Twigs, runs: Numbers, chosen: Numbers) -> Numbers:
    """Of some twigs the longest one of each run, the first of equal ones."""
    order = chosen[np.lexsort((chosen, -twigs.length[chosen], runs[chosen]))]
    longest: Numbers = order[np.diff(runs[order], prepend=-1) > 0]
    return longest


# ---- where twigs were ------------------------------------------------------------------------------
def middles_ahead(skeleton: Skeleton, arcs: Numbers, origin: Floats, way: Floats) -> Floats:
    """The middles of edges ahead of ends that are between both edges beside them: where forks were pruned.

    Parameters
    ----------
    skeleton : Skeleton
        Of what.
    arcs : (k,) integer array
        Arcs inside polygons that the ends are of.
    origin, way : (k, 2) float64 array
        The ends, and where they look.

    Returns
    -------
    (k, 2) float64 array
        NaN where there is no such edge, one of its ends is a tip, or another edge is before its middle.

    Examples
    --------
    >>> from vorotool import skeleton_exact
    >>> skeleton = skeleton_exact([[0, 0], [10, 0], [10, 4], [0, 4]])
    >>> middles_ahead(skeleton, np.array([4]), np.array([[8.0, 2.0]]), np.array([[1.0, 0.0]])).tolist()
    [[10.0, 2.0]]
    """
    polygons, table = skeleton.polygons, skeleton.site_table
    sites, polygon = skeleton.sites[arcs], skeleton.polygon[arcs]
    own = ((table.kind[sites] == EDGE) & (table.polygon[sites] == polygon[:, None])).all(axis=1)
    ring = polygons.polygon_start[table.polygon[sites]] + table.ring[sites]
    own &= ring[:, 0] == ring[:, 1]
    vertex = polygons.ring_start[ring] + table.index[sites]
    found = np.full((len(arcs), 2), np.nan)
    for before, behind in ((0, 1), (1, 0)):
        start = polygons.following[vertex[:, before]]
        end = polygons.following[start]
        chosen = np.flatnonzero(own & (end == vertex[:, behind]))
        start, end = start[chosen], end[chosen]
        around = (vertex[chosen, before], start, end, polygons.following[end])
        middle = polygons.xy[start] / 2 + polygons.xy[end] / 2
        to_middle = middle - origin[chosen]
        is_ahead = (to_middle * way[chosen]).sum(axis=1) > 0
        is_ahead &= is_blunt(polygons.xy[np.stack(around, axis=1)])
        chosen, start, middle, to_middle = (values[is_ahead] for values in (chosen, start, middle, to_middle))
        _, met = first_hits(polygons, polygon[chosen], origin[chosen], to_middle)
        found[chosen[met == start]] = middle[met == start]
    return found
