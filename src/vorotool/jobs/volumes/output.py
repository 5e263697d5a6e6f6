"""Volumes that are written as they are computed, slab by slab: into files, and into Zarr stores chunk by chunk."""

from __future__ import annotations

import io
from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.tessellation.bands import Band
from vorotool.errors import LimitError
from vorotool.jobs.options import AUTO_LEVELS, Options
from vorotool.jobs.run_log import Run
from vorotool.jobs.streamed_output import expected_bytes, write_on_cluster
from vorotool.jobs.targets import Target
from vorotool.plain import plain
from vorotool.types.volumes.voxel_frame import VoxelFrame
from vorotool.types.volumes.voxel_grid import VoxelGrid

Limits = Sequence[tuple[int, int]]
"""First slice and number of slices of each slab."""


@plain
class VolumeStream:
    """A volume that need not be in memory."""

    frame: VoxelFrame
    slices_of: Callable[[int, int], NDArray[Any]]  # `slices_of(first, slices)` gives some slices
    dtype: np.dtype[Any]
    slab: Callable[[int, int], Band]  # `slab(first, slices)` gives some slices as what computes them anywhere
    limits: Limits  # sequence of (int, int): slabs that suit what computes them
    grid: VoxelGrid | None = None  # sides of the voxels, for the file
    nodata: int | None = None  # what voxels without a value have

    def write(self, out: Any, fmt: Any, slabs: Iterator[NDArray[Any]], slices: int, *, threads: int) -> None:
        """Write slabs of so many slices to a file."""
        from vorotool.formats.volumes.writer import write_volume

        shape = (slices, self.frame.height, self.frame.width)
        write_volume(
            out, slabs, shape=shape, dtype=self.dtype, fmt=fmt, grid=self.grid, nodata=self.nodata, threads=threads
        )


def check_volume_chunks(o: Options, frame: VoxelFrame, dtype: np.dtype[Any]) -> tuple[int, int, int]:
    """Choose slices, rows and columns of the chunks of a store."""
    from vorotool.formats.zarr.arrays import zarr_module
    from vorotool.formats.zarr.volumes import volume_chunks

    zarr_module()
    chunks = volume_chunks(frame.shape, dtype, None if o.chunk is None else o.chunk[::-1])
    if min(chunks[0], frame.depth) * frame.height * frame.width > o.max_pixels:
        raise LimitError(
            f"a layer of chunks has {frame.width} x {frame.height} x {chunks[0]} voxels, more than "
            f"--max-pixels {o.max_pixels}: use a lower --chunk"
        )
    return chunks


def write_volume_file(out: Any, o: Options, target: Target, stream: VolumeStream) -> None:
    """Write a volume to a file that is open, if there is room for it."""
    from vorotool.formats.io.disk_space import check_space

    frame, fmt = stream.frame, target.fmt

    def size_of(slices: NDArray[Any]) -> int:
        sample = io.BytesIO()
        stream.write(sample, fmt, iter([slices]), len(slices), threads=o.threads)
        return sample.tell()

    def expected() -> int:
        return expected_bytes(frame.depth, stream.limits[0][1], stream.slices_of, size_of)

    check_space(target.path, frame.voxels * stream.dtype.itemsize, expected)
    slabs = (stream.slices_of(first, slices) for first, slices in stream.limits)
    stream.write(out, fmt, slabs, frame.depth, threads=o.threads)


def write_volume_store(run: Run, o: Options, target: Target, stream: VolumeStream, inputs: Sequence[str]) -> None:
    """Write a volume to a Zarr store, if there is room for it: here, or on a cluster."""
    from vorotool.formats.io.disk_space import check_space
    from vorotool.formats.zarr.store import open_store
    from vorotool.formats.zarr.volumes import add_levels, create_volume, usual_levels, volume_folder, write_slices

    frame, dtype = stream.frame, stream.dtype
    chunks = check_volume_chunks(o, frame, dtype)
    levels = usual_levels(frame.shape) if o.levels == AUTO_LEVELS else o.levels or 0
    room = Fraction(8, 7) if levels else 1  # each copy has an eighth of the voxels of the one before

    def size_of(slices: NDArray[Any]) -> int:
        files: dict[str, Any] = {}
        write_slices(create_volume(files, slices.shape, dtype=dtype, chunks=chunks), 0, slices, threads=o.threads)
        return sum(map(len, files.values()))

    def expected() -> int:
        return int(room * expected_bytes(frame.depth, chunks[0], stream.slices_of, size_of))

    check_space(target.path, int(room * frame.voxels * dtype.itemsize), expected)
    with open_store(target.path, no_clobber=o.no_clobber, inputs=inputs) as store:
        is_labels = target.what == "labels"
        folder = volume_folder(store, target.path, grid=stream.grid, is_labels=is_labels)
        array = create_volume(folder, frame.shape, dtype=dtype, chunks=chunks)
        limits = _of_chunks(stream, chunks[0])
        if o.cluster is not None and o.out_dir is None:
            write_on_cluster(run, folder, stream.slab, limits, address=o.cluster, jobs=o.jobs)
        else:
            for first, slices in limits:
                write_slices(array, first, stream.slices_of(first, slices), threads=o.threads)
        add_levels(store, levels, threads=o.threads)


def _of_chunks(stream: VolumeStream, depth: int) -> Limits:
    """Slabs of whole layers of chunks so deep: about as large as those that suit what computes them."""
    slices = max(1, stream.limits[0][1] // depth) * depth
    return [(first, min(slices, stream.frame.depth - first)) for first in range(0, stream.frame.depth, slices)]
