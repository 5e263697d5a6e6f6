"""Layers of cubic Bézier curves."""

from __future__ import annotations

from dataclasses import field

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.curves.cubics import cubic_polylines
from vorotool.plain import plain
from vorotool.render.canvas.layers import Curves


@plain(eq=False)
class CubicCurves(Curves):
    """Cubic Bézier curves."""

    second: NDArray[np.int32] = field(kw_only=True)  # (m,) int32 array: its second one

    def polylines(self, tolerance: float) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
        """As of `Curves`."""
        return cubic_polylines(self._curves(self.points), tolerance)

    def flattened(self, places: NDArray[np.float64], tolerance: float) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
        """As of `Curves`."""
        points, start = cubic_polylines(self._curves(places), tolerance)
        first = np.delete(np.arange(len(points)), start[1:] - 1)
        return points, np.stack([first, first + 1], axis=1).astype(np.int32)

    def _curves(self, places: NDArray[np.float64]) -> NDArray[np.float64]:
        """(m, 4, 2) control points."""
        return places[np.stack([self.pairs[:, 0], self.control, self.second, self.pairs[:, 1]], axis=1)]
