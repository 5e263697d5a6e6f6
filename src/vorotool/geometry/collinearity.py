"""Places that are exactly on the straight line between others."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

_SPLIT = 2.0**27 + 1
"""Parts a double into two halves of 26 bits, whose products are exact (Dekker 1971)."""


def is_straight(a: Floats, b: Floats, c: Floats) -> NDArray[np.bool_]:
    """Tell where b is certainly between a and c: the products compared are exact, where differences are.

    Parameters
    ----------
    a, b, c : (k, 2) float64 array
        Places.

    Examples
    --------
    >>> a, b, c = np.array([[[0, 2], [0, 0]], [[2, 2], [1, 1]], [[8, 2], [3, 2]]], dtype=float)
    >>> is_straight(a, b, c).tolist()
    [True, False]
    """
    (ux, uy), ux_exact, uy_exact = _difference(b, a)
    (vx, vy), vx_exact, vy_exact = _difference(c, b)
    product, error = _product(ux, vy)
    other, other_error = _product(uy, vx)
    is_zero = (product == other) & (error == other_error) & ux_exact & uy_exact & vx_exact & vy_exact
    is_level = ((ux == 0) & (vx == 0)) | ((uy == 0) & (vy == 0))
    return np.asarray((is_zero | is_level) & (ux * vx + uy * vy >= 0))


def _difference(p: Floats, q: Floats) -> tuple[Floats, NDArray[np.bool_], NDArray[np.bool_]]:
    """Subtract q from p, by columns, and where each is exact (Knuth's two-sum)."""
    way = p - q
    taken = p - way
    x, y = ((p - (way + taken)) + (taken - q) == 0).T
    return way.T, x, y


def _product(x: Floats, y: Floats) -> tuple[Floats, Floats]:
    """The rounded product, and what is missing."""
    product = x * y
    (x1, x2), (y1, y2) = _halves(x), _halves(y)
    return product, x2 * y2 - (((product - x1 * y1) - x2 * y1) - x1 * y2)


def _halves(x: Floats) -> tuple[Floats, Floats]:
    scaled = _SPLIT * x
    high = scaled - (scaled - x)
    return high, x - high
