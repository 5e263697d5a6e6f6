"""Writing PNG label images row by row: our own container around the deflate of zlib.

Rows of a tessellation repeat, so the Up filter leaves almost only zeros, and of zlib's strategies the
run-length one fits: measured (``tests/benchmarks/png_deflate.py``) it is as fast as level 1, about as small.
It also looks for nothing but runs, so that no hash table and no search depth, where builds of zlib differ,
decide its output: zlib 1.2.13 and zlib-ng gave the same bytes on x86-64, the one machine where it was tried.
Pillow holds the whole image, and takes 9 times as long on two processors (`tests/benchmarks/libraries.py png`).
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Callable, Iterable
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import LimitError
from vorotool.formats.io.arrays import blocks, check_fits
from vorotool.numeric.coordinates import current_written
from vorotool.numeric.parallel import in_order

SIGNATURE = b"\x89PNG\r\n\x1a\n"
LARGEST_SIDE = 2**31 - 1
_UP = 2
_ZLIB_HEADER = b"\x78\x01"
_EMPTY_LAST_BLOCK = b"\x03\x00"
_GREY, _RGB, _PALETTE, _RGBA = 0, 2, 3, 6


def write_png(
    out: BinaryIO,
    bands: Iterable[NDArray[Any]],
    shape: tuple[int, int],
    *,
    bit_depth: int = 16,
    palette: NDArray[np.uint8] | None = None,
    rgb: bool = False,
    has_alpha: bool = False,
) -> None:
    """Write a gray, palette or RGB PNG from bands of rows, in bounded memory."""
    height, width = shape
    if max(shape) > LARGEST_SIDE:
        raise LimitError(f"a PNG has at most {LARGEST_SIDE} pixels a side, not {width} x {height}: use .tif or .npy")
    bit_depth = 8 if rgb else bit_depth
    _check_kind(bit_depth, palette)
    out.write(SIGNATURE)
    color_type = (_RGBA if has_alpha else _RGB) if rgb else _GREY if palette is None else _PALETTE
    _write_chunk(out, b"IHDR", struct.pack(">IIBBBBB", width, height, bit_depth, color_type, 0, 0, 0))
    if palette is not None:
        _write_chunk(out, b"PLTE", np.ascontiguousarray(palette).tobytes())
        if has_alpha:
            _write_chunk(out, b"tRNS", b"\0")
    values = (height, (4 if has_alpha else 3) * width) if rgb else shape
    packed = blocks(
        bands,
        values,
        columns=values[1] if bit_depth >= 8 else -(-width * bit_depth // 8),
        dtype=">u2" if bit_depth == 16 else np.uint8,
        encode=_encoder(bit_depth, palette),
    )
    head, checksum = _ZLIB_HEADER, 1
    for data, adler, length in in_order(_deflated, packed, current_written().how.threads):
        _write_chunk(out, b"IDAT", head + data)
        head, checksum = b"", joined_adler32(checksum, adler, length)
    _write_chunk(out, b"IDAT", head + _EMPTY_LAST_BLOCK + struct.pack(">I", checksum))
    _write_chunk(out, b"IEND", b"")


def joined_adler32(first: int, second: int, length: int) -> int:
    """Checksum of two pieces of data from theirs; ``length`` is that of the second."""
    modulus = 65521
    a_before = (first & 0xFFFF) - 1
    a = (a_before + (second & 0xFFFF)) % modulus
    b = ((first >> 16) + (second >> 16) + length * a_before) % modulus
    return b << 16 | a


def _check_kind(bit_depth: int, palette: NDArray[np.uint8] | None) -> None:
    if bit_depth not in (1, 2, 4, 8, 16):
        raise ValueError(f"bit_depth is {bit_depth}: a PNG has 1, 2, 4, 8 or 16 bits per pixel")
    if palette is None:
        return
    if palette.dtype != np.uint8 or palette.ndim != 2 or palette.shape[1] != 3:
        raise ValueError(f"a palette must be (k, 3) uint8, but is {palette.shape} {palette.dtype}")
    if bit_depth > 8 or not 1 <= len(palette) <= 1 << bit_depth:
        raise ValueError(f"{len(palette)} colors do not make a palette of {bit_depth} bits")


def _encoder(bit_depth: int, palette: NDArray[np.uint8] | None) -> Callable[[NDArray[Any], NDArray[Any]], None]:
    """Return what checks rows and packs them: big-endian, several pixels a byte below 8 bits."""
    if palette is None:
        largest, target = (1 << bit_depth) - 1, f"a {bit_depth}-bit PNG"
    else:
        largest, target = len(palette) - 1, f"a palette of {len(palette)} colors"

    def encode(rows: NDArray[Any], out: NDArray[Any]) -> None:
        check_fits(rows, largest, target)
        if bit_depth >= 8:
            out[...] = rows
        elif bit_depth == 1:
            out[...] = np.packbits(rows.astype(bool), axis=1)
        else:
            _pack(rows, bit_depth, out)

    return encode


def _pack(rows: NDArray[Any], bit_depth: int, out: NDArray[Any]) -> None:
    """Put 2 or 4 pixels in each byte, the leftmost in the highest bits."""
    pixels = 8 // bit_depth
    padded = np.zeros((len(rows), out.shape[1] * pixels), np.uint8)
    padded[:, : rows.shape[1]] = rows
    out[...] = 0
    for place in range(pixels):
        out |= padded[:, place::pixels] << np.uint8(8 - bit_depth * (place + 1))


def _deflated(block: NDArray[Any]) -> tuple[bytes, int, int]:
    """Filter and compress a block: its piece of the stream, the filtered bytes' checksum and number."""
    data = block.view(np.uint8)
    filtered = np.empty((len(data) - 1, 1 + data.shape[1]), np.uint8)
    filtered[:, 0] = _UP
    np.subtract(data[1:], data[:-1], out=filtered[:, 1:])
    stream = zlib.compressobj(1, zlib.DEFLATED, -zlib.MAX_WBITS, 8, zlib.Z_RLE)
    piece = stream.compress(filtered.data) + stream.flush(zlib.Z_SYNC_FLUSH)
    return piece, zlib.adler32(filtered.data), filtered.size


def _write_chunk(out: BinaryIO, kind: bytes, data: bytes) -> None:
    out.write(struct.pack(">I", len(data)) + kind)
    out.write(data)
    out.write(struct.pack(">I", zlib.crc32(data, zlib.crc32(kind))))
