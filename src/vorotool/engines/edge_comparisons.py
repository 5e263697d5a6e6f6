"""Comparisons of the angles and lengths of edges: doubles where they are certain, else fractions."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from vorotool.geometry.exact_products import difference, product

Floats = NDArray[np.float64]

UNCERTAIN = 2.0**-48
"""Of the sum of magnitudes: products of four differences and their sums have errors of at most 12 roundings each."""


def is_blunt(points: Floats) -> NDArray[np.bool_]:
    """Tell of edges whether the angles at both ends differ by at most a right angle.

    The cosine of their difference is not negative then. Where doubles cannot tell, fractions do.

    Parameters
    ----------
    points : (k, 4, 2) float64 array
        The vertex before each edge, its ends, and the vertex behind it.

    Examples
    --------
    >>> is_blunt(np.array([[[0, 9], [0, 0], [4, 4], [4, 9]], [[0, 9], [0, 0], [4, 3], [4, 9]]])).tolist()
    [True, True]
    >>> is_blunt(np.array([[[0, 9], [0, 0], [4, 5], [4, 9]]])).tolist()
    [False]
    """
    value, magnitude = _cosine(points)
    blunt: NDArray[np.bool_] = value >= 0
    for k in np.flatnonzero(np.abs(value) <= UNCERTAIN * magnitude).tolist():
        blunt[k] = _exact_cosine(points[k]) >= 0
    return blunt


def _cosine(points: Floats) -> tuple[Floats, Floats]:
    """The cosine of the difference of the angles, times lengths, and the sum of the magnitudes in it."""
    (ux, uy), (vx, vy), (wx, wy) = ((points[:, k] - points[:, m]).T for k, m in ((0, 1), (2, 1), (3, 2)))
    dots, crosses = (ux * vx + uy * vy) * -(vx * wx + vy * wy), (ux * vy - uy * vx) * (vx * wy - vy * wx)
    x, y, z = np.abs(ux * vx) + np.abs(uy * vy), np.abs(vx * wx) + np.abs(vy * wy), np.abs(ux * vy) + np.abs(uy * vx)
    return dots + np.abs(crosses), x * y + z * (np.abs(vx * wy) + np.abs(vy * wx))


def _exact_cosine(points: Floats) -> Fraction:
    (px, py), (ax, ay), (bx, by), (qx, qy) = ((Fraction(x), Fraction(y)) for x, y in points.tolist())
    ux, uy, vx, vy, wx, wy = px - ax, py - ay, bx - ax, by - ay, qx - bx, qy - by
    return (ux * vx + uy * vy) * -(vx * wx + vy * wy) + abs((ux * vy - uy * vx) * (vx * wy - vy * wx))


def shortest(edges: Floats) -> NDArray[np.intp]:
    """Tell which of some edges is the shortest, the first of equal ones.

    Parameters
    ----------
    edges : (t, k, 2, 2) float64 array
        Their ends.

    Returns
    -------
    (t,) integer array
        From 0 to k - 1.

    Examples
    --------
    >>> shortest(np.array([[[[0, 0], [3, 4]], [[0, 0], [4, 3]], [[0, 0], [9, 9]]]], dtype=float)).tolist()
    [0]
    """
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
