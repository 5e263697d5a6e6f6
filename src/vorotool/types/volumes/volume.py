"""A volume as it was read: the stored values."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError
from vorotool.plain import plain
from vorotool.types.values import Value
from vorotool.types.volumes.voxel_frame import VoxelGrid


@plain(eq=False, repr=False)
class Volume(Value):
    """A volume of one channel.

    Parameters
    ----------
    values : (D, H, W) array
        Truth values, integers or floats.
    grid : VoxelGrid, optional
        Sides of the voxels, where the file says them.

    Raises
    ------
    InputError
        If the array has another number of axes, no voxels, masked ones, or no numbers.

    Examples
    --------
    >>> Volume(np.zeros((2, 3, 4), dtype=np.uint8)).shape
    (2, 3, 4)
    """

    values: NDArray[Any]
    grid: VoxelGrid | None = None

    def __post_init__(self) -> None:
        if np.ma.isMaskedArray(self.values) and np.ma.getmaskarray(self.values).any():
            raise InputError("invalid volume: expected a value in each voxel, but some are masked; fill them first")
        values = np.asarray(self.values)
        if values.ndim != 3:
            raise InputError(f"a volume must have shape (D, H, W), but has shape {values.shape}")
        if values.dtype.kind not in "biuf":
            raise InputError(f"a volume must hold numbers, but has type {values.dtype}")
        if values.size == 0:
            raise InputError(f"the volume is empty: its shape is {values.shape}")
        object.__setattr__(self, "values", values)

    @property
    def shape(self) -> tuple[int, int, int]:
        """Slices, rows and columns."""
        depth, height, width = self.values.shape
        return (depth, height, width)

    def _summary(self) -> str:
        depth, height, width = self.shape
        size = "" if self.grid is None else f", voxels of {self.grid.size_text()}"
        return f"{width} x {height} x {depth}, {self.values.dtype}{size}"
