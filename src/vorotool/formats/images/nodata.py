"""Pixels that have no value, as a TIFF says: they are masked."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import isnan
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.formats.images.tiff_grid import PageGrid
from vorotool.formats.images.world_file import world_grid
from vorotool.types.pixel_grid import PixelGrid
from vorotool.types.points.raster import Raster


def tiff_raster(name: str, values: NDArray[Any], about: PageGrid, note: Callable[[str], None]) -> Raster:
    """Make an image of what was read of a TIFF, and say what of it is not used."""
    if about.note:
        note(about.note)
    masked = with_nodata(values, about.nodata)
    return replace(masked, grid=placed_grid(name, about.grid))


def placed_grid(name: str, grid: PixelGrid | None) -> PixelGrid | None:
    """Give the grid of a file, or that of a world file beside it where the file itself is not placed on a map."""
    return grid if grid is not None and grid.transform is not None else world_grid(name) or grid


def with_nodata(values: NDArray[Any], nodata: float | None) -> Raster:
    """Mask the pixels of one value; of those that are not finite the values become 0."""
    missing = missing_values(values, nodata)
    if missing is None:
        return Raster(values)
    if values.dtype.kind == "f":
        values = np.where(missing & ~np.isfinite(values), values.dtype.type(0), values)
    mask: NDArray[np.bool_] = np.asarray(missing.all(axis=2)) if missing.ndim == 3 else missing
    return Raster(values, mask=mask)


def missing_values(values: NDArray[Any], nodata: float | None) -> NDArray[np.bool_] | None:
    """Tell which values stand for none; None where no value does."""
    if nodata is None:
        return None
    missing: NDArray[np.bool_] = np.isnan(values) if isnan(nodata) else values == nodata
    return missing if missing.any() else None
