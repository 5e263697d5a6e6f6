"""Masks without holes and without small objects: of images, and of volumes, which are read slab by slab."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from fractions import Fraction
from itertools import islice
from math import ceil, floor, inf
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.tessellation.raster_objects import (
    PartwiseObjects,
    check_objects,
    default_objects,
    numbered_components,
)
from vorotool.errors import InputError, UsageError, option
from vorotool.numeric.numbers import real_number, shown_number

if TYPE_CHECKING:
    from vorotool.types.volumes.volume import VoxelGrid
    from vorotool.typing import RealLike

_THRESHOLD = option("--threshold T", "threshold=T")
_AS_COMPONENTS = option("--seeds components", 'mode="components"')

Plane = NDArray[np.uint8]
"""(1, H, W) zeros and ones."""


class Cleaning(NamedTuple):
    """Which holes of a mask are filled, and which of its objects are then left out."""

    min_area: int = 0  # pixels, or voxels, that an object has at least
    # whether holes become foreground; a number is the most pixels, or voxels, of a hole that does
    fill_holes: bool | int = False

    def __bool__(self) -> bool:
        """Tell whether a mask can change."""
        return self.min_area > 1 or self.fill_holes is not False

    @property
    def option(self) -> str:
        """What the user calls it."""
        if self.fill_holes is not False:
            return option("--fill-holes", "fill_holes")
        return option("--min-area", "min_area")

    @classmethod
    def of(cls, min_area: RealLike | None, fill_holes: bool | RealLike) -> Cleaning:
        """Return it for areas of any kind of number."""
        least = 0 if min_area is None else ceil(_area(min_area, "min_area"))
        if isinstance(fill_holes, bool | np.bool_):
            return cls(least, bool(fill_holes))
        most = _area(fill_holes, "fill_holes")
        return cls(least, True if most == inf else floor(most))

    def require_mask(self, kind: str, what: str = "image") -> None:
        """Refuse objects that are labels."""
        if kind == "labels":
            raise InputError(
                f"the {what} holds labels, but {self.option} is for masks: use {_THRESHOLD} or {_AS_COMPONENTS}"
            )

    def fills(self, areas: NDArray[np.int64], reaches: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Return which components of the background are filled: number 0 is the foreground."""
        filled = ~reaches
        if self.fill_holes is not True:
            filled &= areas <= min(self.fill_holes, np.iinfo(np.int64).max)
        filled[0] = False
        return filled

    def keeps(self, areas: NDArray[np.int64]) -> NDArray[np.bool_]:
        """Return which components of the foreground stay: number 0 is the background."""
        kept: NDArray[np.bool_] = areas >= min(self.min_area, np.iinfo(np.int64).max)
        kept[0] = False
        return kept


def _area(value: Any, name: str) -> float | Fraction:
    number = real_number(value, name)
    if not number > 0 or (name == "min_area" and number == inf):
        raise UsageError(f"{name} is {shown_number(value)}: give an area above 0")
    return number


class CleanedMask(NamedTuple):
    """A mask, and what was done to it."""

    mask: NDArray[np.bool_]  # (H, W) bool array: the foreground
    filled: int  # pixels of holes that are foreground now
    removed: int  # objects that were left out, of how many
    objects: int  # objects that were left out, of how many


def cleaned_mask(
    mask: NDArray[np.bool_],
    cleaning: Cleaning,
    *,
    connectivity: int = 8,
    missing: NDArray[np.bool_] | None = None,
) -> CleanedMask:
    """Fill the holes of the objects of a mask, and then leave out the objects that are small."""
    check_objects(None, (), connectivity)
    made = mask
    if cleaning.fill_holes is not False:
        background = numbered_components(~mask, 12 - connectivity)
        made = mask | cleaning.fills(np.bincount(background.ravel()), reaches_border(background))[background]
    if missing is not None:
        made = made & ~missing
    filled = int(np.count_nonzero(made)) - int(np.count_nonzero(mask))
    if cleaning.min_area <= 1:
        return CleanedMask(made, filled, 0, 0)
    components = numbered_components(made, connectivity)
    kept = cleaning.keeps(np.bincount(components.ravel()))
    return CleanedMask(kept[components], filled, len(kept) - 1 - int(np.count_nonzero(kept)), len(kept) - 1)


def cleaned_values(
    values: NDArray[Any],
    cleaning: Cleaning,
    mode: str | None,
    *,
    connectivity: int = 8,
    missing: NDArray[np.bool_] | None = None,
) -> CleanedMask:
    """Clean values of which the nonzero ones are foreground."""
    cleaning.require_mask(mode if mode not in (None, "centroids") else default_objects(values))
    return cleaned_mask(values != 0, cleaning, connectivity=connectivity, missing=missing)


def reaches_border(components: NDArray[np.uint32]) -> NDArray[np.bool_]:
    """Return for each number whether a pixel at the border of the image has it."""
    reaches = np.zeros(int(components.max(initial=0)) + 1, dtype=bool)
    for side in (components[0], components[-1], components[:, 0], components[:, -1]):
        reaches[side] = True
    return reaches


class CleanedSlices:
    """The mask of a volume, whose holes are filled and whose small objects are left out; it is never held."""

    def __init__(self, objects: PartwiseObjects, cleaning: Cleaning) -> None:
        self._objects, self._corners = objects, objects.corners
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


def _read(objects: PartwiseObjects) -> Iterator[Plane]:
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
