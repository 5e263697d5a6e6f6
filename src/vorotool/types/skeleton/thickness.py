"""The local thickness of an image, with what its file says of its pixels."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.types import fields as f
from vorotool.types.fields import Record, record
from vorotool.types.pixel_grid import PixelGrid


@record
class ThicknessImage(Record):
    """The diameter of the largest inscribed disc over each pixel."""

    values: NDArray[np.float64] = f.length("rows", "columns")  # (H, W) float64 array: 0 where there is no object
    grid: PixelGrid | None = None  # sides and places of the pixels, where the file says them

    @property
    def largest(self) -> float:
        """The largest thickness; 0 without objects."""
        return float(self.values.max(initial=0.0))
