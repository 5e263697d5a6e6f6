"""Coordinate reference systems of points and polygons: as the input says, or as it is declared."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError, Kind, Message
from vorotool.geometry.crs import crs_member, crs_name, is_geographic, same_crs
from vorotool.geometry.points.point_set import PointSet
from vorotool.geometry.polygons.polygon_set import PolygonSet

Placed = TypeVar("Placed", PointSet, PolygonSet)


def with_crs(value: Placed, name: str, declared: Any, note: Callable[[str], None]) -> Placed:
    """Give an input that names no coordinate reference system the one that is declared; tell where it is of degrees.

    Parameters
    ----------
    value : PointSet or PolygonSet
        As it was read.
    name : str
        The input.
    declared : object
        The ``crs`` member of GeoJSON, or None.
    note : callable
        Told that lengths are in degrees.

    Raises
    ------
    InputError
        If the input names another one.
    """
    if declared is not None:
        if value.crs is None:
            value = replace(value, crs=declared, y_up=True)
        elif not same_crs(value.crs, declared):
            raise InputError(
                f"{name} is in {crs_name(value.crs)}, as it says itself, not in {crs_name(declared)}: leave out "
                "--input-crs, which reprojects nothing"
            )
    if is_geographic(value.crs):
        text = f"{name}: longitude and latitude are treated as planar, lengths are in degrees"
        note(Message(text, Kind.DEGREES, source=name))
    return value


def note_unnamed(name: str, xy: NDArray[np.float64], note: Callable[[str], None]) -> None:
    """Tell of GeoJSON that names no system and may be longitude and latitude: by its numbers that is not known."""
    if len(xy) and bool((np.abs(xy) <= (180.0, 90.0)).all()) and bool((xy % 1 != 0).any()):
        text = (
            f"{name} names no coordinate reference system, and is taken for planar: if it is longitude and latitude, "
            "say so with --input-crs OGC:CRS84"
        )
        note(Message(text, Kind.UNNAMED_CRS, source=name))


def crs_of_numbers(name: str, srids: Sequence[int], lines: Sequence[int]) -> Any:
    """Give the ``crs`` member for the numbers (SRID) of extended well-known text, 0 where a geometry has none.

    Raises
    ------
    InputError
        If there are two.
    """
    first = next((k for k, srid in enumerate(srids) if srid), None)
    if first is None:
        return None
    other = next((k for k, srid in enumerate(srids) if srid not in (0, srids[first])), None)
    if other is not None:
        raise InputError(
            f"{name}, line {lines[other]}: the geometry is in EPSG:{srids[other]}, but that of line {lines[first]} in "
            f"EPSG:{srids[first]}: put them into a file each"
        )
    return crs_member(f"EPSG:{srids[first]}")
