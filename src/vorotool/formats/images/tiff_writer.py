"""Writing TIFF images row by row, through tifffile.

Labels are stored with the horizontal predictor and zlib's run-length deflate: of 67 MB, 4096 x 4096 uint32
labels of 15 000 seeds, 2.6 MB remain after 0.12 s in one thread. For its choice see
`vorotool.formats.images.png_writer`.
Distances hold few runs (86 % remains; level 1 would leave 16 to 69 %), so they and 64-bit integers are stored
as they are.
"""

from __future__ import annotations

import shutil
import tempfile
import zlib
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import DTypeLike, NDArray

from vorotool.formats.images.npy import stored
from vorotool.formats.images.tiff_grid import grid_tags, scale_tag
from vorotool.formats.io.row_bands import BLOCK_BYTES, blocks, checked
from vorotool.numeric.parallel import in_order
from vorotool.types.pixel_grid import PixelGrid

TILE = 512
"""Pixels a side of a tile, as cloud-optimized GeoTIFFs have them."""

CLASSIC_LIMIT = 2**32 - 2**25
"""Bytes of pixels from which offsets may need BigTIFF; the rest is room for tags and tables of strips."""


def write_tiff(
    out: BinaryIO,
    bands: Iterable[NDArray[Any]],
    shape: tuple[int, int],
    *,
    dtype: DTypeLike,
    palette: NDArray[np.uint8] | None = None,
    grid: PixelGrid | None = None,
    nodata: int | None = None,
    scale: float | None = None,
    tiled: bool = False,
    threads: int = 0,
) -> None:
    """Write a single-page TIFF from bands of rows, in bounded memory; a BigTIFF where the pixels need it."""
    tags = grid_tags(grid, shape, np.dtype(dtype), nodata=nodata)
    if scale is not None:
        tags["extratags"] = [*tags.get("extratags", ()), scale_tag(scale)]
    if tiled:
        tags["tile"] = (TILE, TILE)
    if out.seekable():
        _write(out, bands, shape, np.dtype(dtype), palette, tags, threads)
        return
    with tempfile.TemporaryFile() as spool:
        _write(spool, bands, shape, np.dtype(dtype), palette, tags, threads)
        spool.seek(0)
        shutil.copyfileobj(spool, out)


def _write(
    out: BinaryIO,
    bands: Iterable[NDArray[Any]],
    shape: tuple[int, int],
    dtype: np.dtype[Any],
    palette: NDArray[np.uint8] | None,
    tags: Mapping[str, Any],
    threads: int,
) -> None:
    import tifffile

    height, width = shape
    kind = dtype.newbyteorder("<")
    compressed = is_compressed(kind)
    rows = rows_of_strip(shape, kind)
    # named here, since the name of a temporary file is a number, which tifffile does not expect
    handle = tifffile.FileHandle(out, name="image.tif", size=0)
    large = width * height * kind.itemsize >= CLASSIC_LIMIT
    with tifffile.TiffWriter(handle, bigtiff=large, byteorder="<") as writer:
        is_tiled = "tile" in tags
        writer.write(
            (_tiles if is_tiled else _strips)(bands, shape, kind, compressed, threads),
            shape=shape,
            dtype=kind,
            photometric="minisblack" if palette is None else "palette",
            colormap=None if palette is None else _colormap(palette),
            compression="zlib" if compressed else None,
            predictor=2 if compressed else None,
            rowsperstrip=None if is_tiled else rows,
            metadata=None,
            software=False,
            **tags,
        )


def is_compressed(kind: np.dtype[Any]) -> bool:
    """Whether pixels of a type are deflated: distances and 64-bit integers are not."""
    return kind.kind in "ui" and kind.itemsize <= 4


def rows_of_strip(shape: tuple[int, int], kind: np.dtype[Any]) -> int:
    """Give the rows of a strip, which depend on the shape alone."""
    return max(1, min(shape[0], BLOCK_BYTES // (shape[1] * kind.itemsize)))


def uncoded_strips(
    bands: Iterable[NDArray[Any]], shape: tuple[int, int], kind: np.dtype[Any]
) -> Iterator[NDArray[Any]]:
    """Regroup bands into the rows of strips; each comes after the row before it."""

    def encode(rows: NDArray[Any], out: NDArray[Any]) -> None:
        out[...] = stored(rows, kind)

    return blocks(bands, shape, columns=shape[1], dtype=kind, encode=encode)


def encoded(strips: Iterable[NDArray[Any]], compressed: bool, threads: int) -> Iterator[bytes]:
    """Give strips, or tiles, as the file has them."""
    return in_order(deflated, strips, threads) if compressed else (strip[1:].tobytes() for strip in strips)


def _strips(
    bands: Iterable[NDArray[Any]], shape: tuple[int, int], kind: np.dtype[Any], compressed: bool, threads: int
) -> Iterator[bytes]:
    return encoded(uncoded_strips(bands, shape, kind), compressed, threads)


def _tiles(
    bands: Iterable[NDArray[Any]], shape: tuple[int, int], kind: np.dtype[Any], compressed: bool, threads: int
) -> Iterator[bytes]:
    """Tiles row by row, from left to right; those at the right and lower sides are filled up with zeros."""

    def each() -> Iterator[NDArray[Any]]:
        for rows in _rows_of_tiles(bands, shape, kind):
            for left in range(0, shape[1], TILE):
                part = rows[:, left : left + TILE]
                tile = np.zeros((1 + TILE, TILE), kind)  # as a strip has it, after the row before
                tile[1 : 1 + len(part), : part.shape[1]] = part
                yield tile

    return encoded(each(), compressed, threads)


def _rows_of_tiles(
    bands: Iterable[NDArray[Any]], shape: tuple[int, int], kind: np.dtype[Any]
) -> Iterator[NDArray[Any]]:
    """Regroup bands into rows of tiles."""
    held: list[NDArray[Any]] = []
    count = 0
    for band in checked(bands, shape):
        start = 0
        while start < len(band):
            part = band[start : start + TILE - count]
            held.append(stored(part, kind))
            start, count = start + len(part), count + len(part)
            if count == TILE:
                yield np.concatenate(held)
                held, count = [], 0
    if held:
        yield np.concatenate(held)


def deflated(strip: NDArray[Any]) -> bytes:
    """Differences along each row (TIFF's predictor 2, modulo the type's size), as a zlib stream."""
    data = strip[1:].copy()
    np.subtract(strip[1:, 1:], strip[1:, :-1], out=data[:, 1:])
    stream = zlib.compressobj(1, zlib.DEFLATED, zlib.MAX_WBITS, 8, zlib.Z_RLE)
    return stream.compress(data.view(np.uint8).data) + stream.flush()


def _colormap(palette: NDArray[np.uint8]) -> NDArray[np.uint16]:
    """TIFF's form of a palette: 256 entries of 16 bits, channel by channel."""
    colors = np.zeros((256, 3), np.uint16)
    colors[: len(palette)] = palette.astype(np.uint16) * 257
    return np.ascontiguousarray(colors.T)
