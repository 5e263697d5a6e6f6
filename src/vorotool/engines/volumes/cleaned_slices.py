"""Masks of volumes without holes and without small objects, read slab by slab."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import islice
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.tessellation.cleaned_masks import Cleaning
from vorotool.engines.volumes.volume_objects import VolumeObjects
from vorotool.types.volumes.voxel_frame import VoxelGrid

Plane = NDArray[np.uint8]
"""(1, H, W) zeros and ones."""


class CleanedSlices:
    """The mask of a volume, whose holes are filled and whose small objects are left out; it is never held."""

    def __init__(self, objects: VolumeObjects, cleaning: Cleaning, connectivity: int = 26) -> None:
        self._objects, self._corners = objects, connectivity == 26
        self._holes: NDArray[np.bool_] | None = None
        self._kept: NDArray[np.bool_] | None = None
        self.filled = self.removed = self.objects = 0
        if cleaning.fill_holes is not False:
            background = _measured((1 - plane for plane in self._planes()), self.shape, corners=not self._corners)
            filled = cleaning.fills(background.areas, background.reaches)
            self._holes, self.filled = filled[background.number], int(background.areas[filled].sum())
        if cleaning.min_area > 1:
            found = _measured(self._planes(), self.shape, corners=self._corners)
            kept = cleaning.keeps(found.areas)
            self._kept, self.objects = kept[found.number], len(kept) - 1
            self.removed = self.objects - int(np.count_nonzero(kept))
        self._reader, self._next = self._planes(), 0

    @property
    def shape(self) -> tuple[int, int, int]:
        """Slices, rows and columns."""
        return self._objects.source.shape

    @property
    def grid(self) -> VoxelGrid | None:
        """Sides of the voxels."""
        return self._objects.source.grid

    def slices(self, first: int, count: int) -> Plane:
        """Read some slices of the mask, as zeros and ones."""
        if first < self._next:
            self._reader, self._next = self._planes(), 0
        planes = [*islice(self._reader, first - self._next, first - self._next + count)]
        self._next = first + count
        return np.concatenate(planes)

    def _planes(self) -> Iterator[Plane]:
        """Read the mask slice by slice, as far as it is known what to fill and what to keep."""
        planes = _read(self._objects)
        if self._holes is not None:
            planes = _changed(planes, self._holes, self.shape, corners=not self._corners, fills=True)
        if self._kept is not None:
            planes = _changed(planes, self._kept, self.shape, corners=self._corners, fills=False)
        return planes


class _Components(NamedTuple):
    """Components of a volume: the number of each provisional one, and what is known of each; 0 is what is beside."""

    number: NDArray[np.uint32]
    areas: NDArray[np.int64]
    reaches: NDArray[np.bool_]


def _read(objects: VolumeObjects) -> Iterator[Plane]:
    for first, count in objects.limits():
        slab = objects.mask(first, count)
        for at in range(count):
            yield slab[at : at + 1]


def _measured(planes: Iterable[Plane], shape: tuple[int, int, int], *, corners: bool) -> _Components:
    """Count the voxels of the components, and find those that reach a face of the volume."""
    components = _core.volumes.VolumeComponents(shape[2], shape[1], corners)
    areas, reaches = np.zeros(1, np.int64), np.zeros(1, bool)
    for at, plane in enumerate(planes):
        numbers = np.empty(plane.shape, np.uint32)
        components.add(plane, numbers, None)
        if components.size >= len(areas):
            more = 2 * components.size + 1 - len(areas)
            areas, reaches = np.pad(areas, (0, more)), np.pad(reaches, (0, more))
        runs = numbers.reshape(-1)
        start = np.flatnonzero(np.concatenate([[True], runs[1:] != runs[:-1]]))
        np.add.at(areas, runs[start], np.diff(start, append=runs.size))
        if at in (0, shape[0] - 1):
            reaches[runs[start]] = True
        for side in (numbers[0, 0], numbers[0, -1], numbers[0, :, 0], numbers[0, :, -1]):
            reaches[side] = True
    number = np.zeros(components.size + 1, np.uint32)
    count = components.settle(number)
    total, reached = np.zeros(count + 1, np.int64), np.zeros(count + 1, bool)
    np.add.at(total, number, areas[: len(number)])
    np.logical_or.at(reached, number, reaches[: len(number)])
    return _Components(number, total, reached)


def _changed(
    planes: Iterable[Plane], chosen: NDArray[np.bool_], shape: tuple[int, int, int], *, corners: bool, fills: bool
) -> Iterator[Plane]:
    """Fill the chosen components of the background, or keep the chosen ones of the foreground."""
    components = _core.volumes.VolumeComponents(shape[2], shape[1], corners)
    for plane in planes:
        numbers = np.empty(plane.shape, np.uint32)
        components.add(1 - plane if fills else plane, numbers, None)
        field = chosen[numbers].view(np.uint8)
        yield plane | field if fills else field
