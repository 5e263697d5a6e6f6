"""The place on a skeleton that is nearest to a given one."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from vorotool.types.skeleton.skeleton import Skeleton

Floats = NDArray[np.float64]

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
    squares: Floats = (off * off).sum(axis=1)
    return squares


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
