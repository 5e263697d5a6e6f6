"""Bands of rows of a tessellation that are computed apart, each from the few seeds that it needs."""

from __future__ import annotations

from fractions import Fraction
from typing import Any, Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.tessellation.tessellator import Tessellator
from vorotool.numeric.parallel import Progress
from vorotool.plain import plain
from vorotool.types.pixel_frame import Frame
from vorotool.types.points.seed_set import SeedSet
from vorotool.types.spacing import SQUARE, PixelSides

Quantity = Literal["labels", "distance", "distance2"]


class Band(Protocol):
    """Some rows of an image, computed where they are asked for: it can be pickled."""

    def rows(self, *, threads: int = 0, progress: Progress = None) -> NDArray[Any]:
        """Compute the rows."""


@plain
class SeedBand:
    """Rows of a tessellation, with the seeds that they need."""

    seeds: SeedSet  # enough of them
    frame: Frame
    what: Quantity  # what is computed
    dtype: np.dtype[Any]  # its type, which is that of the whole image
    max_distance: float | Fraction | None = None
    sides: PixelSides = SQUARE  # of a pixel, in whose unit distances are

    def rows(self, *, threads: int = 0, progress: Progress = None) -> NDArray[Any]:
        """Compute the rows."""
        sweep = Tessellator(
            self.seeds,
            self.frame,
            max_distance=self.max_distance,
            sides=self.sides,
            threads=threads,
            progress=progress,
        )
        if self.what == "labels":
            return sweep.labels(dtype=self.dtype)
        if self.what == "distance":
            return sweep.distances()
        return sweep.squared_distances(dtype=self.dtype)


class SeedBands:
    """Cuts seeds into those that bands of rows need."""

    def __init__(self, seeds: SeedSet, frame: Frame) -> None:
        self.frame, self.scale = frame, seeds.scale
        self._brought = seeds.frame
        order = np.lexsort((seeds.labels, seeds.x, seeds.y))
        x, y = seeds.x[order], seeds.y[order]
        is_first = np.ones(len(order), bool)  # of those at one place: the one with the smallest label
        is_first[1:] = (x[1:] != x[:-1]) | (y[1:] != y[:-1])
        self._x, self._y, self._labels = x[is_first], y[is_first], seeds.labels[order][is_first]
        columns, self._column = np.unique(self._x, return_inverse=True)
        self._columns = len(columns)

    def seeds_of(self, first: int, rows: int) -> SeedSet:
        """Give the seeds that some rows of the frame need, from top to bottom."""
        top = self.scale * (self.frame.y + first)
        above, below = np.searchsorted(self._y, [top, top + self.scale * rows])
        chosen = np.concatenate(
            [
                self._nearest(np.arange(above)),
                np.arange(above, below),
                self._nearest(np.arange(below, len(self._y))[::-1]),
            ]
        )
        return SeedSet(
            self._x[chosen],
            self._y[chosen],
            self._labels[chosen],
            scale=self.scale,
            frame=self._brought,
            sites=np.empty((0, 2)),
            site_labels=np.empty(0, np.uint32),
        )

    def _nearest(self, seeds: NDArray[np.intp]) -> NDArray[np.intp]:
        """The last seed in each column, of seeds in the order in which they come nearer."""
        nearest = np.full(self._columns, -1)
        nearest[self._column[seeds]] = seeds  # of values for one index the last one stays
        return np.sort(nearest[nearest >= 0])
