"""Coordinates that users give, made an array of our own: no kernel reads memory that others may change meanwhile."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction
from numbers import Real
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError, UsageError, element, option
from vorotool.frozen import frozen
from vorotool.numeric.arrays import Floats
from vorotool.numeric.checks import is_masked_array
from vorotool.numeric.length_units import ascii_unit
from vorotool.numeric.numbers import nearest_double, shown_number, whole_number

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
        shown = ", ".join(map(shown_number, array[row].tolist()))
        raise InputError(f"{element(noun, row)} is ({shown}): {INEXACT}")
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
        raise InputError(_said(noun, expected, axes)) from None
    if array.dtype.kind == "O" and all(isinstance(value, Real | Decimal | np.number) for value in array.flat):
        return array
    if array.dtype.kind not in "iufb" and array.size:
        said = _said(noun, expected, axes)
        raise InputError(said if array.ndim == 0 else f"{said}; these have type {array.dtype}")
    return array


def _said(noun: str, expected: str | None, axes: int) -> str:
    """Say what coordinates must be."""
    return expected or f"{plural(noun)} must be an (n, {axes}) array of numbers"


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


Integers = NDArray[np.int64]

MOST_DECIMALS = MOST_DIGITS = 17

_EXACT = 2.0**52
"""Numbers of steps below this, and the results of dividing them by a power of ten, are distinct doubles."""


class Writing(NamedTuple):
    """How files are written."""

    decimals: int | None = None  # of coordinates
    is_verified: bool = False  # polygons are checked as they are written
    columns: tuple[str, ...] = ()  # of the input, which rows about parts of features, or about several, have
    unit: str | None = None  # of lengths, in ASCII, which tables name in a last column
    coordinate_unit: str | None = None  # which collections state, where no coordinate reference system does
    is_safe: bool = False  # spreadsheets are kept from taking texts of CSV and TSV for formulas
    precision: int = 0  # significant digits of other numbers; 0: the shortest text that reads back the same
    threads: int = 0  # that text and images are made by; 0: all


@dataclass
class Written:
    """What is known of coordinates once they are written."""

    how: Writing
    deviation: float = 0.0  # the largest distance of lines from the curves that they stand for
    has_y_down: bool = False
    crs: Any = None  # the coordinate reference system of the value
    has_places: bool = False  # of a table: some of its columns are coordinates
    system_unread: Any = None  # the coordinate reference system of a file whose readers assume another one


_WRITTEN: ContextVar[Written] = ContextVar("written", default=Written(Writing()))  # noqa: B039, where nobody asks
current_written = _WRITTEN.get


def record_deviation(distances: Floats) -> None:
    """Record how far lines that are written are from their curves."""
    written = _WRITTEN.get()
    written.deviation = max(written.deviation, float(distances.max(initial=0)))


@contextmanager
def writing(
    decimals: int | None = None,
    *,
    is_verified: bool = False,
    columns: Sequence[str] | None = None,
    precision: int | None = None,
    **how: Any,
) -> Iterator[Written]:
    """Say how files are written within, see `Writing`; what else is said outside stays."""
    name = option("--decimals")
    if decimals is not None and not 0 <= whole_number(decimals, name) <= MOST_DECIMALS:
        raise UsageError(f"{name} is {shown_number(decimals)}: use 0 to {MOST_DECIMALS}, or leave it out")
    name = option("--precision")
    if precision is not None:
        if not 1 <= whole_number(precision, name) <= MOST_DIGITS:
            raise UsageError(
                f"{name} is {shown_number(precision)}: use 1 to {MOST_DIGITS} significant digits, or leave it out"
            )
        how["precision"] = precision
    if columns is not None:
        if not isinstance(columns, list | tuple) or not all(isinstance(each, str) for each in columns):
            raise UsageError(f"invalid with_columns {shown_number(columns)}: expected a list of names")
        how["columns"] = tuple(columns)
    for each in {"unit", "coordinate_unit"} & how.keys():
        how[each] = None if how[each] is None else ascii_unit(how[each])
    written = Written(_WRITTEN.get().how._replace(decimals=decimals, is_verified=is_verified, **how))
    token = _WRITTEN.set(written)
    try:
        yield written
    finally:
        _WRITTEN.reset(token)


def current_decimals() -> int | None:
    """Return the decimals of the coordinates of the file that is being written."""
    return _WRITTEN.get().how.decimals


@frozen
class Grid:
    """Multiples of a step: of 10 to the power -decimals, or of 2 to the power of the exponent."""

    decimals: int | None
    exponent: int = 0

    @classmethod
    def of(cls, points: Floats, decimals: int | None) -> Grid:
        """Make the grid of these coordinates: powers of two where doubles are coarser than the decimals."""
        most = float(np.abs(points).max(initial=0))
        if decimals is not None and most * float(10**decimals) < _EXACT:
            return cls(decimals)
        return cls(None, int(np.frexp(most)[1]) - 53)

    def steps(self, values: Floats) -> Integers:
        """Return the nearest number of steps of each coordinate."""
        if self.decimals is None:
            return np.rint(np.ldexp(values, -self.exponent)).astype(np.int64)
        return np.rint(values * float(10**self.decimals)).astype(np.int64)

    def values(self, steps: Integers) -> Floats:
        """Return coordinates: the doubles nearest to multiples of the step."""
        made = steps.astype(np.float64)
        return np.ldexp(made, self.exponent) if self.decimals is None else made / float(10**self.decimals)


def finest_deviation(places: Floats) -> Floats:
    """(n,) how near to curves lines are at best: a step of the grid, for doubles 16 ulps of the largest coordinate."""
    largest = np.abs(places).max(axis=tuple(range(1, places.ndim)), initial=0)
    steps: Floats = 16 * np.spacing(largest)
    decimals = _WRITTEN.get().how.decimals
    return steps if decimals is None else np.maximum(steps, 1 / float(10**decimals))


def on_grid(points: Floats) -> Floats:
    """Round coordinates to the decimals of the file that is being written, if it has any."""
    decimals = _WRITTEN.get().how.decimals
    return points if decimals is None else rounded(points, decimals)


def rounded(points: Floats, decimals: int) -> Floats:
    """Round coordinates to decimals; those whose doubles are coarser stay, and so does what is no finite number."""
    is_number = np.isfinite(points)
    if not is_number.all():
        made = points.copy()
        made[is_number] = rounded(points[is_number], decimals)
        return made
    grid = Grid.of(points, decimals)
    return points if grid.decimals is None else grid.values(grid.steps(points))
