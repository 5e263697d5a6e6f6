"""Radii at which shapes change, in their exact order."""

from __future__ import annotations

from fractions import Fraction
from math import floor, inf, isqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import UsageError
from vorotool.numeric.numbers import nearest_double, real_number, shown_number

Radius = float | Fraction
"""A radius: a double, or an exact fraction such as a decimal number."""


class RankedRadii:
    """What has a spectrum of radii, each known exactly by its square."""

    spectrum: NDArray[np.float64]

    doubt = 0.0
    """Largest relative error of doubles of the spectrum; none if they are correctly rounded."""

    def squared_radius(self, rank: int) -> Fraction:
        """Return the exact square of a radius of the spectrum."""
        raise NotImplementedError

    def reached(self, r: Radius) -> int:
        """Return the exact number of critical radii that are at most r: lower ranks are reached."""
        return self._count(r, or_equal=True)

    def _count(self, r: Radius, *, or_equal: bool) -> int:
        """Doubles that differ by more than the doubt compare as the exact values do; of others these are compared."""
        rounded = nearest_double(r)
        low, high = rounded * (1 - self.doubt), rounded * (1 + self.doubt)
        if self.doubt:  # the smallest doubles are rounded by more
            low, high = np.nextafter(low, 0), np.nextafter(high, inf)
        begin = int(np.searchsorted(self.spectrum, low, side="left"))
        end = int(np.searchsorted(self.spectrum, high, side="right"))
        square = None if r == inf else Fraction(r) ** 2
        while begin < end:
            middle = (begin + end) // 2
            exact = self.squared_radius(middle)
            if square is None or exact < square or (or_equal and exact == square):
                begin = middle + 1
            else:
                end = middle
        return begin

    def radius_from(self, rank: int) -> Radius:
        """Return a radius for the shape of a rank: at least the critical radius, less than the next.

        The radius is the least such double, or a decimal fraction if there is none.
        """
        square = self.squared_radius(rank)
        rounded = float(self.spectrum[rank])
        while rounded < inf and Fraction(rounded) ** 2 < square:
            rounded = float(np.nextafter(rounded, inf))
        while self.doubt and Fraction(below := float(np.nextafter(rounded, 0))) ** 2 >= square:
            rounded = below
        if rounded < inf and self.reached(rounded) == rank + 1:
            return rounded
        return self._fraction_from(rank, square)

    def _fraction_from(self, rank: int, square: Fraction) -> Fraction:
        """Return a decimal at least as large as a radius that another one follows within the spacing of doubles."""
        bits = square.numerator.bit_length() - square.denominator.bit_length()
        digits = 17 - floor(bits / 2 * 0.30103)  # behind the point: at least 16 significant ones
        while True:
            step = Fraction(10) ** -digits
            root = _ceiling_root(square / step**2) * step
            if self.reached(root) == rank + 1:
                return root
            digits += 5


class OfFamily:
    """One shape of a family, that of a radius."""

    family: Any
    r: Radius
    region: NDArray[np.int32]

    @property
    def alpha(self) -> float:
        """The paper's parameter, -1/r."""
        return -nearest_double(1 / self.r)

    @property
    def points(self) -> NDArray[np.float64]:
        """Coordinates, in the order of the input."""
        return self.family.points

    @property
    def inside(self) -> NDArray[np.bool_]:
        """Whether each triangle, or tetrahedron, is in the shape."""
        return self.region >= 0


def checked_radius(r: Any) -> Radius:
    """Return a radius that is positive; infinity is one."""
    value = real_number(r, "r")
    if not value > 0:
        raise UsageError(
            f"r is {shown_number(value)}: a radius must be positive; "
            "leave it out for the smallest that joins all points"
        )
    return value


def _ceiling_root(value: Fraction) -> int:
    """Return the least integer whose square is at least this positive number."""
    return isqrt(-(-value.numerator // value.denominator) - 1) + 1


def squared_radius_of(corners: list[list[float]]) -> Fraction:
    """Return the exact square of the radius of the smallest circle or sphere through two, three or four points."""
    a, *others = ([Fraction(x) for x in corner] for corner in corners)
    b, *rest = ([x - y for x, y in zip(other, a, strict=True)] for other in others)
    if not rest:
        return _dot(b, b) / 4
    if len(rest) == 1:
        c = rest[0]
        third = [x - y for x, y in zip(b, c, strict=True)]
        product = _dot(b, b) * _dot(c, c)
        return product * _dot(third, third) / (4 * (product - _dot(b, c) ** 2))
    c, d = rest
    normals = _cross(c, d), _cross(d, b), _cross(b, c)
    squares = _dot(b, b), _dot(c, c), _dot(d, d)
    center = [sum(square * normal[i] for square, normal in zip(squares, normals, strict=True)) for i in range(3)]
    return _dot(center, center) / (4 * _dot(b, normals[0]) ** 2)


def _dot(p: Any, q: Any) -> Fraction:
    return sum((x * y for x, y in zip(p, q, strict=True)), Fraction(0))


def _cross(p: list[Fraction], q: list[Fraction]) -> list[Fraction]:
    return [p[i - 2] * q[i - 1] - p[i - 1] * q[i - 2] for i in range(3)]
