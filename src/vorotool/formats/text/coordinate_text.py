"""Coordinates as text: the shortest that reads back the same."""

from __future__ import annotations


def coordinate_text(value: float) -> str:
    """Return the text of a coordinate."""
    return repr(value).removesuffix(".0")
