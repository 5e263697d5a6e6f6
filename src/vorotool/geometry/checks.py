"""Checks of arguments that several layers share: what cannot be used is named, in words."""

from __future__ import annotations

import os
from operator import index
from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

from vorotool.errors import InputError, UsageError

MOST_THREADS = 1024
"""More help nothing."""


def checked_threads(threads: int) -> int:
    """Return a number of threads that the core takes; 0 stands for all.

    Raises
    ------
    UsageError
        If it is no integer, or negative.

    Examples
    --------
    >>> checked_threads(5000)
    1024
    """
    try:
        count = index(threads)
    except TypeError:
        count = -1
    if count < 0:
        raise UsageError(f"threads is {threads!r}: it must be an integer of at least 1, or 0 for all")
    return min(count, MOST_THREADS)


def available_threads() -> int:
    """Processors that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def whole_numbers(values: Any, name: str, dtype: DTypeLike, least: int | None = None) -> NDArray[Any]:
    """Return integers in a type that holds them; nothing is rounded or wrapped.

    Parameters
    ----------
    values : array-like
        Integers, or floating-point numbers that are whole.
    name : str
        What the message calls a value.
    dtype : dtype
        The integer type wanted.
    least : int, optional
        The smallest value allowed; by default that of the type.

    Returns
    -------
    C-contiguous array
        Without a copy where possible.

    Raises
    ------
    InputError
        If a value is no integer, or out of range; it is named with its index from 1.

    Examples
    --------
    >>> whole_numbers([1.0, 3.0], "label", np.uint32)
    array([1, 3], dtype=uint32)
    """
    kind = np.dtype(dtype)
    limits = np.iinfo(kind)
    low = limits.min if least is None else least
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
