"""Comparisons of the angles and lengths of edges: doubles where they are certain, else fractions."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.arrays import Floats
from vorotool.numeric.numbers import difference, product

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
