"""Layers of whole circles."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.plain import plain
from vorotool.render.canvas.layers import Arcs


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
