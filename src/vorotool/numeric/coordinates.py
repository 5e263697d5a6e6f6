"""Coordinates that users give, made an array of our own: no kernel reads memory that others may change meanwhile."""

from __future__ import annotations

from collections.abc import Iterator
from decimal import Decimal
from fractions import Fraction
from numbers import Real
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError
from vorotool.numeric.checks import is_masked_array
from vorotool.numeric.numbers import nearest_double, shown_number

LARGEST_INTEGER = 2**53
"""Integers up to here are doubles; of those beyond only some are, and points that differ would become one."""


def coordinate_rows(values: Any, noun: str, axes: int = 2) -> NDArray[np.float64]:
    """Copy (n, axes) coordinates; only decimal fractions are rounded."""
    array = number_array(values, noun, axes=axes)
    if array.size == 0:
        array = array.reshape(0, axes)
    if array.ndim != 2 or array.shape[1] != axes:
        raise InputError(_wrong_shape(noun, array.shape, axes))
    row = first_inexact(array)
    if row is not None:
        raise InputError(f"{noun} {row + 1} is ({', '.join(map(shown_number, array[row].tolist()))}): {INEXACT}")
    if array.dtype.kind == "O":  # float() fails for fractions beyond all doubles
        array = np.array([[nearest_double(value) for value in row] for row in array.tolist()]).reshape(-1, axes)
    return np.array(array, dtype=np.float64, order="C")


def _wrong_shape(noun: str, shape: tuple[int, ...], axes: int) -> str:
    said = f"{plural(noun)} must have shape (n, {axes}), but have shape {shape}"
    if noun == "vertex" or len(shape) != 2 or min(shape) <= MOST_AXES:
        return said
    return f"{said}; for an image give vorotool.Raster(array) to tessellate, else vorotool.seeds_from_raster(array)"


MOST_AXES = 4
"""Of points in some space: an array of points has a side that is no longer."""

INEXACT = "a double would round it; subtract an offset from all coordinates, or convert them to float64"
"""Describe a coordinate that `first_inexact` finds."""


def number_array(values: Any, noun: str, expected: str | None = None, axes: int = 2) -> NDArray[Any]:
    """Give values as an array of integers or floating-point numbers, or of objects that are numbers; not a copy."""
    said = expected or f"{plural(noun)} must be an (n, {axes}) array of numbers"
    if is_masked_array(values):
        if np.ma.is_masked(values):
            if values.ndim != 2 or values.shape[1] != axes:
                raise InputError(_wrong_shape(noun, values.shape, axes))
            raise InputError(
                f"{plural(noun)} are masked in part: leave them out, as in points[~points.mask.any(axis=1)]"
            )
        values = values.data
    try:
        array = np.asarray(list(values) if isinstance(values, Iterator) else values)
    except (TypeError, ValueError) as error:
        if isinstance(error, InputError):  # of an iterator of ours
            raise
        raise InputError(said) from None
    if array.dtype.kind == "O" and all(isinstance(value, Real | Decimal | np.number) for value in array.flat):
        return array
    if array.dtype.kind not in "iufb" and array.size:
        raise InputError(said if array.ndim == 0 else f"{said}; these have type {array.dtype}")
    return array


def first_inexact(array: NDArray[Any]) -> int | None:
    """Return the first row with a number that a double may round, None where there is none."""
    if array.dtype.kind == "O":
        far = np.array([[_is_rounded(value) for value in row] for row in array])
    elif array.dtype.kind == "f" and array.dtype.itemsize > np.float64().itemsize:
        with np.errstate(over="ignore"):
            nearest = array.astype(np.float64)
        far = np.isfinite(nearest) & (nearest != array)
    elif array.dtype.kind in "iu" and array.dtype.itemsize == 8 and array.size:
        if int(array.max()) <= LARGEST_INTEGER and int(array.min()) >= -LARGEST_INTEGER:
            return None
        far = (array > LARGEST_INTEGER) | (array < -LARGEST_INTEGER)
    else:
        return None
    return int(far.any(axis=1).argmax()) if far.any() else None


def _is_rounded(value: Any) -> bool:
    """Whether a number that is no decimal fraction has digits that a double lacks; infinity is refused later."""
    if isinstance(value, int | np.integer):
        return abs(int(value)) > LARGEST_INTEGER
    if isinstance(value, float | Decimal) or not np.isfinite(nearest := nearest_double(value)):
        return False
    return Fraction(*value.as_integer_ratio()) != Fraction(nearest)


def plural(noun: str) -> str:
    """Several of what a message speaks of."""
    return "vertices" if noun == "vertex" else f"{noun}s"
