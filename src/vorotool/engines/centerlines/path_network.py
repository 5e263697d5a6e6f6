"""The arcs of a skeleton as a graph: longest and shortest paths, and the point of it that is nearest to a place."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.centerlines.corner_twigs import TIE
from vorotool.engines.centerlines.ends import Unforked
from vorotool.engines.skeleton.parts import core_skeleton
from vorotool.numeric.arrays import Booleans, Columns, Floats, owners, starts_of
from vorotool.numeric.parallel import Progress
from vorotool.plain import plain
from vorotool.types.skeleton.skeleton import Skeleton

Indices = NDArray[np.int32]
Place = tuple[float, float]


def geometry_of(skeleton: Skeleton, arc: Indices, first: Floats, last: Floats) -> dict[str, Floats]:
    """Places, radii, control points and lengths of parts of arcs, by the parameters of their ends."""
    return _core.pruning.part_geometry(core_skeleton(skeleton), arc, first, last)


@plain(eq=False)
class Paths:
    """Arcs of paths that follow one another, and the nodes that each leads from and to."""

    start: NDArray[np.int64]
    arcs: Indices
    sources: Indices
    targets: Indices

    def reversed(self) -> Paths:
        """One path, the other way round."""
        return Paths(self.start, self.arcs[::-1], self.targets[::-1], self.sources[::-1])

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


@plain(eq=False)
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
        number = np.empty(len(node), dtype=np.int32)
        number[node] = np.arange(len(node))
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
    way = np.diff(points, axis=0, append=points[-1:])
    square = (way * way).sum(axis=1)
    t = np.divide(((p - points) * way).sum(axis=1), square, out=np.zeros(len(points)), where=square > 0)
    off = points + np.clip(t, 0, 1)[:, None] * way - p
    return (off * off).sum(axis=1)


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
