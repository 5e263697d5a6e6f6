"""Volumes in Zarr stores: arrays of three axes, and the images and labels of OME-Zarr; read chunk by chunk."""

from __future__ import annotations

from fractions import Fraction
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError
from vorotool.formats.io.limits import decoding
from vorotool.formats.volumes.source import VolumeSource
from vorotool.formats.zarr.metadata import read_metadata
from vorotool.formats.zarr.multiscales import Described
from vorotool.formats.zarr.reader import StoredArray, ZarrImage
from vorotool.numeric.length_units import ratio, unit_name
from vorotool.plain import plain
from vorotool.types.volumes.voxel_frame import VoxelGrid

_SPACE = ("z", "y", "x")


@plain
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
