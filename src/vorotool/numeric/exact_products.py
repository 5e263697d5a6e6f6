"""Differences and products of doubles, with what their rounding leaves out."""

from __future__ import annotations

from vorotool.numeric.arrays import Floats

_SPLIT = 2.0**27 + 1
"""Parts a double into two halves of 26 bits, whose products are exact (Dekker 1971)."""


def difference(p: Floats, q: Floats) -> tuple[Floats, Floats]:
    """Subtract q from p: the rounded difference, and what is missing (Knuth's two-sum)."""
    rounded = p - q
    taken = p - rounded
    return rounded, (p - (rounded + taken)) + (taken - q)


def product(x: Floats, y: Floats) -> tuple[Floats, Floats]:
    """Multiply: the rounded product, and what is missing, unless it is below the smallest number."""
    rounded = x * y
    (x1, x2), (y1, y2) = _halves(x), _halves(y)
    return rounded, x2 * y2 - (((rounded - x1 * y1) - x2 * y1) - x1 * y2)


def _halves(x: Floats) -> tuple[Floats, Floats]:
    scaled = _SPLIT * x
    high = scaled - (scaled - x)
    return high, x - high
