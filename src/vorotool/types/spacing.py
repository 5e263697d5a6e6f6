"""Rectangular pixels and voxels: their sides as whole steps of one length, in which squared distances are integers."""

from __future__ import annotations

from fractions import Fraction
from math import gcd, isfinite, lcm
from typing import Any

import numpy as np

from vorotool.errors import UsageError
from vorotool.numeric.numbers import real_number, shown_number
from vorotool.plain import plain

MOST_STEPS = 2**21
"""Steps that a side has at most: those of a seed between pixels are a multiple."""

LARGEST_STEP = 10**140
"""A step, or one divided by it: squares of distances are doubles then."""

_ORDER = {2: "(height, width)", 3: "(depth, height, width)"}


@plain
class PixelSides:
    """The sides of a pixel or a voxel."""

    # in steps, without a common divisor: (height, width) or (depth, height, width), as arrays are ordered
    units: tuple[int, ...] = (1, 1)
    step: Fraction = Fraction(1)  # the length of a step

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
        """Words for the lengths, as arrays are ordered."""
        return f"({', '.join(f'{float(side):.10g}' for side in self.lengths)})"


SQUARE = PixelSides()
"""Sides of 1."""


def pixel_sides(spacing: Any, axes: int = 2) -> PixelSides:
    """Return the sides of a pixel from one number for all of them, or from one for each axis, as arrays are ordered."""
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
            f"invalid spacing {shown_number(spacing)}: a side is more than {MOST_STEPS} times the largest common step "
            "of the sides; round the sides to fewer digits, or give them as fractions"
        )
    step = Fraction(common, whole)
    if max(step.numerator, step.denominator) > LARGEST_STEP:
        raise UsageError(f"invalid spacing {shown_number(spacing)}: expected sides from 1e-140 to 1e140")
    return PixelSides(tuple(each // common for each in steps), step)


def distance_as_written(distance: Any, sides: PixelSides) -> Any:
    """Return a distance in the unit of a spacing as the decimal number that it is written as, as the spacing is."""
    is_one = set(sides.units) == {1} and sides.step == 1
    return as_decimal(distance) if isinstance(distance, float) and isfinite(distance) and not is_one else distance


def as_decimal(number: float | Fraction) -> Fraction:
    """Return the shortest decimal number that a float is written as, exactly; a fraction as it is."""
    return number if isinstance(number, Fraction) else Fraction(repr(float(number)))
