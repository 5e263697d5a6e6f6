"""The grid of an image whose axes have coordinates, as an array of xarray has them."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.convert.coordinate_names import plain_name
from vorotool.convert.features import crs_of
from vorotool.errors import InputError
from vorotool.numeric.length_units import ratio
from vorotool.types.pixel_grid import ALIKE, PixelGrid, map_grid

COLUMN_AXES = ("x", "lon", "longitude", "easting", "column", "col")
"""Names of axes that run along rows."""


def grid_of(image: Any) -> PixelGrid | None:
    """Give the grid of an image with named axes; None where its axes have no coordinates."""
    rows, columns = image.dims
    if plain_name(str(rows)) in COLUMN_AXES:
        raise InputError(f"its dimensions are {rows}, {columns}: transpose it, so that rows are first")
    if rows not in image.coords or columns not in image.coords:
        return None
    x, dx = _even(image.coords[columns], columns)
    y, dy = _even(image.coords[rows], rows)
    unit, crs = _unit(image, rows, columns), _crs(image)
    if crs is None and dx > 0 and dy > 0 and all(first in (0, step / 2) for first, step in ((x, dx), (y, dy))):
        return PixelGrid(Fraction(dx), Fraction(dy), unit)
    return map_grid((dx, 0.0, x - dx / 2, 0.0, dy, y - dy / 2), unit=unit, crs=crs)


def _even(coordinate: Any, name: Any) -> tuple[float, float]:
    """Give the first coordinate of an axis and the step; a single one has a step of 1."""
    values: NDArray[Any] = np.asarray(coordinate)
    if values.ndim != 1 or values.dtype.kind not in "iuf" or not np.isfinite(values).all():
        raise InputError(f"the coordinates of {name} are not numbers: drop them, as with drop_vars({name!r})")
    places = values.astype(np.float64)
    if len(places) < 2:
        return (float(places[0]) if len(places) else 0.0), 1.0
    step = (places[-1] - places[0]) / (len(places) - 1)
    wanted = places[0] + step * np.arange(len(places))
    rounding = 4 * np.spacing(np.abs(places).max())  # of coordinates far from 0
    if step == 0 or (np.abs(places - wanted) > float(ALIKE) * abs(step) + rounding).any():
        gaps = np.diff(places)
        raise InputError(
            f"the coordinates of {name} are not evenly spaced: their steps are {gaps.min():g} to {gaps.max():g}; "
            f"resample it to an even grid, as with interp, or drop them, as with drop_vars({name!r})"
        )
    return float(places[0]), float(step)


def _unit(image: Any, rows: Any, columns: Any) -> str | None:
    """Give the unit that both axes have, if it is one of length."""
    units = {str(image.coords[axis].attrs.get("units", "")) for axis in (rows, columns)}
    unit = units.pop()
    return unit if not units and ratio(unit, "m") is not None else None


def _crs(image: Any) -> Any:
    """Give the system that the image names, as rioxarray and CF put it into a coordinate without axes."""
    described = image.coords["spatial_ref"].attrs if "spatial_ref" in image.coords else image.attrs
    given = described.get("crs_wkt") or described.get("crs")
    return crs_of(given)
