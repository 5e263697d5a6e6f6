"""The y axis: which way y goes where coordinates come from."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal

from vorotool.errors import InputError

YAxis = Literal["up", "down", "none"]
UP: YAxis = "up"
"""Maps, drawings of CAD, well-known text: whatever has a coordinate reference system, and what is written as such."""
DOWN: YAxis = "down"
"""Images and SVG, and what is made of them."""
UNSTATED: YAxis = "none"
"""Bare numbers, which are drawn downwards, as in the paper."""

AXES = (UP, DOWN, UNSTATED)
MEMBER = "y_axis"
"""The member of our JSON, GeoJSON and NPZ that says it."""


def y_axis_of(y_up: bool | None, usual: YAxis = UNSTATED) -> YAxis:
    """Return the axis that a caller states by a flag, or the usual one."""
    return usual if y_up is None else UP if y_up else DOWN


def checked_y_axis(given: Any, name: str = MEMBER) -> YAxis:
    """Return what a file or a caller says of the axis."""
    if not isinstance(given, str) or given not in AXES:
        raise InputError(f"{name} is {given!r}: write {', '.join(map(repr, AXES[:2]))} or {AXES[2]!r}")
    return given


def y_axis_member(document: Mapping[str, Any], usual: YAxis) -> YAxis:
    """Return what a document says of the axis, else the usual one of its form."""
    return checked_y_axis(document[MEMBER]) if MEMBER in document else usual


def is_up(value: Any) -> bool:
    """Return whether y of a value goes upwards."""
    return bool(getattr(value, "y_axis", UNSTATED) == UP)
