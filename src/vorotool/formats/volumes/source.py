"""Volumes that are read some slices at a time: what all of them can do, and what is refused in any."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError, LimitError, option
from vorotool.types.volumes.voxel_grid import VoxelGrid

SLAB_BYTES = 2**26
"""Of the slices that are read at a time, where whole volumes are."""

_PAGES = option("--page N or --page all", "page=N")


class VolumeSource(Protocol):
    """A volume in a file, of which some slices are read at a time; it can be sent to other processes."""

    @property
    def name(self) -> str:
        """As the user wrote it, for messages."""

    @property
    def shape(self) -> tuple[int, int, int]:
        """Slices, rows and columns."""

    @property
    def dtype(self) -> np.dtype[Any]:
        """Of what is read: native, two-valued volumes are uint8."""

    @property
    def grid(self) -> VoxelGrid | None:
        """Sides of the voxels, where the file says them."""

    @property
    def note(self) -> str:
        """What the user should know of how it is read; empty if nothing."""

    @property
    def chunk_depth(self) -> int:
        """Slices that are stored together: slabs of so many are read without decoding anything twice."""

    def slices(self, first: int, count: int) -> NDArray[Any]:
        """Read some slices: (count, H, W). They may be a view of the file, which must not be written to."""


def check_voxels(name: str, shape: tuple[int, int, int], most: int) -> None:
    """Refuse a volume that is empty or larger than the limit, from its header alone."""
    depth, height, width = shape
    size = f"{width} x {height} x {depth}"
    if min(shape) < 1:
        raise InputError(f"{name} is {size} voxels: a volume needs at least 1 x 1 x 1")
    if depth * height * width > most:
        raise LimitError(
            f"{name} is {size} = {depth * height * width} voxels, more than {option(f'--max-pixels {most}')}: "
            "raise that if there is memory for it, or crop the volume"
        )


def refuse_axes(name: str, axes: Mapping[str, int]) -> None:
    """Refuse further axes of more than one step."""
    found = [f"{steps} {axis}" for axis, steps in axes.items() if steps != 1]
    if found:
        raise InputError(
            f"{name} has {' and '.join(found)}: a volume has one of each; save one of them alone (in ImageJ with "
            f"Image > Duplicate; rename a wrong axis with Image > Properties), or read single pages with {_PAGES}"
        )


def slabs_of(source: VolumeSource) -> Iterator[tuple[int, NDArray[Any]]]:
    """Read a volume slab by slab: the first slice of each, and the slab."""
    depth, height, width = source.shape
    whole = source.chunk_depth
    count = whole * max(1, SLAB_BYTES // (whole * height * width * source.dtype.itemsize))
    for first in range(0, depth, count):
        yield first, source.slices(first, min(count, depth - first))
