"""Reading PNG with Pillow, and what Pillow leaves out: limits, checksums, 16-bit colors, unscaled gray."""

from __future__ import annotations

import io
import struct
import zlib
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError
from vorotool.formats.images.png_writer import SIGNATURE
from vorotool.formats.io.sources import Source, check_pixels, decoding

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
    joined: NDArray[np.uint16] = high.astype(np.uint16) << np.uint16(8) | low
    return joined
