"""Inverse functions by basic operations only: they give the same bits on every machine, as no library of these does."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]

_TERMS = 15
"""Of the power series: where |z| is at most 1/4 those from the next one on are below 2^-62 z."""


def inverse_sine(z: ArrayLike) -> Floats:
    """Angles of sines, which may be beyond 1 by their rounding.

    Parameters
    ----------
    z : array-like
        From -1 to 1.

    Examples
    --------
    >>> inverse_sine([0.5, 1.0]).tolist()
    [0.5235987755982988, 1.5707963267948963]
    """
    return _by_halves(np.clip(np.asarray(z, dtype=np.float64), -1, 1), -1)


def inverse_sinh(z: ArrayLike) -> Floats:
    """Give the inverse of the hyperbolic sine.

    Parameters
    ----------
    z : array-like
        Finite; below 2^500 in magnitude.

    Examples
    --------
    >>> float(inverse_sinh(0.75)), float(np.log(2))
    (0.6931471805599453, 0.6931471805599453)
    """
    return _by_halves(np.asarray(z, dtype=np.float64), 1)


def _by_halves(z: Floats, sign: int) -> Floats:
    """f(z) = 2 f(z / sqrt(2 (1 + sqrt(1 + sign z^2)))) brings z below 1/4, where the series is summed."""
    shape, z = z.shape, z.flatten()
    factor = np.ones_like(z)
    large = np.flatnonzero(np.abs(z) > 0.25)
    while large.size:
        part = z[large]
        root = np.sqrt(1 + part * part if sign > 0 else (1 - part) * (1 + part))
        part /= np.sqrt(2 * (1 + root))
        z[large] = part
        factor[large] *= 2
        large = large[np.abs(part) > 0.25]
    square, total = z * z, np.zeros_like(z)
    for coefficient in reversed(_coefficients(sign)):
        total *= square
        total += coefficient
    result: Floats = (factor * z * total).reshape(shape)
    return result


def _coefficients(sign: int) -> list[float]:
    values, product = [], 1.0
    for k in range(_TERMS):
        values.append(product / (2 * k + 1))
        product *= -sign * (2 * k + 1) / (2 * k + 2)
    return values
