"""Checks of arguments that several layers share."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable
from operator import index
from typing import TYPE_CHECKING, Any, TypeGuard

import numpy as np
from numpy.typing import DTypeLike, NDArray

from vorotool.errors import InputError, UsageError
from vorotool.numeric.numbers import shown_number

if TYPE_CHECKING:
    import numpy as np

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


def set_rows(value: object, name: str, dtype: DTypeLike, width: int = 0) -> None:
    """Give an array of a frozen value its type, and rows of a width: (n, width), or (n,) for 0."""
    array = np.ascontiguousarray(getattr(value, name), dtype=dtype)
    if array.size == 0:
        array = array.reshape((0, width) if width else (0,))
    if array.ndim != (2 if width else 1) or (width and array.shape[1] != width):
        raise InputError(f"{name} must have shape (…, {width or ''}), but has shape {array.shape}")
    object.__setattr__(value, name, array)


def whole_numbers(values: Any, name: str, dtype: DTypeLike, least: int | None = None) -> NDArray[Any]:
    """Return integers in a type that holds them; nothing is rounded or wrapped."""
    kind = np.dtype(dtype)
    limits = np.iinfo(kind)
    low = limits.min if least is None else least
    if is_masked_array(values) and np.ma.is_masked(values):
        raise InputError(f"each {name} must be an integer, but some are masked: leave them out")
    try:
        array = np.asarray(values)
    except ValueError:
        array = np.asarray(None)
    if array.dtype == kind and (low == limits.min or array.min(initial=limits.max) >= low):
        return np.ascontiguousarray(array)
    if array.dtype.kind not in "biuf" and not all(type(value) is int for value in array.flat):
        raise InputError(f"each {name} must be an integer, but the array has type {array.dtype}")
    bad = (array < low) | (array > limits.max) | (array != array)  # noqa: PLR0124 - NaN is not itself
    if array.dtype.kind == "f":
        bad |= (array != np.floor(array)) | (array >= 2.0 ** (limits.bits - (limits.min < 0)))
    if np.any(bad):
        at = int(np.argmax(bad))
        raise InputError(f"{name} {at + 1} is {array.flat[at]}: it must be an integer from {low} to {limits.max}")
    return np.ascontiguousarray(array, dtype=kind)


def is_masked_array(values: Any) -> TypeGuard[np.ma.MaskedArray[Any, Any]]:
    """Whether values are in a masked array."""
    module = sys.modules.get("numpy.ma")
    return module is not None and isinstance(values, module.MaskedArray)
