"""Rectangles from whatever a caller holds."""

from __future__ import annotations

from typing import Any

from vorotool.errors import InputError, UsageError
from vorotool.numeric.numbers import finite_double, shown_number
from vorotool.types.box import Box, Extent

EXPECTED = "expected a Box or four finite numbers x, y, width, height with width and height above 0"


def as_box(source: Any, name: str) -> Box:
    """Give a box from one, or from four numbers: its smallest corner, its width and its height."""
    if isinstance(source, Box):
        return source
    try:
        return Box.of_size(*as_extent(source, name))
    except UsageError as error:
        raise InputError(error.marked) from None


def as_extent(source: Any, name: str) -> Extent:
    """Give the smallest corner of a rectangle, its width and its height, digit by digit as they were given."""
    if isinstance(source, Box):
        return source.extent
    try:
        x, y, width, height = (finite_double(side, name) for side in source)
    except (TypeError, ValueError):  # a UsageError is one of the latter
        raise UsageError(f"invalid {name} {shown_number(source)}: {EXPECTED}") from None
    return x, y, width, height
