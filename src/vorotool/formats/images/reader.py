"""Reading images: their values as they are stored."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import AS_VOLUME, InputError, option
from vorotool.formats.images import npy, png_reader, pnm_reader, tiff_reader
from vorotool.formats.images.magic import PICTURES
from vorotool.formats.images.nodata import tiff_raster
from vorotool.formats.images.picture_reader import is_lossy, read_picture_file
from vorotool.formats.images.world_file import world_grid
from vorotool.formats.io.limits import check_pixels
from vorotool.formats.io.npy_arrays import npy_header
from vorotool.formats.io.sources import Source
from vorotool.formats.parsing.reader_options import ReadOptions
from vorotool.types.points.raster import Raster


def read_image(source: Source, options: ReadOptions) -> Raster:
    """Read the values of an image as they are stored: palette indices, labels, gray values are not rescaled."""
    kind, page, max_pixels = source.format, options.page, options.max_pixels
    if kind == "tiff":
        values, about = tiff_reader.read_tiff(source, page=page, max_pixels=max_pixels)
        return tiff_raster(source.name, _plain(values), about, options.note)
    if kind in PICTURES:
        seen = read_picture_file(source, kind, page=page, max_pixels=max_pixels, note=options.note)
        return Raster(_plain(seen), world_grid(source.name), is_lossy=is_lossy(source.data, kind))
    _check_page(source, page)
    readers: dict[str, Callable[[Source, int], NDArray[Any]]] = {
        "png": png_reader.read_png,
        "pnm": pnm_reader.read_pnm,
        "npy": _read_npy,
    }
    return Raster(_plain(readers[kind](source, max_pixels)), world_grid(source.name))


def _check_page(source: Source, page: int | None) -> None:
    if page not in (None, 0):
        raise InputError(f"{source.name} has a single page: {option(f'--page {page}')} does not exist")


def _npy_shape(source: Source) -> tuple[int, ...]:
    """Shape of an NPY image: (H, W), or (H, W, C) with at most 4 channels."""
    shape = npy_header(source).shape
    if len(shape) not in (2, 3) or (len(shape) == 3 and not 1 <= shape[2] <= 4):
        as_volume = f"; read it as a volume with {AS_VOLUME}" if len(shape) == 3 else ""
        raise InputError(
            f"{source.name} has the shape {shape}: an image is (H, W), or (H, W, C) with C from 1 to 4{as_volume}"
        )
    return shape


def _read_npy(source: Source, max_pixels: int) -> NDArray[Any]:
    shape = _npy_shape(source)
    check_pixels(source.name, shape[1], shape[0], max_pixels)
    return npy.read_npy(source, max_items=4 * max_pixels, option="4 x " + option("--max-pixels"))


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
