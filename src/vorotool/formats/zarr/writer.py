"""Images in Zarr arrays (format 3), chunk by chunk."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Sequence
from concurrent.futures import Future, wait
from itertools import product
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from numpy.typing import DTypeLike, NDArray

from vorotool.errors import UsageError, option
from vorotool.formats.zarr.multiscales import OME_ENDING, add_scales, array_folder, write_image
from vorotool.formats.zarr.reader import StoredArray
from vorotool.formats.zarr.store import open_store
from vorotool.numeric.parallel import in_order, start
from vorotool.types.pixel_grid import PixelGrid
from vorotool.types.volumes.voxel_frame import VoxelGrid

Result = TypeVar("Result")

CHUNK = (512, 2048)
"""Rows and columns of a chunk: so large that there are few files, and so wide since a row of chunks is held."""

BAND_BYTES = 2**28
"""A row of chunks is made of fewer rows where it would take more."""

_LEVEL = 1
"""Of zstd: of 268 MB of labels of a million seeds 1.5 MB remain; higher levels give little more."""


def zarr_module() -> Any:
    """Import zarr."""
    try:
        import zarr
    except ImportError:
        raise UsageError("Zarr stores need the zarr package: pip install 'vorotool[zarr]'") from None
    return zarr


def chunks_of(shape: tuple[int, int], dtype: DTypeLike, asked: tuple[int, int] | None = None) -> tuple[int, int]:
    """Choose rows and columns of the chunks of an image, if they are not asked for."""
    rows, columns = asked or CHUNK
    while asked is None and rows > 1 and rows * shape[1] * np.dtype(dtype).itemsize > BAND_BYTES:
        rows //= 2
    return min(rows, shape[0]), min(columns, shape[1])


def create_array(
    store: Any,
    shape: tuple[int, ...],
    *,
    dtype: DTypeLike,
    chunks: tuple[int, ...],
    attributes: dict[str, Any] | None = None,
) -> Any:
    """Make an array for an image or a volume in an empty folder."""
    zarr = zarr_module()
    return to_its_end(
        lambda: zarr.create_array(
            store if isinstance(store, dict) else os.fspath(store),
            shape=shape,
            chunks=chunks,
            dtype=np.dtype(dtype),
            compressors=[zarr.codecs.ZstdCodec(level=_LEVEL)],
            fill_value=0,
            dimension_names=("z", "y", "x")[-len(shape) :],
            attributes=attributes,
            overwrite=False,
            zarr_format=3,
        )
    )


def open_array(folder: str | os.PathLike[str]) -> Any:
    """Open an array to write in it."""
    return zarr_module().open_array(os.fspath(folder), mode="r+")


def write_rows(
    array: Any, first: int, rows: NDArray[Any], *, threads: int = 0, check: Callable[[], object] | None = None
) -> None:
    """Write one row of chunks, each chunk by itself: an interrupt waits for some milliseconds only."""
    height, width = array.chunks
    if first % height or len(rows) != min(height, array.shape[0] - first):
        raise ValueError(f"rows {first} to {first + len(rows) - 1} are not those of chunks of {height} rows")

    stopped = threading.Event()

    def write(column: int) -> None:
        if stopped.is_set():
            return
        if check is not None:
            check()
        array[first : first + len(rows), column : column + width] = rows[:, column : column + width]

    def write_all() -> None:
        for _ in in_order(write, range(0, array.shape[1], width), threads):
            pass

    to_its_end(write_all, stopped.set)


def to_its_end(function: Callable[[], Result], stop: Callable[[], None] = lambda: None) -> Result:
    """Call what writes in a store, and wait until it has ended, through an interrupt, too, which asks it to stop."""
    work: Future[Result] = Future()
    try:
        start(function, work)
        return work.result()
    except BaseException:
        stop()
        if not work.cancel():
            wait([work])
        raise


def write_zarr(
    path: str | os.PathLike[str], image: NDArray[Any], *, grid: PixelGrid | None = None, threads: int = 0
) -> None:
    """Write an image that is held to a store, which replaces an older one when all is written."""
    height, width = image.shape
    chunks = chunks_of((height, width), image.dtype)
    zarr_module()
    with open_store(path) as store:
        folder = array_folder(store, path, grid=grid, is_labels=True)
        array = create_array(folder, (height, width), dtype=image.dtype, chunks=chunks)
        for first in range(0, height, chunks[0]):
            write_rows(array, first, image[first : first + chunks[0]], threads=threads)


Shape = tuple[int, int, int]

VOLUME_CHUNK = (64, 256, 256)
"""Slices, rows and columns of a chunk of bytes: of larger values it has fewer slices."""

CHUNK_BYTES = 2**22
"""Of a chunk, before it is compressed."""

_SMALL = 256
"""Voxels of the longest side of a copy that needs no coarser one."""

_AXES = ("z", "y", "x")


def volume_chunks(shape: Shape, dtype: DTypeLike, asked: Shape | None = None) -> Shape:
    """Choose the chunks of a volume, if they are not asked for: near 4 MiB, and so that a slab of them can be held."""
    size = np.dtype(dtype).itemsize
    slices, rows, columns = asked or VOLUME_CHUNK
    if asked is None:
        while slices > 1 and (
            slices * rows * columns * size > CHUNK_BYTES or slices * shape[1] * shape[2] * size > BAND_BYTES
        ):
            slices //= 2
        while 4 * min(slices, shape[0]) * rows * columns * size <= CHUNK_BYTES and (rows, columns) < shape[1:]:
            rows, columns = 2 * rows, 2 * columns
    return min(slices, shape[0]), min(rows, shape[1]), min(columns, shape[2])


def create_volume(folder: Any, shape: Shape, *, dtype: DTypeLike, chunks: Shape) -> Any:
    """Make an array for a volume in an empty folder: see `vorotool.formats.zarr.writer.create_array`."""
    return create_array(folder, shape, dtype=dtype, chunks=chunks)


def write_slices(
    array: Any, first: int, slab: NDArray[Any], *, threads: int = 0, check: Callable[[], object] | None = None
) -> None:
    """Write all chunks of some slices, each chunk by itself: an interrupt waits for some milliseconds only."""
    depth = array.chunks[0]
    if first % depth or (len(slab) % depth and first + len(slab) != array.shape[0]):
        raise ValueError(f"slices {first} to {first + len(slab) - 1} are not those of chunks of {depth} slices")

    def write(place: tuple[slice, ...]) -> None:
        z, y, x = place
        array[first + z.start : first + z.stop, y, x] = slab[z, y, x]

    _write_parts(write, _parts(slab.shape, array.chunks), threads, check)


def volume_folder(
    store: Path, path: str | os.PathLike[str], *, grid: VoxelGrid | None = None, is_labels: bool = True
) -> Path:
    """Where the array of a volume goes: in the store itself, or in the group of what is to be called as OME-Zarr."""
    name = Path(path).name
    if not name.lower().endswith(OME_ENDING):
        return store
    sides = [1.0, 1.0, 1.0] if grid is None else [float(side) for side in grid.sides]
    scale = dict(zip(_AXES, sides, strict=True))
    write_image(store, name[: -len(OME_ENDING)], scale, None if grid is None else grid.unit, is_labels=is_labels)
    return store / "0"


def check_levels(path: str | os.PathLike[str], levels: int) -> None:
    """Refuse coarser copies in what is not named as OME-Zarr, or fewer than none of them."""
    if levels < 0:
        raise UsageError(f"invalid number of coarser copies {levels}: expected 0 or more")
    if levels and not Path(path).name.lower().endswith(OME_ENDING):
        end = option(f"-o NAME{OME_ENDING}", f"a path that ends in {OME_ENDING}")
        raise UsageError(f"coarser copies apply to OME-Zarr only: use {end}, or leave them out")


def usual_levels(shape: Shape) -> int:
    """Give the number of coarser copies after which one is small enough to be shown as a whole."""
    levels = 0
    while max(shape) > _SMALL:
        shape, levels = _coarser(shape), levels + 1
    return levels


def add_levels(store: Path, levels: int, *, threads: int = 0, check: Callable[[], object] | None = None) -> None:
    """Make coarser copies of the array ``0`` of a group, each of every second voxel of the one before."""
    factors, product_of_steps = [], (1, 1, 1)
    for level in range(1, levels + 1):
        finer = StoredArray(store.name, store / str(level - 1))
        shape = _three(finer.shape)
        steps = _steps(shape)
        _write_coarser(store / str(level), finer, steps, threads, check)
        product_of_steps = _three([step * by for step, by in zip(product_of_steps, steps, strict=True)])
        factors.append(product_of_steps)
    if factors:
        add_scales(store, factors)


def _write_coarser(
    folder: Path, finer: StoredArray, steps: Shape, threads: int, check: Callable[[], object] | None
) -> None:
    """Make a copy of every so manieth voxel."""
    shape = _coarser(_three(finer.shape))
    chunks = _three([min(sides) for sides in zip(finer.metadata.chunks, shape, strict=True)])
    array = create_volume(folder, shape, dtype=finer.dtype, chunks=chunks)

    def write(place: tuple[slice, ...]) -> None:
        region = tuple(
            slice(part.start * step, min(part.stop * step, side))
            for part, step, side in zip(place, steps, finer.shape, strict=True)
        )
        array[place] = finer.read(region, threads=1)[tuple(slice(None, None, step) for step in steps)]

    _write_parts(write, _parts(shape, chunks), threads, check)


def write_zarr_volume(
    path: str | os.PathLike[str],
    values: NDArray[Any],
    *,
    grid: VoxelGrid | None = None,
    is_labels: bool = True,
    levels: int = 0,
    threads: int = 0,
) -> None:
    """Write a volume that is held to a store, which replaces an older one when all is written."""
    shape = _three(values.shape)
    chunks = volume_chunks(shape, values.dtype)
    check_levels(path, levels)
    zarr_module()
    with open_store(path) as store:
        folder = volume_folder(store, path, grid=grid, is_labels=is_labels)
        create_volume(folder, shape, dtype=values.dtype, chunks=chunks)
        write_slices(open_array(folder), 0, values, threads=threads)
        add_levels(store, levels, threads=threads)


def _three(sizes: Sequence[int]) -> Shape:
    depth, height, width = sizes
    return depth, height, width


def _steps(shape: Shape) -> Shape:
    """How many voxels make one of the next copy: an axis of one voxel stays as it is."""
    return _three([1 if side == 1 else 2 for side in shape])


def _coarser(shape: Shape) -> Shape:
    return _three([-(-side // step) for side, step in zip(shape, _steps(shape), strict=True)])


def _parts(shape: Sequence[int], chunks: Sequence[int]) -> list[tuple[slice, ...]]:
    """The chunks that a box is made of."""
    axes = [
        [slice(start, min(start + step, side)) for start in range(0, side, step)]
        for side, step in zip(shape, chunks, strict=True)
    ]
    return list(product(*axes))


def _write_parts(
    write: Callable[[tuple[slice, ...]], None],
    parts: Sequence[tuple[slice, ...]],
    threads: int,
    check: Callable[[], object] | None,
) -> None:
    """Write chunks in threads of our own, to the end of each."""
    stopped = threading.Event()

    def one(place: tuple[slice, ...]) -> None:
        if not stopped.is_set():
            if check is not None:
                check()
            write(place)

    def write_all() -> None:
        for _ in in_order(one, parts, threads):
            pass

    to_its_end(write_all, stopped.set)
