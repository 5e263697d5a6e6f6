"""Images in files that are read band by band, Zarr arrays and pages of TIFF files; and what headers say alone."""

from __future__ import annotations

import io
from collections.abc import Callable
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import AS_VOLUME, InputError, UsageError, VorotoolError
from vorotool.formats.images.image_grids import PageGrid, grid_of, missing_values, placed_grid, world_grid
from vorotool.formats.images.pictures import picture_pages
from vorotool.formats.images.png_writer import SIGNATURE
from vorotool.formats.images.reader import png_header, pnm_header
from vorotool.formats.images.tiff_layout import TiffLayout, decode_rows, is_decoded_here
from vorotool.formats.images.tiff_reader import count_pages, opened_tiff, page_grid, page_layout, page_of
from vorotool.formats.io.arrays import npy_header, plain_values
from vorotool.formats.io.descriptors import stream_kind
from vorotool.formats.io.sources import (
    GZIP,
    NPY,
    Source,
    StoredParts,
    check_pixels,
    decoding,
    explained_reading,
    read_source,
)
from vorotool.formats.opening import open_zarr
from vorotool.formats.recognition import PICTURES, TIFF_MAGIC, format_of, image_format
from vorotool.formats.zarr.reader import StoredArray, ZarrImage
from vorotool.formats.zarr.store import is_folder
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


_BYTES = 65_536
"""Within which the header of a PNG, PNM or NPY file ends."""


@frozen
class ImageHeader:
    """What the header of an image says."""

    width: int
    height: int
    grid: PixelGrid | None = None  # sides and places of the pixels
    note: str = ""  # what of the grid is not used


def image_header(name: str) -> ImageHeader:
    """Read the header of an image, of a TIFF that of its first page: the others are smaller copies of it, or masks."""
    if stream_kind(name) is not None:
        raise UsageError(f"{name} is a stream, whose header cannot be read by itself: name a file")
    array = open_zarr(name) if is_folder(name) else None
    if array is not None:
        height, width = array.shape
        return ImageHeader(width, height, array.grid)
    with explained_reading(name), Path(name).open("rb") as file:
        begin = file.read(_BYTES)
    if begin.startswith(TIFF_MAGIC):
        header = _of_tiff(name)
    else:
        width, height = _plain_size(Source(name, begin))
        header = ImageHeader(width, height, world_grid(name))
    check_pixels(name, header.width, header.height, header.width * header.height)
    return header


def _of_tiff(name: str) -> ImageHeader:
    with opened_tiff(name, str(Path(name).absolute())) as file:
        page = page_of(file, name, 0)
        with decoding(name, "TIFF"):
            about = grid_of(name, file, page)
            return ImageHeader(int(page.imagewidth), int(page.imagelength), placed_grid(name, about.grid), about.note)


def _plain_size(source: Source) -> tuple[int, int]:
    """Give width and height of an image whose header is a few bytes."""
    if source.data.startswith(SIGNATURE):
        png = png_header(source)
        return png.width, png.height
    if format_of(source.data) == "pnm":
        pnm = pnm_header(source)
        return pnm.width, pnm.height
    if source.data.startswith(NPY):
        shape = npy_header(source).shape
        if len(shape) >= 2:
            return shape[1], shape[0]
    raise InputError(
        f"{source.name} is not a TIFF, PNG, PNM, NPY or Zarr image, so its header cannot be read by itself: convert "
        f"it with gdal_translate {source.name} raster.tif"
    )


# ---- pages ---------------------------------------------------------------------------------------
_HEAD = 4096
"""Bytes that tell the format."""


def page_count(path: str) -> int | None:
    """Count the pages of a TIFF or the pictures of an animation; other images have one, and what is none has none."""
    try:
        if Path(path).is_dir():
            return 1
        with Path(path).open("rb") as file:
            head = file.read(_HEAD)
        source = read_source(path) if head.startswith(GZIP) else Source(path, head)
        kind = image_format(source)
        if kind == "tiff":
            content = io.BytesIO(source.data) if source.is_unpacked else path
            with opened_tiff(path, content) as tiff, decoding(path, "TIFF"):
                return max(1, count_pages(tiff))
        if kind in PICTURES and format_of(source.data) == kind:
            return picture_pages(source if source.is_unpacked else read_source(path), kind)
        return None if kind is None else 1
    except (OSError, ValueError, VorotoolError):
        return 1
