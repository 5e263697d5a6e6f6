"""Coordinates as text: the shortest that reads back the same."""

from __future__ import annotations


def coordinate_text(value: float) -> str:
    """Return the text of a coordinate.

    Examples
    --------
    >>> coordinate_text(2.0), coordinate_text(0.1)
    ('2', '0.1')
    """
    return repr(value).removesuffix(".0")
