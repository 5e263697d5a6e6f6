"""What engines accept as points: one conversion for all of them."""

from __future__ import annotations

from typing import Any

import numpy as np

from vorotool.errors import InputError
from vorotool.geometry.points import PointSet


def as_points(
    source: Any, *, expected: str = "points must be an (n, 2) array of numbers or shapely points"
) -> PointSet:
    """Points from a `PointSet`, an array, a list of pairs or of shapely points, or a shapely geometry.

    Parameters
    ----------
    source : object
        What the user gave; the order is kept.
    expected : str
        What to say when it cannot be used.

    Raises
    ------
    InputError
        If it is none of these, or a coordinate is not finite.

    Examples
    --------
    >>> as_points([[2, 1], [7, 5]]).xy.tolist()
    [[2.0, 1.0], [7.0, 5.0]]
    """
    if isinstance(source, PointSet):
        return source
    if hasattr(source, "geom_type"):
        from shapely import get_coordinates

        return PointSet(get_coordinates(source))
    try:
        if not (isinstance(source, np.ndarray) and source.dtype.kind in "fiub"):
            source = [(p.x, p.y) if hasattr(p, "geom_type") else p for p in source]
        xy = np.asarray(source, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError(expected) from None
    return PointSet(xy)
