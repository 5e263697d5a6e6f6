"""Reading one page of a TIFF: its tags by tifffile, its pixels as they are checked, pictures within it by Pillow."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import AS_VOLUME, InputError, LimitError, option
from vorotool.formats.images.jpeg_sizes import check_jpegs
from vorotool.formats.images.tiff_grid import PageGrid, grid_of
from vorotool.formats.images.tiff_layout import JPEGS, TiffLayout, layout_of
from vorotool.formats.images.tiff_segments import decode_image, is_decoded_here
from vorotool.formats.images.tiff_tags import check_tags
from vorotool.formats.io.limits import check_pixels, decoding, interruptible
from vorotool.formats.io.sources import Source

_MOST_CHANNELS = 4
_PILLOW_MODES = {"1", "L", "P", "LA", "RGB", "RGBA", "I;16", "I;16B"}


def tiff_pages(source: Source) -> int:
    """Count the pages."""
    with opened_tiff(source.name, io.BytesIO(source.data)) as file, decoding(source.name, "TIFF"):
        return count_pages(file)


def count_pages(file: Any) -> int:
    """Count the pages of a file; if all others are smaller copies or masks of the first, it has one."""
    count = len(file.pages)
    return 1 if count > 1 and all(_is_of_first(file.pages[number]) for number in range(1, count)) else count


_COPY, _MASK = 1, 4
"""Bits of the tag NewSubfileType."""


def _is_of_first(page: Any) -> bool:
    return bool(int(page.subfiletype) & (_COPY | _MASK))


def read_tiff(source: Source, *, page: int | None, max_pixels: int) -> tuple[NDArray[Any], PageGrid]:
    """Return the stored values, (H, W) or (H, W, C), and what the file says of its pixels."""
    with opened_tiff(source.name, io.BytesIO(source.data)) as file:
        chosen = page_of(file, source.name, page)
        layout = page_layout(source.name, len(source.data), chosen)
        check_pixels(source.name, layout.width, layout.height, max_pixels)
        if layout.width * layout.height * layout.samples > _MOST_CHANNELS * max_pixels:
            raise LimitError(
                f"{source.name} has {layout.samples} values per pixel: with {layout.width} x {layout.height} pixels "
                f"these are more than {_MOST_CHANNELS} x {option(f'--max-pixels {max_pixels}')}"
            )
        with decoding(source.name, "TIFF"):
            about = grid_of(source.name, file, chosen)
            if is_decoded_here(layout):
                values = decode_image(layout, source.data)
            else:
                values = interruptible(lambda: _by_library(source, chosen, layout))
    if values.dtype.kind not in "buif" or not 2 <= values.ndim <= 3:
        raise InputError(f"{source.name} holds {values.dtype} of shape {values.shape}: an image of numbers is expected")
    return values, about


def page_layout(name: str, size: int, page: Any) -> TiffLayout:
    """Check a page of a file of so many bytes: see `layout_of`."""
    with decoding(name, "TIFF"):
        return layout_of(name, size, page)


def opened_tiff(name: str, file: str | BinaryIO) -> Any:
    """Open a file by its path, or its content."""
    import logging

    import tifffile

    # what tifffile would log is either raised below or does not matter; without a handler it goes to standard
    # error
    logger = logging.getLogger("tifffile")
    if not logger.handlers:
        logger.addHandler(logging.NullHandler())
    with decoding(name, "TIFF"):
        if isinstance(file, str):
            with Path(file).open("rb") as tags:
                check_tags(name, tags)
        else:
            check_tags(name, file)
        return tifffile.TiffFile(file, is_ndpi=False)  # whose pages would be chained in another way


def page_of(file: Any, name: str, page: int | None) -> Any:
    """Choose a page of a file; without a number there must be one only."""
    with decoding(name, "TIFF"):
        count = len(file.pages)
        if 0 <= (page or 0) < count and (page is not None or count_pages(file) == 1):
            return file.pages[page or 0]
    if page is None and count > 1:
        one = option(f"--page 0 to --page {count - 1}, or --page all", f"page=0 to page={count - 1}")
        raise InputError(f"{name} has {count} pages: choose one with {one}, or read them as a volume with {AS_VOLUME}")
    if count == 0:
        raise InputError(f"{name} is damaged: it begins as a TIFF, but holds no image")
    raise InputError(
        f"{name} has {count} page{'s' * (count != 1)}, counted from 0: {option(f'--page {page}')} does not exist"
    )


def _by_library(source: Source, page: Any, layout: TiffLayout) -> NDArray[Any]:
    """Decode what other libraries know: JPEG, fax and further pictures within TIFF."""
    import tifffile

    if layout.compression in JPEGS:
        check_jpegs(layout, source.data)
    if layout.compression not in tifffile.TIFF.DECOMPRESSORS:
        return _by_pillow(source, page)
    if page.dtype is None:  # by its version the library refuses such a page, or reads it as an empty one
        raise InputError(
            f"{source.name} has {layout.bits} bits per sample, which is not supported: is the file damaged? If not, "
            "save it with samples of 8, 16 or 32 bits"
        )
    values = np.asarray(page.asarray())
    if values.ndim == 3 and page.planarconfig == 2 and page.samplesperpixel == values.shape[0]:
        values = np.moveaxis(values, 0, 2)
    return values


def _by_pillow(source: Source, page: Any) -> NDArray[Any]:
    from PIL.TiffImagePlugin import TiffImageFile

    compression = getattr(page.compression, "name", str(page.compression))
    with TiffImageFile(io.BytesIO(source.data)) as image:
        image.seek(page.index)
        if image.size != (page.imagewidth, page.imagelength):
            raise InputError(f"{source.name} is damaged: its size is stated twice, the second time as {image.size}")
        if image.mode not in _PILLOW_MODES:
            raise InputError(
                f"{source.name} has {compression} compression of {page.dtype} pixels: "
                "install imagecodecs, or save it with deflate or no compression"
            )
        return np.asarray(image)
