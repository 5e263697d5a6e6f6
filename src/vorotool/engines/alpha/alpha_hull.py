"""The alpha hull: arcs of the shape's boundary, trimmed where they meet."""

from __future__ import annotations

from collections import defaultdict
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError, UsageError, option
from vorotool.numeric.curves.inverse_functions import angle_of, cosine_and_sine, hypotenuse, inverse_sine
from vorotool.numeric.lazy import shapely
from vorotool.numeric.numbers import nearest_double, shown_number
from vorotool.types.alpha.complex import CLASSES
from vorotool.types.alpha.shape import AlphaHull, AlphaShape
from vorotool.types.arguments import check_value

# Which discs there are is exact. Where their arcs meet is computed in doubles: crossings closer together than this
# part of the radius are not told apart, some thousand roundings of it.
_CLOSE = 2.0**-40

_MOST_BITS = 400
"""Of the exponent of a radius or a coordinate: products of two are floating-point numbers, and half so many bits below
1 leave room for the squares of lengths that are shorter by `_FLATTEST`."""

_FLATTEST = 2.0**300
"""A radius, or a coordinate, in parts of the shortest edge: with more bits in between squares of edges are nothing."""

# A piece between two crossings is covered as a whole or not at all, and if it is, then near its ends by a disc with
# two points on its circle: points near the ends and between them decide.
_PROBES = (0.02, 0.25, 0.5, 0.75, 0.98)


def alpha_hull(shape: AlphaShape) -> AlphaHull:
    """Compute the alpha hull: the complement of all empty open discs of radius r.

    Each boundary edge of the alpha shape is a chord of an empty disc, on the side without a triangle, and its arc
    within the triangle bounds the hull; where arcs of two edges cross, the other disc covers the part beyond. A
    singular edge has no arc: the discs on its two sides cover each other's arcs.

    Parameters
    ----------
    shape : AlphaShape
        A shape without thresholds and with a finite radius.

    Returns
    -------
    AlphaHull
        The arcs, and the isolated points of the hull.

    Raises
    ------
    UsageError
        If the radius is infinite: the alpha hull is then the convex hull.
    InputError
        If the radius is so large that an arc cannot be told from its edge.

    References
    ----------
    Edelsbrunner, Kirkpatrick and Seidel 1983.

    Examples
    --------
    Three arcs of a triangle, which cross near its corners: those are points of the hull by themselves.

    >>> from vorotool import alpha_shape
    >>> hull = alpha_hull(alpha_shape([[0, 0], [1, 0], [0.5, 0.75**0.5]], r=0.6))
    >>> len(hull), hull.points.tolist()
    (3, [0, 1, 2])
    """
    check_value(shape, "shape", "AlphaShape")
    if not len(shape.points):  # of an image without foreground
        return _no_hull(shape)
    if shape.r == np.inf:
        raise UsageError(
            "the hull of an infinite radius is the convex hull: use "
            f"{option('vorotool delaunay', 'delaunay(points).hull')}, or a finite r"
        )
    exponent = _scale(shape)
    arcs = _Arcs(shape, exponent)
    pieces = arcs.pieces()
    order, ring_starts = _rings(pieces)
    on_arcs = {int(node) for node in pieces.nodes[order].reshape(-1) if node >= 0}
    outer = np.flatnonzero((shape.point_classes < 3) & (shape.family.mesh.first == np.arange(len(shape.points))))
    alone = np.array([v for v in outer.tolist() if v not in on_arcs], dtype=np.int32)
    arc = pieces.arc[order]
    place, center = np.ldexp(pieces.place[order], exponent), np.ldexp(arcs.center[arc], exponent)
    return AlphaHull(
        shape,
        place[:, 0],
        place[:, 1],
        center,
        arcs.edge[arc],
        ring_starts,
        alone,
    )


def _no_hull(shape: AlphaShape) -> AlphaHull:
    place, nothing = np.empty((0, 2)), np.empty(0, np.int32)
    return AlphaHull(shape, place, place, place, nothing, np.zeros(1, np.int64), nothing)


def _scale(shape: AlphaShape) -> int:
    """The power of two to divide by: 0 unless products of two lengths would be no floating-point numbers."""
    r = nearest_double(shape.r)
    ends = shape.points[shape.edges]
    with np.errstate(over="ignore"):
        shortest = float(hypotenuse(*(ends[:, 1] - ends[:, 0]).T).min(initial=np.inf))
    largest = max(r, float(np.abs(shape.points).max()))
    if not (np.isfinite(largest) and largest <= shortest * _FLATTEST):
        raise InputError(
            f"the radius {shown_number(shape.r)} is too large for an edge of length {shortest:g}: the arcs of the "
            "hull would coincide with the edges in double precision; use a smaller r, or leave the hull out"
        )
    exponent = int(np.frexp(largest)[1])
    return exponent if exponent > _MOST_BITS or exponent < -_MOST_BITS // 2 else 0


class _Pieces:
    """Parts of arcs that bound the hull: their arc, both ends, and numbers that tell equal ends."""

    def __init__(self, arc: list[int], place: list[Any], nodes: list[tuple[int, int]]) -> None:
        self.arc = np.array(arc, dtype=np.int64)
        self.place = np.array(place, dtype=np.float64).reshape(-1, 2, 2)
        self.nodes = np.array(nodes, dtype=np.int64).reshape(-1, 2)


class _Arcs:
    """The arc of each boundary edge, clockwise around the center of its empty disc."""

    def __init__(self, shape: AlphaShape, exponent: int) -> None:
        self.r = float(np.ldexp(float(shape.r), -exponent))
        self.points = np.ldexp(shape.points, -exponent)
        self.edge = shape.edge_index[shape.kind == CLASSES.index("boundary")]
        a, b = self._directed(shape)
        self.a, self.b = a, b
        self.start, self.end = self.points[a], self.points[b]
        # The triangle is on the left of a to b, the center on the right.
        middle, right = self._to_centers(self.start, self.end)
        self.center = middle + right
        self.angle = 2 * inverse_sine(hypotenuse(*(self.end - self.start).T) / 2 / self.r)
        singular = shape.family.edges[shape.edge_index[shape.kind == CLASSES.index("singular")]]
        middle, right = self._to_centers(*self.points[singular.T])
        self.centers = np.concatenate([self.center, middle + right, middle - right])

    def _directed(self, shape: AlphaShape) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
        """Ends of each boundary edge, with the shape's triangle on the left."""
        family = shape.family
        sides = family.sides[self.edge]
        inside = np.append(shape.inside, False)[sides]
        t = np.where(inside[:, 0], sides[:, 0], sides[:, 1])
        corners = family.mesh.triangles[t]
        ends = family.edges[self.edge]
        follows = (np.roll(corners, -1, axis=1) == ends[:, 1:]) & (corners == ends[:, :1])
        forward = follows.any(axis=1)
        a, b = ends.T
        return np.where(forward, a, b), np.where(forward, b, a)

    def _to_centers(self, a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
        """Middles of a to b, and by what Pythagoras says the way to centers on the right."""
        across = b - a
        half = hypotenuse(*across.T) / 2
        depth = np.sqrt(np.maximum((self.r - half) * (self.r + half), 0))
        right = np.stack([across[:, 1], -across[:, 0]], axis=1) / (2 * half)[:, None]
        return np.stack([(a + b) / 2, depth[:, None] * right])

    def at(self, arc: NDArray[np.int64], turned: NDArray[np.float64]) -> NDArray[np.float64]:
        """Points of arcs, so far from their starts, as an angle."""
        x, y = (self.start[arc] - self.center[arc]).T
        cosine, sine = cosine_and_sine(turned)
        turned_offsets = np.stack([x * cosine + y * sine, y * cosine - x * sine], axis=1)
        return self.center[arc] + turned_offsets

    def turn_of(self, arc: NDArray[np.int64], points: NDArray[np.float64]) -> NDArray[np.float64]:
        """How far points on the circles of arcs are from their starts, in (-π, π]."""
        ux, uy = (self.start[arc] - self.center[arc]).T
        vx, vy = (points - self.center[arc]).T
        return -angle_of(ux * vx + uy * vy, ux * vy - uy * vx)

    def crossings(self) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]:
        """Pairs of arcs that cross between their ends, the first number smaller, and where."""
        if not len(self.edge):
            return np.empty(0, np.int64), np.empty(0, np.int64), np.empty((0, 2))
        middle = self.at(np.arange(len(self.edge)), self.angle / 2)
        # A minor arc is within the box of its ends and its middle, made wider by the distance of a quarter-point.
        low = np.minimum(np.minimum(self.start, self.end), middle)
        high = np.maximum(np.maximum(self.start, self.end), middle)
        slack = self.r * (1 - cosine_and_sine(self.angle / 4)[0])[:, None] + _CLOSE * self.r
        boxes = shapely.box(*(low - slack).T, *(high + slack).T)
        i, j = shapely.STRtree(boxes).query(boxes)
        i, j = i[i < j], j[i < j]
        between = self.center[j] - self.center[i]
        half = hypotenuse(*between.T) / 2
        meets = (half > 0) & (half < self.r)
        i, j, between, half = i[meets], j[meets], between[meets], half[meets]
        reach = np.sqrt((self.r - half) * (self.r + half)) / (2 * half)
        normal = np.stack([-between[:, 1], between[:, 0]], axis=1) * reach[:, None]
        base = (self.center[i] + self.center[j]) / 2
        found = [self._within(i, j, base + sign * normal) for sign in (1, -1)]
        return tuple(np.concatenate(part) for part in zip(*found, strict=True))  # type: ignore[return-value]

    def _within(
        self, i: NDArray[np.int64], j: NDArray[np.int64], points: NDArray[np.float64]
    ) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]:
        """Those that are on both arcs, and not at an end."""
        chosen = np.ones(len(i), dtype=bool)
        for arc in (i, j):
            turned = self.turn_of(arc, points)
            chosen &= (turned > _CLOSE) & (turned < self.angle[arc] - _CLOSE)
        return i[chosen], j[chosen], points[chosen]

    def pieces(self) -> _Pieces:
        """The parts of the arcs that no other disc covers."""
        i, j, places = self.crossings()
        cuts: dict[int, list[tuple[float, int]]] = defaultdict(list)
        for arcs in (i, j):
            turned = self.turn_of(arcs, places)
            for number, (arc, turn) in enumerate(zip(arcs.tolist(), turned.tolist(), strict=True)):
                cuts[arc].append((turn, -1 - number))
        arc, place, nodes, spans = [], [], [], []
        for k in range(len(self.edge)):
            stops = [(0.0, int(self.a[k])), *sorted(cuts.get(k, [])), (float(self.angle[k]), int(self.b[k]))]
            for (first, p), (last, q) in pairwise(stops):
                arc.append(k)
                spans.append((first, last))
                nodes.append((p, q))
                place.append(tuple(self._place(k, n, places) for n in (p, q)))
        pieces = _Pieces(arc, place, nodes)
        kept = ~self._covered(pieces.arc, np.array(spans).reshape(-1, 2))
        pieces.arc, pieces.place, pieces.nodes = pieces.arc[kept], pieces.place[kept], pieces.nodes[kept]
        return pieces

    def _place(self, arc: int, node: int, crossings: NDArray[np.float64]) -> list[float]:
        if node < 0:
            return crossings[-1 - node].tolist()
        return (self.start if node == self.a[arc] else self.end)[arc].tolist()

    def _covered(self, arc: NDArray[np.int64], spans: NDArray[np.float64]) -> NDArray[np.bool_]:
        covered = np.zeros(len(arc), dtype=bool)
        if not len(arc):
            return covered
        tree = shapely.STRtree(shapely.points(self.centers))
        for part in _PROBES:
            left = np.flatnonzero(~covered)
            turned = spans[left, 0] + part * (spans[left, 1] - spans[left, 0])
            probes = shapely.points(self.at(arc[left], turned))
            _, distance = tree.query_nearest(probes, return_distance=True, all_matches=False)
            covered[left] = distance < self.r * (1 - 16 * _CLOSE)
        return covered


def _rings(pieces: _Pieces) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Order pieces into rings: after each the first one, clockwise from the way back, that leaves its end."""
    leaving: dict[int, list[int]] = defaultdict(list)
    for number, (node, _) in enumerate(pieces.nodes.tolist()):
        leaving[node].append(number)
    order: list[int] = []
    starts = [0]
    used = np.zeros(len(pieces.arc), dtype=bool)
    for first in range(len(used)):
        current = first
        while not used[current]:
            used[current] = True
            order.append(current)
            choices = [k for k in leaving[int(pieces.nodes[current, 1])] if not used[k] or k == first]
            if not choices:
                break
            current = choices[0] if len(choices) == 1 else min(choices, key=_clockwise_from(pieces, current))
        if len(order) > starts[-1]:
            starts.append(len(order))
    return np.array(order, dtype=np.int64), np.array(starts, dtype=np.int64)


def _clockwise_from(pieces: _Pieces, arriving: int) -> Any:
    """How far, clockwise, the chord of a piece is turned from the way back along another."""
    back = pieces.place[arriving, 0] - pieces.place[arriving, 1]
    start = angle_of(*back)

    def turn(piece: int) -> float:
        ahead = pieces.place[piece, 1] - pieces.place[piece, 0]
        return float((start - angle_of(*ahead)) % (2 * np.pi))

    return turn
