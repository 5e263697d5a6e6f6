"""Images that are written as they are computed, rows by rows: into files, and into Zarr stores chunk by chunk."""

from __future__ import annotations

import io
from collections.abc import Callable, Iterator, Mapping, Sequence
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.tessellation.bands import Band
from vorotool.engines.tessellation.frames import band_limits
from vorotool.errors import LimitError
from vorotool.jobs.options import Options
from vorotool.jobs.run_log import Run
from vorotool.jobs.targets import Target
from vorotool.plain import plain
from vorotool.types.pixel_frame import Frame

RowsOf = Callable[[int, int], NDArray[Any]]
"""``rows_of(first, rows)`` gives some rows of an image."""

SAMPLES = 3
"""Bands that are encoded to learn how much room all need, where it may not be there."""


@plain
class Stream:
    """An image that need not be in memory."""

    frame: Frame
    rows_of: RowsOf  # gives any rows
    dtype: np.dtype[Any]
    largest: int  # the largest value there can be
    band: Callable[[int, int], Band]  # gives any rows as what computes them anywhere
    kind: Mapping[str, Any]  # further options of `write_label_image`

    def bands(self) -> Iterator[NDArray[Any]]:
        """Give all rows, band by band."""
        return (self.rows_of(first, rows) for first, rows in band_limits(self.frame))

    def write(self, out: Any, fmt: str, bands: Iterator[NDArray[Any]], rows: int, *, threads: int) -> None:
        """Write bands of so many rows to a file."""
        from vorotool.formats.images.label_images import write_label_image

        write_label_image(
            out,
            bands,
            shape=(rows, self.frame.width),
            dtype=self.dtype,
            fmt=fmt,  # type: ignore[arg-type]  # which the command has looked up
            largest_label=self.largest,
            threads=threads,
            **self.kind,
        )


def scale_of_squares(step: Fraction) -> float | None:
    """Return what squared distances are multiplied by; None where they are in pixels."""
    return None if step == 1 else float(step * step)


def check_chunks(o: Options, frame: Frame, dtype: np.dtype[Any]) -> tuple[int, int]:
    """Choose rows and columns of the chunks of a store."""
    from vorotool.formats.zarr.arrays import chunks_of, zarr_module

    zarr_module()
    chunks = chunks_of(frame.shape, dtype, None if o.chunk is None else o.chunk[::-1])
    if chunks[0] * frame.width > o.max_pixels:
        raise LimitError(
            f"a row of chunks has {frame.width} x {chunks[0]} pixels, more than --max-pixels {o.max_pixels}: "
            "use a lower --chunk"
        )
    return chunks


def write_file(out: Any, o: Options, target: Target, stream: Stream) -> None:
    """Write an image to a file that is open, if there is room for it."""
    from vorotool.formats.io.disk_space import check_space

    frame, fmt = stream.frame, target.fmt

    def size_of(rows: NDArray[Any]) -> int:
        sample = io.BytesIO()
        stream.write(sample, fmt, iter([rows]), len(rows), threads=o.threads)
        return sample.tell()

    most = frame.pixels * (11 if fmt == "text" else stream.dtype.itemsize)
    check_space(target.path, most, lambda: _expected(stream, next(band_limits(frame))[1], size_of))
    stream.write(out, fmt, stream.bands(), frame.height, threads=o.threads)


def write_store(run: Run, o: Options, target: Target, stream: Stream, inputs: Sequence[str]) -> None:
    """Write an image to a Zarr store, if there is room for it: here, or on a cluster."""
    from vorotool.formats.io.disk_space import check_space
    from vorotool.formats.zarr.arrays import create_array, write_rows
    from vorotool.formats.zarr.multiscales import array_folder
    from vorotool.formats.zarr.store import open_store

    frame, dtype = stream.frame, stream.dtype
    chunks = check_chunks(o, frame, dtype)

    def size_of(rows: NDArray[Any]) -> int:
        files: dict[str, Any] = {}
        write_rows(create_array(files, rows.shape, dtype=dtype, chunks=chunks), 0, rows, threads=o.threads)
        return sum(map(len, files.values()))

    check_space(target.path, frame.pixels * dtype.itemsize, lambda: _expected(stream, chunks[0], size_of))
    with open_store(target.path, no_clobber=o.no_clobber, inputs=inputs) as store:
        grid = stream.kind.get("grid")
        folder = array_folder(store, target.path, grid=grid, is_labels=target.what == "labels")
        scale = stream.kind.get("scale")
        about = None if scale is None else {"scale": scale}  # no name that readers would turn integers to floats by
        array = create_array(folder, frame.shape, dtype=dtype, chunks=chunks, attributes=about)
        limits = [(first, min(chunks[0], frame.height - first)) for first in range(0, frame.height, chunks[0])]
        if o.cluster is not None and o.out_dir is None:
            write_on_cluster(run, folder, stream.band, limits, address=o.cluster, jobs=o.jobs)
            return
        for first, count in limits:
            write_rows(array, first, stream.rows_of(first, count), threads=o.threads)


def write_on_cluster(
    run: Run,
    folder: Path,
    band_of: Callable[[int, int], Band],
    limits: Sequence[tuple[int, int]],
    *,
    address: str,
    jobs: int | None,
) -> None:
    """Let a cluster compute the bands of an image, or the slabs of a volume, and write them into a store."""
    from vorotool.batch.dask_bands import write_bands

    show = run.progress("tessellate")
    bands = ((first, band_of(first, count)) for first, count in limits)
    for done, _ in enumerate(write_bands(folder, bands, address=address, jobs=jobs), start=1):
        if show is not None:
            show(done / len(limits))


def _expected(stream: Stream, rows: int, size_of: Callable[[NDArray[Any]], int]) -> int:
    return expected_bytes(stream.frame.height, rows, stream.rows_of, size_of)


def expected_bytes(height: int, rows: int, rows_of: RowsOf, size_of: Callable[[NDArray[Any]], int]) -> int:
    """Estimate the bytes of an image, or a volume, from those of some bands, in which its parts differ."""
    bands = -(-height // rows)
    chosen = {bands * (2 * k + 1) // (2 * SAMPLES) for k in range(SAMPLES)}
    seen = size = 0
    for band in sorted(chosen):
        count = min(rows, height - band * rows)
        size += size_of(rows_of(band * rows, count))
        seen += count
    return size * height // seen
