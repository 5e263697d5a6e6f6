"""Points as readers find them: in the plane, or with a z where that is asked for."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vorotool.geometry.points.point_set import PointSet


class PointRows(NamedTuple):
    """A list of points.

    Parameters
    ----------
    coordinates : (n, 2) or (n, 3) float64 array
        x, y, and z where it is asked for.
    labels : (n,) int64 array, optional
        The input's own.
    properties : dict
        Further columns.
    placed : dict
        Direction of y and coordinate reference system, as `PointSet` takes them.
    """

    coordinates: NDArray[np.float64]
    labels: NDArray[np.int64] | None
    properties: dict[str, Any]
    placed: dict[str, Any]


def point_set(rows: PointRows) -> PointSet:
    """Give points of the plane.

    Examples
    --------
    >>> len(point_set(PointRows(np.zeros((3, 2)), None, {}, {"y_up": True})))
    3
    """
    return PointSet(rows.coordinates, rows.labels, rows.properties, **rows.placed)
