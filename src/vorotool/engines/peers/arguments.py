"""Arguments that these functions have in common with those that they are named after."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError, UsageError
from vorotool.geometry.arguments.images import as_raster
from vorotool.geometry.numbers import real_number, shown_number

if TYPE_CHECKING:
    from vorotool.typing import ImageLike, Spacing


def pixel_side(spacing: Spacing | None) -> Fraction:
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


def plane(values: ImageLike, name: str) -> NDArray[Any]:
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
    shape = getattr(values, "shape", None)
    if isinstance(shape, tuple) and len(shape) == 2 and 0 in shape:
        return np.asarray(values)
    image = as_raster(values, name, is_grey=True)
    if image.is_colour:
        raise InputError(f"invalid {name}: expected one value in each pixel, but it is a colour image")
    if image.mask is not None and image.mask.any():
        raise InputError(f"invalid {name}: expected a value in each pixel, but some are masked; fill them first")
    return image.values
