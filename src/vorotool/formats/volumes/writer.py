"""Writing volumes slab by slab: TIFF stacks through tifffile, and NPY."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, BinaryIO, Literal

import numpy as np
from numpy.typing import DTypeLike, NDArray

from vorotool.errors import UsageError, option
from vorotool.formats.images.image_grids import NO_UNIT, NODATA, imagej_unit, ratio_of, resolution, resolution_tags
from vorotool.formats.images.ome_xml import PIXEL, ome_document, ome_type, shown_side
from vorotool.formats.images.tiff_writer import CLASSIC_LIMIT, write_pages
from vorotool.formats.io.arrays import write_npy
from vorotool.types.pixels import PixelGrid
from vorotool.types.volumes.volume import LabelVolume, Volume, VoxelGrid

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
