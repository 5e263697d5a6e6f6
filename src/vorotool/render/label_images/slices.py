"""Pictures of label volumes: one slice, or the three through the middle side by side, and a page with all slices."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.tessellation.tessellator import inner_runs
from vorotool.errors import LimitError, UsageError
from vorotool.frozen import frozen
from vorotool.numeric.arrays import ranges
from vorotool.types.images import LabelImage
from vorotool.types.pixels import Frame
from vorotool.types.points.seed_set import SeedSet
from vorotool.types.volumes.volume import LabelVolume, VolumeSeeds, VoxelFrame

Z, Y, X = range(3)

_GAP = 50
"""The larger side of a picture is this many gaps between its views wide."""

_LEAST_GAP = 3
"""Pixels."""

_STEPS = 256
"""Places of seeds are kept to this part of a pixel."""


class View(NamedTuple):
    """A slice of a volume and its place in a picture."""

    axes: tuple[int, int]  # (int, int): axis of the volume that goes down, and the one to the right
    number: int  # which slice along the third axis
    top: int  # pixel of the upper left corner
    left: int  # pixel of the upper left corner

    @property
    def across(self) -> int:
        """The axis that the slice is across."""
        return 3 - sum(self.axes)


@frozen
class SlicePicture:
    """Where slices lie in a picture, whose pixels are squares with the shortest side of a voxel."""

    frame: VoxelFrame
    units: tuple[int, ...] = (1, 1, 1)  # sides of a voxel: along z, y and x
    # the slice that is drawn, by its z; by default there are three views: the slice across z through the middle
    # voxel, to the right of it the one across x, and below it the one across y
    chosen: int | None = None

    def __post_init__(self) -> None:
        first, count = self.frame.z, self.frame.depth
        if self.chosen is not None and not first <= self.chosen < first + count:
            last = first + count - 1
            which = f"slices {first} to {last}" if count > 1 else f"slice {first} alone"
            raise UsageError(f"--slice {self.chosen} does not exist: the volume has {which}")

    @cached_property
    def sizes(self) -> tuple[int, int, int]:
        """Pixels of the picture along z, y and x."""
        least = min(self.units)
        depth, height, width = (
            max(1, (2 * voxels * unit + least) // (2 * least))
            for voxels, unit in zip(self.frame.shape, self.units, strict=True)
        )
        return (depth, height, width)

    @cached_property
    def views(self) -> tuple[View, ...]:
        """What is drawn."""
        depth, height, width = self.frame.shape
        if self.chosen is not None:
            return (View((Y, X), self.chosen - self.frame.z, 0, 0),)
        down, right = self.sizes[Y] + self._gap, self.sizes[X] + self._gap
        return (
            View((Y, X), depth // 2, 0, 0),
            View((Y, Z), width // 2, 0, right),
            View((Z, X), height // 2, down, 0),
        )

    @property
    def _gap(self) -> int:
        return max(_LEAST_GAP, max(self.sizes) // _GAP)

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns of the picture."""
        depth, height, width = self.sizes
        return (height, width) if self.chosen is not None else (height + self._gap + depth, width + self._gap + depth)

    def check(self, max_pixels: int) -> None:
        """Refuse a picture of too many pixels."""
        height, width = self.shape
        if height * width > max_pixels:
            raise LimitError(
                f"a picture of slices would have {width} x {height} pixels, more than --max-pixels {max_pixels}: use "
                "--slice Z, or --what labels"
            )

    def image(self, volume: LabelVolume) -> LabelImage:
        """Give the picture as labels, with those seeds that lie in the slices."""
        labels = np.zeros(self.shape, volume.labels.dtype)
        marks = self._marks(volume)
        for view in self.views:
            labels[self._place(view)] = self._drawn(view, np.take(volume.labels, view.number, axis=view.across))
        height, width = self.shape
        return LabelImage(labels, Frame(0, 0, width, height), marks)

    def _place(self, view: View) -> tuple[slice, slice]:
        rows, columns = (self.sizes[axis] for axis in view.axes)
        return (slice(view.top, view.top + rows), slice(view.left, view.left + columns))

    def _drawn(self, view: View, values: NDArray[Any]) -> NDArray[Any]:
        """Give each pixel of a view the voxel that it lies in; values are ordered as the volume's axes are."""
        made = values if view.axes[0] < view.axes[1] else values.T
        rows, columns = (self._voxels(axis) for axis in view.axes)
        return made[np.ix_(rows, columns)]

    def _voxels(self, axis: int) -> NDArray[np.int64]:
        """The voxel of each pixel along an axis."""
        size, voxels = self.sizes[axis], self.frame.shape[axis]
        return (2 * np.arange(size) + 1) * voxels // (2 * size)

    def _marks(self, volume: LabelVolume) -> SeedSet | None:
        """Seeds in the slices: the pixels of objects, else points."""
        seeds = volume.seeds
        if seeds is None or seeds.sites is None:
            return None
        if seeds.frame is not None and len(seeds) > len(seeds.sites):
            return self._objects(volume)
        places, labels = [np.empty((0, 2), np.int64)], [np.empty(0, np.uint32)]
        for view in self.views:
            voxels = self._voxels_of(seeds.places, seeds.scale)
            inside = self._inside(voxels) & (voxels[:, 2 - view.across] == view.number)
            places.append(self._places(view, seeds.places[inside] / seeds.scale))
            labels.append(seeds.labels[inside])
        xy, own = np.concatenate(places), np.concatenate(labels)
        return SeedSet(xy[:, 0], xy[:, 1], own, scale=_STEPS)

    def _voxels_of(self, places: NDArray[np.int64], scale: int) -> NDArray[np.int64]:
        """The voxel that each seed lies in, (x, y, z) from the first one; between two it is the latter."""
        first = (self.frame.x, self.frame.y, self.frame.z)
        return (2 * places + scale) // (2 * scale) - np.array(first)

    def _inside(self, voxels: NDArray[np.int64]) -> NDArray[np.bool_]:
        is_on_axis: NDArray[np.bool_] = (voxels >= 0) & (voxels < np.array(self.frame.shape[::-1]))
        return np.logical_and.reduce(is_on_axis, axis=1)

    def _places(self, view: View, xyz: NDArray[np.float64]) -> NDArray[np.int64]:
        """Column and row in the picture of places in a slice, in steps of a part of a pixel."""
        first = (self.frame.z, self.frame.y, self.frame.x)
        found = []
        for axis, start in zip(reversed(view.axes), (view.left, view.top), strict=True):
            scale = self.sizes[axis] / self.frame.shape[axis]
            found.append((xyz[:, 2 - axis] - first[axis] + 0.5) * scale - 0.5 + start)
        return np.rint(_STEPS * np.stack(found, axis=1)).astype(np.int64)

    def _objects(self, volume: LabelVolume) -> SeedSet:
        """The pixels of the objects in the slices, with what is inside them."""
        assert volume.seeds is not None
        painted = np.zeros(self.shape, np.uint32)
        for view in self.views:
            objects = np.zeros([side for axis, side in enumerate(self.frame.shape) if axis != view.across], np.uint32)
            for voxels, labels in self._object_voxels(volume.seeds, view):
                inside = self._inside(voxels)
                rows, columns = (voxels[inside, 2 - axis] for axis in sorted(view.axes))
                objects[rows, columns] = labels[inside]
            painted[self._place(view)] = self._drawn(view, objects)
        row, column = np.nonzero(painted)
        height, width = self.shape
        return SeedSet(column, row, painted[row, column], frame=Frame(0, 0, width, height))

    def _object_voxels(self, seeds: VolumeSeeds, view: View) -> Iterator[tuple[NDArray[np.int64], NDArray[np.uint32]]]:
        """Voxels of objects in a slice, (x, y, z) from the first one of the frame, and labels: outer and inner ones."""
        outer = self._voxels_of(seeds.places, seeds.scale)
        chosen = outer[:, 2 - view.across] == view.number
        yield outer[chosen], seeds.labels[chosen]
        if seeds.filled is None:
            return
        seed, start, end = inner_runs(seeds, slice(0, len(seeds)))
        start, end = start - self.frame.x, end - self.frame.x
        if view.across == X:
            start, end = np.maximum(start, view.number), np.minimum(end, view.number + 1)
            chosen = start < end
        else:
            chosen = outer[seed, 2 - view.across] == view.number
        seed, start, lengths = seed[chosen], start[chosen], (end - start)[chosen]
        voxels = np.repeat(outer[seed], lengths, axis=0)
        voxels[:, 0] = ranges(start, lengths)
        yield voxels, np.repeat(seeds.labels[seed], lengths)
