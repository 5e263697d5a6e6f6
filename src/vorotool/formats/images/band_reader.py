"""Images in files that are read band by band: Zarr arrays, and pages of TIFF files."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import AS_VOLUME, InputError
from vorotool.formats.images.image_grids import PageGrid, missing_values, placed_grid
from vorotool.formats.images.tiff_layout import TiffLayout, decode_rows, is_decoded_here
from vorotool.formats.images.tiff_reader import opened_tiff, page_grid, page_layout, page_of
from vorotool.formats.io.arrays import plain_values
from vorotool.formats.io.sources import StoredParts, check_pixels, decoding
from vorotool.formats.zarr.reader import StoredArray, ZarrImage
from vorotool.frozen import frozen
from vorotool.numeric.checks import MAX_PIXELS
from vorotool.numeric.length_units import ratio
from vorotool.types.images import Raster
from vorotool.types.pixels import PixelGrid


@frozen
class ZarrRows(ZarrImage):
    """The rows of a Zarr array."""

    @property
    def grid(self) -> PixelGrid | None:
        """Sides of the pixels, if there is a unit."""
        if self.described is None:
            return None
        height, width = self.described.scale[-2:]
        other, unit = (str(each) if each else None for each in self.described.units[-2:])
        factor = None if unit is None or other is None else ratio(other, unit)
        if unit is None or factor is None or not all(1e-100 < side < 1e100 for side in (height, width)):
            return None
        return PixelGrid(width, height * factor, unit, "ome")

    @cached_property
    def _array(self) -> StoredArray:
        """Two axes, or more of one step each which are named."""
        axes = None if self.described is None else self.described.axes
        if axes is not None and axes[-2:] != ("y", "x"):
            raise InputError(f"{self.name} has the axes {', '.join(axes)}: an image has y and x for the last ones")
        array = self.opened()
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
        return self.read(self._array, slice(first, first + count), slice(0, self.shape[1]))


@frozen
class TiffRows(StoredParts):
    """The rows of a page of a TIFF file with one value a pixel."""

    page: int | None = None

    @cached_property
    def _opened(self) -> tuple[TiffLayout, PageGrid]:
        """Where the pixels of the page are, which are read when they are asked for, and what is said of them."""
        with opened_tiff(self.name, self.path) as file:
            page = page_of(file, self.name, self.page)
            layout = page_layout(self.name, file.filehandle.size, page)
            with decoding(self.name, "TIFF"):
                return layout, page_grid(self.name, file, page)

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

            rows = decode_rows(layout, read, first, count)[:, :, 0]
        values = plain_values(rows)
        missing = missing_values(values, self._opened[1].nodata)
        return values if missing is None else np.ma.MaskedArray(values, missing)


def read_rows(
    rows: ZarrRows | TiffRows, *, max_pixels: int = MAX_PIXELS, note: Callable[[str], None] | None = None
) -> Raster:
    """Read a whole image, and say what of it is not used."""
    height, width = rows.shape
    check_pixels(rows.name, width, height, max_pixels)
    if note is not None and rows.note:
        note(rows.note)
    return Raster(rows.rows(0, height), rows.grid)
