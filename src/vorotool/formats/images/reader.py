"""Reading images: their values as they are stored; PNG, PBM, PGM and PPM files.

PNG is decoded by Pillow, and here what Pillow leaves out: limits, checksums, 16-bit colors, unscaled gray. Pillow, and
so imageio, spread the values of PBM, PGM and PPM over the full range: ``P2 3 1 9 1 5 9`` is read as 28, 142, 255, and
of colors of more than 8 bits the lower ones are lost (`tests/benchmarks/libraries.py pnm`).
"""

from __future__ import annotations

import io
import re
import struct
import zlib
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import AS_VOLUME, InputError, option
from vorotool.formats.images import tiff_reader
from vorotool.formats.images.image_grids import tiff_raster, world_grid
from vorotool.formats.images.pictures import is_lossy, read_picture_file
from vorotool.formats.images.png_writer import SIGNATURE
from vorotool.formats.io.arrays import npy_header, npy_values
from vorotool.formats.io.sources import Source, check_pixels, decoding
from vorotool.formats.parsing.reader_options import ReadOptions
from vorotool.formats.recognition import GAP, PICTURES
from vorotool.numeric.coordinates import MOST_AXES
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
        "png": read_png,
        "pnm": read_pnm,
        "npy": _read_npy,
    }
    values = _plain(readers[kind](source, max_pixels))
    if kind == "npy" and _may_be_points(values):
        shape = f"the integers in {source.name} have the shape {values.shape}"
        options.note(f"{shape} and are taken for an image; if they are points, save x and y alone, with shape (n, 2)")
    return Raster(values, world_grid(source.name))


def _may_be_points(values: NDArray[Any]) -> bool:
    """Whether an array has the sides of a list rather than those of an image of labels."""
    is_list = values.ndim == 2 and 1 < min(values.shape) <= MOST_AXES < max(values.shape)
    return is_list and values.dtype.kind in "iu" and bool(values.max() > 1)


def _check_page(source: Source, page: int | None) -> None:
    if page not in (None, 0):
        raise InputError(f"{source.name} has a single page: {option(f'--page {page}')} does not exist")


def _read_npy(source: Source, max_pixels: int) -> NDArray[Any]:
    """Return (H, W) values, or (H, W, C) with at most 4 channels."""
    header = npy_header(source)
    shape = header.shape
    if len(shape) not in (2, 3) or (len(shape) == 3 and not 1 <= shape[2] <= 4):
        as_volume = f"; read it as a volume with {AS_VOLUME}" if len(shape) == 3 else ""
        raise InputError(
            f"{source.name} has the shape {shape}: an image is (H, W), or (H, W, C) with C from 1 to 4{as_volume}"
        )
    check_pixels(source.name, shape[1], shape[0], max_pixels)
    return npy_values(source, header).astype(header.dtype.newbyteorder("="), order="C", copy=False)


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
    page, palette, is_inverted = None, None, False
    if source.format == "tiff":
        page, palette, is_inverted = tiff_reader.shown_colors(source, options.page)
    image = read_image(source, replace(options, page=page))
    if source.format == "png":
        palette = png_palette(source)
    pixels = _as_seen(image.values, palette)
    return ~pixels if is_inverted else pixels, image.grid


def _as_seen(values: NDArray[Any], palette: NDArray[np.uint8] | None) -> NDArray[np.uint8]:
    if palette is not None and values.ndim == 2 and values.max() < len(palette):
        return palette[values]
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


_CHANNELS = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}
_DEPTHS = {0: (1, 2, 4, 8, 16), 2: (8, 16), 3: (1, 2, 4, 8), 4: (8, 16), 6: (8, 16)}
_GREY_STEP = {2: 85, 4: 17}  # Pillow spreads 2 and 4-bit gray over 0..255 in these steps
_PALETTE, _GREY_ALPHA, _COLOR_ALPHA = 3, 4, 6
_MOST_EXPANSION = 1032  # deflate codes 258 bytes in 2 bits at best


class PngHeader(NamedTuple):
    """The fields of IHDR that matter here."""

    width: int
    height: int
    bit_depth: int
    color_type: int


def png_header(source: Source) -> PngHeader:
    """Read the header alone."""
    data = source.data
    if not data.startswith(SIGNATURE) or len(data) < 33 or data[12:16] != b"IHDR":
        raise InputError(f"{source.name} is not a PNG file, or is cut off in the header ({len(data)} bytes)")
    header = PngHeader(*struct.unpack(">IIBB", data[16:26]))
    if header.bit_depth not in _DEPTHS.get(header.color_type, ()):
        raise InputError(
            f"{source.name} has color type {header.color_type} with {header.bit_depth} bits, which PNG does not define"
        )
    return header


def read_png(source: Source, max_pixels: int) -> NDArray[Any]:
    """Return the stored values: (H, W) uint8 or uint16 for gray and palette indices, else (H, W, C)."""
    header = png_header(source)
    check_pixels(source.name, header.width, header.height, max_pixels)
    _check_chunks(source, header)
    with decoding(source.name, "PNG"):
        if header.bit_depth < 16 or header.color_type == 0:
            return _read_plain(source.data, header)
        if header.color_type == _GREY_ALPHA:
            return _read_gray_alpha_16(source.data)
        return _read_color_16(source.data)


def png_palette(source: Source) -> NDArray[np.uint8] | None:
    """Give the (256, 3) colors of the indices of a palette PNG, black beyond its own; None of another PNG."""
    from PIL.PngImagePlugin import PngImageFile

    header = png_header(source)
    if header.color_type != _PALETTE:
        return None
    _check_chunks(source, header)
    with decoding(source.name, "PNG"), PngImageFile(io.BytesIO(source.data)) as image:
        image.load()
        colors = np.frombuffer(bytes(image.getpalette("RGB") or []), np.uint8).reshape(-1, 3)
    palette = np.zeros((256, 3), np.uint8)
    palette[: len(colors)] = colors
    return palette


def _chunks(source: Source) -> Iterator[tuple[bytes, int]]:
    """Kind and length of each chunk; bounds and checksums are looked at on the way."""
    data, at = memoryview(source.data), len(SIGNATURE)
    while True:
        if at + 12 > len(data):
            raise InputError(f"{source.name} is cut off after {len(data)} bytes: it has no IEND chunk")
        length, kind = struct.unpack_from(">I4s", data, at)
        end = at + 12 + length
        if end > len(data):
            raise InputError(
                f"{source.name} is cut off after {len(data)} bytes: "
                f"chunk {kind.decode('latin-1')} at byte {at} ends at byte {end}"
            )
        if zlib.crc32(data[at + 4 : end - 4]) != int.from_bytes(data[end - 4 : end], "big"):
            raise InputError(
                f"{source.name} is damaged: chunk {kind.decode('latin-1')} at byte {at} has a wrong checksum"
            )
        if kind == b"IHDR" and at > len(SIGNATURE):  # Pillow would go by the last one, the checks by the first
            raise InputError(f"{source.name} is damaged: at byte {at} there is a second header")
        yield kind, length
        if kind == b"IEND":
            return
        at = end


def _check_chunks(source: Source, header: PngHeader) -> None:
    """Refuse damaged files, and those whose data cannot be a whole image, before memory is taken."""
    compressed = sum(length for kind, length in _chunks(source) if kind == b"IDAT")
    bits = header.bit_depth * _CHANNELS[header.color_type]
    needed = header.height * (header.width * bits // 8)
    if compressed * _MOST_EXPANSION < needed:
        raise InputError(
            f"{source.name} is damaged: its {compressed} bytes of image data cannot hold "
            f"{header.width} x {header.height} pixels"
        )


def _decoded(data: bytes, rawmode: str | None = None) -> NDArray[Any]:
    """Decode by Pillow's class itself: `Image.open` would judge the size, which is done already."""
    from PIL.PngImagePlugin import PngImageFile

    with PngImageFile(io.BytesIO(data)) as image:
        if rawmode is not None:
            tiles: Any = [(*tile[:3], rawmode) for tile in image.tile]
            image.tile = tiles
        image.load()
        return np.asarray(image)


def _read_plain(data: bytes, header: PngHeader) -> NDArray[Any]:
    values = _decoded(data)
    if header.bit_depth == 16:
        return values.astype(np.uint16, copy=False)
    if header.color_type == 0 and header.bit_depth in _GREY_STEP:
        return values // np.uint8(_GREY_STEP[header.bit_depth])
    return values


def _read_color_16(data: bytes) -> NDArray[np.uint16]:
    """Pillow keeps 8 of the 16 bits of a color: decode the high bytes, then the low ones."""
    mode = "RGB" if data[25] != _COLOR_ALPHA else "RGBA"
    high, low = _decoded(data, f"{mode};16B"), _decoded(data, f"{mode};16L")
    return _joined(high, low)


def _read_gray_alpha_16(data: bytes) -> NDArray[np.uint16]:
    """Gray and alpha of 16 bits are stored as 8-bit red, green, blue, alpha are: relabel the header."""
    header = data[12:24] + bytes([8, _COLOR_ALPHA]) + data[26:29]
    relabeled = data[:12] + header + struct.pack(">I", zlib.crc32(header)) + data[33:]
    values = _decoded(relabeled)
    return _joined(values[:, :, 0::2], values[:, :, 1::2])


def _joined(high: NDArray[Any], low: NDArray[Any]) -> NDArray[np.uint16]:
    return high.astype(np.uint16) << np.uint16(8) | low
