"""Bands of rows of a tessellation that are computed apart, each from the few seeds that it needs."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.tessellation.tessellator import Tessellator
from vorotool.geometry.pixel_frame import Frame
from vorotool.geometry.points.seed_set import SeedSet
from vorotool.geometry.progress import Progress
from vorotool.geometry.spacing import SQUARE, PixelSides

Quantity = Literal["labels", "distance", "distance2"]


class Band(Protocol):
    """Some rows of an image, computed where they are asked for: it can be pickled."""

    def rows(self, *, threads: int = 0, progress: Progress = None) -> NDArray[Any]:
        """Compute the rows."""


@dataclass(frozen=True)
class SeedBand:
    """Rows of a tessellation, with the seeds that they need.

    Parameters
    ----------
    seeds : SeedSet
        Enough of them.
    frame : Frame
        The rows.
    what : {"labels", "distance", "distance2"}
        What is computed.
    dtype : dtype
        Its type, which is that of the whole image.
    max_distance : Fraction or float, optional
        Of labels.
    sides : PixelSides
        Of a pixel, in whose unit distances are.
    """

    seeds: SeedSet
    frame: Frame
    what: Quantity
    dtype: np.dtype[Any]
    max_distance: float | Fraction | None = None
    sides: PixelSides = SQUARE

    def rows(self, *, threads: int = 0, progress: Progress = None) -> NDArray[Any]:
        """Compute the rows.

        Examples
        --------
        >>> seeds = SeedSet(np.array([0, 4]), np.array([0, 9]), np.array([1, 2]))
        >>> SeedBand(seeds, Frame(0, 5, 5, 1), "labels", np.dtype(np.uint8)).rows()
        array([[1, 2, 2, 2, 2]], dtype=uint8)
        """
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
    """Cuts seeds into those that bands of rows need.

    In each column of seeds a pixel's nearest one is within the rows of its band, or it is the nearest above these, or
    below. So a band needs the seeds in its rows and two lists with at most one seed a column: any band is computed
    apart from the others, with the same result.

    Parameters
    ----------
    seeds : SeedSet
        All of them.
    frame : Frame
        The whole image.

    Examples
    --------
    >>> seeds = SeedSet(np.array([3, 3, 3, 8]), np.array([0, 1, 9, 0]), np.array([1, 2, 3, 4]))
    >>> SeedBands(seeds, Frame(0, 0, 9, 9)).seeds_of(4, 2).labels.tolist()
    [4, 2, 3]
    """

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
