"""Images in files that are read band by band: Zarr arrays, and pages of TIFF files."""

from __future__ import annotations

import os
from collections.abc import Callable
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import AS_VOLUME, InputError
from vorotool.formats.images.tiff_grid import PageGrid, grid_of, missing_values, placed_grid
from vorotool.formats.images.tiff_layout import TiffLayout, decode_band, is_decoded_here
from vorotool.formats.images.tiff_reader import opened_tiff, page_layout, page_of
from vorotool.formats.io.limits import check_pixels, decoding
from vorotool.formats.zarr.metadata import read_metadata
from vorotool.formats.zarr.multiscales import Level, full_size, label_images
from vorotool.formats.zarr.reader import StoredArray
from vorotool.formats.zarr.store import is_array, is_group
from vorotool.plain import plain
from vorotool.types.pixel_frame import MAX_PIXELS
from vorotool.types.pixel_grid import PixelGrid
from vorotool.types.points.raster import Raster


@plain
class ZarrRows:
    """The rows of a Zarr array."""

    name: str  # as the user wrote it
    path: str  # absolute, for processes in other folders

    @cached_property
    def _level(self) -> Level | None:
        """The image of an OME-Zarr group."""
        return None if is_array(self.path) or not is_group(self.path) else full_size(self.name, self.path)

    @property
    def grid(self) -> PixelGrid | None:
        """Sides of the pixels."""
        return None if self._level is None else self._level.grid

    @property
    def note(self) -> str:
        """Where else there are labels."""
        found = [] if self._level is None else label_images(self.path)
        return f"{self.name} has label images: {self.name.rstrip(os.sep)}/labels/{found[0]} names one" if found else ""

    @cached_property
    def _array(self) -> StoredArray:
        level = self._level
        if level is not None:
            return self._image(str(Path(self.path, *level.path.split("/"))), level.axes)
        if not is_array(self.path):
            if is_group(self.path):
                example = f"{self.name.rstrip(os.sep)}/0"
                raise InputError(f"{self.name} is a Zarr group: name an array in it, such as {example}")
            try:
                read_metadata(self.path)
            except InputError as error:
                raise InputError(f"{self.name} holds no Zarr array: {error}") from None
            raise InputError(f"{self.name} holds no Zarr array: the folder of an array has a zarr.json or .zarray")
        return self._image(self.path, None)

    def _image(self, path: str, axes: tuple[str, ...] | None) -> StoredArray:
        """Open an array that has two axes, or more of one step each which are named."""
        with decoding(self.name, "Zarr"):
            array = StoredArray(self.name, path)
        shape, kind = array.shape, array.dtype
        if axes is not None and len(axes) == len(shape):
            for axis, steps in zip(axes[:-2], shape[:-2], strict=True):
                if steps != 1:
                    raise InputError(
                        f"{self.name} has {steps} steps along the axis {axis}: an image has one; save one of them alone"
                        + (f", or read it as a volume with {AS_VOLUME}" if axis == "z" else "")
                    )
            shape = shape[-2:]
        if len(shape) != 2:
            as_volume = f"; read it as a volume with {AS_VOLUME}" if len(shape) == 3 else ""
            raise InputError(
                f"{self.name} has {len(shape)} axes, shape {shape}: an image has two, rows and columns{as_volume}"
            )
        if kind.kind not in "biuf":
            raise InputError(f"{self.name} holds {kind}: an image of numbers is expected")
        check_pixels(self.name, shape[1], shape[0], shape[0] * shape[1])
        return array

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        height, width = self._array.shape[-2:]
        return height, width

    def rows(self, first: int, count: int) -> NDArray[Any]:
        """Read some rows; bool becomes uint8."""
        with decoding(self.name, "Zarr"):
            array = self._array
            plane = (slice(first, first + count), slice(0, self.shape[1]))
            read = array.read((*[slice(0, 1)] * (len(array.shape) - 2), *plane))
            return plain_values(read.reshape(read.shape[-2:]))

    def __getstate__(self) -> dict[str, Any]:
        """Leave out what is open."""
        return {"name": self.name, "path": self.path}


@plain
class TiffRows:
    """The rows of a page of a TIFF file with one value a pixel."""

    name: str  # as of `ZarrRows`
    path: str  # as of `ZarrRows`
    page: int | None = None

    @cached_property
    def _opened(self) -> tuple[TiffLayout, PageGrid]:
        """Where the pixels of the page are, which are read when they are asked for, and what is said of them."""
        with opened_tiff(self.name, self.path) as file:
            page = page_of(file, self.name, self.page)
            layout = page_layout(self.name, file.filehandle.size, page)
            with decoding(self.name, "TIFF"):
                return layout, grid_of(self.name, file, page)

    @property
    def _layout(self) -> TiffLayout:
        return self._opened[0]

    @property
    def grid(self) -> PixelGrid | None:
        """Sides and places of the pixels."""
        return placed_grid(self.name, self._opened[1].grid)

    @property
    def note(self) -> str:
        """What of its grid is not used."""
        return self._opened[1].note

    @property
    def is_plain(self) -> bool:
        """Whether each pixel has one number, in a form that is decoded strip by strip."""
        return self._layout.samples == 1 and is_decoded_here(self._layout)

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        return self._layout.height, self._layout.width

    def rows(self, first: int, count: int) -> NDArray[Any]:
        """Read some rows; bool becomes uint8, and what has no value is masked."""
        layout = self._layout
        with decoding(self.name, "TIFF"), Path(self.path).open("rb") as file:

            def read(offset: int, size: int) -> bytes:
                file.seek(offset)
                return file.read(size)

            rows = decode_band(layout, read, first, count)
        values = plain_values(rows)
        missing = missing_values(values, self._opened[1].nodata)
        return values if missing is None else np.ma.MaskedArray(values, missing)

    def __getstate__(self) -> dict[str, Any]:
        """Leave out what is open."""
        return {"name": self.name, "path": self.path, "page": self.page}


def read_rows(
    rows: ZarrRows | TiffRows, *, max_pixels: int = MAX_PIXELS, note: Callable[[str], None] | None = None
) -> Raster:
    """Read a whole image, and say what of it is not used."""
    height, width = rows.shape
    check_pixels(rows.name, width, height, max_pixels)
    if note is not None and rows.note:
        note(rows.note)
    return Raster(rows.rows(0, height), rows.grid)


def plain_values(values: NDArray[Any]) -> NDArray[Any]:
    """Native bytes; two-valued images are 0 and 1."""
    if values.dtype == np.bool_:
        return values.astype(np.uint8)
    return values.astype(values.dtype.newbyteorder("="), copy=False)
