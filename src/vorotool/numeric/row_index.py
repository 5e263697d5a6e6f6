"""The index of the input: what a data frame calls its rows, kept for each point or polygon that is made of one."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError


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
