"""Equality of values that hold arrays (NaN equals NaN), and the row index of data frames."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import fields, is_dataclass
from itertools import starmap
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError
from vorotool.numeric.checks import is_masked_array


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
        return _objects([index[row] if row >= 0 else None for row in rows.tolist()])
    if hasattr(index, "take"):
        return index.take(rows)
    return _objects([index[row] for row in rows.tolist()])


def joined_index(first: Any, count: int, second: Any, more: int) -> Any:
    """Give the index of objects that follow others; the entries of those without one are None."""
    if first is None and second is None:
        return None
    if all(hasattr(index, "append") and hasattr(index, "take") for index in (first, second)):  # both of pandas
        return first.append(second)
    return _objects([*([None] * count if first is None else first), *([None] * more if second is None else second)])


def _objects(values: list[Any]) -> NDArray[np.object_]:
    made = np.empty(len(values), dtype=object)
    for place, value in enumerate(values):  # a slice would take tuples apart
        made[place] = value
    return made
