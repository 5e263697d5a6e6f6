"""How the pixels of a TIFF page lie in its strips or tiles: all that its tags say is checked before any is decoded."""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import replace
from itertools import product
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError, LimitError
from vorotool.formats.io import unpacking
from vorotool.frozen import frozen
from vorotool.numeric.parallel import in_order

LARGEST_TILE = 2**26
"""Bytes of a tile; only a larger image may have larger ones."""

_NUMBERS = {
    "imagewidth": "ImageWidth",
    "imagelength": "ImageLength",
    "imagedepth": "ImageDepth",
    "samplesperpixel": "SamplesPerPixel",
    "planarconfig": "PlanarConfiguration",
    "compression": "Compression",
    "predictor": "Predictor",
    "fillorder": "FillOrder",
    "rowsperstrip": "RowsPerStrip",
}
_TILE_NUMBERS = {"tilewidth": "TileWidth", "tilelength": "TileLength", "tiledepth": "TileDepth"}
_MOST_EXPANSION = {5: 2731, 8: 1032, 32946: 1032, 32773: 64}
"""By LZW (4096 bytes for 12 bits), deflate (258 bytes for 2 bits) and PackBits (128 for 2 bytes)."""
_PLAIN, _SEPARATE = 1, 2

JPEGS = {6, 7, 33007, 34892}
"""Compressions that are JPEG."""


@frozen
class TiffLayout:
    """Strips or tiles of a page, all of which are in the file."""

    name: str  # of the file, for messages
    width: int
    height: int
    samples: int  # values a pixel
    planes: int  # 1, or `samples` where each has its own segments
    bits: int  # of a value; 0 where values differ in that
    dtype: np.dtype[Any] | None  # of the values, native; None if it is none that numpy has
    byte_order: Literal["<", ">"]
    compression: int  # as in the tags
    predictor: int  # as in the tags
    fill_order: int  # as in the tags
    is_tiled: bool  # tiles, not strips
    rows: int  # of a segment: a strip or a tile
    columns: int  # of a segment: a strip or a tile
    # (n,) int64 arrays: where the segments are in the file, in order of planes, rows and columns; one that has
    # neither offset nor bytes is all background: GDAL leaves out what is empty
    offsets: NDArray[np.int64]
    # (n,) int64 arrays: where the segments are in the file, in order of planes, rows and columns; one that has
    # neither offset nor bytes is all background: GDAL leaves out what is empty
    counts: NDArray[np.int64]
    background: float  # of what is left out

    @property
    def kind(self) -> str:
        """The name of a segment: strip or tile."""
        return "tile" if self.is_tiled else "strip"

    @property
    def across(self) -> int:
        """Segments beside each other."""
        return -(-self.width // self.columns)

    @property
    def down(self) -> int:
        """Segments below each other."""
        return -(-self.height // self.rows)

    @property
    def values(self) -> int:
        """Values a pixel of a segment."""
        return self.samples // self.planes

    @property
    def row_bytes(self) -> int:
        """Bytes of a row of a segment; rows begin at whole bytes."""
        return -(-self.columns * self.values * self.bits // 8)

    @property
    def is_one_array(self) -> bool:
        """Whether all values stand in one strip as an array has them, row after row."""
        is_plain = self.compression == _PLAIN and self.predictor == 1 and self.fill_order == 1
        has_all = len(self.offsets) == 1 and self.counts[0] > 0 and not self.is_tiled and self.rows == self.height
        return is_plain and has_all and self.dtype is not None and self.bits == 8 * self.dtype.itemsize

    def place(self, index: int) -> tuple[int, int, int, int]:
        """Plane, first row, first column of a segment, and how many of its rows are in the image."""
        plane, within = divmod(index, self.across * self.down)
        row, column = divmod(within, self.across)
        return plane, row * self.rows, column * self.columns, min(self.rows, self.height - row * self.rows)


def layout_of(name: str, size: int, page: Any) -> TiffLayout:
    """Check the tags of a page of a file of so many bytes."""
    is_tiled = bool(page.is_tiled)
    numbers = _checked_numbers(name, page, is_tiled)
    width, height, samples = (numbers[key] for key in ("imagewidth", "imagelength", "samplesperpixel"))
    if numbers["imagedepth"] != 1 or (is_tiled and numbers["tiledepth"] != 1):
        raise InputError(f"{name} is a volume {numbers['imagedepth']} deep: save its slices as pages")
    layout = TiffLayout(
        name,
        width,
        height,
        samples,
        planes=samples if numbers["planarconfig"] == _SEPARATE else 1,
        bits=page.bitspersample if isinstance(page.bitspersample, int) else 0,
        dtype=page.dtype,
        byte_order=">" if page.parent.byteorder == ">" else "<",
        compression=numbers["compression"],
        predictor=numbers["predictor"],
        fill_order=numbers["fillorder"],
        is_tiled=is_tiled,
        rows=numbers["tilelength"] if is_tiled else min(numbers["rowsperstrip"], height),
        columns=numbers["tilewidth"] if is_tiled else width,
        offsets=_table(name, "offsets", page.dataoffsets),
        counts=_table(name, "byte counts", page.databytecounts),
        background=page.nodata if isinstance(page.nodata, int | float) else 0,
    )
    if page.is_subsampled and layout.compression not in JPEGS:
        raise InputError(f"{name} has fewer colors than pixels, but no JPEG compression: save it as RGB")
    _check_tile_size(layout)
    _check_segments(layout, size)
    return _joined(layout)


def _checked_numbers(name: str, page: Any, is_tiled: bool) -> dict[str, int]:
    """Tags that must be whole numbers from 1 on."""
    if is_tiled:
        tags = {key: tag for key, tag in _NUMBERS.items() if key != "rowsperstrip"} | _TILE_NUMBERS
    else:
        tags = _NUMBERS
    numbers = {}
    for key, tag in tags.items():
        value = getattr(page, key)
        if not isinstance(value, int):
            raise InputError(f"{name} is damaged: its {tag} is {value!r:.40}, which is not an integer")
        if value < (key != "fillorder"):  # in which 0 means nothing
            shown = f"{page.imagewidth} x {page.imagelength} pixels: an image needs at least 1 x 1"
            is_side = key in ("imagewidth", "imagelength")
            raise InputError(f"{name} is {shown}" if is_side else f"{name} is damaged: its {tag} is {value}")
        numbers[key] = value
    return numbers


def _table(name: str, what: str, values: Any) -> NDArray[np.int64]:
    table = np.asarray(values)
    if table.size == 0:
        return np.zeros(0, np.int64)
    if table.ndim != 1 or table.dtype.kind not in "iu" or int(table.min()) < 0 or int(table.max()) >= 2**62:
        raise InputError(f"{name} is damaged: the {what} of its strips or tiles are {values!r:.40}")
    return table.astype(np.int64)


def _check_tile_size(layout: TiffLayout) -> None:
    """Tiles reach beyond the image, but not so far that they are all there is to decode."""
    image = layout.width * layout.height * layout.samples * layout.bits // 8
    tile = layout.rows * layout.row_bytes
    if layout.is_tiled and tile > max(LARGEST_TILE, 4 * image):
        raise InputError(
            f"{layout.name} is damaged: it has tiles of {layout.columns} x {layout.rows} pixels "
            f"for an image of {layout.width} x {layout.height}"
        )


def _check_segments(layout: TiffLayout, size: int) -> None:
    """Every segment must be in the file: tifffile would fill missing ones with zeros."""
    name, kind, needed = layout.name, layout.kind, layout.planes * layout.across * layout.down
    for what, table in (("offsets", layout.offsets), ("byte counts", layout.counts)):
        if len(table) < needed:
            raise InputError(
                f"{name} is damaged: its image of {layout.width} x {layout.height} pixels needs {needed} "
                f"{kind}{'s' * (needed != 1)}, but there are {what} of {len(table)}"
            )
    offsets, counts = layout.offsets[:needed], layout.counts[:needed]
    is_left_out = (offsets == 0) & (counts == 0)
    if is_left_out.all():
        raise InputError(f"{name} is damaged: all of its {needed} {kind}s are empty")
    _refuse(
        layout,
        (counts == 0) != (offsets == 0),
        "{kind} {index} has {count} bytes at byte {offset}, which is impossible",
    )
    ends = offsets + counts
    if (ends > size).any():
        index = int(np.argmax(ends > size))
        raise InputError(f"{name} is cut off after {size} bytes: {kind} {index} ends at byte {ends[index]}")
    if layout.bits:
        rows = np.full(needed, layout.rows, np.int64)
        rows.reshape(layout.planes, layout.down, layout.across)[:, -1] = layout.height - layout.rows * (layout.down - 1)
        least = rows * layout.row_bytes
        if layout.compression == _PLAIN:
            _refuse(layout, (counts < least) & ~is_left_out, "{kind} {index} has {count} bytes, but its rows need more")
        elif layout.compression in _MOST_EXPANSION:
            most = counts * _MOST_EXPANSION[layout.compression]
            _refuse(
                layout, (most < least) & ~is_left_out, "{kind} {index} has {count} bytes, which cannot hold its pixels"
            )


def _joined(layout: TiffLayout) -> TiffLayout:
    """Take strips that follow each other for one, which is read at once."""
    needed = layout.down
    offsets, counts = layout.offsets[:needed], layout.counts[:needed]
    sizes = np.full(needed, layout.rows * layout.row_bytes)
    sizes[-1] = (layout.height - layout.rows * (needed - 1)) * layout.row_bytes
    is_one = layout.compression == _PLAIN and layout.bits > 0 and layout.planes == 1 and not layout.is_tiled
    if not (is_one and (counts >= sizes).all() and (np.diff(offsets) == sizes[:-1]).all()):
        return layout
    return replace(layout, rows=layout.height, offsets=offsets[:1], counts=sizes.sum(keepdims=True))


def _refuse(layout: TiffLayout, is_wrong: NDArray[np.bool_], words: str) -> None:
    if is_wrong.any():
        index = int(np.argmax(is_wrong))
        text = words.format(kind=layout.kind, index=index, count=layout.counts[index], offset=layout.offsets[index])
        raise InputError(f"{layout.name} is damaged: {text}")


# ---- decoding ------------------------------------------------------------------------------------
SPARE = 2**16
"""Bytes beyond the pixels that a compressed segment may have: some writers fill up a block."""

LARGEST_SEGMENT = 2**31
"""Bytes of a segment, which is decoded as a whole if it is compressed."""

_WORTH_THREADS = 2**20
"""Bytes of an image from which threads take less time than they cost."""

_ZSTD = 50000
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
    view = memoryview(data)
    # segments that take long are decoded in this thread, which sees signals in between
    is_short = layout.rows * layout.row_bytes <= unpacking.PIECE
    is_large = layout.height * layout.width * layout.samples * layout.bits >= 8 * _WORTH_THREADS
    threads = 0 if is_short and is_large else 1
    image = decode_rows(layout, lambda offset, size: view[offset : offset + size], 0, layout.height, threads)
    return image[:, :, 0] if layout.samples == 1 else image


def decode_rows(
    layout: TiffLayout, read: Callable[[int, int], bytes | memoryview], first: int, count: int, threads: int = 1
) -> NDArray[Any]:
    """Decode some rows of a page: (count, W, C)."""
    rows = np.empty((count, layout.width, layout.samples), layout.dtype)
    bands = range(first // layout.rows, -(-(first + count) // layout.rows))

    def put(index: tuple[int, int, int]) -> None:
        plane, band, column = index
        number = (plane * layout.down + band) * layout.across + column
        _, y, x, height = layout.place(number)
        top, bottom = max(y, first), min(y + height, first + count)
        channels = slice(plane, plane + 1) if layout.planes > 1 else slice(None)
        place = rows[top - first : bottom - first, x : x + layout.columns, channels]
        place[...] = _rows_of_segment(layout, read, number, top - y, bottom - top)[:, : place.shape[1]]

    for _ in in_order(put, product(range(layout.planes), bands, range(layout.across)), threads):
        pass
    return rows


def _rows_of_segment(
    layout: TiffLayout, read: Callable[[int, int], bytes | memoryview], index: int, first: int, count: int
) -> NDArray[Any]:
    """Decode some rows of a segment: (count, columns, values). Of one that is not compressed no others are read."""
    offset, size = int(layout.offsets[index]), int(layout.counts[index])
    if layout.compression == _PLAIN and size:
        data = read(offset + first * layout.row_bytes, count * layout.row_bytes)
        return _values(layout, _in_order_of_bits(layout, data), count)
    return _decode_segment(layout, read(offset, size), index)[first : first + count]


def _decode_segment(layout: TiffLayout, data: bytes | memoryview, index: int) -> NDArray[Any]:
    """Decode a segment: (rows, columns, values); a tile at the lower end may have only the rows of the image."""
    assert layout.dtype is not None
    rows = layout.place(index)[3]
    if not data:  # left out by its writer, which the layout tells from damage
        return np.full((rows, layout.columns, layout.values), layout.background, layout.dtype)
    full = layout.rows * layout.row_bytes
    if full > LARGEST_SEGMENT:
        raise LimitError(
            f"{layout.name} has {layout.kind}s of {full} bytes, which are decoded as a whole: save it in tiles"
        )
    data = _unpacked(layout, _in_order_of_bits(layout, data), index, full + SPARE)
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
