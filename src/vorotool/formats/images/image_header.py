"""Size, grid and number of pages of an image, from its header alone."""

from __future__ import annotations

import io
from pathlib import Path

from vorotool.errors import InputError, UsageError, VorotoolError
from vorotool.formats.images.image_grids import grid_of, placed_grid, world_grid
from vorotool.formats.images.pictures import picture_pages
from vorotool.formats.images.png_writer import SIGNATURE
from vorotool.formats.images.reader import png_header, pnm_header
from vorotool.formats.images.tiff_reader import count_pages, opened_tiff, page_of
from vorotool.formats.io.arrays import npy_header
from vorotool.formats.io.descriptors import stream_kind
from vorotool.formats.io.sources import GZIP, NPY, Source, check_pixels, decoding, explained_reading, read_source
from vorotool.formats.opening import open_zarr
from vorotool.formats.recognition import PICTURES, TIFF_MAGIC, format_of, image_format
from vorotool.formats.zarr.store import is_folder
from vorotool.frozen import frozen
from vorotool.types.pixels import PixelGrid

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
