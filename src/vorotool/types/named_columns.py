"""Columns of the input that options name: by their names, or by paths with dots into objects."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from vorotool.errors import InputError, UsageError


def column_of(columns: Mapping[str, Any], name: str) -> Any:
    """Return a column by its name, or what a path with dots leads to in the objects of one; None if there is none."""
    if name in columns:
        return columns[name]
    parts = name.split(".")
    for used in range(len(parts) - 1, 0, -1):
        column = columns.get(".".join(parts[:used]))
        inner = None if column is None else [_within(value, parts[used:]) for value in column]
        if inner is not None and any(value is not None for value in inner):
            return inner
    return None


def _within(value: Any, path: Sequence[str]) -> Any:
    """Follow a path of names into an object; None where it does not lead anywhere."""
    for name in path:
        value = value.get(name) if isinstance(value, Mapping) else None
    return value


def chosen_column(columns: Mapping[str, Any], name: str, option: str) -> Any:
    """Return a column that an option names; see `column_of`."""
    found = column_of(columns, name)
    if found is not None:
        return found
    if not columns:
        raise UsageError(f"invalid {option} {name!r}: the input has no columns; leave it out")
    raise UsageError(f"invalid {option} {name!r}: expected a column of the input, {', '.join(columns)}")


def check_plain(values: Iterable[Any], option: str) -> None:
    """Refuse a column that holds objects or lists where texts or numbers are expected."""
    from vorotool.numeric.checks import described
    from vorotool.numeric.numbers import shown_number

    for value in values:
        if isinstance(value, Mapping | list | tuple | set):
            raise InputError(
                f"invalid {option}: {shown_number(value)} is {described(value)}, not text or a number; name a member "
                "of an object with a dot, such as column.name"
            )
