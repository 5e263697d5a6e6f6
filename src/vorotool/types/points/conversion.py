"""Points of shapely geometry."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.ragged import within

POINT, MULTIPOINT, COLLECTION = 0, 4, 7
"""Type numbers of GEOS."""


def single_points(geometry: Any) -> tuple[NDArray[np.object_], NDArray[np.int64]]:
    """Return the points of geometry that are not empty, and the item that each comes from."""
    import shapely

    points, owners = np.array(geometry, dtype=object), np.arange(len(geometry))
    while len(points) and (shapely.get_type_id(points) != POINT).any():
        points, index = shapely.get_parts(points, return_index=True)
        owners = owners[index]
    there = ~shapely.is_empty(points) if len(points) else np.zeros(0, dtype=bool)
    return points[there], owners[there]


def part_numbers(owners: NDArray[Any]) -> NDArray[np.int64]:
    """Count the points of each item from 1."""
    first = np.flatnonzero(np.diff(owners, prepend=-1))
    return within(np.diff(first, append=len(owners))) + 1
