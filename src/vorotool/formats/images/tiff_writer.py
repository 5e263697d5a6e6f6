"""Writing TIFF images row by row, and volumes slab by slab as TIFF stacks and NPY; through tifffile.

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
from typing import Any, BinaryIO, Literal

import numpy as np
from numpy.typing import DTypeLike, NDArray

from vorotool.errors import UsageError, option
from vorotool.formats.images.image_grids import (
    NO_UNIT,
    NODATA,
    grid_tags,
    imagej_unit,
    ratio_of,
    resolution,
    resolution_tags,
    scale_tag,
)
from vorotool.formats.images.ome_xml import PIXEL, ome_document, ome_type, shown_side
from vorotool.formats.io.arrays import BLOCK_BYTES, blocks, checked, stored, write_npy
from vorotool.numeric.coordinates import current_written
from vorotool.numeric.parallel import in_order
from vorotool.types.pixels import PixelGrid
from vorotool.types.volumes.volume import LabelVolume, Volume, VoxelGrid

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


VolumeFormat = Literal["tiff", "npy"]

_PAGE_BYTES = 512
"""That the tags of a page take at most, its table of strips aside."""


def write_volume(
    out: BinaryIO,
    slabs: Iterable[NDArray[Any]],
    *,
    shape: tuple[int, int, int],
    dtype: DTypeLike,
    fmt: VolumeFormat,
    grid: VoxelGrid | None = None,
    nodata: int | None = None,
) -> None:
    """Write a volume from slabs of slices, in bounded memory; the bytes do not depend on the slabs or the threads."""
    kind = np.dtype(np.uint8 if np.dtype(dtype) == np.bool_ else dtype).newbyteorder("<")
    if fmt == "npy":
        write_npy(out, slabs, shape, dtype=kind)
        return
    if fmt != "tiff":
        one = option("-o labels.tif, labels.npy or labels.zarr", "the path labels.tif, labels.npy or labels.zarr")
        raise UsageError(f"a volume cannot be written as {fmt!r}: use {one}")
    is_large = shape[0] * (shape[1] * shape[2] * kind.itemsize + _PAGE_BYTES) >= CLASSIC_LIMIT
    tags = stack_tags(grid, shape, np.dtype(kind).newbyteorder("="), is_large=is_large, nodata=nodata)
    write_pages(out, slabs, shape, kind, tags, is_large=is_large)


def write_values(out: BinaryIO, value: LabelVolume | Volume, fmt: VolumeFormat) -> None:
    """Write a volume that is in memory."""
    values = value.labels if isinstance(value, LabelVolume) else value.values
    write_volume(out, [values], shape=value.shape, dtype=values.dtype, fmt=fmt, grid=value.grid)


# ---- what is said of voxels ----------------------------------------------------------------------
_IMAGEJ_TYPES = (np.uint8, np.uint16, np.float32)
_ASCII = 2
"""Type of a tag."""

StackForm = Literal["imagej", "ome", "tiff"]


def stack_form(grid: VoxelGrid | None, dtype: np.dtype[Any], *, is_large: bool) -> StackForm:
    """Choose whose description a stack has: that of its input, else ImageJ's."""
    form = "imagej" if grid is None else grid.form
    if form == "tiff":
        return "tiff"
    if form == "imagej" and dtype in _IMAGEJ_TYPES and not is_large:
        return "imagej"
    return "tiff" if ome_type(dtype) is None else "ome"


def stack_tags(
    grid: VoxelGrid | None,
    shape: tuple[int, int, int],
    dtype: np.dtype[Any],
    *,
    is_large: bool = False,
    nodata: int | None = None,
) -> dict[str, Any]:
    """Arguments of tifffile that say what is known of voxels; the description is on the first page."""
    more = {} if nodata is None else {"extratags": [(NODATA, _ASCII, 0, str(nodata), True)]}
    form = stack_form(grid, dtype, is_large=is_large)
    plane = None if grid is None else PixelGrid(grid.width, grid.height, grid.unit)
    if form == "imagej":
        return {**_imagej(grid, shape[0]), **more}
    tags = {} if plane is None or plane.unit is None else resolution_tags(plane)
    if form == "ome":
        sides = {} if grid is None else {"X": grid.width, "Y": grid.height, "Z": grid.depth}
        tags |= {"description": ome_document(shape, dtype, sides, _ome_unit(grid))}
    return {**tags, **more}


def _imagej(grid: VoxelGrid | None, slices: int) -> dict[str, Any]:
    """Sides along x and y as resolution, the unit and the distance of slices in the description."""
    lines = ["ImageJ=1.54f", f"images={slices}", f"slices={slices}"]
    tags: dict[str, Any] = {}
    if grid is not None:
        ratios = [ratio_of(float(1 / side)) for side in (grid.width, grid.height)]
        if None not in ratios:
            tags = resolution(ratios, NO_UNIT)
            lines += [] if grid.unit is None else [f"unit={imagej_unit(grid.unit)}"]
            lines += [f"spacing={shown_side(grid.depth)}", "loop=false"]
    return {**tags, "description": "".join(f"{line}\n" for line in lines).encode("ascii")}


def _ome_unit(grid: VoxelGrid | None) -> str:
    if grid is None or grid.unit is None:
        return PIXEL
    return "in" if grid.unit == "inch" else grid.unit
