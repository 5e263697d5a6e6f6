"""The arcs of a skeleton as a graph: longest and shortest paths, and the point of it that is nearest to a place."""

from __future__ import annotations

from dataclasses import field, replace
from itertools import pairwise
from math import inf

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.centerlines.ends import Unforked
from vorotool.engines.centerlines.extended_ends import TIP, Reaches
from vorotool.engines.centerlines.twigs import TIE
from vorotool.engines.common import nearest_on_segments
from vorotool.engines.skeleton.parts import core_skeleton
from vorotool.frozen import frozen
from vorotool.numeric.arrays import Booleans, Columns, Floats, dots, owners, ranks_of, starts_of
from vorotool.numeric.parallel import Progress
from vorotool.types.skeleton.skeleton import INTERIOR, Skeleton

Indices = NDArray[np.int32]
Place = tuple[float, float]


def geometry_of(skeleton: Skeleton, arc: Indices, first: Floats, last: Floats) -> dict[str, Floats]:
    """Places, radii, control points and lengths of parts of arcs, by the parameters of their ends."""
    return _core.pruning.part_geometry(core_skeleton(skeleton), arc, first, last)


@frozen(eq=False)
class Paths:
    """Arcs of paths that follow one another, and the nodes that each leads from and to."""

    start: NDArray[np.int64]
    arcs: Indices
    sources: Indices
    targets: Indices

    def turned(self, is_turned: Booleans) -> Paths:
        """Some paths the other way round."""
        path = owners(np.diff(self.start))
        place = np.arange(len(self.arcs))
        turned = is_turned[path]
        order = np.where(turned, (self.start[:-1] + self.start[1:] - 1)[path] - place, place)
        sources, targets = self.sources[order], self.targets[order]
        return Paths(
            self.start, self.arcs[order], np.where(turned, targets, sources), np.where(turned, sources, targets)
        )

    @property
    def end_nodes(self) -> Indices:
        """(k, 2) the first and the last node of each path."""
        return np.stack([self.sources[self.start[:-1]], self.targets[self.start[1:] - 1]], axis=1)


@frozen(eq=False)
class Pieces(Columns):
    """Parts of arcs along lines, each in the direction of its line."""

    line: Indices
    arc: Indices
    first: Floats
    last: Floats
    is_turned: Booleans


class Network:
    """Arcs of a skeleton, or parts of them, as a graph; places inside arcs can be made nodes."""

    def __init__(self, axis: Unforked, *, by_edge: bool) -> None:
        self.axis, self.skeleton, self.by_edge = axis, axis.skeleton, by_edge
        self.arc = axis.arcs.astype(np.int32)
        node, self.leaves = _numbered(self.skeleton, axis.arcs, by_edge=by_edge)
        self.node = node
        number = ranks_of(node, len(node), np.int32)
        self.ends = number[self.skeleton.arcs[self.arc]]
        self.first, self.last = np.zeros(len(self.arc)), np.ones(len(self.arc))
        self.length = axis.reach[self.arc]
        self.nodes = len(node)

    def node_near(self, place: Place) -> int:
        """The node at the place of the skeleton that is nearest to a given one, without round ends if there is more."""
        arcs = self.axis.arcs
        plain = arcs[~self.axis.is_round[arcs]]
        return self._node_at(*nearest_place(self.skeleton, place, plain if len(plain) else arcs))

    def _node_at(self, arc: int, place: float) -> int:
        """The node at a place of an arc, which is parted there if need be."""
        k = int(np.flatnonzero((self.arc == arc) & (self.first <= place) & (place <= self.last))[0])
        for end, own in ((0, self.first[k]), (1, self.last[k])):
            if place == own:
                return int(self.ends[k, end])
        node, self.nodes = self.nodes, self.nodes + 1
        self.arc = np.append(self.arc, self.arc[k])
        self.ends = np.concatenate([self.ends, [[node, self.ends[k, 1]]]]).astype(np.int32)
        self.first, self.last = np.append(self.first, place), np.append(self.last, self.last[k])
        self.ends[k, 1], self.last[k] = node, place
        both = [k, len(self.arc) - 1]
        self.length = np.append(self.length, 0.0)
        self.length[both] = geometry_of(self.skeleton, self.arc[both], self.first[both], self.last[both])["length"]
        return node

    def longest_paths(self, progress: Progress) -> Paths:
        """One path a polygon that has one of more than a place; each from the end with the first leaf."""
        count = len(self.skeleton.polygons)
        polygon = np.ascontiguousarray(self.skeleton.polygon[self.arc])
        tie = TIE if self.by_edge else 0.0
        start, arcs, targets = _core.graphs.longest_paths(
            self.ends, self.length, polygon, count, self.nodes, tie, progress
        )
        path = owners(np.diff(start))
        length = np.bincount(path, self.length[arcs], minlength=count)
        kept = (length > 0)[path]
        sizes = np.diff(start)[length > 0]
        paths = self._with_sources(starts_of(sizes), arcs[kept], targets[kept])
        one, other = self.axis.first_leaf[self.node[paths.end_nodes]].T
        return paths.turned(one > other)

    def pieces(self, paths: Paths) -> Pieces:
        """What paths are of."""
        return Pieces(
            owners(np.diff(paths.start), dtype=np.int32),
            self.arc[paths.arcs],
            self.first[paths.arcs],
            self.last[paths.arcs],
            self.ends[paths.arcs, 0] != paths.sources,
        )

    def path(self, first: int, last: int, progress: Progress) -> Paths | None:
        """The shortest path between two nodes; with last -1 the longest of those to leaves."""
        polygon = self.skeleton.polygon[self.arc]
        at_ends = ((self.ends == first) | (self.ends == last)).any(axis=1)
        own = np.flatnonzero(np.isin(polygon, polygon[at_ends]))  # no other is looked at
        found = _core.graphs.path_from(self.ends[own], self.length[own], self.nodes, first, last, progress)
        if found is None:
            return None
        return self._with_sources(np.array([0, len(found[0])]), own[found[0]].astype(np.int32), found[1])

    def _with_sources(self, start: NDArray[np.int64], arcs: Indices, targets: Indices) -> Paths:
        ends = self.ends[arcs]
        return Paths(start, arcs, np.where(ends[:, 1] == targets, ends[:, 0], ends[:, 1]), targets)


def _numbered(skeleton: Skeleton, arcs: NDArray[np.intp], *, by_edge: bool) -> tuple[NDArray[np.intp], int]:
    """All nodes in the order of their numbers, and the number of those that are leaves of some arcs."""
    ends = skeleton.arcs[arcs]
    is_leaf = np.bincount(ends.reshape(-1), minlength=len(skeleton.vertices)) == 1
    vertex = skeleton.site_table.vertices(skeleton.polygons, skeleton.sites[arcs])
    edge = np.zeros(len(is_leaf), dtype=np.int64)
    for column in ends.T:
        edge[column] = vertex.min(axis=1)
    nodes = np.arange(len(is_leaf))
    return np.lexsort((nodes, edge * (is_leaf & by_edge), ~is_leaf)), int(is_leaf.sum())


_FINENESS = 2.0**-12
"""Of the extent of the skeleton: how near polylines are to arcs in the search for those that may be nearest."""


def nearest_place(skeleton: Skeleton, place: tuple[float, float], arcs: NDArray[np.intp]) -> tuple[int, float]:
    """Find the nearest place on some arcs of a skeleton."""
    p = np.array(place)
    fineness = _FINENESS * (float(np.ptp(skeleton.vertices, axis=0).max()) or 1.0)
    points, start = skeleton.flattened(fineness)
    own = np.sqrt(_squares_to_pieces(points, p))
    own[start[1:] - 1] = np.inf  # from the last point of an arc no piece goes on
    distance = np.minimum.reduceat(own, start[:-1])[arcs]
    candidates = arcs[distance <= distance.min() + 2 * fineness]
    found = [_nearest_on_arc(skeleton, arc, p) for arc in candidates.tolist()]
    best = min(range(len(found)), key=lambda k: found[k][0])
    return int(candidates[best]), found[best][1]


def _squares_to_pieces(points: Floats, p: Floats) -> Floats:
    """Squared distances from the piece that begins at each point; the last has none."""
    off = nearest_on_segments(p, points, np.append(points[1:], points[-1:], axis=0)) - p
    return dots(off, off)


def _nearest_on_arc(skeleton: Skeleton, arc: int, p: Floats) -> tuple[float, float]:
    """Squared distance and parameter: at an end, or where the way to the place is across the curve."""
    a, b = skeleton.vertices[skeleton.arcs[arc]] - p
    c = skeleton.control[arc] - p if skeleton.is_parabola[arc] else (a + b) / 2
    bend, way = a - 2 * c + b, c - a
    # B(u) = a + 2 u way + u^2 bend; half its product with B'(u) is a cubic
    cubic = [_dot(a, way), _dot(a, bend) + 2 * _dot(way, way), 3 * _dot(way, bend), _dot(bend, bend)]
    found = []
    for u in (0.0, *_roots(cubic), 1.0):
        at = a + u * (2 * way + u * bend)
        found.append((_dot(at, at), u))
    return min(found)


def _dot(a: Floats, b: Floats) -> float:
    return float(a[0] * b[0] + a[1] * b[1])


def _roots(coefficients: list[float]) -> list[float]:
    """Roots of a polynomial between 0 and 1, by bisection between those of its derivative."""
    degree = len(coefficients) - 1
    if degree == 0:
        return []
    slopes = [k * value for k, value in enumerate(coefficients)][1:]
    ends = [0.0, *_roots(slopes), 1.0]
    return [root for low, high in pairwise(ends) for root in _bisected(coefficients, low, high)]


def _bisected(coefficients: list[float], low: float, high: float) -> list[float]:
    def value(u: float) -> float:
        total = 0.0
        for coefficient in reversed(coefficients):
            total = total * u + coefficient
        return total

    rises = value(high) > 0
    if (value(low) > 0) == rises:
        return []
    while True:
        middle = (low + high) / 2
        if not low < middle < high:
            return [middle]
        low, high = (low, middle) if (value(middle) > 0) == rises else (middle, high)


BUMP = 0.25
"""In radii of the disc that a piece hangs on: what is shorter is no branch beside a line."""

SAME = 0.125
"""As a part of the radius: by how much that of a disc before may differ where sides are parallel."""


def at_strip_ends(
    axis: Unforked, pieces: Pieces, known: int, wanted: tuple[bool, bool]
) -> tuple[Pieces, NDArray[np.bool_]]:
    """Let lines end where the ends of strips begin."""
    strips = _Strips(axis, known)
    ends = axis.skeleton.arcs[pieces.arc].astype(np.intp)
    ends[np.stack([pieces.first != 0, pieces.last != 1], axis=1)] = -1  # no node where an arc is parted
    sources, targets = np.where(pieces.is_turned[:, None], ends[:, ::-1], ends).T.tolist()
    arcs, start = pieces.arc.tolist(), starts_of(np.bincount(pieces.line)).tolist()
    whole = [([sources[begin], *targets[begin:stop]], arcs[begin:stop]) for begin, stop in pairwise(start)]
    walks = [strips.walk(*line) if wanted[0] else _Walk([], []) for line in whole]
    walks += [strips.walk(nodes[::-1], along[::-1]) if wanted[1] else _Walk([], []) for nodes, along in whole]
    found = strips.ends_on(walks)
    index, sizes, added = [], [], []
    for begin, stop, head, tail in zip(start, start[1:], found, found[len(whole) :], strict=False):
        kept = range(begin + head.dropped, stop - tail.dropped)
        sizes.append(len(head.added) + len(kept) + len(tail.added))
        index += [-1] * len(head.added) + list(kept) + [-1] * len(tail.added)
        added += [(arc, outer, True) for arc, outer in head.added]
        added += [(arc, outer, False) for arc, outer in tail.added[::-1]]
    made, new = pieces[np.array(index, dtype=np.intp)], np.flatnonzero(np.array(index) < 0)
    arc, outer, is_head = np.array(added, dtype=np.intp).reshape(-1, 3).T
    made.arc[new], made.first[new], made.last[new] = arc, 0, 1
    made.is_turned[new] = (axis.skeleton.arcs[arc, 0] == outer) != is_head
    is_made = np.array([end != _End() for end in found], dtype=bool).reshape(2, -1).T
    return replace(made, line=owners(np.array(sizes, dtype=np.int64), dtype=np.int32)), is_made


@frozen
class _Walk:
    """Nodes and arcs from an end of a line inwards: what the line loses, and what is there instead, is left out."""

    nodes: list[int]  # one node more than arcs; or none
    arcs: list[int]  # one node more than arcs; or none
    dropped: int = 0  # how many arcs at the end of the line are of no walk
    # the arcs that are there instead, with their outer nodes
    added: list[tuple[int, int]] = field(default_factory=list)
    is_lead: bool = False  # whether a lead was at the end


@frozen
class _End:
    """What a line loses, from the outside, and what it gets instead: arcs and their outer nodes."""

    dropped: int = 0
    added: tuple[tuple[int, int], ...] = ()


class _Strips:
    """A skeleton to look for ends in, as lists."""

    def __init__(self, axis: Unforked, known: int) -> None:
        skeleton = axis.skeleton
        self.radius, self.length = skeleton.radius, skeleton.length
        is_plain = ~(axis.is_round | axis.is_lead)
        is_plain[known:] = False
        self.is_plain, self.is_round, self.is_lead = is_plain.tolist(), axis.is_round.tolist(), axis.is_lead.tolist()
        self.reaches = Reaches(skeleton)
        ends = skeleton.arcs[:known].astype(np.intp)
        ends[skeleton.side[:known] != INTERIOR] = len(skeleton.vertices)
        self.both = ends.sum(axis=1).tolist()
        self.beside: list[int] = (np.argsort(ends.reshape(-1), kind="stable") // 2).tolist()
        self.start = starts_of(np.bincount(ends.reshape(-1), minlength=len(skeleton.vertices))).tolist()

    def at(self, node: int) -> list[int]:
        """Its arcs."""
        return self.beside[self.start[node] : self.start[node + 1]]

    def walk(self, nodes: list[int], arcs: list[int]) -> _Walk:
        """Follow a line from its end; in a round end, from its farthest leaf."""
        first = next((k for k, arc in enumerate(arcs) if self.is_plain[arc]), len(arcs))
        stop = len(nodes) - (nodes[-1] < 0 or not self.is_plain[arcs[-1]])
        if first + 1 >= stop or nodes[first] < 0:
            return _Walk([], [])
        is_round = any(self.is_round[arc] for arc in arcs[:first])
        added = self._farthest(nodes[first], arcs[first]) if is_round else []
        return _Walk(
            [node for _, node in added] + nodes[first:stop],
            [arc for arc, _ in added] + arcs[first : stop - 1],
            first,
            added,
            first > 0 and self.is_lead[arcs[first - 1]],
        )

    def ends_on(self, walks: list[_Walk]) -> list[_End]:
        """What lines lose and get at the end of each walk."""
        found = []
        for walk, strips in zip(walks, self._strips(walks), strict=True):
            at = self._place(walk, strips)
            if at < 0 or (at == 0 and not walk.added and (walk.is_lead or not walk.dropped)):
                found.append(_End())  # the middle of a fork is an end
            else:
                found.append(_End(walk.dropped + max(at - len(walk.added), 0), tuple(walk.added[at:])))
        return found

    def _strips(self, walks: list[_Walk]) -> list[list[int]]:
        """Where the discs one and two radii on, and three if it is long before, are about as large."""
        sizes = np.array([len(walk.nodes) for walk in walks], dtype=np.int64)
        start, walk = starts_of(sizes), owners(sizes)
        if not len(walk):
            return [[]] * len(walks)
        nodes = np.concatenate([np.array(walk.nodes, dtype=np.intp) for walk in walks])
        arcs = np.concatenate([np.array([*walk.arcs, -1][: len(walk.nodes)], dtype=np.intp) for walk in walks])
        radius = self.radius[nodes]
        some = np.flatnonzero(sizes)
        unit = np.repeat(np.maximum.reduceat(radius, start[some]), sizes[some])  # far from other walks nothing is lost
        radius, ways = radius / unit, np.where(arcs < 0, 8.0, self.length[arcs] / unit)
        depth = np.concatenate([[0.0], np.cumsum(ways)[:-1]])
        begin, end = depth[start[walk]], depth[start[walk + 1] - 1]
        found = (radius > 0) & (depth + 2 * radius <= end)
        for far in (1, 2, 3):
            place = depth + far * radius
            after = np.clip(np.searchsorted(depth, place), 1, len(depth) - 1)
            step = depth[after] - depth[after - 1]
            part = np.divide(place - depth[after - 1], step, out=np.zeros_like(step), where=step > 0)
            off = np.abs(radius[after - 1] + part * (radius[after] - radius[after - 1]) - radius)
            found &= (off <= SAME * radius) | ((far > 2) & (depth - begin <= 2 * radius))
        at = np.flatnonzero(found)
        return [part.tolist() for part in np.split(at - start[walk[at]], np.searchsorted(at, start[1:-1]))]

    def _farthest(self, node: int, inner: int) -> list[tuple[int, int]]:
        """The way to the farthest leaf beyond a node, from there: arcs and their outer nodes."""
        order, todo = {}, [(arc, node, 0.0) for arc in self.at(node) if arc != inner]
        far = {node: 0.0}
        while todo:
            arc, before, way = todo.pop()
            outer = self.both[arc] - before
            if outer in far:
                continue
            far[outer], order[outer] = way + self.reaches.length[arc], (arc, before)
            todo += [(to, outer, far[outer]) for to in self.at(outer) if to != arc]
        at, found = max(far, key=lambda k: far[k]), []
        while at != node:
            found.append((order[at][0], at))
            at = order[at][1]
        return found

    def _place(self, walk: _Walk, strips: list[int]) -> int:
        """Which of some nodes of a walk is the innermost one that has all of an end beyond, or -1."""
        nodes, arcs, own, found = walk.nodes, walk.arcs, self.reaches.own, -1
        most = max((own[nodes[at]] for at in strips), default=0.0)
        farthest, branch, bump = 0.0, 0.0, BUMP / TIP
        is_strip = set(strips)
        for at in range(strips[-1] + 1 if strips else 0):
            node, inner, outer = nodes[at], arcs[at], arcs[at - 1] if at else -1
            if at:
                farthest, branch = self.reaches.over(outer, nodes[at - 1], farthest, branch)
            farthest = max(farthest, own[node])
            for arc in self.at(node):
                if arc not in (inner, outer):
                    reach, beyond = self._beyond(arc, node, most)
                    farthest, branch = max(farthest, reach), max(branch, beyond)
            if farthest > most or branch > bump * most:
                break
            if farthest <= own[node] and branch <= bump * own[node] and at in is_strip:
                found = at
        return found

    def _beyond(self, arc: int, node: int, most: float) -> tuple[float, float]:
        """The reach of what hangs on a node, and the longest branch there; infinite where it is no piece."""
        leaf = self.both[arc] - node
        if self.start[leaf + 1] - self.start[leaf] == 1:  # most are
            return self.reaches.over(arc, leaf, self.reaches.own[leaf], 0.0)
        order, todo, seen = [], [(arc, node, 0.0)], {node}
        while todo:
            arc, inner, before = todo.pop()
            outer, far = self.both[arc] - inner, before + self.reaches.length[arc]
            if outer in seen or far + self.reaches.own[outer] > most:
                return inf, inf
            seen.add(outer)
            order.append((arc, outer, inner))
            todo += [(to, outer, far) for to in self.at(outer) if to != arc]
        found: dict[int, tuple[float, float]] = {}
        for arc, outer, inner in reversed(order):
            reach, beyond = self.reaches.over(arc, outer, *found.get(outer, (self.reaches.own[outer], 0.0)))
            far, branch = found.get(inner, (0.0, 0.0) if inner == node else (self.reaches.own[inner], 0.0))
            found[inner] = max(far, reach), max(branch, beyond)
        return found[node]
