"""Twigs of a skeleton: branches into corners of polygons, compared exactly where doubles are not certain."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.arrays import Booleans, Columns, Floats, Numbers, owners, ranges
from vorotool.numeric.numbers import difference, product
from vorotool.plain import plain
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.skeleton.skeleton import EDGE, INTERIOR, Skeleton, ends_of_sites


@plain(eq=False)
class Branches:
    """Branches inside polygons."""

    first: Numbers  # (b,) integer array: of the arcs of each, which follow one another
    last: Numbers  # (b,) integer array: of the arcs of each, which follow one another
    ends: Numbers  # (b, 2) integer array: nodes
    length: Floats  # (b,) float64 array: of all its arcs
    degree: Numbers  # (v,) integer array: number of arcs inside polygons at each node

    def arcs(self, chosen: Numbers) -> Numbers:
        """All arcs of some branches."""
        return ranges(self.first[chosen], self.last[chosen] + 1 - self.first[chosen])


def branches_inside(skeleton: Skeleton) -> Branches:
    """Find the branches inside polygons."""
    inside = np.flatnonzero(skeleton.side == INTERIOR)
    begins = np.flatnonzero(np.diff(skeleton.branch[inside], prepend=-1))
    first, last = inside[begins], inside[np.append(begins, len(inside))[1:] - 1]
    degree = np.bincount(skeleton.arcs[inside].reshape(-1), minlength=len(skeleton.vertices))
    ends = np.stack([skeleton.arcs[first, 0], skeleton.arcs[last, 1]], axis=1).astype(np.intp)
    length = np.add.reduceat(skeleton.length[inside], begins) if len(begins) else np.zeros(0)
    return Branches(first, last, ends, length, degree)


@plain(eq=False)
class Twigs:
    """Branches from a leaf between two edges with a corner in common to a junction, along one of these or both."""

    branch: Numbers  # (t,) integer array: which, and its first arc
    arc: Numbers  # (t,) integer array: which, and its first arc
    leaf: Numbers  # (t,) integer array: the leaf, and the junction
    node: Numbers  # (t,) integer array: the leaf, and the junction
    edges: Numbers  # (t, 2) integer array: the sites on both sides of the leaf, the one with the smaller number first
    # (t, 2) bool array: whether each is a site of all arcs: where a wall has a corner that turns outwards, it is not
    is_beside: Booleans
    length: Floats  # (t,) float64 array: of the branches
    # (t,) float64 array: of the angle that the boundary turns by at the corner: from -1 at a tip that is all but
    # closed, to 1
    cosine: Floats

    def __len__(self) -> int:
        return len(self.leaf)


def corner_twigs(skeleton: Skeleton, branches: Branches) -> Twigs:
    """Find the twigs among some branches."""
    is_leaf = branches.degree[branches.ends] == 1
    maybe = np.flatnonzero(is_leaf[:, 0] != is_leaf[:, 1])
    outer = np.where(is_leaf[maybe, 0], branches.first[maybe], branches.last[maybe])
    edges = np.sort(skeleton.sites[outer], axis=1).astype(np.intp)
    is_beside = _are_beside(skeleton, branches, maybe, edges)
    kept = np.flatnonzero(is_beside.any(axis=1) & (skeleton.site_table.kind[edges] == EDGE).all(axis=1))
    ends = _ends(skeleton, edges[kept])
    meets = (ends[:, 0, :, None] == ends[:, 1, None]).all(axis=-1)  # (k, 2, 2) ends of the one, and of the other
    has_corner = meets.any(axis=(1, 2))
    kept, ends, meets = kept[has_corner], ends[has_corner], meets[has_corner]
    branch = maybe[kept]
    leaf, node = np.where(is_leaf[branch, 0], branches.ends[branch].T, branches.ends[branch].T[::-1])
    length, cosine = branches.length[branch], _cosine(ends, meets)
    return Twigs(branch, branches.first[branch], leaf, node, edges[kept], is_beside[kept], length, cosine)


def _are_beside(skeleton: Skeleton, branches: Branches, chosen: Numbers, edges: Numbers) -> Booleans:
    """(k, 2) whether each of two sites is one of all arcs of a branch."""
    arcs, size = branches.arcs(chosen), branches.last[chosen] + 1 - branches.first[chosen]
    which = owners(size)
    sites = skeleton.sites[arcs]
    missed = [(sites != edges[which, k, None]).all(axis=1) for k in range(2)]
    return np.stack([np.bincount(which[miss], minlength=len(chosen)) == 0 for miss in missed], axis=1)


def _ends(skeleton: Skeleton, edges: Numbers) -> Floats:
    """(…, 2, 2) the ends of edges, without a gap."""
    return ends_of_sites(skeleton.polygons, skeleton.site_table, edges)


def around_edges(polygons: PolygonSet, vertex: Numbers) -> Floats:
    """(…, 4, 2) the ends of edges, by the vertices where they begin, between those before and behind."""
    before = np.empty(len(polygons.xy), dtype=np.intp)
    before[polygons.following] = np.arange(len(before))
    end = polygons.following[vertex]
    return polygons.xy[np.stack([before[vertex], vertex, end, polygons.following[end]], axis=-1)]


def _cosine(ends: Floats, meets: Booleans) -> Floats:
    """Of the turn where both edges meet."""
    every = np.arange(len(ends))
    at = meets.any(axis=2).argmax(axis=1), meets.any(axis=1).argmax(axis=1)
    (ux, uy), (vx, vy) = ((ends[every, k, at[k]] - ends[every, k, 1 - at[k]]).T for k in range(2))
    size = np.sqrt((ux * ux + uy * uy) * (vx * vx + vy * vy))
    return 0.0 - np.divide(ux * vx + uy * vy, size, out=np.zeros(len(ends)), where=size > 0)


@plain(eq=False)
class Pairs(Columns):
    """Twigs at both corners of an edge."""

    one: Numbers  # (p,) integer array: the twigs, the smaller number first
    other: Numbers  # (p,) integer array: the twigs, the smaller number first
    edge: Numbers  # (p,) integer array: the site
    # (p,) bool array: whether the angles at both corners differ by no more than a right angle: neither is a tip
    is_blunt: Booleans


def pairs_of(skeleton: Skeleton, twigs: Twigs) -> Pairs:
    """Find the pairs of twigs, by the numbers of their edges."""
    twig, edge = np.repeat(np.arange(len(twigs)), 2)[twigs.is_beside.reshape(-1)], twigs.edges[twigs.is_beside]
    order = np.lexsort((twig, edge))
    follows = np.flatnonzero(np.diff(edge[order]) == 0)
    one, other, edge = twig[order[follows]], twig[order[follows + 1]], edge[order[follows]]
    beside = np.stack([twigs.edges[of].sum(axis=1) - edge for of in (one, other)], axis=1)
    return Pairs(one, other, edge, is_blunt(_along(skeleton, edge, beside)))


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
    return np.where(is_near[:, :1], edges[:, 1], edges[:, 0])


TIE = 2.0**-20
"""A millionth: far more than equal lengths differ by once vertices are placed on a lattice of 2^-30 of the extent."""
UNCERTAIN = 2.0**-48
"""Of the sum of magnitudes: products of four differences and their sums have errors of at most 12 roundings each."""


def is_blunt(points: Floats) -> NDArray[np.bool_]:
    """Tell of edges whether neither end is a tip."""
    values, magnitudes = _comparisons(*((points[:, k] - points[:, m]).T for k, m in ((0, 1), (2, 1), (3, 2))))
    blunt: NDArray[np.bool_] = (values >= 0).all(axis=0)
    for k in np.flatnonzero((np.abs(values) <= UNCERTAIN * magnitudes).any(axis=0)).tolist():
        (px, py), (ax, ay), (bx, by), (qx, qy) = ((Fraction(x), Fraction(y)) for x, y in points[k].tolist())
        exact, _ = _comparisons((px - ax, py - ay), (bx - ax, by - ay), (qx - bx, qy - by))
        blunt[k] = all(value >= 0 for value in exact)
    return blunt


def _comparisons(u: Any, v: Any, w: Any) -> tuple[Any, Any]:
    """A number that is not negative where an edge v between u and w is blunt, and the magnitudes of its terms."""
    dots = u[0] * v[0] + u[1] * v[1], -(v[0] * w[0] + v[1] * w[1])
    sines = abs(u[0] * v[1] - u[1] * v[0]), abs(v[0] * w[1] - v[1] * w[0])
    sizes = [abs(a[0] * b[0]) + abs(a[1] * b[1]) + abs(a[0] * b[1]) + abs(a[1] * b[0]) for a, b in ((u, v), (v, w))]
    values = [sines[0] - dots[0], sines[1] - dots[1], dots[0] * dots[1] + sines[0] * sines[1]]
    return _columns(values), _columns([*sizes, sizes[0] * sizes[1]])


def _columns(values: list[Any]) -> Any:
    return values if isinstance(values[0], Fraction) else np.stack(values)


def shortest(edges: Floats) -> NDArray[np.intp]:
    """Tell which of some edges is the shortest, the first of equal ones."""
    way, way_lost = difference(edges[..., 1, :], edges[..., 0, :])
    squares, squares_lost = product(way, way)
    square, lost = difference(squares[..., 0], -squares[..., 1])
    found: NDArray[np.intp] = square.argmin(axis=1)
    is_close = square <= square.min(axis=1, keepdims=True) * (1 + UNCERTAIN)
    is_exact = (way_lost == 0).all(axis=-1) & (squares_lost == 0).all(axis=-1) & (lost == 0)
    close = (is_close.sum(axis=1) > 1) & (is_close & ~is_exact).any(axis=1)
    for k in np.flatnonzero(close).tolist():
        exact = [_exact_square(*edge) for edge in edges[k].tolist()]
        found[k] = exact.index(min(exact))
    return found


def _exact_square(a: list[float], b: list[float]) -> Fraction:
    return sum(((Fraction(q) - Fraction(p)) ** 2 for p, q in zip(a, b, strict=True)), Fraction(0))
