"""Reading images: which format a file has, how large it is, and its values as they are stored."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import PurePath
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError
from vorotool.formats.images import npy, png_reader, pnm_reader, tiff_reader
from vorotool.formats.images.picture_reader import PICTURES, is_lossy, picture_format, read_picture_file
from vorotool.formats.io.limits import SourceLike, check_pixels
from vorotool.formats.io.npy_arrays import MAGIC, npy_header
from vorotool.formats.parsing.format_names import IMAGE_NAMES, known_input_format
from vorotool.geometry.pixel_frame import MAX_PIXELS
from vorotool.geometry.points.raster import Raster

_EXTENSIONS = {f".{name}": kind for name, kind in IMAGE_NAMES.items() if kind != "zarr"}
_MAGIC = (
    (b"\x89PNG", "png"),
    (b"II*\x00", "tiff"),
    (b"MM\x00*", "tiff"),
    (b"II+\x00", "tiff"),
    (b"MM\x00+", "tiff"),
    (MAGIC, "npy"),
)


def is_image(source: SourceLike) -> bool:
    """Tell whether a source is to be read as an image, by its content, else by its extension.

    An NPY file of shape (n, 2) is a list of points, and no image.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> is_image(SimpleNamespace(name="-", data=b"P5 1 1 255 x"))
    True
    >>> is_image(SimpleNamespace(name="a.csv", data=b"1,2"))
    False
    """
    kind = _by_content(source.data) or _EXTENSIONS.get(_extension(source))
    if kind == "npy":
        try:
            shape = npy_header(source).shape
        except InputError:
            return False
        return len(shape) in (2, 3) and shape[1] != 2
    return kind is not None


def image_format(source: SourceLike, input_format: str | None = None) -> str:
    """Return "png", "tiff", "pnm", "npy" or one of `PICTURES`: what is said, else the extension, else the content.

    Raises
    ------
    InputError
        If it is none of them, or the content is plainly another.
    UsageError
        If what the caller says is none of them.
    """
    found = _by_content(source.data)
    said = known_input_format(input_format, IMAGE_NAMES) or _EXTENSIONS.get(_extension(source)) or found or ""
    if said == "zarr":
        raise InputError(f"{source.name} is a file, but a Zarr store is a folder: leave out --input-format")
    if not source.data:
        raise InputError(f"{source.name} is empty: an image was expected")
    if said and found and found != said:
        raise InputError(f"{source.name} is no {said} file, it begins as {found}: use --input-format {found}")
    if said:
        return said
    raise InputError(
        f"{source.name} is no image that is read (PNG, TIFF, PGM, PBM, NPY, {', '.join(PICTURES.values())}): name it "
        "with --input-format, or convert it to PNG"
    )


def read_image(
    source: SourceLike,
    *,
    input_format: str | None = None,
    page: int | None = None,
    max_pixels: int = MAX_PIXELS,
    note: Callable[[str], None] | None = None,
) -> Raster:
    """Read the values of an image as they are stored: palette indices, labels, grey values are not rescaled.

    Two-valued images give 0 and 1 (in PBM, 1 is the ink). An opaque alpha channel is dropped; a colour image
    that is grey at every pixel becomes a single channel; any other keeps its channels, shape (H, W, C). JPEG, BMP, GIF,
    WebP and AVIF are read as they look: with their palettes applied, and upright.

    Parameters
    ----------
    source : SourceLike
        Name and content of the file.
    input_format : str, optional
        A name in `IMAGE_NAMES`; by default the extension decides, else the content.
    page : int, optional
        Which page of a TIFF, from 0; needed if it has several. Of an animation the first picture is the default.
    max_pixels : int
        The limit, compared with the header before memory is taken.
    note : callable, optional
        Told of an animation, of which one picture is read.

    Returns
    -------
    Raster
        Values of the stored integer or floating-point type (uint8 for two-valued images), and the resolution,
        if the file states one.

    Raises
    ------
    InputError
        If the file is damaged or cut off, or no such image, or has no such page.
    LimitError
        If it has more than ``max_pixels`` pixels.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> read_image(SimpleNamespace(name="a.pbm", data=b"P1 3 1 1 0 1")).values
    array([[1, 0, 1]], dtype=uint8)
    """
    kind = image_format(source, input_format)
    if kind == "tiff":
        values, resolution = tiff_reader.read_tiff(source, page=page, max_pixels=max_pixels)
        return Raster(_plain(values), resolution)
    if kind in PICTURES:
        seen = read_picture_file(source, kind, page=page, max_pixels=max_pixels, note=note)
        return Raster(_plain(seen), is_lossy=is_lossy(source.data, kind))
    _check_page(source, page)
    readers: dict[str, Callable[[SourceLike, int], NDArray[Any]]] = {
        "png": png_reader.read_png,
        "pnm": pnm_reader.read_pnm,
        "npy": _read_npy,
    }
    return Raster(_plain(readers[kind](source, max_pixels)))


def _extension(source: SourceLike) -> str:
    return PurePath(source.name).suffix.lower()


def _by_content(data: bytes) -> str | None:
    for magic, kind in _MAGIC:
        if data.startswith(magic):
            return kind
    return "pnm" if pnm_reader.looks_like_pnm(data) else picture_format(data)


def _check_page(source: SourceLike, page: int | None) -> None:
    if page not in (None, 0):
        raise InputError(f"{source.name} has a single page, so there is no --page {page}")


def _npy_shape(source: SourceLike) -> tuple[int, ...]:
    """Shape of an NPY image: (H, W), or (H, W, C) with at most 4 channels."""
    shape = npy_header(source).shape
    if len(shape) not in (2, 3) or (len(shape) == 3 and not 1 <= shape[2] <= 4):
        raise InputError(f"{source.name} has the shape {shape}: an image is (H, W), or (H, W, C) with C from 1 to 4")
    return shape


def _read_npy(source: SourceLike, max_pixels: int) -> NDArray[Any]:
    shape = _npy_shape(source)
    check_pixels(source.name, shape[1], shape[0], max_pixels)
    return npy.read_npy(source, max_items=4 * max_pixels, option="4 x --max-pixels")


def _plain(values: NDArray[Any]) -> NDArray[Any]:
    """Drop the channels that say nothing."""
    if values.dtype == np.bool_:
        values = values.astype(np.uint8)
    if values.ndim == 2:
        return values
    if values.shape[2] in (2, 4):
        opaque = 1.0 if values.dtype.kind == "f" else np.iinfo(values.dtype).max
        if not (values[:, :, -1] == opaque).all():
            return values
        values = values[:, :, :-1]
    first = values[:, :, :1]
    if (values == first).all():
        return np.ascontiguousarray(first[:, :, 0])
    return np.ascontiguousarray(values)
