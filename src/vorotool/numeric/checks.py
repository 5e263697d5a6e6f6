"""Checks of arguments that several layers share, how values compare, and descriptions of what a caller passed."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import fields, is_dataclass
from itertools import starmap
from operator import index
from os import PathLike
from typing import Any, TypeGuard

import numpy as np
from numpy.typing import DTypeLike, NDArray

from vorotool.errors import InputError, UsageError, element
from vorotool.numeric.arrays import objects
from vorotool.numeric.numbers import plain_text, shown_number

MAX_PIXELS = 2**31
"""Pixels held in memory at most, unless told otherwise (``--max-pixels``)."""

MOST_THREADS = 1024
"""More help nothing."""


def checked_threads(threads: int) -> int:
    """Return a number of threads that the core takes; 0 stands for all."""
    try:
        count = index(threads)
    except TypeError:
        count = -1
    if count < 0:
        raise UsageError(f"threads is {shown_number(threads)}: it must be an integer of at least 1, or 0 for all")
    return min(count, MOST_THREADS)


def checked_flag(value: Any, name: str) -> bool:
    """Return an argument that is true or false; an array, which has no single answer, is neither."""
    try:
        return bool(value)
    except (TypeError, ValueError):
        raise UsageError(f"{name} is {shown_number(value)}: give True or False") from None


def as_array(values: Any, name: str) -> NDArray[Any]:
    """Return an array of what a caller holds."""
    try:
        return np.asarray(values)
    except (TypeError, ValueError):
        raise InputError(f"invalid {name} {shown_number(values)}: expected an array") from None


def available_threads() -> int:
    """Processors that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def is_choice(value: object, choices: Iterable[object]) -> bool:
    """Tell whether an argument is one of a few names or numbers; an array, which has no single answer, is not."""
    return isinstance(value, str | int | float | np.bool_ | np.number | None) and value in tuple(choices)


def whole_numbers(values: Any, name: str, dtype: DTypeLike, least: int | None = None) -> NDArray[Any]:
    """Return integers in a type that holds them; nothing is rounded or wrapped."""
    kind = np.dtype(dtype)
    limits = np.iinfo(kind)
    low = limits.min if least is None else least
    if is_masked_array(values) and np.ma.is_masked(values):
        raise InputError(f"each {name} must be an integer, but some are masked: leave them out")
    try:
        array = np.asarray(values)
    except (TypeError, ValueError):
        array = np.asarray(None)
    if array.dtype == kind and (low == limits.min or array.min(initial=limits.max) >= low):
        return np.ascontiguousarray(array)
    is_object = array.dtype.kind == "O"
    if not (all(type(value) is int for value in array.flat) if is_object else array.dtype.kind in "biuf"):
        raise InputError(f"each {name} must be an integer, but the array has type {array.dtype}")
    bad = (array < low) | (array > limits.max) | (array != array)  # noqa: PLR0124 - NaN is not itself
    if array.dtype.kind == "f":
        bad |= (array != np.floor(array)) | (array >= 2.0 ** (limits.bits - (limits.min < 0)))
    if np.any(bad):
        at = np.argwhere(bad)[0].tolist()
        found = plain_text(array[tuple(at)])
        raise InputError(f"{element(name, *at)} is {found}: it must be an integer from {low} to {limits.max}")
    return np.ascontiguousarray(array, dtype=kind)


def is_masked_array(values: Any) -> TypeGuard[np.ma.MaskedArray[Any, Any]]:
    """Whether values are in a masked array."""
    # another thread may be importing the module: then there are none
    return isinstance(values, getattr(sys.modules.get("numpy.ma"), "MaskedArray", ()))


MOST_SHOWN = 6
"""Columns that a message names."""

LONGEST = 40
"""Characters of a text that a message shows."""


@contextmanager
def naming(name: str) -> Iterator[None]:
    """Put the name of a parameter before what is wrong with its value."""
    try:
        yield
    except InputError as error:
        raise InputError(f"invalid {name}: {error.marked}") from None


def unexpected(value: Any, expected: str) -> InputError:
    """Give the error for a value of another kind."""
    return InputError(f"expected {expected}, but got {described(value)}")


def described(value: Any) -> str:
    """Name the type of a value, and its shape or columns."""
    if value is None:
        return "None"
    if isinstance(value, str | bytes):
        return repr(value if len(value) <= LONGEST else value[:LONGEST])
    kind = type(value).__name__
    article = "an" if kind[0].lower() in "aeiou" else "a"
    if isinstance(value, Mapping):
        return f"{article} {kind} with {listing(list(value))}" if value else f"an empty {kind}"
    names = column_names(value)
    if names is not None:
        return f"{article} {kind} with the columns {listing(names)}" if names else f"{article} {kind} without columns"
    shape, dtype = getattr(value, "shape", None), getattr(value, "dtype", None)
    if isinstance(shape, tuple) and dtype is not None:
        what = "an array" if kind in ("ndarray", "memmap") else f"{article} {kind}"
        return f"{what} of {dtype} and shape {shape}"
    return f"{article} {kind}"


def listing(names: list[Any]) -> str:
    """Name the first few of some names."""
    shown = [plain_text(name) for name in names[:MOST_SHOWN]]
    return ", ".join([*shown, *(["…"] if len(names) > MOST_SHOWN else [])])


def items_of(source: Any) -> Any:
    """Take all items of an iterator, and a buffer as an array; all else stays as it is."""
    if isinstance(source, memoryview):
        return np.asarray(source)
    if not isinstance(source, Iterator):
        return source
    try:
        return list(source)
    except (OSError, ValueError) as error:
        raise InputError(f"{described(source)} cannot be read: {error}") from None


def column_names(value: Any) -> list[Any] | None:
    """Give the names of the columns of a data frame; None of what is none."""
    fields = getattr(getattr(value, "dtype", None), "names", None)
    if isinstance(fields, tuple):
        return list(fields)
    if hasattr(value, "dims") or not hasattr(value, "__len__"):  # of xarray, whose axes may have any name; lazy frames
        return None
    names = getattr(value, "column_names", None)  # pyarrow, whose columns are arrays
    names = getattr(value, "columns", None) if names is None else names
    if not isinstance(names, Iterable) or not hasattr(value, "__getitem__") or isinstance(value, type):
        return None
    return list(names)


def refuse_paths(value: Any, *, texts: bool = False) -> None:
    """Refuse the path of a file, or any text: functions take what was read from it."""
    if isinstance(value, PathLike) or (texts and isinstance(value, str)):
        raise InputError(
            f"expected a value, but got the name of a file; to read a file use vorotool.read({str(value)!r})"
        )


def is_equal(a: Any, b: Any) -> bool:
    """Tell whether two parts of values are equal."""
    if a is b:
        return True
    if isinstance(a, Mapping) and isinstance(b, Mapping):
        return a.keys() == b.keys() and all(is_equal(a[name], b[name]) for name in a)
    if is_dataclass(a) and type(a) is type(b):
        return all(is_equal(getattr(a, each.name), getattr(b, each.name)) for each in fields(a) if each.compare)
    if _is_rows(a) and _is_rows(b):
        return len(a) == len(b) and _equal_rows(a, b)
    return _equal_items(a, b)


def _is_rows(value: Any) -> bool:
    """Whether it is an array, a sequence, or an index of a data frame."""
    if isinstance(value, np.ndarray):
        return value.ndim > 0
    if isinstance(value, str | bytes):
        return False
    return isinstance(value, Sequence) or (hasattr(value, "__array__") and hasattr(value, "__len__"))


def _equal_rows(a: Any, b: Any) -> bool:
    if isinstance(a, np.ndarray) and isinstance(b, np.ndarray) and a.dtype.kind in "biuf" and b.dtype.kind in "biuf":
        return _equal_numbers(a, b)
    return all(starmap(is_equal, zip(_items(a), _items(b), strict=True)))


def _items(rows: Any) -> list[Any]:
    return rows.tolist() if isinstance(rows, np.ndarray) else list(rows)


def _equal_numbers(a: NDArray[Any], b: NDArray[Any]) -> bool:
    if a.shape != b.shape:
        return False
    same = np.equal(np.ma.getdata(a), np.ma.getdata(b))
    if a.dtype.kind == b.dtype.kind == "f":
        same |= np.isnan(np.ma.getdata(a)) & np.isnan(np.ma.getdata(b))
    if is_masked_array(a) or is_masked_array(b):
        first, second = np.ma.getmaskarray(a), np.ma.getmaskarray(b)
        same = (first == second) & (same | first)
    return bool(same.all())


def _equal_items(a: Any, b: Any) -> bool:
    try:
        return bool(a == b) or bool(a != a and b != b)  # noqa: PLR0124 - NaN is not itself
    except Exception:  # of a foreign type: NA of pandas, for one, is neither equal nor different
        return False


def check_index(index: Any, count: int, noun: str) -> None:
    """Refuse an index that has not one entry for each of some objects; None is no index."""
    if index is not None and len(index) != count:
        raise InputError(f"index must hold one entry a {noun}, {count}, but holds {len(index)}")


def index_of_rows(index: Any, rows: NDArray[Any]) -> Any:
    """Give the entries of chosen rows: an index of pandas stays one, with its type and its name."""
    if index is None:
        return None
    rows = np.asarray(rows, dtype=np.intp)
    if rows.size and rows.min() < 0:
        return objects([index[row] if row >= 0 else None for row in rows.tolist()])
    if hasattr(index, "take"):
        return index.take(rows)
    return objects([index[row] for row in rows.tolist()])


def joined_index(first: Any, count: int, second: Any, more: int) -> Any:
    """Give the index of objects that follow others; the entries of those without one are None."""
    if first is None and second is None:
        return None
    if all(hasattr(index, "append") and hasattr(index, "take") for index in (first, second)):  # both of pandas
        return first.append(second)
    return objects([*([None] * count if first is None else first), *([None] * more if second is None else second)])
