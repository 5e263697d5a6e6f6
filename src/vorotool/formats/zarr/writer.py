"""Images and volumes in Zarr stores (format 3), chunk by chunk; OME-Zarr with coarser copies."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Sequence
from concurrent.futures import Future, wait
from itertools import product
from math import prod
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from numpy.typing import DTypeLike, NDArray

from vorotool.errors import UsageError
from vorotool.formats.zarr.reader import OME_ENDING, StoredArray, add_scales, has_long_name, write_image
from vorotool.formats.zarr.store import open_store
from vorotool.numeric.parallel import in_order, start
from vorotool.types.pixels import PixelGrid
from vorotool.types.volumes.volume import VoxelGrid

Result = TypeVar("Result")

Shape = tuple[int, ...]

CHUNK = (512, 2048)
"""Rows and columns of a chunk: so large that there are few files, and so wide since a row of chunks is held."""

VOLUME_CHUNK = (64, 256, 256)
"""Slices, rows and columns of a chunk of bytes: of larger values it has fewer slices."""

BAND_BYTES = 2**28
"""A row or layer of chunks is made of fewer rows or slices where it would take more."""

CHUNK_BYTES = 2**22
"""Of a chunk of a volume, before it is compressed."""

_SMALL = 256
"""Voxels of the longest side of a copy that needs no coarser one."""

_LEVEL = 1
"""Of zstd: of 268 MB of labels of a million seeds 1.5 MB remain; higher levels give little more."""


def zarr_module() -> Any:
    """Import zarr."""
    try:
        import zarr
    except ImportError:
        raise UsageError("Zarr stores need the zarr package: pip install 'vorotool[zarr]'") from None
    return zarr


def chunks_of(shape: Shape, dtype: DTypeLike, asked: Shape | None = None) -> Shape:
    """Choose the chunks of an image or a volume, if they are not asked for: so that a row or layer can be held."""
    is_image, size = len(shape) == 2, np.dtype(dtype).itemsize
    first, *others = asked or (CHUNK if is_image else VOLUME_CHUNK)
    if asked is None:
        layer = prod(shape[1:]) * size
        while first > 1 and (
            first * layer > BAND_BYTES or (not is_image and first * prod(others) * size > CHUNK_BYTES)
        ):
            first //= 2
        while not is_image and 4 * min(first, shape[0]) * prod(others) * size <= CHUNK_BYTES and others < [*shape[1:]]:
            others = [2 * side for side in others]
    return tuple(map(min, (first, *others), shape))


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


def write_chunks(
    array: Any, first: int, part: NDArray[Any], *, threads: int = 0, check: Callable[[], object] | None = None
) -> None:
    """Write all chunks of some rows or slices, each by itself: an interrupt waits for some milliseconds only."""
    depth = array.chunks[0]
    end, whole = first + len(part), array.shape[0]
    if first % depth or (len(part) % depth and end != whole) or end > whole:
        raise ValueError(f"rows or slices {first} to {end - 1} are not those of chunks of {depth}")

    def write(place: tuple[slice, ...]) -> None:
        array[(slice(first + place[0].start, first + place[0].stop), *place[1:])] = part[place]

    _write_parts(write, _parts(part.shape, array.chunks), threads, check)


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
    path: str | os.PathLike[str],
    values: NDArray[Any],
    *,
    grid: PixelGrid | VoxelGrid | None = None,
    is_labels: bool = True,
    threads: int = 0,
) -> None:
    """Write an image or a volume that is held to a store, which replaces an older one when all is written."""
    chunks = chunks_of(values.shape, values.dtype)
    zarr_module()
    with open_store(path) as store:
        folder = array_folder(store, path, values.ndim, grid=grid, is_labels=is_labels)
        array = create_array(folder, values.shape, dtype=values.dtype, chunks=chunks)
        write_chunks(array, 0, values, threads=threads)


def array_folder(
    store: Path, path: str | os.PathLike[str], axes: int, *, grid: PixelGrid | VoxelGrid | None, is_labels: bool
) -> Path:
    """Where the array of an image goes: in the store itself, or in the group of what is to be called as OME-Zarr."""
    name = Path(path).name
    if not name.lower().endswith(OME_ENDING):
        return store
    unit, sides = None, [1.0] * axes
    if isinstance(grid, VoxelGrid):
        unit, sides = grid.unit, [float(side) for side in grid.sides]
    elif grid is not None and grid.is_size and has_long_name(grid.unit):
        unit, sides = grid.unit, [float(grid.height), float(grid.width)]
    scale = dict(zip("zyx"[-axes:], sides, strict=True))
    write_image(store, name[: -len(OME_ENDING)], scale, unit, is_labels=is_labels)
    return store / "0"


def usual_levels(shape: Shape) -> int:
    """Give the number of coarser copies after which one is small enough to be shown as a whole."""
    levels = 0
    while max(shape) > _SMALL:
        shape, levels = _coarser(shape), levels + 1
    return levels


def add_levels(store: Path, levels: int, *, threads: int = 0) -> None:
    """Make coarser copies of the array ``0`` of a group, each of every second voxel of the one before."""
    factors: list[Shape] = []
    product_of_steps: Shape = (1, 1, 1)
    for level in range(1, levels + 1):
        finer = StoredArray(store.name, store / str(level - 1))
        steps = _steps(finer.shape)
        _write_coarser(store / str(level), finer, steps, threads)
        product_of_steps = tuple(step * by for step, by in zip(product_of_steps, steps, strict=True))
        factors.append(product_of_steps)
    if factors:
        add_scales(store, factors)


def _write_coarser(folder: Path, finer: StoredArray, steps: Shape, threads: int) -> None:
    """Make a copy of every so manieth voxel."""
    shape = _coarser(finer.shape)
    chunks = tuple(map(min, finer.metadata.chunks, shape))
    array = create_array(folder, shape, dtype=finer.dtype, chunks=chunks)

    def write(place: tuple[slice, ...]) -> None:
        region = tuple(
            slice(part.start * step, min(part.stop * step, side))
            for part, step, side in zip(place, steps, finer.shape, strict=True)
        )
        array[place] = finer.read(region, threads=1)[tuple(slice(None, None, step) for step in steps)]

    _write_parts(write, _parts(shape, chunks), threads)


def _steps(shape: Shape) -> Shape:
    """How many voxels make one of the next copy: an axis of one voxel stays as it is."""
    return tuple(1 if side == 1 else 2 for side in shape)


def _coarser(shape: Shape) -> Shape:
    return tuple(-(-side // step) for side, step in zip(shape, _steps(shape), strict=True))


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
    check: Callable[[], object] | None = None,
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
