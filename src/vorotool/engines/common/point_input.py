"""Points from all that engines accept: one conversion for all of them."""

from __future__ import annotations

from typing import Any

import numpy as np

from vorotool.errors import InputError
from vorotool.geometry.coordinates import number_array
from vorotool.geometry.points.point_set import PointSet
from vorotool.geometry.polygons.polygon_set import PolygonSet


def as_points(
    source: Any,
    *,
    expected: str = "points must be an (n, 2) array of numbers or shapely points",
    noun: str = "point",
) -> PointSet:
    """Points from a `PointSet`, an array, a list of pairs or of shapely points, or a shapely (Multi)Point.

    Parameters
    ----------
    source : object
        What the user gave; the order is kept.
    expected : str
        What to say when it cannot be used.
    noun : str
        What a message calls one of them.

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
    if isinstance(source, PolygonSet):
        raise InputError("these are polygons or lines: give points, for example their centroids or vertices")
    if getattr(source, "geom_type", "") == "MultiPoint":
        source = source.geoms
    elif hasattr(source, "geom_type"):
        source = [] if source.is_empty and source.geom_type == "Point" else [source]
    if not isinstance(source, np.ndarray) or source.dtype.kind == "O":
        try:
            source = [_position(p, f"{noun} {i}") for i, p in enumerate(source, 1)]
        except TypeError:
            raise InputError(expected) from None
    return PointSet(number_array(source, noun, expected))


def _position(point: Any, name: str) -> Any:
    """Coordinates of a point; of geometry only single points have them."""
    if not hasattr(point, "geom_type"):
        return point
    if point.geom_type != "Point" or point.is_empty:
        raise InputError(
            f"{name} is {'an empty' if point.is_empty else 'a'} {point.geom_type}: give points; of a polygon "
            "or line its centroid or its vertices"
        )
    return point.x, point.y
