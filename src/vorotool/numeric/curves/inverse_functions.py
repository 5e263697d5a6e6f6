"""Elementary functions by basic operations only: they give the same bits on every machine, as no library of these does.

Sums, products, quotients and square roots are rounded alike everywhere; sines, logarithms, powers and hypot are not.
"""

from __future__ import annotations

from math import factorial

import numpy as np
from numpy.typing import ArrayLike

from vorotool.numeric.arrays import Floats

PI = 3.141592653589793
_QUARTER = (1.5707963267341256, 6.077100506506192e-11)
"""A quarter of a turn: its first 33 bits, so that small multiples are exact, and the rest."""

_TERMS = 15
"""Of the power series: where |z| is at most 1/4 those from the next one on are below 2^-62 z."""


def inverse_sine(z: ArrayLike) -> Floats:
    """Angles of sines, which may be beyond 1 by their rounding."""
    return _by_halves(np.clip(np.asarray(z, dtype=np.float64), -1, 1), -1)


def inverse_sinh(z: ArrayLike) -> Floats:
    """Give the inverse of the hyperbolic sine."""
    return _by_halves(np.asarray(z, dtype=np.float64), 1)


def hypotenuse(x: ArrayLike, y: ArrayLike) -> Floats:
    """Lengths of ways (x, y), wrong by less than a unit in the last place."""
    x, y = np.abs(np.asarray(x, dtype=np.float64)), np.abs(np.asarray(y, dtype=np.float64))
    large, small = np.maximum(x, y), np.minimum(x, y)
    is_near = (large >= 2.0**-459) & (large <= 2.0**511) | (large == 0)
    if is_near.all():
        return _hypotenuse(large, small)
    is_infinite = np.isinf(large)
    shift = np.where(is_near | is_infinite, 0, np.frexp(np.where(is_infinite, 0, large))[1])
    with np.errstate(over="ignore", under="ignore", invalid="ignore"):
        found: Floats = np.ldexp(_hypotenuse(np.ldexp(large, -shift), np.ldexp(small, -shift)), shift)
    return np.where(is_infinite, np.inf, found)


def _hypotenuse(large: Floats, small: Floats) -> Floats:
    root = np.sqrt(large * large + small * small)
    is_even = root <= 2 * small
    over = root - np.where(is_even, small, large)
    one = np.where(is_even, large * (2 * over - large), 2 * over * (large - 2 * small))
    two = np.where(is_even, (over - 2 * (large - small)) * over, (4 * over - small) * small + over * over)
    step = np.divide(one + two, 2 * root, out=np.zeros_like(root), where=root > 0)
    return np.asarray(root - step)


def angle_of(x: ArrayLike, y: ArrayLike) -> Floats:
    """Angles of ways (x, y) from the first axis towards the second, in [-π, π], as ``np.arctan2(y, x)``."""
    x, y = np.asarray(x, dtype=np.float64), np.asarray(y, dtype=np.float64)
    length, small = hypotenuse(x, y), np.minimum(np.abs(x), np.abs(y))
    angle = inverse_sine(np.divide(small, length, out=np.zeros_like(length), where=length > 0))
    angle = np.where(np.abs(y) > np.abs(x), PI / 2 - angle, angle)
    return np.copysign(np.where(np.signbit(x), PI - angle, angle), y)


def cosine_and_sine(angle: ArrayLike) -> tuple[Floats, Floats]:
    """Give both of angles of at most a few turns, by the power series of what is beside multiples of a quarter."""
    angle = np.asarray(angle, dtype=np.float64)
    quarters = np.rint(angle / (PI / 2))
    rest = (angle - quarters * _QUARTER[0]) - quarters * _QUARTER[1]
    square = rest * rest
    cosine, sine = (_series(square, first) for first in (0, 1))
    sine = rest * sine
    turns = quarters.astype(np.int64) % 4
    is_odd, is_back = turns % 2 == 1, turns >= 2
    across, along = np.where(is_odd, -sine, cosine), np.where(is_odd, cosine, sine)
    return np.where(is_back, -across, across), np.where(is_back, -along, along)


def _series(square: Floats, first: int) -> Floats:
    """Sum of (-1)^k square^k / (2k + first)!; up to an eighth of a turn the terms left out are below 2^-58."""
    total = np.zeros_like(square)
    for k in reversed(range(9)):
        total = total * square + (1 - k % 2 * 2) / factorial(2 * k + first)
    return total


def decimal_logarithm(values: ArrayLike) -> Floats:
    """Logarithms to base 10 of numbers above 0, within 2^-48."""
    fraction, exponent = np.frexp(np.asarray(values, dtype=np.float64))
    # the logarithm of f is twice the inverse hyperbolic tangent of (f - 1) / (f + 1): at most 1/3
    z = (fraction - 1) / (fraction + 1)
    total = np.zeros_like(z)
    for k in reversed(range(17)):
        total = total * (z * z) + 1 / (2 * k + 1)
    return np.asarray(0.30102999566398120 * exponent + 0.43429448190325183 * (2 * z * total))


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
    return (factor * z * total).reshape(shape)


def _coefficients(sign: int) -> list[float]:
    values, product = [], 1.0
    for k in range(_TERMS):
        values.append(product / (2 * k + 1))
        product *= -sign * (2 * k + 1) / (2 * k + 2)
    return values
