"""Geometry of rows as that of shapely."""

from __future__ import annotations

from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from vorotool.numeric.numbers import Flatten
from vorotool.numeric.ragged import with_length
from vorotool.products.formats import resolved
from vorotool.types.features import Areas, Corners, Geometry, Lines, Mixture, Rows, features_of, parts_of
from vorotool.types.polygons.conversion import to_shapely


def geometry_of(value: Any, what: str | None = None, *, flatten: Flatten = None) -> NDArray[Any]:
    """(n,) geometry of each row of a value; None where there is none."""
    return geometry_of_rows(features_of(value, what, flatten=flatten))


def geometry_of_rows(features: Rows | Mixture) -> NDArray[Any]:
    """(n,) geometry of rows, one kind after the other."""
    made: NDArray[Any] = np.concatenate([shapely_of(rows.geometry) for rows in parts_of(features)])
    return made


def shapely_of(geometry: Geometry | NDArray[Any] | None) -> NDArray[Any]:
    """(n,) the same as shapely has it."""
    made: NDArray[Any]
    if isinstance(geometry, Corners):
        made = _of_corners(geometry)
    elif isinstance(geometry, Lines):
        made = lines(geometry)
    elif isinstance(geometry, Areas):
        valid = resolved("formats.text.rings:valid_coverage")  # as it would be written without decimals
        made = valid(geometry.xy, geometry.nesting, in_box=geometry.in_box)
    elif isinstance(geometry, np.ndarray):
        made = geometry
    else:
        assert geometry is not None
        made = to_shapely(geometry)
    return made


def lines(geometry: Lines) -> NDArray[Any]:
    """(n,) lines through places that follow one another; empty where these all are one place."""
    points, start, has_length = with_length(geometry.xy, geometry.starts)
    made: NDArray[Any] = np.full(len(has_length), shapely.LineString(), dtype=object)
    kind = shapely.GeometryType.LINESTRING
    made[has_length] = shapely.from_ragged_array(kind, np.ascontiguousarray(points), (start,))
    return made


def _of_corners(geometry: Corners) -> NDArray[Any]:
    places, count = geometry.xy[geometry.corners], len(geometry.corners)
    made: NDArray[Any]
    if geometry.corners.shape[1] == 1:
        made = shapely.points(np.ascontiguousarray(places[:, 0]))
    elif geometry.corners.shape[1] == 2:
        made = shapely.linestrings(np.ascontiguousarray(places))
    else:
        rings = np.ascontiguousarray(places[:, [0, 1, 2, 0]].reshape(-1, 2))
        starts = np.arange(0, 4 * count + 1, 4), np.arange(count + 1)
        made = shapely.from_ragged_array(shapely.GeometryType.POLYGON, rings, starts)
    return made
