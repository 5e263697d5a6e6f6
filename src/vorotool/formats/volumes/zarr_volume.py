"""Volumes in Zarr stores: arrays of three axes, and the images and labels of OME-Zarr; read chunk by chunk."""

from __future__ import annotations

import os
from fractions import Fraction
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError
from vorotool.formats.images.band_reader import plain_values
from vorotool.formats.io.limits import decoding
from vorotool.formats.zarr.metadata import read_metadata
from vorotool.formats.zarr.multiscales import Described, label_images, largest_image
from vorotool.formats.zarr.reader import StoredArray
from vorotool.formats.zarr.store import is_array, is_group
from vorotool.numeric.length_units import ratio, unit_name
from vorotool.plain import plain
from vorotool.types.volumes.voxel_frame import VoxelGrid

_SPACE = ("z", "y", "x")


@plain
class ZarrVolume:
    """The slices of a Zarr array."""

    name: str  # as the user wrote it
    path: str  # absolute, for processes in other folders

    @cached_property
    def _image(self) -> Described | None:
        """The image of an OME-Zarr group."""
        return None if is_array(self.path) or not is_group(self.path) else largest_image(self.name, self.path)

    @cached_property
    def _array(self) -> StoredArray:
        image, path = self._image, self.path
        if image is not None:
            path = str(Path(path, *image.path.split("/")))
        elif not is_array(path):
            self._refuse()
        with decoding(self.name, "Zarr"):
            array = StoredArray(self.name, path)
            axes = self._axes(array, path)
        _check_axes(self.name, axes, array.shape)
        if array.dtype.kind not in "biuf":
            raise InputError(f"{self.name} holds {array.dtype}: a volume of numbers is expected")
        return array

    def _axes(self, array: StoredArray, path: str) -> tuple[str, ...]:
        """Names of the axes, as far as they are told; those of plain arrays tell which is which in messages."""
        if self._image is not None:
            if len(self._image.axes) != len(array.shape):
                raise InputError(
                    f"{self.name} has the axes {', '.join(self._image.axes)}, but its image has {len(array.shape)}"
                )
            return self._image.axes
        told = (read_metadata(path) or {}).get("dimension_names")
        if isinstance(told, list) and len(told) == len(array.shape):
            return tuple(str(name) if name else str(axis) for axis, name in enumerate(told))
        return tuple(map(str, range(len(array.shape))))

    def _refuse(self) -> None:
        """Say what is there instead of an array."""
        if is_group(self.path):
            example = f"{self.name.rstrip(os.sep)}/0"
            raise InputError(f"{self.name} is a Zarr group: name an array in it, such as {example}")
        try:
            read_metadata(self.path)
        except InputError as error:
            raise InputError(f"{self.name} holds no Zarr array: {error.marked}") from None
        raise InputError(f"{self.name} holds no Zarr array: the folder of an array has a zarr.json or .zarray")

    @property
    def shape(self) -> tuple[int, int, int]:
        """Slices, rows and columns."""
        depth, height, width = self._array.shape[-3:]
        return depth, height, width

    @property
    def dtype(self) -> np.dtype[Any]:
        """Of what is read."""
        kind = self._array.dtype
        return np.dtype(np.uint8) if kind.kind == "b" else kind

    @property
    def grid(self) -> VoxelGrid | None:
        """Sides of the voxels."""
        return None if self._image is None else _grid(self._image)

    @property
    def note(self) -> str:
        """Where else there are labels."""
        found = [] if self._image is None else label_images(self.path)
        return f"{self.name} has label images: {self.name.rstrip(os.sep)}/labels/{found[0]} names one" if found else ""

    @property
    def chunk_depth(self) -> int:
        """Slices of a chunk."""
        return min(self._array.metadata.chunks[-3], self.shape[0])

    def slices(self, first: int, count: int) -> NDArray[Any]:
        """Read some slices; bool becomes uint8."""
        with decoding(self.name, "Zarr"):
            array = self._array
            _, height, width = self.shape
            leading = [slice(0, 1)] * (len(array.shape) - 3)
            read = array.read((*leading, slice(first, first + count), slice(0, height), slice(0, width)))
            return plain_values(read.reshape(read.shape[-3:]))

    def __getstate__(self) -> dict[str, Any]:
        """Leave out what is open."""
        return {"name": self.name, "path": self.path}


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
