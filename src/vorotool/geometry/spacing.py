"""Rectangular pixels: their sides as whole steps of one length, in which squared distances are integers."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np

from vorotool.errors import UsageError
from vorotool.geometry.numbers import real_number, shown_number

if TYPE_CHECKING:
    from vorotool.typing import Spacing

MOST_STEPS = 2**21
"""Steps that a side has at most: those of a seed between pixels are up to 256 times as many."""


@dataclass(frozen=True)
class PixelSides:
    """The sides of a pixel.

    Parameters
    ----------
    x, y : int
        Width and height in steps, without a common divisor.
    step : Fraction
        The length of a step.

    Examples
    --------
    >>> PixelSides(2, 3, Fraction(1, 4)).is_square
    False
    """

    x: int = 1
    y: int = 1
    step: Fraction = Fraction(1)

    @property
    def is_square(self) -> bool:
        """Whether both are equal."""
        return self.x == self.y


SQUARE = PixelSides()
"""Sides of 1."""


def pixel_sides(spacing: Spacing | None) -> PixelSides:
    """Give the sides of a pixel from one number, or from (height, width), as arrays are ordered.

    A float stands for the shortest decimal number that it is written as: 0.1 is a tenth.

    Raises
    ------
    UsageError
        If it is neither, or the sides have no common step that is coarse enough for exact arithmetic.

    Examples
    --------
    >>> pixel_sides((1.5, 0.325))
    PixelSides(x=13, y=60, step=Fraction(1, 40))
    """
    if spacing is None:
        return SQUARE
    is_one = np.ndim(spacing) == 0  # type: ignore[arg-type]
    given: list[Any] = [spacing] if is_one else list(spacing)  # type: ignore[arg-type]
    read = [real_number(each, "spacing") for each in given]
    if len(given) not in (1, 2) or not all(0 < side < float("inf") for side in read):
        raise UsageError(
            f"invalid spacing {shown_number(spacing)}: expected a number above 0, or two of them, (height, width)"
        )
    height, width = (as_decimal(side) for side in (read[0], read[-1]))
    ratio = width / height
    if max(ratio.numerator, ratio.denominator) > MOST_STEPS:
        raise UsageError(
            f"invalid spacing {shown_number(spacing)}: in whole steps of one length a side has more than {MOST_STEPS}; "
            "round the sides to fewer digits, or give them as fractions"
        )
    return PixelSides(ratio.numerator, ratio.denominator, height / ratio.denominator)


def as_decimal(number: float | Fraction) -> Fraction:
    """Give the shortest decimal number that a float is written as, exactly; a fraction as it is.

    Examples
    --------
    >>> as_decimal(0.1)
    Fraction(1, 10)
    """
    return number if isinstance(number, Fraction) else Fraction(repr(float(number)))
