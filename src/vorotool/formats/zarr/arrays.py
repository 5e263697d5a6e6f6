"""Images in Zarr arrays (format 3), chunk by chunk."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable
from concurrent.futures import Future, wait
from typing import Any, TypeVar

import numpy as np
from numpy.typing import DTypeLike, NDArray

from vorotool.errors import UsageError
from vorotool.formats.zarr.multiscales import array_folder
from vorotool.formats.zarr.store import open_store
from vorotool.numeric.parallel import in_order, start
from vorotool.types.pixel_grid import PixelGrid

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
