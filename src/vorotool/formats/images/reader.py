"""Reading images: their values as they are stored; PBM, PGM and PPM files.

Pillow, and so imageio, spread the values of the latter over the full range: ``P2 3 1 9 1 5 9`` is read as 28, 142, 255,
and of colors of more than 8 bits the lower ones are lost (`tests/benchmarks/libraries.py pnm`).
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import AS_VOLUME, InputError, option
from vorotool.formats.images import png_reader, tiff_reader
from vorotool.formats.images.image_grids import tiff_raster, world_grid
from vorotool.formats.images.pictures import is_lossy, read_picture_file
from vorotool.formats.io.arrays import npy_header, read_npy
from vorotool.formats.io.sources import Source, check_pixels
from vorotool.formats.opening import GAP, PICTURES
from vorotool.formats.parsing.reader_options import ReadOptions
from vorotool.types.images import Raster
from vorotool.types.pixels import PixelGrid


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
        "pnm": read_pnm,
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
    return read_npy(source, max_items=4 * max_pixels, option="4 x " + option("--max-pixels"))


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


# ---- as a screen shows them ----------------------------------------------------------------------
_WHITE = 255


def picture_and_grid(source: Source, options: ReadOptions) -> tuple[NDArray[np.uint8], PixelGrid | None]:
    """Read an image as a screen shows it, and what its file says of its pixels."""
    if source.format != "tiff" or tiff_reader.tiff_pages(source) == 1:
        options = replace(options, page=None)
    image = read_image(source, options)
    return _as_seen(source, image.values), image.grid


def _as_seen(source: Source, values: NDArray[Any]) -> NDArray[np.uint8]:
    palette = png_reader.png_palette(source) if source.format == "png" else None
    if palette is not None and values.ndim == 2:
        colors: NDArray[np.uint8] = palette[values]
        return colors
    channels = _spread(values[:, :, None] if values.ndim == 2 else values)
    if channels.shape[2] in (2, 4):
        alpha = channels[:, :, -1:].astype(np.uint16)
        channels = ((channels[:, :, :-1] * alpha + _WHITE * (_WHITE - alpha) + _WHITE // 2) // _WHITE).astype(np.uint8)
    return np.ascontiguousarray(np.broadcast_to(channels, (*channels.shape[:2], 3)))


def _spread(values: NDArray[Any]) -> NDArray[np.uint8]:
    """Values as 8 bits; an alpha channel runs from 0 to the largest value of its type."""
    if values.dtype == np.uint8 and not _is_two_valued(values):
        return values
    colors = slice(None, -1) if values.shape[2] in (2, 4) else slice(None)
    scaled = np.nan_to_num(values.astype(np.float64), nan=0.0, posinf=0.0, neginf=0.0)
    low, high = scaled[:, :, colors].min(), scaled[:, :, colors].max()
    spread = (scaled - low) * (_WHITE / (high - low)) if high > low else np.zeros_like(scaled)
    if values.shape[2] in (2, 4):
        opaque = 1.0 if values.dtype.kind == "f" else np.iinfo(values.dtype).max
        spread[:, :, -1] = np.clip(scaled[:, :, -1] / opaque, 0, 1) * _WHITE
    return np.rint(spread).astype(np.uint8)


def _is_two_valued(values: NDArray[np.uint8]) -> bool:
    return values.shape[2] == 1 and bool(((values == values.min()) | (values == values.max())).all())


_LARGEST_MAXIMUM = 65_535
_HEADERS = {
    True: re.compile(rb"P[14]" + GAP + rb"(\d{1,18})" + GAP + rb"(\d{1,18})()(?:\s|(?=#)|$)"),
    False: re.compile(rb"P[2356]" + (GAP + rb"(\d{1,18})") * 3 + rb"(?:\s|(?=#)|$)"),
}
_COMMENT = re.compile(rb"#[^\n\r]*")


class PnmHeader(NamedTuple):
    """Kind (1 to 6), size, largest value, and where the pixels begin."""

    kind: int
    width: int
    height: int
    maximum: int
    offset: int


def pnm_header(source: Source) -> PnmHeader:
    """Read the header alone."""
    start = source.data[:65_536]
    kind = start[1] - ord("0") if re.match(rb"P[1-6]", start) else 0
    match = _HEADERS[kind in (1, 4)].match(start)
    if match is None:
        raise InputError(
            f"{source.name} has no complete PBM, PGM or PPM header: P1 to P6, width, height, largest value"
        )
    maximum = int(match[3] or 1)
    if not 1 <= maximum <= _LARGEST_MAXIMUM:
        raise InputError(
            f"{source.name} states {maximum} as the largest value: it must be from 1 to {_LARGEST_MAXIMUM}"
        )
    return PnmHeader(kind, int(match[1]), int(match[2]), maximum, match.end())


def read_pnm(source: Source, max_pixels: int) -> NDArray[Any]:
    """Return (H, W), or (H, W, 3) values of type uint8, or uint16 where the largest value needs it."""
    header = pnm_header(source)
    check_pixels(source.name, header.width, header.height, max_pixels)
    channels = 3 if header.kind in (3, 6) else 1
    values = (_packed if header.kind > 3 else _written)(source, header, channels * header.width)
    above = np.flatnonzero(values > header.maximum)
    if above.size:
        row, column = divmod(int(above[0]) // channels, header.width)
        raise InputError(
            f"{source.name} has {values[above[0]]} in row {row}, column {column}, "
            f"above its largest value {header.maximum}"
        )
    values = values.astype(np.uint8 if header.maximum < 256 else np.uint16, copy=False)
    return values.reshape(header.height, header.width, *([3] if channels == 3 else []))


def _packed(source: Source, header: PnmHeader, columns: int) -> NDArray[Any]:
    """Values of bytes, of P4 of bits."""
    row = -(-columns // 8) if header.kind == 4 else columns
    dtype = np.dtype(np.uint8 if header.maximum < 256 else ">u2")
    needed, present = row * header.height * dtype.itemsize, len(source.data) - header.offset
    if present < needed:
        raise InputError(f"{source.name} is cut off: its pixels need {needed} bytes, it has {present}")
    values = np.frombuffer(source.data, dtype, row * header.height, header.offset)
    return (
        np.unpackbits(values.view(np.uint8).reshape(-1, row), axis=1, count=columns).ravel()
        if header.kind == 4
        else values
    )


def _written(source: Source, header: PnmHeader, columns: int) -> NDArray[Any]:
    """Values of text; of P1 digits, which need no space between them."""
    words = _COMMENT.sub(b" ", source.data[header.offset :]).split()
    if header.kind == 1:
        values: NDArray[Any] = np.frombuffer(b"".join(words), np.uint8) - np.uint8(ord("0"))
    else:
        bad = next((place for place, word in enumerate(words) if not word.isdigit() or len(word) > 18), None)
        if bad is not None:
            word = words[bad][:40].decode("latin-1")
            raise InputError(f"{source.name} has {word!r} as value {bad + 1}: it must be an integer")
        values = np.array(words, dtype="S18").astype(np.int64)
    needed = columns * header.height
    if len(values) < needed:
        raise InputError(f"{source.name} is cut off: it has {len(values)} of {needed} values")
    return values[:needed]
