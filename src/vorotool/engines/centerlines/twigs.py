"""Twigs of a skeleton: branches into corners of polygons, compared exactly where doubles are not certain."""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction
from heapq import heapify, heappop, heappush
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.skeleton.parts import with_straight_arcs
from vorotool.frozen import frozen
from vorotool.numeric.arrays import (
    Booleans,
    Columns,
    Floats,
    Numbers,
    crosses,
    dots,
    mask_of,
    norms,
    owners,
    ranges,
    ranks_of,
    starts_of,
    within,
)
from vorotool.numeric.numbers import difference, is_among, product
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.skeleton.segment_voronoi import EDGE, ends_of_sites
from vorotool.types.skeleton.skeleton import INTERIOR, Skeleton


@frozen(eq=False)
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


@frozen(eq=False)
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
    before = ranks_of(polygons.following, len(polygons.xy), np.intp)
    end = polygons.following[vertex]
    return polygons.xy[np.stack([before[vertex], vertex, end, polygons.following[end]], axis=-1)]


def _cosine(ends: Floats, meets: Booleans) -> Floats:
    """Of the turn where both edges meet."""
    every = np.arange(len(ends))
    at = meets.any(axis=2).argmax(axis=1), meets.any(axis=1).argmax(axis=1)
    (ux, uy), (vx, vy) = ((ends[every, k, at[k]] - ends[every, k, 1 - at[k]]).T for k in range(2))
    size = np.sqrt((ux * ux + uy * uy) * (vx * vx + vy * vy))
    return 0.0 - np.divide(ux * vx + uy * vy, size, out=np.zeros(len(ends)), where=size > 0)


@frozen(eq=False)
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


@frozen(eq=False)
class _Sides(Columns):
    """Edges on one side of arcs around nodes that are on the other side of no arc there."""

    node: Numbers  # (k,) integer array: the node, the arc, the edge, and the vertex where that begins
    arc: Numbers  # (k,) integer array: the node, the arc, the edge, and the vertex where that begins
    site: Numbers  # (k,) integer array: the node, the arc, the edge, and the vertex where that begins
    vertex: Numbers  # (k,) integer array: the node, the arc, the edge, and the vertex where that begins


@frozen(eq=False)
class _Order:
    """Edges around rings, by the vertices where they begin: one way round or the other."""

    place: Numbers  # (n,) integer array: of each edge in this order, ring by ring; and the edge at each place
    first: Numbers  # (n,) integer array: the first place of its ring, and the number of these
    size: Numbers  # (n,) integer array: the first place of its ring, and the number of these
    # (n + 1,) integer array: how many corners before each place do not turn to the left; a corner has the place of
    # the edge before it
    bends: Numbers


@frozen(eq=False)
class _Gaps:
    """Where twigs were pruned."""

    node: Numbers  # (g,) integer array: where from, and an arc there
    arc: Numbers  # (g,) integer array: where from, and an arc there
    is_leaf: Booleans  # (g,) bool array: whether no other arc is there
    start: Numbers  # (g + 1,) integer array: gap k has the edges `start[k]` to `start[k + 1] - 1`
    site: Numbers  # (n,) integer array: edges in the order around the node
    ends: Numbers  # (n, 2) integer array: the vertices where they begin and end in this order

    def __add__(self, more: _Gaps) -> _Gaps:
        start = np.concatenate([self.start, self.start[-1] + more.start[1:]])
        names = ("node", "arc", "is_leaf", "site", "ends")
        rest = {name: np.concatenate([getattr(self, name), getattr(more, name)]) for name in names}
        return _Gaps(start=start, **rest)


def with_pruned_twigs(skeleton: Skeleton) -> Skeleton:
    """Add what was pruned between edges with convex corners, behind all arcs; branches end where it begins."""
    if not len(skeleton):
        return skeleton
    gaps = _gaps(skeleton)
    return _with_trees(skeleton, gaps) if len(gaps.node) else skeleton


def _sides(skeleton: Skeleton) -> tuple[_Sides, _Sides]:
    """Where gaps begin, counterclockwise around nodes inside: on the left of an arc; and where they end."""
    table, polygons = skeleton.site_table, skeleton.polygons
    inside = np.flatnonzero((skeleton.side == INTERIOR) & (skeleton.arcs[:, 0] != skeleton.arcs[:, 1]))
    node = skeleton.arcs[inside].T.reshape(-1).astype(np.intp)
    arc = np.concatenate([inside, inside])
    left, right = (skeleton.sites[inside][:, order].T.reshape(-1).astype(np.intp) for order in ([0, 1], [1, 0]))
    keys = [node * len(table) + site for site in (left, right)]
    is_pruned = skeleton.radius[node] > 0
    if skeleton.border == "open":  # what is missing there was cut off
        is_pruned &= ~skeleton.touches_frame[node]
    made = []
    for site, own, others in ((left, *keys), (right, *keys[::-1])):
        maybe = np.flatnonzero(is_pruned & (table.kind[site] == EDGE))
        chosen = maybe[~is_among(own[maybe], others)]
        vertex = table.vertices(polygons, site[chosen])
        made.append(_Sides(node[chosen], arc[chosen], site[chosen], vertex.astype(np.intp)))
    return made[0], made[1]


# ---- gaps -----------------------------------------------------------------------------------------
def _gaps(skeleton: Skeleton) -> _Gaps:
    """All gaps between edges with convex corners, whichever way their rings go."""
    begins, ends = _sides(skeleton)
    xy, following = skeleton.polygons.xy, skeleton.polygons.following
    to_node, way = skeleton.vertices[begins.node] - xy[begins.vertex], (xy[following] - xy)[begins.vertex]
    is_forward = crosses(way, to_node) > 0  # what is inside is on the left
    one, other = (_gaps_along(skeleton, begins[is_forward == along], ends, along) for along in (True, False))
    return one + other


def _order(skeleton: Skeleton, is_forward: bool) -> _Order:
    polygons = skeleton.polygons
    ring = owners(np.diff(polygons.ring_starts))
    first, size = polygons.ring_starts[ring], np.diff(polygons.ring_starts)[ring]
    place = np.arange(len(ring))
    way = polygons.xy[polygons.following] - polygons.xy
    if not is_forward:
        place = 2 * first + size - 1 - place
        way = -way[place]
    (ux, uy), (vx, vy) = way.T, way[polygons.following].T  # rings are at the same places either way
    return _Order(place, first, size, starts_of(~(ux * vy - uy * vx > 0)))


def _gaps_along(skeleton: Skeleton, begins: _Sides, ends: _Sides, is_forward: bool) -> _Gaps:
    """Gaps whose edges follow one another in the order of their rings, or against it."""
    order = _order(skeleton, is_forward)
    end = _ends_of(order, begins, ends)
    begins, end = begins[end >= 0], end[end >= 0]
    own = begins.vertex
    place, first, size = order.place[own], order.first[own], order.size[own]
    steps = (order.place[ends.vertex[end]] - place) % size
    last = place + steps
    beyond = np.maximum(last - first - size, 0)  # corners on from the first place of the ring
    bends = order.bends[last - beyond] - order.bends[place] + order.bends[first + beyond] - order.bends[first]
    degree = np.bincount(skeleton.arcs[skeleton.side == INTERIOR].reshape(-1), minlength=len(skeleton.vertices))
    is_leaf = degree[begins.node] == 1
    kept = np.flatnonzero((bends == 0) & (steps > is_leaf))  # to a single corner a part of the twig is left
    counts = steps[kept] + 1
    start, gap, along = starts_of(counts), np.repeat(kept, counts), within(counts)
    edge = order.place[first[gap] + (place[gap] - first[gap] + along) % size[gap]]
    site = _sites_of_edges(skeleton)[edge]
    site[start[:-1]], site[start[1:] - 1] = begins.site[kept], ends.site[end[kept]]
    vertices = np.stack([edge, skeleton.polygons.following[edge]][:: 1 if is_forward else -1], axis=1)
    return _Gaps(begins.node[kept], begins.arc[kept], is_leaf[kept], start, site, vertices)


def _ends_of(order: _Order, begins: _Sides, ends: _Sides) -> Numbers:
    """Which gap ends next around the ring, of those at the same node; -1 for none."""
    count = len(order.place)
    ranks = ends.node * count + order.place[ends.vertex]
    by_rank = np.argsort(ranks, kind="stable")
    ranks = ranks[by_rank]
    first, size = order.first[begins.vertex], order.size[begins.vertex]
    base = begins.node * count
    at = np.searchsorted(ranks, base + order.place[begins.vertex], side="right")
    is_around = at == np.searchsorted(ranks, base + first + size)
    at[is_around] = np.searchsorted(ranks, (base + first)[is_around])
    found = np.full(len(at), -1, dtype=np.intp)
    is_there = at < np.searchsorted(ranks, base + first + size)
    found[is_there] = by_rank[at[is_there]]
    return found


def _sites_of_edges(skeleton: Skeleton) -> Numbers:
    """(n,) the site of the edge that begins at each vertex."""
    polygons, table = skeleton.polygons, skeleton.site_table
    sites = np.flatnonzero(table.kind == EDGE)
    found = np.zeros(len(polygons.xy), dtype=np.intp)
    found[table.vertices(polygons, sites)] = sites
    return found


# ---- trees ----------------------------------------------------------------------------------------
def _with_trees(skeleton: Skeleton, gaps: _Gaps) -> Skeleton:
    """Trees in gaps, each arc a branch; branches that they hang on are parted there, and leaves led to their roots."""
    trees = _convex_trees(gaps.start, skeleton.polygons.xy[gaps.ends], skeleton.vertices[gaps.node])
    root = trees.root[gaps.is_leaf]
    skeleton = _led_on(
        skeleton, gaps.node[gaps.is_leaf], gaps.arc[gaps.is_leaf], trees.places[root], trees.radius[root]
    )
    is_corner, is_new = np.ones(len(gaps.site), dtype=bool), np.ones(len(trees.chain), dtype=bool)
    is_corner[gaps.start[1:] - 1] = is_new[root] = False
    inner = len(skeleton.vertices) - 1 + np.cumsum(is_new)
    inner[root] = gaps.node[gaps.is_leaf]
    corner = len(skeleton.vertices) + is_new.sum() - 1 + np.cumsum(is_corner)
    numbers = np.concatenate([inner, corner[::-1]])  # corners from behind, as in trees
    stems = np.flatnonzero(~gaps.is_leaf)
    first, last = gaps.start[stems], gaps.start[stems + 1] - 1
    to = numbers[np.where(trees.root[stems] < 0, -1 - first, trees.root[stems])]
    ends = np.concatenate([np.stack([gaps.node[stems], to], axis=1), numbers[trees.arcs]])
    edges = np.concatenate([np.stack([last, first], axis=1), trees.edges])
    gap = np.searchsorted(gaps.start, edges[:, 1], side="right") - 1
    places = np.concatenate([trees.places[is_new], skeleton.polygons.xy[gaps.ends[is_corner, 1]]])
    radii = np.concatenate([trees.radius[is_new], np.zeros(is_corner.sum())])
    return _with_arcs(skeleton, gaps.node, places, radii, ends, gaps.site[edges], gaps.arc[gap])


def _led_on(skeleton: Skeleton, leaves: Numbers, arcs: Numbers, places: Floats, radius: Floats) -> Skeleton:
    """Straight arcs that end at other places."""
    vertices, radii, length = skeleton.vertices.copy(), skeleton.radius.copy(), skeleton.length.copy()
    vertices[leaves], radii[leaves] = places, radius
    length[arcs] = norms(vertices[skeleton.arcs[arcs, 1]] - vertices[skeleton.arcs[arcs, 0]])
    return replace(skeleton, vertices=vertices, radius=radii, length=length)


def _with_arcs(
    skeleton: Skeleton, parted: Numbers, places: Floats, radius: Floats, ends: Numbers, sites: Numbers, like: Numbers
) -> Skeleton:
    """Straight lines behind all arcs, each a branch in the polygon of another arc; nodes are parted."""
    is_parted = mask_of(parted, len(skeleton.vertices))
    begins = (np.diff(skeleton.branch, prepend=-1) != 0) | is_parted[skeleton.arcs[:, 0]]
    skeleton = replace(skeleton, branch=np.cumsum(begins) - 1)
    return with_straight_arcs(skeleton, places, radius, ends, sites, like)


Line = tuple[float, float, float]


@frozen(eq=False)
class Trees:
    """Nodes and arcs inside chains."""

    chain: Numbers  # (u,) integer array: of each node
    places: Floats  # (u, 2) float64 array: of each node; the origin of its chain where doubles give none
    radius: Floats  # (u,) float64 array: distances from the edges
    # (k,) integer array: the node of each chain that its last edges meet at: the last one made; -1 in chains of two
    # edges
    root: Numbers
    # (a, 2) integer array: from the node nearer to the root, to another: the number of a node, or `-1 - e` for the
    # corner behind edge e
    arcs: Numbers
    edges: Numbers  # (a, 2) integer array: left and right of each arc


def _convex_trees(start: Numbers, ends: Floats, origins: Floats) -> Trees:
    """Find the trees of chains of two edges or more, counterclockwise around what is inside, in time O(n log n)."""
    sizes = np.diff(start)
    way = ends[:, 1] - ends[:, 0]
    length = norms(way)
    normal = np.stack([-way[:, 1], way[:, 0]], axis=1) / length[:, None]
    offset = dots(normal, ends[:, 0] - np.repeat(origins, sizes, axis=0))
    lines = list(zip(*normal.T.tolist(), offset.tolist(), strict=True))
    nodes: list[Line] = []
    arcs: list[tuple[int, int, int, int]] = []
    for first, last in pairwise(start.tolist()):
        _collapse(lines, first, last, nodes, arcs)
    made = np.array(nodes).reshape(-1, 3)
    found = np.array(arcs, dtype=np.intp).reshape(-1, 4)
    chain = owners(sizes - 2)
    root = np.where(sizes > 2, np.cumsum(sizes - 2) - 1, -1)
    return Trees(chain, made[:, :2] + origins[chain], made[:, 2], root, found[:, :2], found[:, 2:])


def _collapse(
    lines: list[Line], first: int, last: int, nodes: list[Line], arcs: list[tuple[int, int, int, int]]
) -> None:
    """Let the inner edges of a chain shrink to points, in the order of their distances."""
    before = {k: k - 1 for k in range(first + 1, last)}
    behind = {k: k + 1 for k in range(first, last - 1)}
    corner = {k: -1 - k for k in range(first, last - 1)}  # the node where each edge meets that behind it
    heap = [(*_meeting(lines[k - 1], lines[k], lines[k + 1]), k, k - 1, k + 1) for k in range(first + 1, last - 1)]
    heapify(heap)
    while heap:
        distance, x, y, k, one, other = heappop(heap)
        if before.get(k) != one or behind.get(k) != other:  # its neighbors are others since, or it is gone
            continue
        arcs += [(len(nodes), corner[one], k, one), (len(nodes), corner[k], other, k)]
        corner[one] = len(nodes)
        nodes.append((x, y, distance if math.isfinite(distance) else -lines[k][2]))
        del before[k], behind[k]
        behind[one], before[other] = other, one
        for changed in (one, other):
            if first < changed < last - 1:
                near = before[changed], behind[changed]
                meeting = _meeting(lines[near[0]], lines[changed], lines[near[1]])
                heappush(heap, (*meeting, changed, *near))


def _meeting(a: Line, b: Line, c: Line) -> Line:
    """Return how far three lines are from the point that is equally far from all, and that point; else infinity."""
    ux, uy, u = a[0] - b[0], a[1] - b[1], a[2] - b[2]
    vx, vy, v = c[0] - b[0], c[1] - b[1], c[2] - b[2]
    whole = ux * vy - uy * vx
    if whole == 0:
        return math.inf, 0.0, 0.0
    x, y = (u * vy - uy * v) / whole, (ux * v - u * vx) / whole
    distance = b[0] * x + b[1] * y - b[2]
    return (distance, x, y) if distance > 0 else (math.inf, 0.0, 0.0)
