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

from vorotool.formats.images.image_grids import grid_tags, scale_tag
from vorotool.formats.io.arrays import BLOCK_BYTES, blocks, checked, stored
from vorotool.numeric.coordinates import current_written
from vorotool.numeric.parallel import in_order
from vorotool.types.pixels import PixelGrid

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
) -> None:
    """Write a single-page TIFF from bands of rows, in bounded memory; a BigTIFF where the pixels need it."""
    tags = grid_tags(grid, shape, np.dtype(dtype), nodata=nodata)
    if scale is not None:
        tags["extratags"] = [*tags.get("extratags", ()), scale_tag(scale)]
    if tiled:
        tags["tile"] = (TILE, TILE)
    kind = np.dtype(dtype).newbyteorder("<")
    large = shape[0] * shape[1] * kind.itemsize >= CLASSIC_LIMIT
    write_pages(out, bands, shape, kind, tags, is_large=large, palette=palette)


def write_pages(
    out: BinaryIO,
    bands: Iterable[NDArray[Any]],
    shape: tuple[int, ...],
    kind: np.dtype[Any],
    tags: Mapping[str, Any],
    *,
    is_large: bool,
    palette: NDArray[np.uint8] | None = None,
) -> None:
    """Write an image from bands of rows, or a stack from slabs of slices; the bytes do not depend on these."""
    if not out.seekable():
        with tempfile.TemporaryFile() as spool:
            write_pages(spool, bands, shape, kind, tags, is_large=is_large, palette=palette)
            spool.seek(0)
            shutil.copyfileobj(spool, out)
        return
    import tifffile

    is_tiled = "tile" in tags
    strips = (_tiles if is_tiled else _strips)(bands, shape, kind)
    compressed = kind.kind in "ui" and kind.itemsize <= 4  # distances and 64-bit integers are not
    # named here, since the name of a temporary file is a number, which tifffile does not expect
    handle = tifffile.FileHandle(out, name="image.tif", size=0)
    with tifffile.TiffWriter(handle, bigtiff=is_large, byteorder="<") as writer:
        writer.write(
            in_order(deflated, strips, current_written().how.threads)
            if compressed
            else (strip[1:].tobytes() for strip in strips),
            shape=shape,
            dtype=kind,
            photometric="minisblack" if palette is None else "palette",
            colormap=None if palette is None else _colormap(palette),
            compression="zlib" if compressed else None,
            predictor=2 if compressed else None,
            rowsperstrip=None if is_tiled else max(1, min(shape[-2], BLOCK_BYTES // (shape[-1] * kind.itemsize))),
            metadata=None,
            software=False,
            **tags,
        )


def _strips(
    bands: Iterable[NDArray[Any]], shape: tuple[int, ...], kind: np.dtype[Any], rows: int | None = None
) -> Iterator[NDArray[Any]]:
    """Regroup bands into the rows of strips; each comes after the row before it, and none has rows of two pages."""

    def encode(rows: NDArray[Any], out: NDArray[Any]) -> None:
        out[...] = stored(rows, kind)

    pages = [bands] if len(shape) == 2 else ([image] for slab in checked(bands, shape) for image in slab)
    for page in pages:
        yield from blocks(page, shape[-2:], columns=shape[-1], dtype=kind, encode=encode, rows=rows)


def _tiles(bands: Iterable[NDArray[Any]], shape: tuple[int, ...], kind: np.dtype[Any]) -> Iterator[NDArray[Any]]:
    """Tiles row by row, from left to right; those at the right and lower sides are filled up with zeros."""
    for rows in _strips(bands, shape, kind, TILE):
        for left in range(0, shape[1], TILE):
            part = rows[1:, left : left + TILE]
            tile = np.zeros((1 + TILE, TILE), kind)  # as a strip has it, after the row before
            tile[1 : 1 + len(part), : part.shape[1]] = part
            yield tile


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
