"""The sides of pixels and voxels that a caller asks for, or that a value carries."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np

from vorotool.convert.grids import grid_of
from vorotool.errors import InputError, UsageError, warn
from vorotool.numeric.crs import is_geographic
from vorotool.numeric.length_units import ratio
from vorotool.types.pixel_grid import ALIKE, PixelGrid, rounded_side, sides_of_grid
from vorotool.types.spacing import PixelSides, pixel_sides
from vorotool.types.volumes.voxel_frame import VoxelGrid

AUTO = "auto"


def asked_sides(source: Any, spacing: Any, axes: int = 2) -> PixelSides:
    """Give the sides that are asked for, of pixels of 1 without; ``"auto"`` is what the value carries.

    A value that carries a size which nobody asks for is warned of.
    """
    if spacing is not None and not isinstance(spacing, str):
        return pixel_sides(spacing, axes)
    if spacing not in (None, AUTO):
        raise UsageError(f"invalid spacing {spacing!r}: expected numbers, or 'auto' for the size that the image states")
    try:
        grid = carried_grid(source, axes)
    except InputError:
        if spacing == AUTO:
            raise
        grid = None  # who reads the value says what is wrong with its axes
    what = "pixels" if axes == 2 else "voxels"
    if spacing is None:
        if grid is not None and not isinstance(getattr(source, "sides", None), PixelSides):  # labels have theirs
            warn(
                f"the input has {what} of {grid.size_text()}, but distances are measured in {what}: spacing='auto' "
                f"uses this size, spacing=1 confirms {what}"
            )
        return pixel_sides(None, axes)
    if grid is None:
        raise UsageError(f"spacing='auto' needs an image that states the size of its {what}: give numbers instead")
    sides = sides_of_grid(grid) if isinstance(grid, PixelGrid) else sides_of_voxels(grid)
    if sides is None:
        raise UsageError(
            f"spacing='auto': the input has {what} of {grid.size_text()}, whose sides have no common step that is "
            "coarse enough for exact distances: give rounded numbers"
        )
    return sides


def carried_grid(source: Any, axes: int) -> PixelGrid | VoxelGrid | None:
    """Give the size that a value carries: an image or a volume that was read, or an array whose axes have steps."""
    grid = getattr(source, "grid", None)
    if axes == 2 and not isinstance(grid, PixelGrid) and _has_axes(source, 2):
        grid = grid_of(source)
    if axes == 3 and not isinstance(grid, VoxelGrid) and _has_axes(source, 3):
        grid = _voxels(source)
    if isinstance(grid, PixelGrid) and axes == 2:
        is_plain = grid.unit is None and grid.width == grid.height == 1
        is_angular = grid.unit == "deg" or is_geographic(grid.crs)
        return None if (not grid.is_size and grid.unit is not None) or is_plain or is_angular else grid
    if isinstance(grid, VoxelGrid) and axes == 3:
        return None if grid.unit is None and set(grid.sides) == {1} else grid
    return None


def _has_axes(source: Any, axes: int) -> bool:
    return hasattr(source, "dims") and hasattr(source, "coords") and len(source.dims) == axes


def _voxels(source: Any) -> VoxelGrid | None:
    """Give the steps of the coordinates of three axes, in the unit of the last one."""
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


def sides_of_voxels(grid: VoxelGrid) -> PixelSides | None:
    """Give sides with a common step: as the file has them, else as the shortest decimal numbers that are alike."""
    depth, height, width = grid.sides
    alike = {side: width for side in (height, depth) if abs(side - width) <= ALIKE * width}
    exact = [alike.get(side, side) for side in (depth, height, width)]
    for sides in (exact, [*map(rounded_side, exact)]):
        try:
            return pixel_sides(sides, 3)
        except UsageError:
            continue
    return None
