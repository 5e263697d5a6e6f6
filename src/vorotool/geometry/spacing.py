"""Rectangular pixels and voxels: their sides as whole steps of one length, in which squared distances are integers."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import gcd, isfinite, lcm
from typing import Any

import numpy as np

from vorotool.errors import UsageError
from vorotool.geometry.numbers import real_number, shown_number

MOST_STEPS = 2**21
"""Steps that a side has at most: those of a seed between pixels are a multiple."""

LARGEST_STEP = 10**140
"""A step, or one divided by it: squares of distances are doubles then."""

_ORDER = {2: "(height, width)", 3: "(depth, height, width)"}


@dataclass(frozen=True)
class PixelSides:
    """The sides of a pixel or a voxel.

    Parameters
    ----------
    units : tuple of int
        In steps, without a common divisor: (height, width) or (depth, height, width), as arrays are ordered.
    step : Fraction
        The length of a step.

    Examples
    --------
    >>> PixelSides((3, 2), Fraction(1, 4)).x
    2
    """

    units: tuple[int, ...] = (1, 1)
    step: Fraction = Fraction(1)

    @property
    def x(self) -> int:
        """Width."""
        return self.units[-1]

    @property
    def y(self) -> int:
        """Height."""
        return self.units[-2]

    @property
    def lengths(self) -> tuple[Fraction, ...]:
        """Lengths of the sides, as arrays are ordered."""
        return tuple(units * self.step for units in self.units)

    def text(self) -> str:
        """Words for the lengths, as arrays are ordered.

        Examples
        --------
        >>> PixelSides((3, 2), Fraction(1, 4)).text()
        '(0.75, 0.5)'
        """
        return f"({', '.join(f'{float(side):.10g}' for side in self.lengths)})"


SQUARE = PixelSides()
"""Sides of 1."""


def pixel_sides(spacing: Any, axes: int = 2) -> PixelSides:
    """Give the sides of a pixel from one number for all of them, or from one for each axis, as arrays are ordered.

    A float stands for the shortest decimal number that it is written as: 0.1 is a tenth.

    Raises
    ------
    UsageError
        If it is neither, or the sides have no common step that is coarse enough for exact arithmetic.

    Examples
    --------
    >>> pixel_sides((1.5, 0.325))
    PixelSides(units=(60, 13), step=Fraction(1, 40))
    """
    if spacing is None:
        return PixelSides((1,) * axes)
    is_one = not isinstance(spacing, list | tuple) and np.ndim(spacing) == 0
    given: list[Any] = [spacing] if is_one else list(spacing)
    read = [real_number(each, "spacing") for each in given]
    if len(given) not in (1, axes) or not all(0 < side < float("inf") for side in read):
        raise UsageError(
            f"invalid spacing {shown_number(spacing)}: expected a number above 0, or {axes} of them, {_ORDER[axes]}"
        )
    sides = [as_decimal(side) for side in read] * (axes // len(read))
    whole = lcm(*(side.denominator for side in sides))
    steps = [int(side * whole) for side in sides]
    common = gcd(*steps)
    if max(steps) // common > MOST_STEPS:
        raise UsageError(
            f"invalid spacing {shown_number(spacing)}: in whole steps of one length a side has more than {MOST_STEPS}; "
            "round the sides to fewer digits, or give them as fractions"
        )
    step = Fraction(common, whole)
    if max(step.numerator, step.denominator) > LARGEST_STEP:
        raise UsageError(f"invalid spacing {shown_number(spacing)}: expected sides from 1e-140 to 1e140")
    return PixelSides(tuple(each // common for each in steps), step)


def distance_as_written(distance: Any, sides: PixelSides) -> Any:
    """Give a distance in the unit of a spacing as the decimal number that it is written as, as the spacing is.

    Examples
    --------
    >>> distance_as_written(0.1, pixel_sides(0.5)), distance_as_written(0.1, SQUARE)
    (Fraction(1, 10), 0.1)
    """
    is_one = set(sides.units) == {1} and sides.step == 1
    return as_decimal(distance) if isinstance(distance, float) and isfinite(distance) and not is_one else distance


def as_decimal(number: float | Fraction) -> Fraction:
    """Give the shortest decimal number that a float is written as, exactly; a fraction as it is.

    Examples
    --------
    >>> as_decimal(0.1)
    Fraction(1, 10)
    """
    return number if isinstance(number, Fraction) else Fraction(repr(float(number)))
