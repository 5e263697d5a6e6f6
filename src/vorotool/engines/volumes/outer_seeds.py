"""Outer voxels of the objects of a volume, collected slab by slab."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.tessellation.label_sums import parts
from vorotool.engines.tessellation.raster_objects import Objects
from vorotool.engines.volumes.inner_voxels import outer_voxels
from vorotool.engines.volumes.volume_objects import VolumeObjects
from vorotool.errors import LimitError, option
from vorotool.numeric.parallel import Progress
from vorotool.types.volumes.volume_seeds import VolumeSeeds
from vorotool.types.volumes.voxel_frame import VoxelFrame

CHUNK = 1 << 22
"""Seeds that are placed at a time."""

_CENTROIDS = option("--seeds centroids", 'mode="centroids"')


class OuterSeeds:
    """The seeds of a volume: all foreground voxels where each has its own label, else the outer ones of objects."""

    def __init__(
        self, objects: VolumeObjects, kind: Objects | str, connectivity: int = 26, most: int | None = None
    ) -> None:
        self._objects, self._kind, self._most = objects, kind, most
        _, height, width = objects.source.shape
        self._plane = height * width
        self._components = (
            _core.volumes.VolumeComponents(width, height, connectivity == 26) if kind == "components" else None
        )
        self._waiting = np.empty((0, height, width), np.uint32)  # the last two slices that were read
        self._read = self._done = 0  # slices that were read, and whose seeds are known
        self._places: list[NDArray[np.int64]] = []
        self._labels: list[NDArray[np.uint32]] = []
        self._filled: list[NDArray[np.bool_]] = []
        self._count = 0

    def read(self, frame: VoxelFrame, progress: Progress = None) -> VolumeSeeds:
        """Read the volume, and give its seeds, without sites."""
        depth = frame.depth
        for first, count in self._objects.limits():
            if self._kind == "pixels":
                self._keep(first, np.flatnonzero(self._objects.values(first, count)), None, None)
            else:
                self._add(self._fields(first, count), is_last=first + count == depth)
            if progress is not None:
                progress((first + count) / depth)
        return self._seeds(frame)

    def _fields(self, first: int, count: int) -> NDArray[Any]:
        """Labels of some slices, or provisional numbers of components."""
        if self._components is None:
            return self._objects.labels(first, count)
        mask = self._objects.mask(first, count)
        numbers = np.empty(mask.shape, np.uint32)
        self._components.add(mask, numbers, None)
        return numbers

    def _add(self, slab: NDArray[Any], *, is_last: bool) -> None:
        block = np.concatenate([self._waiting, slab]) if len(self._waiting) else slab
        begin = self._done - (self._read - len(self._waiting))  # slices of the block that are only there as neighbors
        self._read += len(slab)
        end = len(block) if is_last else len(block) - 1
        self._waiting = block[-2:].copy()
        # Provisional numbers differ within a component, whose voxels side by side are of one: the mask tells.
        is_outer = outer_voxels(block != 0 if self._components is not None else block)[begin:end]
        chosen = block[begin:end]
        places = np.flatnonzero(is_outer)
        is_inner = np.logical_and(chosen != 0, ~is_outer).reshape(-1)
        after = np.minimum(places + 1, max(is_inner.size - 1, 0))  # the last voxel of a row is outer
        self._keep(self._done, places, chosen.reshape(-1)[places].astype(np.uint32), is_inner[after])
        self._done += end - begin

    def _keep(
        self,
        first: int,
        places: NDArray[np.intp],
        labels: NDArray[np.uint32] | None,
        filled: NDArray[np.bool_] | None,
    ) -> None:
        self._count += len(places)
        if self._most is not None and self._count > self._most:
            what = "foreground voxels" if labels is None else "outer voxels of objects"
            raise LimitError(
                f"the volume has at least {self._count} {what}, more than {option(f'--max-sites {self._most}')}: use "
                f"{_CENTROIDS}, or a larger limit"
            )
        places += first * self._plane
        self._places.append(places)
        if labels is not None and filled is not None:
            self._labels.append(labels)
            self._filled.append(filled)

    def _seeds(self, frame: VoxelFrame) -> VolumeSeeds:
        """Put what was kept together; each list goes as soon as it is used."""
        labels = self._numbers()
        places = np.empty((self._count, 3), np.int64, order="F")
        start = 0
        self._places.reverse()
        while self._places:
            flat = self._places.pop()
            for part in parts(len(flat), CHUNK):
                rows, x = np.divmod(flat[part], frame.width)
                z, y = np.divmod(rows, frame.height)
                for axis, values in enumerate((x, y, z)):
                    places[start : start + len(x), axis] = values
                start += len(x)
        filled = np.concatenate(self._filled) if self._filled else np.zeros(0, bool)
        return VolumeSeeds(
            places,
            labels,
            frame=frame,
            sites=np.empty((0, 3)),
            site_labels=np.empty(0, np.uint32),
            filled=filled if filled.any() else None,
        )

    def _numbers(self) -> NDArray[np.uint32]:
        if self._kind == "pixels":
            return np.arange(1, self._count + 1, dtype=np.uint32)
        labels = np.concatenate(self._labels) if self._labels else np.empty(0, np.uint32)
        self._labels.clear()
        if self._components is None:
            return labels
        number = np.empty(self._components.size + 1, np.uint32)
        self._components.settle(number)
        numbers: NDArray[np.uint32] = number[labels]
        return numbers
