"""Words for what a caller gave instead of what is expected."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from os import PathLike
from typing import Any

from vorotool.errors import InputError

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
    shown = [str(name) for name in names[:MOST_SHOWN]]
    return ", ".join([*shown, *(["…"] if len(names) > MOST_SHOWN else [])])


def items_of(source: Iterator[Any]) -> list[Any]:
    """Take all items of an iterator."""
    try:
        return list(source)
    except (OSError, ValueError) as error:
        raise InputError(f"{described(source)} cannot be read: {error}") from None


def column_names(value: Any) -> list[Any] | None:
    """Give the names of the columns of a data frame; None of what is none."""
    fields = getattr(getattr(value, "dtype", None), "names", None)
    if isinstance(fields, tuple):
        return list(fields)
    if hasattr(value, "dims"):  # of xarray, whose axes may have any name
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
