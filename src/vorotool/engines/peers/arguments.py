"""Arguments that these functions have in common with those that they are named after."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError, UsageError
from vorotool.geometry.numbers import real_number, shown_number

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


def pixel_side(spacing: float | Fraction | Sequence[float | Fraction] | None) -> Fraction:
    """Give the side of a square pixel: a number, or two equal ones.

    Raises
    ------
    UsageError
        If it is neither.

    Examples
    --------
    >>> pixel_side(None), pixel_side(0.5), pixel_side((2, 2))
    (Fraction(1, 1), Fraction(1, 2), Fraction(2, 1))
    """
    if spacing is None:
        return Fraction(1)
    is_one = np.ndim(spacing) == 0  # type: ignore[arg-type]
    given: list[Any] = [spacing] if is_one else list(spacing)  # type: ignore[arg-type]
    sides = {real_number(each, "spacing") for each in given}
    if len(given) not in (1, 2) or not all(0 < side < float("inf") for side in sides):
        raise UsageError(f"invalid spacing {shown_number(spacing)}: expected a number above 0, or two equal ones")
    if len(sides) > 1:
        raise UsageError(
            f"invalid spacing {shown_number(spacing)}: expected two equal numbers, since rectangular pixels are not "
            "taken yet; resample the image to square pixels"
        )
    return Fraction(sides.pop())


def plane(values: ArrayLike, name: str) -> NDArray[Any]:
    """Give an image as a 2-D array of booleans or numbers.

    Raises
    ------
    InputError
        If it is none, or some pixels are masked.

    Examples
    --------
    >>> plane([[0, 1]], "mask").shape
    (1, 2)
    """
    if isinstance(values, np.ma.MaskedArray) and np.ma.getmaskarray(values).any():
        raise InputError(f"invalid {name}: expected a value in each pixel, but some are masked; fill them first")
    array: NDArray[Any] = np.asarray(values)
    if array.ndim != 2 or array.dtype.kind not in "biuf":
        raise InputError(
            f"invalid {name}: expected a 2-D array of booleans or numbers, but got {array.dtype} of shape {array.shape}"
        )
    return array
