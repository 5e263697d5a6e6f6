"""Slabs of slices of a tessellation that are computed apart, each from the seeds that it needs."""

from __future__ import annotations

from fractions import Fraction
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.volumes.volume_measures import volume_diagram
from vorotool.engines.volumes.volume_tessellator import VolumeSweep
from vorotool.numeric.parallel import Progress
from vorotool.plain import plain
from vorotool.types.spacing import PixelSides
from vorotool.types.volumes.label_volume import CUBE
from vorotool.types.volumes.volume_seeds import VolumeSeeds
from vorotool.types.volumes.voxel_frame import VoxelFrame

Quantity = Literal["labels", "distance", "distance2", "diagram"]


def with_neighbors(frame: VoxelFrame, first: int, slices: int) -> tuple[int, int]:
    """Give the first slice and the number of slices, with one more on each side where the frame has one."""
    begin, end = max(first - 1, 0), min(first + slices + 1, frame.depth)
    return begin, end - begin


@plain
class SeedSlab:
    """Slices of a tessellation, with the seeds that they need: it can be pickled."""

    seeds: VolumeSeeds  # enough of them
    frame: VoxelFrame  # the whole volume
    first: int
    slices: int
    what: Quantity  # what is computed
    dtype: np.dtype[Any]  # its type, which is that of the whole volume
    sides: PixelSides = CUBE
    max_distance: float | Fraction | None = None

    def rows(self, *, threads: int = 0, progress: Progress = None) -> NDArray[Any]:
        """Compute the slices."""
        sweep = VolumeSweep(
            self.seeds,
            self.frame,
            sides=self.sides,
            max_distance=self.max_distance,
            threads=threads,
            progress=progress,
        )
        if self.what == "labels":
            return sweep.labels(self.first, self.slices, dtype=self.dtype)
        if self.what == "diagram":
            begin, count = with_neighbors(self.frame, self.first, self.slices)
            lines = volume_diagram(sweep.labels(begin, count), threads=threads)
            return lines[self.first - begin :][: self.slices]
        if self.what == "distance":
            return sweep.distances(self.first, self.slices)
        return sweep.squared_distances(self.first, self.slices, dtype=self.dtype)


class SeedSlabs:
    """Cuts seeds into those that slabs of slices need."""

    def __init__(self, seeds: VolumeSeeds, frame: VoxelFrame) -> None:
        self.frame, self.seeds = frame, seeds
        order = np.lexsort((seeds.labels, seeds.x, seeds.y, seeds.z))  # rows stay whole, with what is inside objects
        places = seeds.places[order]
        is_first = np.ones(len(order), bool)  # of those at one place: the one with the smallest label
        is_first[1:] = (places[1:] != places[:-1]).any(axis=1)
        self._places, self._labels = places[is_first], seeds.labels[order][is_first]
        self._filled = None if seeds.filled is None else seeds.filled[order][is_first]
        x, y, _ = self._places.T
        by_column = np.lexsort((y, x))
        is_next = (x[by_column][1:] != x[by_column][:-1]) | (y[by_column][1:] != y[by_column][:-1])
        self._column = np.empty(len(by_column), np.int64)
        self._column[by_column] = np.append(0, np.cumsum(is_next))[: len(by_column)]
        self._columns = int(self._column.max(initial=-1)) + 1

    def seeds_of(self, first: int, slices: int) -> VolumeSeeds:
        """Give the seeds that some slices of the frame need, from the first to the last."""
        scale, z = self.seeds.scale, self._places[:, 2]
        top = scale * (self.frame.z + first)
        before, behind = np.searchsorted(z, [top, top + scale * slices])
        above, below = self._nearest(np.arange(before)), self._nearest(np.arange(behind, len(z))[::-1])
        chosen = np.concatenate([above, np.arange(before, behind), below])
        filled = None
        if self._filled is not None:
            filled = np.zeros(len(chosen), bool)
            filled[len(above) : len(chosen) - len(below)] = self._filled[before:behind]
        return VolumeSeeds(
            self._places[chosen],
            self._labels[chosen],
            scale=scale,
            frame=self.seeds.frame,
            sites=np.empty((0, 3)),
            site_labels=np.empty(0, np.uint32),
            filled=filled,
        )

    def _nearest(self, seeds: NDArray[np.intp]) -> NDArray[np.intp]:
        """The last seed in each column, of seeds in the order in which they come nearer."""
        nearest = np.full(self._columns, -1)
        nearest[self._column[seeds]] = seeds  # of values for one index the last one stays
        return np.sort(nearest[nearest >= 0])
