"""Volumes that are read some slices at a time: what all of them can do, and what is refused in any."""

from __future__ import annotations

import mmap
import os
import tempfile
import weakref
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any, Protocol, cast

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError, LimitError, option
from vorotool.formats.io.sources import copy_stream
from vorotool.types.volumes.voxel_frame import VoxelGrid

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


def mapped(path: str) -> bytes:
    """Give the content of a file, as something that can be sliced like bytes."""
    with Path(path).open("rb") as file:
        return cast("bytes", memoryview(mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)))


class Spool:
    """A temporary file with all that comes through a stream; it is removed with this object, or when Python ends."""

    def __init__(self, name: str) -> None:
        descriptor, self.path = tempfile.mkstemp(prefix="vorotool-")
        self._remove = weakref.finalize(self, _remove, self.path)
        with os.fdopen(descriptor, "wb") as out:
            copy_stream(name, out)


def _remove(path: str) -> None:
    Path(path).unlink(missing_ok=True)


def checked_slabs(slabs: Iterable[NDArray[Any]], shape: tuple[int, int, int]) -> Iterator[NDArray[Any]]:
    """Pass on slabs of shape (slices, H, W), and see that they are D slices together."""
    depth, height, width = shape
    seen = 0
    for item in slabs:
        slab = np.asarray(item)
        if slab.ndim != 3 or slab.shape[1:] != (height, width):
            raise ValueError(f"a slab has shape {slab.shape}: it must be (slices, {height}, {width})")
        seen += len(slab)
        if seen > depth:
            break
        yield slab
    if seen != depth:
        raise ValueError(f"the slabs have {'more than ' * (seen > depth)}{min(seen, depth)} slices, not {depth}")
