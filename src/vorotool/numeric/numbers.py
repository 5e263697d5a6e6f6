"""Numbers from users, of any type of Python or in text: taken exactly, or refused."""

from __future__ import annotations

import re
from collections.abc import Callable
from decimal import Decimal
from fractions import Fraction
from math import inf, isfinite, isnan
from numbers import Rational
from operator import index
from typing import Any, Literal, TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import UsageError
from vorotool.numeric.arrays import Floats

LARGEST_EXPONENT = 400
"""Of decimal numbers: an exact power of ten beyond any double's takes time and memory, and means nothing."""

MOST_IN_A_ROW = 4
"""Numbers of a place or a frame, which are shown one by one."""

MOST_SHOWN = 40
"""Characters of what stands in the place of a number."""

Flatten: TypeAlias = float | Literal["auto"] | None
"""How far lines may be from curves; None is "auto", each curve by its size."""


def real_number(value: Any, name: str) -> float | Fraction:
    """Return a number exactly: as a double where that is what it is or where it equals one, else as a fraction."""
    if type(value) is float and not isnan(value):
        return value
    if isinstance(value, np.ndarray) and value.ndim == 0:
        value = value[()]
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, np.floating) and np.isfinite(value):  # a long double, which has no type of Python
        return _simplest(Fraction(*value.as_integer_ratio()))
    if isinstance(value, Fraction):
        return value
    if isinstance(value, Rational):
        return _simplest(Fraction(int(value.numerator), int(value.denominator)))
    if isinstance(value, Decimal) and value.is_finite() and abs(value.adjusted()) <= LARGEST_EXPONENT:
        return Fraction(value)
    if isinstance(value, float | np.floating) or (isinstance(value, Decimal) and value.is_infinite()):
        number = float(value)
        if not isnan(number):
            return number
    raise UsageError(f"{name} is {shown_number(value)}: give a number")


def _simplest(exact: Fraction) -> float | Fraction:
    number = nearest_double(exact)
    return number if number == exact else exact


def nearest_double(value: float | Fraction) -> float:
    """Return the double nearest to a number; infinity for what is beyond all."""
    try:
        return float(value)
    except OverflowError:
        return inf if value > 0 else -inf


def finite_double(value: Any, name: str) -> float:
    """Return a number as a double."""
    number = nearest_double(real_number(value, name))
    if not isfinite(number):
        raise UsageError(f"{name} is {shown_number(value)}: give a finite number")
    return number


def whole_number(value: Any, name: str) -> int:
    """Return an integer of Python or NumPy as one of Python."""
    try:
        return index(value)
    except TypeError:
        raise UsageError(f"{name} is {shown_number(value)}: give an integer") from None


def pair_of_doubles(values: Any, name: str) -> tuple[float, float]:
    """Return two numbers as doubles; infinity for what is beyond all."""
    try:
        x, y = values
    except (TypeError, ValueError):
        raise UsageError(f"{name} is {shown_number(values)}: give (x, y)") from None
    return nearest_double(real_number(x, f"x of {name}")), nearest_double(real_number(y, f"y of {name}"))


def shown_number(value: Any) -> str:
    """Give what was given as a number, or in the place of one, as a message shows it: short, however long it is."""
    if isinstance(value, float):
        return repr(float(value)).removesuffix(".0")
    if isinstance(value, int) and abs(value) < 2**64:
        return repr(value)
    if isinstance(value, int | Fraction):
        number = nearest_double(value)
        if isfinite(number) and (number or not value):
            return repr(number).removesuffix(".0")
        return f"{Decimal(value.numerator) / Decimal(value.denominator):.1e}"
    if isinstance(value, tuple | list) and 0 < len(value) <= MOST_IN_A_ROW:
        shown = ", ".join("…" if isinstance(one, tuple | list) else shown_number(one) for one in value)
        return f"({shown})" if isinstance(value, tuple) else f"[{shown}]"
    text = plain_text(value, repr)
    return text if len(text) <= MOST_SHOWN else f"{text[: MOST_SHOWN - 1]}…"


def plain_text(value: Any, write: Callable[[Any], str] = str) -> str:
    """Write a value as text; Python writes no integers of more than some thousand digits."""
    try:
        return write(value)
    except ValueError:
        return f"of type {type(value).__name__}"


def checked_tolerance(value: Any, *, allows_zero: bool = False) -> float:
    """Give a tolerance, such as how far lines may be from curves."""
    length = finite_double(value, "the tolerance")
    if not (length > 0 or (allows_zero and length == 0)):
        least = "0 or more" if allows_zero else "positive"
        raise UsageError(f"the tolerance is {shown_number(value)}: it must be {least}")
    return length


def checked_flatten(tolerance: Flatten) -> float | None:
    """Return a tolerance, None if each curve has its own."""
    is_own = tolerance is None or (isinstance(tolerance, str) and tolerance == "auto")
    return None if is_own else checked_tolerance(tolerance)


_COLUMN = r"(?a)(?:(?:-?(?:0|[1-9]\d*)(?:\.\d+)?(?:[eE][+-]?\d+)?)?\n)*"


class NumberText(str):
    """A number as it is written, which is a number in JSON, too: no digit of it changes on its way."""

    __slots__ = ()

    @property
    def number(self) -> int | float:
        """Its value: an integer where it is written as one, of no more digits than are usual."""
        return int(self) if len(self) < 64 and not any(mark in self for mark in ".eE") else float(self)


def typed_texts(values: list[str]) -> list[Any]:
    """Give the texts of a column as numbers if all are, but for empty ones, which are None then."""
    text = "\n".join(values)
    if text.count("\n") + 1 != len(values) or not any(values) or not re.fullmatch(_COLUMN, text + "\n"):
        return values
    return [NumberText(value) if value else None for value in values]


Integer = TypeVar("Integer", bound=np.integer[Any])


def distinct(values: NDArray[Integer]) -> NDArray[Integer]:
    """Each value once, increasing."""
    found = np.sort(values, axis=None)
    is_new = np.ones(len(found), dtype=bool)
    np.not_equal(found[1:], found[:-1], out=is_new[1:])
    return found[is_new]


def rows_of(keys: NDArray[np.int64], wanted: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the first row in which a column of keys has each number; -1 where it has not."""
    if not len(keys):
        return np.full(len(wanted), -1)
    order = np.argsort(keys, kind="stable")
    row = order[np.searchsorted(keys, wanted, sorter=order).clip(max=len(keys) - 1)]
    return np.where(keys[row] == wanted, row, -1)


def is_among(values: NDArray[Integer], chosen: NDArray[Integer]) -> NDArray[np.bool_]:
    """Whether each value is one of those that are chosen."""
    found = distinct(chosen)
    if not len(found):
        return np.zeros(np.shape(values), dtype=bool)
    place = np.searchsorted(found, values)
    return np.asarray(found[np.minimum(place, len(found) - 1)] == values)


_SPLIT = 2.0**27 + 1
"""Parts a double into two halves of 26 bits, whose products are exact (Dekker 1971)."""


def difference(p: Floats, q: Floats) -> tuple[Floats, Floats]:
    """Subtract q from p: the rounded difference, and what is missing (Knuth's two-sum)."""
    rounded = p - q
    taken = p - rounded
    return rounded, (p - (rounded + taken)) + (taken - q)


def product(x: Floats, y: Floats) -> tuple[Floats, Floats]:
    """Multiply: the rounded product, and what is missing, unless it is below the smallest number."""
    rounded = x * y
    (x1, x2), (y1, y2) = _halves(x), _halves(y)
    return rounded, x2 * y2 - (((rounded - x1 * y1) - x2 * y1) - x1 * y2)


def _halves(x: Floats) -> tuple[Floats, Floats]:
    scaled = _SPLIT * x
    high = scaled - (scaled - x)
    return high, x - high
