"""Volumes that are read some slices at a time: what all of them can do, what is refused in any, NPY and Zarr."""

from __future__ import annotations

import mmap
import os
import tempfile
import weakref
from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping
from fractions import Fraction
from functools import cached_property
from pathlib import Path
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError, LimitError, option
from vorotool.formats.io.arrays import NpyHeader, npy_header, npy_values, plain_values
from vorotool.formats.io.sources import Source, StoredParts, copy_stream, decoding
from vorotool.formats.zarr.metadata import read_metadata
from vorotool.formats.zarr.reader import Described, StoredArray, ZarrImage
from vorotool.frozen import frozen
from vorotool.numeric.length_units import ratio, unit_name
from vorotool.types.volumes.volume import VoxelGrid

SLAB_BYTES = 2**26
"""Of the slices that are read at a time, where whole volumes are."""

_PAGES = option("--page N or --page all", "page=N")


@frozen
class VolumeSource(StoredParts, ABC):
    """A volume in a file, of which some slices are read at a time."""

    spool: Spool | None = None  # keeps the file, where it is a temporary one

    @property
    @abstractmethod
    def shape(self) -> tuple[int, int, int]:
        """Slices, rows and columns."""

    @property
    @abstractmethod
    def stored_dtype(self) -> np.dtype[Any]:
        """Type of the values in the file."""

    @property
    def dtype(self) -> np.dtype[Any]:
        """Of what is read: native, two-valued volumes are uint8."""
        kind = self.stored_dtype
        return np.dtype(np.uint8) if kind.kind == "b" else kind.newbyteorder("=")

    @property
    def grid(self) -> VoxelGrid | None:
        """Sides of the voxels, where the file says them."""
        return None

    @property
    def note(self) -> str:
        """What the user should know of how it is read; empty if nothing."""
        return ""

    @property
    def chunk_depth(self) -> int:
        """Slices that are stored together: slabs of so many are read without decoding anything twice."""
        return 1

    @abstractmethod
    def slices(self, first: int, count: int) -> NDArray[Any]:
        """Read some slices: (count, H, W). They may be a view of the file, which must not be written to."""

    def __getstate__(self) -> dict[str, Any]:
        """Leave out what is open, and what removes the file."""
        return super().__getstate__() | {"spool": None}


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


# ---- NPY -----------------------------------------------------------------------------------------
@frozen
class NpyVolume(VolumeSource):
    """The slices of an array of three axes; in Fortran order each slice is scattered over the whole file."""

    @cached_property
    def _source(self) -> Source:
        return Source(self.name, mapped(self.path))

    @cached_property
    def _header(self) -> NpyHeader:
        header = npy_header(self._source)
        if len(header.shape) != 3:
            raise InputError(
                f"{self.name} has {len(header.shape)} axes, shape {header.shape}: a volume has three, slices, rows and "
                "columns; save a part of it that has three"
            )
        return header

    @cached_property
    def _values(self) -> NDArray[Any]:
        return npy_values(self._source, self._header)

    @property
    def shape(self) -> tuple[int, int, int]:
        """Slices, rows and columns."""
        depth, height, width = self._values.shape  # which says if the file ends before
        return depth, height, width

    @property
    def stored_dtype(self) -> np.dtype[Any]:
        """Type of the values in the file."""
        return self._header.dtype

    @property
    def note(self) -> str:
        """That the order of the axes costs time."""
        if not self._header.fortran_order or 1 in self.shape:
            return ""
        return f"{self.name} is in Fortran order, which is read slowly: save it in C order"

    def slices(self, first: int, count: int) -> NDArray[Any]:
        """Read some slices; bool becomes uint8."""
        return plain_values(np.ascontiguousarray(self._values[first : first + count]))


_SPACE = ("z", "y", "x")


@frozen
class ZarrVolume(ZarrImage, VolumeSource):
    """The slices of a Zarr array."""

    @cached_property
    def _array(self) -> StoredArray:
        array = self.opened()
        with decoding(self.name, "Zarr"):
            axes = self._axes(array)
        _check_axes(self.name, axes, array.shape)
        if array.dtype.kind not in "biuf":
            raise InputError(f"{self.name} holds {array.dtype}: a volume of numbers is expected")
        return array

    def _axes(self, array: StoredArray) -> tuple[str, ...]:
        """Names of the axes, as far as they are known; those of plain arrays tell which is which in messages."""
        if self.described is not None:
            if len(self.described.axes) != len(array.shape):
                raise InputError(
                    f"{self.name} has the axes {', '.join(self.described.axes)}, but its image has {len(array.shape)}"
                )
            return self.described.axes
        named = (read_metadata(self.path) or {}).get("dimension_names")
        if isinstance(named, list) and len(named) == len(array.shape):
            return tuple(str(name) if name else str(axis) for axis, name in enumerate(named))
        return tuple(map(str, range(len(array.shape))))

    @property
    def shape(self) -> tuple[int, int, int]:
        """Slices, rows and columns."""
        depth, height, width = self._array.shape[-3:]
        return depth, height, width

    @property
    def stored_dtype(self) -> np.dtype[Any]:
        """Type of the values in the file."""
        return self._array.dtype

    @property
    def grid(self) -> VoxelGrid | None:
        """Sides of the voxels."""
        return None if self.described is None else _grid(self.described)

    @property
    def chunk_depth(self) -> int:
        """Slices of a chunk."""
        return min(self._array.metadata.chunks[-3], self.shape[0])

    def slices(self, first: int, count: int) -> NDArray[Any]:
        """Read some slices; bool becomes uint8."""
        _, height, width = self.shape
        return self.read(self._array, slice(first, first + count), slice(0, height), slice(0, width))


def _check_axes(name: str, axes: tuple[str, ...], shape: tuple[int, ...]) -> None:
    """Refuse fewer axes than three, further ones of more than one step, and another order than z, y, x."""
    if len(shape) < 3:
        raise InputError(
            f"{name} has {len(shape)} axes, shape {shape}: a volume has three, slices, rows and columns; leave out "
            "what asks for a volume to read it as an image"
        )
    for axis, steps in zip(axes[:-3], shape[:-3], strict=True):
        if steps != 1:
            raise InputError(
                f"{name} has {steps} steps along the axis {axis}: a volume has z, y and x; save one of them alone, for "
                "example with the zarr package"
            )
    told = tuple(axis.lower() for axis in axes[-3:])
    if set(told) <= {"t", "c", *_SPACE} and told != _SPACE:
        raise InputError(
            f"{name} has the axes {', '.join(axes)}: a volume has z, y and x for the last ones; save it so, or leave "
            "out what asks for a volume"
        )


def _grid(image: Described) -> VoxelGrid | None:
    """Sides of the voxels; None where they are in units that cannot be compared, or nothing is said."""
    if len(image.axes) < 3:
        return None
    sides, units = image.scale[-3:], [str(unit) if unit else None for unit in image.units[-3:]]
    if not all(1e-100 < side < 1e100 for side in sides):
        return None
    unit = units[2]
    factors = [_ratio(each, unit) for each in units]
    if None in factors or (unit is None and set(sides) == {1}):
        return None
    depth, height, width = (side * (factor or 1) for side, factor in zip(sides, factors, strict=True))
    return VoxelGrid(width, height, depth, unit, "zarr")


def _ratio(unit: str | None, other: str | None) -> Fraction | None:
    if unit is None or other is None:
        return Fraction(1) if unit == other else None
    return ratio(unit_name(unit), unit_name(other))
