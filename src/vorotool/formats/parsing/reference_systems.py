"""Coordinate reference systems of points and polygons: as the input says, or as it is declared."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError, Kind, Message, UsageError, option
from vorotool.formats.parsing.reader_options import ReadOptions
from vorotool.numeric.crs import TO_CRS, crs_member, crs_name, crs_text, note_degrees, same_crs
from vorotool.types.fields import DOWN, UP, YAxis, with_y_axis
from vorotool.types.points.point_set import PointSet
from vorotool.types.polygons.polygon_set import PolygonSet

_CRS = option("--input-crs", "crs")
_Y_DOWN = option("--y-down", "y_up=False")

Placed = TypeVar("Placed", PointSet, PolygonSet)


def with_crs(value: Placed, name: str, options: ReadOptions) -> Placed:
    """Return the coordinate reference system of an input: its own, else the declared one, else the wanted one."""
    value = declared_in(value, name, options.crs)
    if options.to_crs is not None:
        if value.crs is None:
            raise InputError(
                f"{name} states no coordinate reference system, so {TO_CRS} cannot reproject it: name its system with "
                f"{_CRS}"
            )
        if not same_crs(value.crs, options.to_crs):
            value = replace(value, xy=reprojected(value.xy, name, value.crs, options.to_crs))
        value = replace(value, crs=options.to_crs, y_axis=UP)
    note_degrees(value, name, options.note)
    return value


def with_stated_axis(value: Any, name: str, axis: YAxis) -> Any:
    """Return an input whose y goes the way that the caller states."""
    crs = getattr(getattr(value, "polygons", value), "crs", None)
    if axis == DOWN and crs is not None:
        raise UsageError(f"{name} is in {crs_name(crs)}, where y goes up: leave out {_Y_DOWN}")
    return with_y_axis(value, axis)


def declared_in(value: Placed, name: str, declared: Any) -> Placed:
    """Give an input that names no coordinate reference system the one that is declared, if one is."""
    if declared is None:
        return value
    if value.crs is None:
        return replace(value, crs=declared, y_axis=UP)
    if not same_crs(value.crs, declared):
        raise InputError(
            f"{name} is in {crs_name(value.crs)}, as the file states, not in {crs_name(declared)}: leave out {_CRS}, "
            f"which does not reproject; {TO_CRS} does"
        )
    return value


def note_unnamed(name: str, xy: NDArray[np.float64], note: Callable[[str], None]) -> None:
    """Tell of GeoJSON that names no system and may be longitude and latitude: by its numbers that is not known."""
    if len(xy) and bool((np.abs(xy) <= (180.0, 90.0)).all()) and bool((xy % 1 != 0).any()):
        text = (
            f"{name} states no coordinate reference system and is treated as planar: for longitude and latitude use "
            + option("--input-crs OGC:CRS84", 'crs="OGC:CRS84"')
        )
        note(Message(text, Kind.UNNAMED_CRS, source=name))


def crs_of_numbers(name: str, srids: Sequence[int], line_of: Callable[[int], int]) -> Any:
    """Give the ``crs`` member for the numbers (SRID) of extended well-known text, 0 where a geometry has none."""
    first = next((k for k, srid in enumerate(srids) if srid), None)
    if first is None:
        return None
    other = next((k for k, srid in enumerate(srids) if srid not in (0, srids[first])), None)
    if other is not None:
        raise InputError(
            f"{name}, line {line_of(other)}: the geometry is in EPSG:{srids[other]}, but that of line "
            f"{line_of(first)} in EPSG:{srids[first]}: put them into separate files"
        )
    return crs_member(f"EPSG:{srids[first]}")


def reprojected(xy: NDArray[np.float64], name: str, source: Any, target: Any) -> NDArray[np.float64]:
    """Bring coordinates from one system into another, vertex by vertex: edges stay straight lines between them."""
    from vorotool.convert.extras import needed

    pyproj = needed("pyproj", "gis", "other coordinate reference systems")
    systems = [_known(pyproj, each) for each in (source, target)]
    pyproj.network.set_network_enabled(False)  # grids that are not there are not looked for elsewhere
    made = np.stack(pyproj.Transformer.from_crs(*systems, always_xy=True).transform(*xy.T), axis=1)
    bad = np.flatnonzero(~np.isfinite(made).all(axis=1))
    if bad.size:
        x, y = xy[bad[0]].tolist()
        raise InputError(
            f"{name}: ({x}, {y}) in {crs_name(source)} cannot be expressed in {crs_name(target)} ({bad.size} such "
            "vertices): choose a system for this region"
        )
    return made


def _known(pyproj: Any, crs: Any) -> Any:
    try:
        return pyproj.CRS.from_user_input(crs_text(crs))
    except pyproj.exceptions.CRSError:
        raise UsageError(
            f"the coordinate reference system {crs_name(crs)} is unknown: check authority and code, as in EPSG:3857"
        ) from None
