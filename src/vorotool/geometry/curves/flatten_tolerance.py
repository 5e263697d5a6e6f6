"""How far lines may be from curves where a format has none."""

from __future__ import annotations

import numpy as np

from vorotool.errors import UsageError
from vorotool.geometry.numbers import finite_double, shown_number
from vorotool.geometry.polygons.polygon_set import PolygonSet

FLATTEN = 2.0**-12
"""Of the larger side of the bounds, where nothing else is asked for."""


def default_flatten(polygons: PolygonSet) -> float:
    """1/4096 of the larger side of the bounds of polygons; 1 of nothing.

    Examples
    --------
    >>> default_flatten(PolygonSet([[0, 0], [4096, 0], [0, 3]], [0, 3], [0], [0]))
    1.0
    """
    xy = polygons.xy
    return FLATTEN * (float(np.ptp(xy, axis=0).max()) or 1.0) if len(xy) else 1.0


def checked_flatten(tolerance: float | None, polygons: PolygonSet) -> float:
    """A tolerance, or the default one.

    Raises
    ------
    UsageError
        If it is no finite number, or not positive.
    """
    if tolerance is None:
        return default_flatten(polygons)
    length = finite_double(tolerance, "the tolerance")
    if not length > 0:
        raise UsageError(f"the tolerance is {shown_number(tolerance)}: it must be positive")
    return length
