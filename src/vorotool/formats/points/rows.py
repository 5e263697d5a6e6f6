"""Points as readers find them: in the plane, or with a z where that is asked for."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vorotool.types.points.point_set import PointSet


class PointRows(NamedTuple):
    """A list of points."""

    coordinates: NDArray[np.float64]  # (n, 2) or (n, 3) float64 array: x, y, and z where it is asked for
    labels: NDArray[np.int64] | None  # (n,) int64 array: the input's own
    properties: dict[str, Any]  # further columns
    placed: dict[str, Any]  # direction of y and coordinate reference system, as `PointSet` takes them


def point_set(rows: PointRows) -> PointSet:
    """Give points of the plane."""
    return PointSet(rows.coordinates, rows.labels, rows.properties, **rows.placed)
