"""An image as it was read: the stored values, palette indices kept."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError
from vorotool.numeric.checks import is_masked_array
from vorotool.types import fields as f
from vorotool.types.axis import DOWN, YAxis
from vorotool.types.fields import record
from vorotool.types.pixel_grid import PixelGrid
from vorotool.types.values import Pixels, Value, placed


@record
class Raster(Value, Pixels):
    """A single-channel image, or a color image that still has to be thresholded.

    Parameters
    ----------
    values : (H, W) or (H, W, C) array
        Truth values, integers or floats. PBM: 1 is foreground. Palette images: the indices.
    grid : PixelGrid, optional
        Sides and places of the pixels, where the file says them.
    mask : (H, W) bool array, optional
        Pixels that are background whatever their values, as those of a masked array are.
    is_lossy : bool
        The file keeps values nearly, as JPEG does: they are no labels, and no mask until there is a threshold.
    y_axis : {"down", "up", "none"}
        Direction of y: "down" unless the first row is the lowest one.

    Raises
    ------
    InputError
        If the array has another number of axes, no pixels, or no numbers.

    Examples
    --------
    >>> Raster(np.eye(3, dtype=np.uint8)).is_color
    False
    """

    values: NDArray[Any]
    grid: PixelGrid | None = None
    mask: NDArray[np.bool_] | None = None
    is_lossy: bool = False
    y_axis: YAxis = f.y_axis(default=DOWN)

    def __post_init__(self) -> None:
        if is_masked_array(self.values):
            mask = np.ma.getmaskarray(self.values)
            object.__setattr__(self, "mask", mask.any(axis=2) if mask.ndim == 3 else mask)
            object.__setattr__(self, "values", self.values.filled(0))
        values = np.asarray(self.values)
        if values.ndim not in (2, 3):
            raise InputError(f"an image must have shape (H, W) or (H, W, C), but has shape {values.shape}")
        if values.dtype.kind not in "biuf":
            raise InputError(f"an image must hold numbers, but has type {values.dtype}")
        if values.size == 0:
            raise InputError(f"the image is empty: its shape is {values.shape}")
        object.__setattr__(self, "values", values)

    @property
    def is_color(self) -> bool:
        """Whether the image has channels."""
        return self.values.ndim == 3

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        return (self.values.shape[0], self.values.shape[1])

    @property
    def crs(self) -> Any:
        """The ``crs`` member of GeoJSON for the map that the image lies on; None without one."""
        return None if self.grid is None else self.grid.crs

    def _array(self) -> NDArray[Any]:
        return self.values

    def _summary(self) -> str:
        height, width = self.shape
        channels = f" x {self.values.shape[2]}" if self.is_color else ""
        size = "" if self.grid is None else f", pixels of {self.grid.size_text()}"
        text = f"{width} x {height}{channels}, {self.values.dtype}{size}"
        return placed(text, None if self.grid is None else self.grid.crs)
