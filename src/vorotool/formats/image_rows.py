"""Images in files that are read band by band: Zarr arrays, and pages of TIFF files."""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError
from vorotool.formats.limits import check_pixels, decoding
from vorotool.formats.stores import is_array, is_group, is_store
from vorotool.formats.tiff_reader import Resolution, check_segments, opened_tiff, page_of, resolution_of
from vorotool.formats.zarr_arrays import zarr_module
from vorotool.geometry.frame import MAX_PIXELS
from vorotool.geometry.raster import Raster

_TIFF_MAGIC = (b"II*\x00", b"MM\x00*", b"II+\x00", b"MM\x00+")


@dataclass(frozen=True)
class ZarrRows:
    """The rows of a Zarr array.

    Parameters
    ----------
    name : str
        As the user wrote it.
    path : str
        Absolute, for processes in other folders.

    Raises
    ------
    InputError
        If it is no array of numbers with two axes, or is damaged.
    """

    name: str
    path: str
    resolution: Resolution | None = None

    @cached_property
    def _array(self) -> Any:
        zarr = zarr_module()
        if not is_array(self.path):
            if is_group(self.path):
                example = f"{self.name.rstrip(os.sep)}/0"
                raise InputError(f"{self.name} is a Zarr group: name an array in it, such as {example}")
            raise InputError(
                f"{self.name} holds no Zarr array: a zarr.json or .zarray that describes one must be in it"
            )
        with decoding(self.name, "Zarr"):
            array = zarr.open_array(self.path, mode="r")
            kind, shape = np.dtype(array.dtype), array.shape
        if len(shape) != 2:
            raise InputError(f"{self.name} has {len(shape)} axes, shape {shape}: an image has two, rows and columns")
        if kind.kind not in "biuf":
            raise InputError(f"{self.name} holds {kind}: an image of numbers was expected")
        check_pixels(self.name, shape[1], shape[0], shape[0] * shape[1])
        return array

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        height, width = self._array.shape
        return height, width

    def rows(self, first: int, count: int) -> NDArray[Any]:
        """Read some rows; bool becomes uint8."""
        with decoding(self.name, "Zarr"):
            return _plain(np.asarray(self._array[first : first + count]))

    def __getstate__(self) -> dict[str, Any]:
        """Leave out what is open."""
        return {"name": self.name, "path": self.path, "resolution": self.resolution}


@dataclass(frozen=True)
class TiffRows:
    """The rows of a page of a TIFF file with one value a pixel.

    Parameters
    ----------
    name, path
        As of `ZarrRows`.
    page : int, optional
        Which page.

    Raises
    ------
    InputError
        If the file is damaged or cut off, or no such image.
    """

    name: str
    path: str
    page: int | None = None

    @cached_property
    def _opened(self) -> tuple[Any, Resolution | None]:
        """The page, whose pixels are read from the file when they are asked for, and its resolution."""
        with opened_tiff(self.name, self.path) as file:
            page = page_of(file, self.name, self.page)
            check_segments(self.name, file.filehandle.size, page)
            with decoding(self.name, "TIFF"):
                return page, resolution_of(file, page)

    @property
    def _page(self) -> Any:
        return self._opened[0]

    @property
    def resolution(self) -> Resolution | None:
        """Pixels a unit."""
        return self._opened[1]

    @property
    def is_plain(self) -> bool:
        """Whether each pixel has one number, in a form that is decoded strip by strip."""
        page = self._page
        return bool(page.samplesperpixel == 1 and page.imagedepth == 1 and page.dtype is not None)

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        return int(self._page.imagelength), int(self._page.imagewidth)

    def rows(self, first: int, count: int) -> NDArray[Any]:
        """Read some rows; bool becomes uint8."""
        page = self._page
        rows = np.zeros((count, self.shape[1]), page.dtype)
        with decoding(self.name, "TIFF"), Path(self.path).open("rb") as file:
            for index in self._segments(first, count):
                self._put(rows, first, index, file)
        return _plain(rows)

    def _segments(self, first: int, count: int) -> Iterator[int]:
        """Numbers of the strips or tiles that have some of these rows."""
        page = self._page
        height, across = page.rowsperstrip, 1
        if page.is_tiled:
            height, across = page.tilelength, -(-self.shape[1] // page.tilewidth)
        for band in range(first // height, -(-(first + count) // height)):
            yield from range(band * across, (band + 1) * across)

    def _put(self, rows: NDArray[Any], first: int, index: int, file: BinaryIO) -> None:
        """Decode a strip or a tile, and put what is of these rows in its place; one without bytes is zeros."""
        page = self._page
        length = page.databytecounts[index]
        if not length:
            return
        file.seek(page.dataoffsets[index])
        tables = {} if page.jpegtables is None else {"jpegtables": page.jpegtables}
        segment, (_, _, y, x, _), shape = page.decode(file.read(length), index, **tables)
        top, bottom = max(y, first), min(y + shape[1], first + len(rows), self.shape[0])
        right = min(x + shape[2], self.shape[1])
        rows[top - first : bottom - first, x:right] = segment[0, top - y : bottom - y, : right - x, 0]

    def __getstate__(self) -> dict[str, Any]:
        """Leave out what is open."""
        return {"name": self.name, "path": self.path, "page": self.page}


def open_rows(
    path: str | os.PathLike[str], *, input_format: str | None = None, page: int | None = None
) -> ZarrRows | TiffRows | None:
    """Open an image that can be read band by band; None if it is none.

    Parameters
    ----------
    path : str or path
        Of a Zarr store or of a file.
    input_format : str, optional
        What the caller says that it is.
    page : int, optional
        Of a TIFF.

    Raises
    ------
    InputError
        If it is one, but damaged.

    Examples
    --------
    >>> open_rows("data/dots.csv")
    """
    name = os.fspath(path)
    if is_zarr(name, input_format):
        if page not in (None, 0):
            raise InputError(f"{name} has a single page, so there is no --page {page}")
        return ZarrRows(name, str(Path(name).absolute()))
    if input_format not in (None, "tiff") or not _begins_as_tiff(name):
        return None
    rows = TiffRows(name, str(Path(name).absolute()), page)
    return rows if rows.is_plain else None


def is_zarr(name: str, input_format: str | None = None) -> bool:
    """Whether an input is, or should be, a Zarr array: a folder that holds one, or is named or said to."""
    if input_format not in (None, "zarr") or not Path(name).is_dir():
        return False
    return input_format == "zarr" or is_store(name) or name.rstrip(os.sep).lower().endswith(".zarr")


def read_rows(rows: ZarrRows | TiffRows, *, max_pixels: int = MAX_PIXELS) -> Raster:
    """Read a whole image.

    Raises
    ------
    LimitError
        If it has more than ``max_pixels`` pixels.
    """
    height, width = rows.shape
    check_pixels(rows.name, width, height, max_pixels)
    return Raster(rows.rows(0, height), rows.resolution)


def _plain(values: NDArray[Any]) -> NDArray[Any]:
    """Native bytes; two-valued images are 0 and 1."""
    if values.dtype == np.bool_:
        return values.astype(np.uint8)
    return values.astype(values.dtype.newbyteorder("="), copy=False)


def _begins_as_tiff(name: str) -> bool:
    try:
        with Path(name).open("rb") as file:
            return file.read(4) in _TIFF_MAGIC
    except (OSError, ValueError):  # who reads it says why
        return False
