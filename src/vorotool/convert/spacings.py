"""Spacing and pixel grids from numbers, images and stores of the caller."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from vorotool.convert.features import crs_of
from vorotool.convert.tables import plain_name
from vorotool.errors import InputError, UsageError, warn
from vorotool.numeric.crs import is_geographic
from vorotool.numeric.length_units import ratio
from vorotool.numeric.numbers import shown_number
from vorotool.products.registry import is_of
from vorotool.types.pixels import ALIKE, PixelGrid, PixelSides, map_grid, pixel_sides, rounded_side, sides_of_grid

if TYPE_CHECKING:
    from vorotool.types.volumes.volume import VoxelGrid

AUTO = "auto"


def asked_sides(source: Any, spacing: Any, axes: int = 2) -> PixelSides:
    """Give the sides that are asked for, of pixels of 1 without; ``"auto"`` is what the value carries.

    A value that carries a size which nobody asks for is warned of.
    """
    if spacing is not None and not isinstance(spacing, str):
        return pixel_sides(spacing, axes)
    if spacing not in (None, AUTO):
        raise UsageError(
            f"invalid spacing {shown_number(spacing)}: expected numbers, or 'auto' for the size that the image states"
        )
    try:
        grid = carried_grid(source, axes)
    except InputError:
        if spacing == AUTO:
            raise
        grid = None  # who reads the value says what is wrong with its axes
    what = "pixels" if axes == 2 else "voxels"
    if spacing is None:
        if (
            grid is not None and not _is_sheared(grid) and not isinstance(getattr(source, "sides", None), PixelSides)
        ):  # labels have theirs
            warn(
                f"the input has {what} of {grid.size_text()}, but distances are measured in {what}: spacing='auto' "
                f"uses this size, spacing=1 confirms {what}"
            )
        return pixel_sides(None, axes)
    if grid is None or _is_sheared(grid):
        needed = f"states the size of its {what}" if grid is None else "is not sheared on the map"
        raise UsageError(f"spacing='auto' needs an image that {needed}: give numbers instead")
    sides = sides_of_grid(*((grid.height, grid.width) if isinstance(grid, PixelGrid) else grid.sides))
    if sides is None:
        raise UsageError(
            f"spacing='auto': the input has {what} of {grid.size_text()}, whose sides have no common step that is "
            "coarse enough for exact distances: give rounded numbers"
        )
    return sides


def _is_sheared(grid: PixelGrid | VoxelGrid) -> bool:
    return isinstance(grid, PixelGrid) and not grid.is_rectangular


def carried_grid(source: Any, axes: int) -> PixelGrid | VoxelGrid | None:
    """Give the size that a value carries: an image or a volume that was read, or an array whose axes have steps."""
    grid = getattr(source, "grid", None)
    if axes == 2 and not isinstance(grid, PixelGrid) and _has_axes(source, 2):
        grid = grid_of(source)
    if axes == 3 and not is_of(grid, "VoxelGrid") and _has_axes(source, 3):
        grid = _voxels(source)
    if isinstance(grid, PixelGrid) and axes == 2:
        is_plain = grid.unit is None and grid.width == grid.height == 1
        is_angular = grid.unit == "deg" or is_geographic(grid.crs)
        return None if (not grid.is_size and grid.unit is not None) or is_plain or is_angular else grid
    if axes == 3 and grid is not None and is_of(grid, "VoxelGrid"):
        return None if grid.unit is None and set(grid.sides) == {1} else grid
    return None


def _has_axes(source: Any, axes: int) -> bool:
    return hasattr(source, "dims") and hasattr(source, "coords") and len(source.dims) == axes


def _voxels(source: Any) -> VoxelGrid | None:
    """Give the steps of the coordinates of three axes, in the unit of the last one."""
    from vorotool.types.volumes.volume import VoxelGrid

    if any(axis not in source.coords for axis in source.dims):
        return None
    steps, units = [], []
    for axis in source.dims:
        places = np.asarray(source.coords[axis], dtype=np.float64)
        if len(places) < 2:
            return None
        step = (places[-1] - places[0]) / (len(places) - 1)
        if not step > 0 or (np.abs(np.diff(places) - step) > float(ALIKE) * step).any():
            return None
        steps.append(rounded_side(Fraction(float(step))))
        units.append(str(source.coords[axis].attrs.get("units", "")) or None)
    factors = [Fraction(1) if unit == units[-1] else ratio(unit or "", units[-1] or "") for unit in units]
    if None in factors:
        return None
    depth, height, width = (step * (factor or 1) for step, factor in zip(steps, factors, strict=True))
    return VoxelGrid(width, height, depth, units[-1])


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
