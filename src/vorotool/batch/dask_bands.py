"""A Dask cluster that computes an image band by band, or a volume slab by slab, and writes it into one store."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack, suppress
from pathlib import Path
from typing import Any

from vorotool import __version__
from vorotool.batch.dask_cluster import ONE_AT_A_TIME, completed, connected
from vorotool.engines.tessellation.bands import Band
from vorotool.errors import OutputError, VorotoolError
from vorotool.formats.zarr.arrays import open_array, write_rows
from vorotool.formats.zarr.volumes import write_slices

_PLANE = ("y", "x")

MOST_UNDER_WAY = 2
"""Bands a worker that are handed over: one is computed while the next one comes."""


def write_bands(
    folder: Path, bands: Iterator[tuple[int, Band]], *, address: str, jobs: int | None = None
) -> Iterator[int]:
    """Compute bands on a Dask cluster, whose workers write them into a store that all see by the same path."""
    given: dict[Any, int] = {}
    with ExitStack() as stack:
        client = stack.enter_context(connected(address, jobs))
        stack.callback(_cancel, client, given)
        done = completed(client)

        def give() -> bool:
            first, band = next(bands, (-1, None))
            if band is None:
                return False
            future = client.submit(_write_band, str(folder), first, band, pure=False, key=f"{folder.name}-{first}")
            given[future] = first
            done.add(future)
            return True

        while len(given) < MOST_UNDER_WAY * len(client.nthreads()) and give():
            pass
        while given:
            future, result = next(done)
            first = given.pop(future)
            _check(future, result)
            give()
            yield first
    for left in folder.rglob("*.partial"):  # of workers that were lost while they wrote a chunk
        left.unlink()


def _write_band(folder: str, first: int, band: Band) -> str:
    """Compute and write a band in a worker; the version of its package."""
    from distributed import get_worker

    threads = get_worker().state.nthreads

    def check(_: float = 0.0) -> None:
        if not (Path(folder) / "zarr.json").exists():
            raise OutputError(f"{folder} cannot be written: it is gone, or is not the same folder for all workers")

    with ONE_AT_A_TIME:
        check()
        array = open_array(folder)
        write = write_rows if array.ndim == len(_PLANE) else write_slices
        write(array, first, band.rows(threads=threads, progress=check), threads=threads, check=check)
    return __version__


def _check(future: Any, result: Any) -> None:
    """Raise what went wrong with a band."""
    if future.status == "finished":
        if result != __version__:
            raise VorotoolError(f"a worker has vorotool {result}, but this is {__version__}")
        return
    error = result[1] if future.status == "error" else "the scheduler does not answer any more"
    if isinstance(error, VorotoolError | OSError):
        raise error
    raise VorotoolError(f"the cluster gave it up: {error}")


def _cancel(client: Any, given: dict[Any, int]) -> None:
    if given:
        with suppress(OSError):
            client.cancel(list(given))
