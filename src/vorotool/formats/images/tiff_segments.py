"""Decoding strips and tiles of TIFF files, none of them beyond what its pixels need."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError, LimitError
from vorotool.formats.compression import unpacking
from vorotool.formats.images.tiff_layout import TiffLayout
from vorotool.numeric.parallel import in_order

SPARE = 2**16
"""Bytes beyond the pixels that a compressed segment may have: some writers fill up a block."""

LARGEST_SEGMENT = 2**31
"""Bytes of a segment, which is decoded as a whole if it is compressed."""

_WORTH_THREADS = 2**20
"""Bytes of an image from which threads take less time than they cost."""

_PLAIN, _ZSTD = 1, 50000
_UNPACKERS: dict[int, unpacking.Unpacker] = {
    5: unpacking.unpack_lzw,
    8: unpacking.unpack_zlib,
    32946: unpacking.unpack_zlib,
    32773: unpacking.unpack_packbits,
    34925: unpacking.unpack_lzma,
    _ZSTD: unpacking.unpack_zstd,
}
_NONE, _DIFFERENCES, _FLOAT_DIFFERENCES = 1, 2, 3
_REVERSED = bytes(int(f"{byte:08b}"[::-1], 2) for byte in range(256))
_LOWEST_BIT_FIRST = 2


def is_decoded_here(layout: TiffLayout) -> bool:
    """Whether this module knows the compression and the form of the values."""
    dtype = layout.dtype
    if dtype is None or dtype.kind not in "buif":
        return False
    if layout.bits == 8 * dtype.itemsize:
        has_known_values = layout.predictor in (_NONE, _DIFFERENCES) + (_FLOAT_DIFFERENCES,) * (dtype.kind == "f")
    else:
        has_known_values = 1 <= layout.bits <= 16 and dtype.kind in "bu" and layout.predictor == _NONE
    is_known = layout.compression == _PLAIN or layout.compression in _UNPACKERS
    return has_known_values and is_known and (layout.compression != _ZSTD or unpacking.has_zstd())


def decode_image(layout: TiffLayout, data: bytes) -> NDArray[Any]:
    """Decode all of an image: (H, W), or (H, W, C) of several values a pixel."""
    assert layout.dtype is not None
    view, count = memoryview(data), layout.planes * layout.across * layout.down
    image = np.empty((layout.height, layout.width, layout.samples), layout.dtype)

    def put(index: int) -> None:
        plane, y, x, rows = layout.place(index)
        offset, count = int(layout.offsets[index]), int(layout.counts[index])
        channels = slice(plane, plane + 1) if layout.planes > 1 else slice(None)
        place = image[y : y + rows, x : x + layout.columns, channels]
        place[...] = decode_segment(layout, view[offset : offset + count], index)[:rows, : place.shape[1]]

    # segments that take long are decoded in this thread, which sees signals in between
    is_short = layout.rows * layout.row_bytes <= unpacking.PIECE
    for _ in in_order(put, range(count), 0 if is_short and image.nbytes >= _WORTH_THREADS else 1):
        pass
    return image[:, :, 0] if layout.samples == 1 else image


def decode_rows(
    layout: TiffLayout, read: Callable[[int, int], bytes], index: int, first: int, count: int
) -> NDArray[Any]:
    """Decode some rows of a segment: (count, columns, values). Of one that is not compressed no others are read."""
    offset, size = int(layout.offsets[index]), int(layout.counts[index])
    if layout.compression == _PLAIN and size:
        data = read(offset + first * layout.row_bytes, count * layout.row_bytes)
        return _values(layout, _in_order_of_bits(layout, data), count)
    return decode_segment(layout, read(offset, size), index)[first : first + count]


def decode_band(layout: TiffLayout, read: Callable[[int, int], bytes], first: int, count: int) -> NDArray[Any]:
    """Decode some rows of a page that has one value a pixel: (count, W)."""
    rows = np.empty((count, layout.width), layout.dtype)
    for band in range(first // layout.rows, -(-(first + count) // layout.rows)):
        for index in range(band * layout.across, (band + 1) * layout.across):
            _, y, x, height = layout.place(index)
            top, bottom = max(y, first), min(y + height, first + count)
            place = rows[top - first : bottom - first, x : x + layout.columns]
            place[...] = decode_rows(layout, read, index, top - y, bottom - top)[:, : place.shape[1], 0]
    return rows


def decode_segment(layout: TiffLayout, data: bytes | memoryview, index: int) -> NDArray[Any]:
    """Decode a segment: (rows, columns, values); a tile at the lower end may have only the rows of the image."""
    assert layout.dtype is not None
    rows = layout.place(index)[3]
    if not data:  # left out by its writer, which the layout tells from damage
        return np.full((rows, layout.columns, layout.values), layout.background, layout.dtype)
    full = layout.rows * layout.row_bytes
    if layout.compression != _PLAIN:
        if full > LARGEST_SEGMENT:
            raise LimitError(
                f"{layout.name} has {layout.kind}s of {full} bytes, which are decoded as a whole: save it in tiles"
            )
        data = _unpacked(layout, _in_order_of_bits(layout, data), index, full + SPARE)
    else:
        data = _in_order_of_bits(layout, data)
    if len(data) < rows * layout.row_bytes:
        raise InputError(
            f"{layout.name} is damaged: {layout.kind} {index} has {len(data)} bytes, "
            f"but its {rows} rows need {rows * layout.row_bytes}"
        )
    return _values(layout, data, min(layout.rows, len(data) // layout.row_bytes))


def _unpacked(layout: TiffLayout, data: bytes | memoryview, index: int, most: int) -> bytes:
    unpacked: bytes = _UNPACKERS[layout.compression](data, most)
    if len(unpacked) > most:
        raise InputError(
            f"{layout.name} is damaged: {layout.kind} {index} unpacks to more than {most} bytes, "
            f"of which its pixels need {layout.rows * layout.row_bytes}"
        )
    return unpacked


def _in_order_of_bits(layout: TiffLayout, data: bytes | memoryview) -> bytes | memoryview:
    return bytes(data).translate(_REVERSED) if layout.fill_order == _LOWEST_BIT_FIRST else data


def _values(layout: TiffLayout, data: bytes | memoryview, rows: int) -> NDArray[Any]:
    """Values of so many rows."""
    assert layout.dtype is not None
    packed = np.frombuffer(data, np.uint8, rows * layout.row_bytes).reshape(rows, layout.row_bytes)
    shape = (rows, layout.columns, layout.values)
    if layout.bits != 8 * layout.dtype.itemsize:
        return _from_bits(packed, shape, layout.bits).astype(layout.dtype)
    if layout.predictor == _FLOAT_DIFFERENCES:
        return _floats_of_differences(packed, shape, layout.dtype)
    stored = packed.view(layout.dtype.newbyteorder(layout.byte_order)).reshape(shape)
    values = stored.astype(layout.dtype.newbyteorder("="), copy=False)
    if layout.predictor == _DIFFERENCES:
        words = values.view(f"u{values.itemsize}").reshape(shape if layout.values > 1 else shape[:2])
        values = np.cumsum(words, axis=1, dtype=words.dtype).view(values.dtype).reshape(shape)
    return values


def _from_bits(packed: NDArray[np.uint8], shape: tuple[int, int, int], bits: int) -> NDArray[np.uint16]:
    """Values of 1 to 16 bits, which follow each other without a gap, the highest bit first."""
    rows, columns, values = shape
    each = np.unpackbits(packed, axis=1, count=columns * values * bits).reshape(rows, columns, values, bits)
    result = np.zeros(shape, np.uint16)
    for bit in range(bits):
        result <<= np.uint16(1)
        result |= each[..., bit]
    return result


def _floats_of_differences(
    packed: NDArray[np.uint8], shape: tuple[int, int, int], dtype: np.dtype[Any]
) -> NDArray[Any]:
    """Undo the predictor of floating-point values: of each row the highest bytes come first, as differences."""
    rows, columns, values = shape
    summed = np.cumsum(packed.reshape(rows, -1, values), axis=1, dtype=np.uint8)
    parts = summed.reshape(rows, dtype.itemsize, columns * values)
    if sys.byteorder == "little":
        parts = parts[:, ::-1]
    joined = np.ascontiguousarray(np.moveaxis(parts, 1, 2))
    return joined.view(dtype.newbyteorder("=")).reshape(shape)
