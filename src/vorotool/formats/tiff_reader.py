"""Reading one page of a TIFF with tifffile, or with Pillow where a compression needs its decoders."""

from __future__ import annotations

import io
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError
from vorotool.formats.limits import SourceLike, check_pixels, decoding

Resolution = tuple[float, float, str]

_UNITS = {2: "inch", 3: "cm"}
_PILLOW_MODES = {"1", "L", "P", "LA", "RGB", "RGBA", "I;16", "I;16B"}


def tiff_size(source: SourceLike, page: int | None) -> tuple[int, int]:
    """Read width and height of a page from its tags."""
    with opened_tiff(source.name, io.BytesIO(source.data)) as file:
        chosen = page_of(file, source.name, page)
        return int(chosen.imagewidth), int(chosen.imagelength)


def tiff_pages(source: SourceLike) -> int:
    """Count the pages."""
    with opened_tiff(source.name, io.BytesIO(source.data)) as file, decoding(source.name, "TIFF"):
        return len(file.pages)


def read_tiff(source: SourceLike, *, page: int | None, max_pixels: int) -> tuple[NDArray[Any], Resolution | None]:
    """Return the stored values, (H, W) or (H, W, C), and pixels a unit, where the file states them."""
    with opened_tiff(source.name, io.BytesIO(source.data)) as file:
        chosen = page_of(file, source.name, page)
        with decoding(source.name, "TIFF"):
            size = int(chosen.imagewidth), int(chosen.imagelength), int(chosen.imagedepth)
            resolution = resolution_of(file, chosen)
        check_pixels(source.name, size[0], size[1] * size[2], max_pixels)
        if size[2] != 1:
            raise InputError(f"{source.name} is a volume {size[2]} deep: save its slices as pages")
        check_segments(source.name, len(source.data), chosen)
        with decoding(source.name, "TIFF"):
            values = _values(source, chosen)
    if values.dtype.kind not in "buif" or not 2 <= values.ndim <= 3:
        raise InputError(
            f"{source.name} holds {values.dtype} of shape {values.shape}: an image of numbers was expected"
        )
    return values, resolution


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
        return tifffile.TiffFile(file)


def page_of(file: Any, name: str, page: int | None) -> Any:
    """Choose a page of a file; without a number there must be one only."""
    with decoding(name, "TIFF"):
        count = len(file.pages)
        if 0 <= (page or 0) < count and (page is not None or count == 1):
            return file.pages[page or 0]
    if page is None and count > 1:
        raise InputError(f"{name} has {count} pages: choose one with --page 0 to --page {count - 1}")
    raise InputError(f"{name} has {count} page{'s' * (count != 1)}, counted from 0: there is no --page {page or 0}")


def check_segments(name: str, size: int, page: Any) -> None:
    """Every strip or tile must lie in the file: tifffile would fill missing ones with zeros."""
    for index, (offset, length) in enumerate(zip(page.dataoffsets, page.databytecounts, strict=False)):
        if offset + length > size:
            raise InputError(
                f"{name} is cut off after {size} bytes: "
                f"{'tile' if page.is_tiled else 'strip'} {index} ends at byte {offset + length}"
            )


def _values(source: SourceLike, page: Any) -> NDArray[Any]:
    try:
        values = np.asarray(page.asarray())
    except ValueError as error:
        if "imagecodecs" not in str(error):
            raise
        return _by_pillow(source, page)
    if values.ndim == 3 and page.planarconfig == 2 and page.samplesperpixel == values.shape[0]:
        values = np.moveaxis(values, 0, 2)
    return values


def _by_pillow(source: SourceLike, page: Any) -> NDArray[Any]:
    from PIL.TiffImagePlugin import TiffImageFile

    compression = getattr(page.compression, "name", str(page.compression))
    with TiffImageFile(io.BytesIO(source.data)) as image:
        image.seek(page.index)
        if image.mode not in _PILLOW_MODES:
            raise InputError(
                f"{source.name} has {compression} compression of {page.dtype} pixels: "
                "install imagecodecs, or save it with deflate or no compression"
            )
        return np.asarray(image)


def resolution_of(file: Any, page: Any) -> Resolution | None:
    """Pixels a unit in x and y, and the unit, where the file states them."""
    if "XResolution" not in page.tags or "YResolution" not in page.tags:
        return None
    per_unit = [page.tags[name].value for name in ("XResolution", "YResolution")]
    if any(denominator == 0 or numerator == 0 for numerator, denominator in per_unit):
        return None
    unit = _UNITS.get(int(page.tags.valueof("ResolutionUnit", default=2)))
    if file.is_imagej:
        unit = (file.imagej_metadata or {}).get("unit") or unit
    if unit is None:
        return None
    x, y = (numerator / denominator for numerator, denominator in per_unit)
    return x, y, str(unit)
