"""Layers of whole circles and of cubic Bézier curves."""

from __future__ import annotations

from dataclasses import field

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.curves.flatten import cubic_polylines
from vorotool.plain import plain
from vorotool.render.canvas.layers import Arcs, Curves


@plain(eq=False)
class Circles(Arcs):
    """Circles, each of two arcs of half of it; see `circles`."""

    @property
    def radius(self) -> NDArray[np.float64]:
        """(n,) of the circles."""
        return np.asarray((self.start[::2, 0] - self.end[::2, 0]) / 2)


def circles(name: str, xy: NDArray[np.float64], radius: NDArray[np.float64], edge: str, width: float) -> Circles:
    """Give a layer of circles that are not filled."""
    right, left = (xy + way * radius[:, None] * (1, 0) for way in (1, -1))
    start, end = (np.stack(ends, axis=1).reshape(-1, 2) for ends in ((right, left), (left, right)))
    rings = np.arange(0, 2 * len(xy) + 1, 2)
    return Circles(name, start, end, np.repeat(xy, 2, axis=0), rings, None, edge, width, np.ones(2 * len(xy), bool))


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
