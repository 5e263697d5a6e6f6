"""Bands of rows, or of slices, of a tessellation that are computed apart, each from the few seeds that it needs."""

from __future__ import annotations

from fractions import Fraction
from typing import Any, Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.tessellation.tessellator import Tessellator
from vorotool.numeric.parallel import Progress
from vorotool.plain import plain
from vorotool.types.pixels import Frame, PixelSides
from vorotool.types.points.seed_set import SeedSet
from vorotool.types.volumes.volume import VolumeSeeds
from vorotool.types.volumes.voxel_frame import VoxelFrame

Quantity = Literal["labels", "distance", "distance2", "diagram"]


class Band(Protocol):
    """Some rows of an image, or slices of a volume, computed where they are asked for: it can be pickled."""

    def rows(self, *, threads: int = 0, progress: Progress = None) -> NDArray[Any]:
        """Compute them."""


def with_neighbors(frame: Frame | VoxelFrame, first: int, count: int) -> tuple[int, int]:
    """Give the first row or slice and their number, with one more on each side where the frame has one."""
    begin, end = max(first - 1, 0), min(first + count + 1, frame.shape[0])
    return begin, end - begin


@plain
class SeedBand:
    """Rows or slices of a tessellation, with the seeds that they need."""

    seeds: SeedSet | VolumeSeeds  # enough of them
    frame: Frame | VoxelFrame  # the whole one
    first: int
    count: int
    what: Quantity  # what is computed
    dtype: np.dtype[Any]  # its type, which is that of the whole
    sides: PixelSides | None = None  # of a pixel or voxel, in whose unit distances are
    max_distance: float | Fraction | None = None

    def rows(self, *, threads: int = 0, progress: Progress = None) -> NDArray[Any]:
        """Compute the rows or slices."""
        is_diagram = self.what == "diagram"
        begin, count = (with_neighbors if is_diagram else _alone)(self.frame, self.first, self.count)
        sweep = Tessellator(
            self.seeds,
            self.frame.part(begin, count),
            max_distance=self.max_distance,
            sides=self.sides,
            threads=threads,
            progress=progress,
        )
        if is_diagram:
            from vorotool.engines.label_images.regions import diagram_of

            return diagram_of(sweep.labels(), threads=threads)[self.first - begin :][: self.count]
        return sweep.computed(self.what, self.dtype)


def _alone(_frame: Frame | VoxelFrame, first: int, count: int) -> tuple[int, int]:
    return first, count


class SeedBands:
    """Cuts seeds into those that bands of rows or slices need."""

    def __init__(self, seeds: SeedSet | VolumeSeeds, frame: Frame | VoxelFrame) -> None:
        self.frame, self.seeds = frame, seeds
        filled = getattr(seeds, "filled", None)
        keys: Any = (seeds.labels, *seeds.coordinates)
        order = np.lexsort(keys)  # rows stay whole, with what is inside objects
        places = [values[order] for values in seeds.coordinates]
        is_first = np.ones(len(order), bool)  # of those at one place: the one with the smallest label
        is_first[1:] = np.logical_or.reduce([values[1:] != values[:-1] for values in places])
        self._places = [values[is_first] for values in places]
        self._labels = seeds.labels[order][is_first]
        self._filled = None if filled is None else filled[order][is_first]
        across = self._places[:-1]
        by_column = np.lexsort(across[::-1])
        steps = [values[by_column][1:] != values[by_column][:-1] for values in across]
        self._column = np.empty(len(by_column), np.int64)
        self._column[by_column] = np.append(0, np.cumsum(np.logical_or.reduce(steps)))[: len(by_column)]
        self._columns = int(self._column.max(initial=-1)) + 1

    def band(
        self,
        what: Quantity,
        dtype: np.dtype[Any],
        first: int,
        count: int,
        *,
        sides: PixelSides | None = None,
        max_distance: float | Fraction | None = None,
    ) -> SeedBand:
        """Give some rows or slices as what computes them anywhere."""
        own = with_neighbors(self.frame, first, count) if what == "diagram" else (first, count)
        return SeedBand(self.seeds_of(*own), self.frame, first, count, what, dtype, sides, max_distance)

    def seeds_of(self, first: int, count: int) -> SeedSet | VolumeSeeds:
        """Give the seeds that some rows or slices of the frame need, from the first to the last."""
        scale, along = self.seeds.scale, self._places[-1]
        top = scale * (self.frame.origin[-1] + first)
        before, behind = np.searchsorted(along, [top, top + scale * count])
        above, below = self._nearest(np.arange(before)), self._nearest(np.arange(behind, len(along))[::-1])
        chosen = np.concatenate([above, np.arange(before, behind), below])
        places = [values[chosen] for values in self._places]
        known: dict[str, Any] = {"scale": scale, "frame": self.seeds.frame, "site_labels": np.empty(0, np.uint32)}
        if len(places) == 2:
            x, y = places
            return SeedSet(x, y, self._labels[chosen], sites=np.empty((0, 2)), **known)
        if self._filled is not None:
            known["filled"] = filled = np.zeros(len(chosen), bool)
            filled[len(above) : len(chosen) - len(below)] = self._filled[before:behind]
        return VolumeSeeds(np.array(places).T, self._labels[chosen], sites=np.empty((0, 3)), **known)

    def _nearest(self, seeds: NDArray[np.intp]) -> NDArray[np.intp]:
        """The last seed in each column, of seeds in the order in which they come nearer."""
        nearest = np.full(self._columns, -1)
        nearest[self._column[seeds]] = seeds  # of values for one index the last one stays
        return np.sort(nearest[nearest >= 0])
