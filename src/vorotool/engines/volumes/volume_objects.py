"""The objects of a volume that is read slab by slab."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from math import floor
from typing import Any, Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.tessellation.otsu import best_split, otsu_threshold
from vorotool.engines.tessellation.raster_objects import (
    Note,
    Objects,
    label_values,
    mask_options,
    objects_of_value,
    only_value,
    photograph_signs,
)
from vorotool.errors import InputError, option
from vorotool.numeric.checks import checked_flag
from vorotool.numeric.numbers import finite_double
from vorotool.plain import plain
from vorotool.types.volumes.volume import Volume
from vorotool.types.volumes.voxel_frame import VoxelGrid

SLAB_VOXELS = 2**23
"""Voxels that are read at a time, or one slice: each takes up to some 16 bytes while its slab is looked at."""

_NARROW = 2
"""Bytes of integers that are counted by a table of all of them."""

_THRESHOLD = option("--threshold T", "threshold=T (of seeds_from_volume)")
_AS_LABELS = option("--seeds labels", 'mode="labels"')


class SlicesSource(Protocol):
    """A volume that is read slab by slab."""

    @property
    def shape(self) -> tuple[int, int, int]:
        """Slices, rows and columns."""

    @property
    def grid(self) -> VoxelGrid | None:
        """Sides of the voxels, where the file says them."""

    def slices(self, first: int, count: int) -> NDArray[Any]:
        """Read some slices."""


@plain
class HeldSlices:
    """A volume in memory, as one that is read."""

    volume: Volume

    @property
    def shape(self) -> tuple[int, int, int]:
        """Slices, rows and columns."""
        return self.volume.shape

    @property
    def grid(self) -> VoxelGrid | None:
        """Sides of the voxels."""
        return self.volume.grid

    def slices(self, first: int, count: int) -> NDArray[Any]:
        """Give some slices."""
        return self.volume.values[first : first + count]


@plain
class VolumeObjects:
    """The slices of a volume, of which the objects are seeds."""

    source: SlicesSource
    threshold: float | None = None  # foreground is what is larger
    invert: bool = False  # exchange foreground and background
    step: int = 1  # slices that are read at a time

    @classmethod
    def of(
        cls,
        source: SlicesSource,
        threshold: float | Literal["otsu"] | None,
        *,
        invert: bool = False,
        slices: int | None = None,
    ) -> VolumeObjects:
        """Settle the threshold, for which ``otsu`` reads the volume, and how many slices are read at a time."""
        _, height, width = source.shape
        made = cls(source, None, invert, slices or max(1, SLAB_VOXELS // (height * width)))
        if threshold is None:
            return made
        if isinstance(threshold, str) and threshold == "otsu":
            number, is_flat = _otsu(source, made)
            return replace(made, threshold=number, invert=invert and not is_flat)
        finite_double(threshold, "threshold")
        return replace(made, threshold=threshold)

    def limits(self) -> Iterator[tuple[int, int]]:
        """First slice and number of slices of the slabs in which it is read."""
        depth = self.source.shape[0]
        return ((first, min(self.step, depth - first)) for first in range(0, depth, self.step))

    def values(self, first: int, count: int) -> NDArray[Any]:
        """Read some slices, of which the nonzero values are foreground."""
        values = self.source.slices(first, count)
        if self.threshold is not None:  # as an integer where values are: a float would round those beyond 2^53
            values = values > (floor(self.threshold) if values.dtype.kind in "iu" else self.threshold)
        elif values.dtype.kind == "f" and not np.isfinite(values).all():
            raise _not_finite()
        return values == 0 if self.invert else values

    def labels(self, first: int, count: int) -> NDArray[Any]:
        """Read the values of some slices as labels, in an unsigned type."""
        return label_values(self.values(first, count), first=first)

    def mask(self, first: int, count: int) -> NDArray[np.uint8]:
        """Read the foreground of some slices, as zeros and ones."""
        return np.ascontiguousarray(self.values(first, count) != 0).view(np.uint8)

    def kind(self, *, note: Note = None) -> Objects:
        """Tell whether the nonzero values are of a mask or labels, as `default_objects` does of an image."""
        if self.threshold is not None or checked_flag(self.invert, "invert"):
            return "components"
        one, found = only_value((first, self.values(first, count)) for first, count in self.limits())
        if found is None:
            return objects_of_value(one, note=note)
        _refuse_gray(found[1], found[0])
        return "labels"


def _refuse_gray(values: NDArray[Any], first: int) -> None:
    """Refuse what looks like gray values, in the first slice that has two values beside 0."""
    several = (
        number for number, plane in enumerate(values) if plane.any() and (plane[plane != 0] != plane.max()).any()
    )
    at = next(several, None)
    if at is None:
        return
    plane, number = values[at], first + at
    if plane.dtype.kind != "f" or (plane == np.floor(plane)).all():
        plane = label_values(plane[None], first=number)[0]
    looks, distinct, fragments = photograph_signs(plane)
    if looks:
        raise InputError(
            f"slice {number} of the volume holds {distinct} different values in {fragments} connected pieces, like "
            f"gray values: use {mask_options(plane)}, {_THRESHOLD}, or {_AS_LABELS} if these are labels"
        )


def _not_finite() -> InputError:
    return InputError(f"the volume holds NaN or infinite values: use {_THRESHOLD} with a number, or replace them")


def _otsu(source: SlicesSource, objects: VolumeObjects) -> tuple[float, bool]:
    """Otsu's threshold, and whether all voxels have one value, which it is then; for it all floats are held."""
    slabs = (source.slices(first, count) for first, count in objects.limits())
    first = next(slabs)
    if first.dtype.kind == "f":
        values = np.concatenate([first, *slabs])
        if not np.isfinite(values).all():
            raise _not_finite()
        low, high = values.min().item(), values.max().item()
        return (low, True) if low == high else (otsu_threshold(values), False)
    distinct, counts = _counted(first)
    for slab in slabs:
        more, times = _counted(slab)
        both = np.concatenate([distinct, more])
        distinct, index = np.unique(both, return_inverse=True)
        total = np.zeros(len(distinct), np.int64)
        np.add.at(total, index, np.concatenate([counts, times]))
        counts = total
    if len(distinct) == 1:
        return int(distinct[0]), True
    offsets = distinct.astype(np.uint64) - distinct[0].astype(np.uint64)  # modulo 2^64, so right where it is signed
    return int(distinct[best_split(offsets, counts)]), False


def _counted(slab: NDArray[Any]) -> tuple[NDArray[Any], NDArray[np.int64]]:
    """Give the distinct integers of a slab, and how often each occurs."""
    slab = slab.view(np.uint8) if slab.dtype == bool else slab
    if slab.dtype.itemsize > _NARROW:
        distinct, counts = np.unique(slab, return_counts=True)
        return distinct, counts.astype(np.int64)
    least, kinds = int(np.iinfo(slab.dtype).min), 1 << 8 * slab.itemsize
    counts = np.zeros(kinds, np.int64)
    for plane in slab:
        counts += np.bincount(plane.reshape(-1).astype(np.int32) - least, minlength=kinds)
    present = np.flatnonzero(counts)
    return (present + least).astype(slab.dtype), counts[present]
