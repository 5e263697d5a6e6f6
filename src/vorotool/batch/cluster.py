"""A Dask cluster that does the tasks of a batch, or computes one image or volume band by band into one store."""

from __future__ import annotations

import logging
import os
import signal
import threading
from collections.abc import Callable, Generator, Iterator
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import replace
from itertools import takewhile
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from vorotool import __version__
from vorotool.batch.workers import Outcome, Process, Task, carry_out, keep_busy
from vorotool.errors import OutputError, UsageError, VorotoolError
from vorotool.formats.zarr.writer import open_array, write_chunks

if TYPE_CHECKING:
    from vorotool.engines.tessellation.tessellator import Band

LOCAL = "local"
PATIENCE = 10.0
"""Seconds for a scheduler to answer."""

FIRST_WORKER = 120.0
"""Seconds for a first worker to come: a cluster may just have been asked for some."""

CLOSING = 0.1
"""Seconds for taking leave: an interrupt is over within 0.2 s."""

AHEAD = 2
"""Items a worker that are handed over: one is computed while the next one comes."""

ONE_AT_A_TIME = threading.Lock()
"""Warnings belong to a whole process, and so does memory: a worker with several threads does one task at a time."""


T = TypeVar("T")


# ---- what is done ------------------------------------------------------------------------------------------------
def cluster_results(
    process: Process, tasks: Iterator[tuple[int, Task]], *, address: str, jobs: int | None = None
) -> Generator[tuple[int, Outcome], None, None]:
    """Do tasks on a Dask cluster, whose workers see the same files by the same paths."""

    def call(numbered: tuple[int, Task]) -> tuple[Any, ...]:
        return f"vorotool-{numbered[1].tag}{numbered[0]}", _carry_out, process, _absolute(numbered[1])

    for (number, task), failure, outcome in _done_on_cluster(tasks, call, address, jobs):
        if failure is not None:
            yield number, Outcome(code=1, message=str(failure))
        else:
            yield number, replace(outcome, outputs=dict(zip(task.outputs, outcome.outputs.values(), strict=False)))


def write_bands(
    folder: Path, bands: Iterator[tuple[int, Band]], *, address: str, jobs: int | None = None
) -> Iterator[int]:
    """Compute bands on a Dask cluster, whose workers write them into a store that all see by the same path."""

    def call(numbered: tuple[int, Band]) -> tuple[Any, ...]:
        return f"{folder.name}-{numbered[0]}", _write_band, str(folder), *numbered

    for (first, _), failure, _ in _done_on_cluster(bands, call, address, jobs):
        if failure is not None:
            raise failure
        yield first
    for left in folder.rglob("*.partial"):  # of workers that were lost while they wrote a chunk
        left.unlink()


def _done_on_cluster(
    items: Iterator[T], call: Callable[[T], tuple[Any, ...]], address: str, jobs: int | None
) -> Iterator[tuple[T, Exception | None, Any]]:
    """Yield each item as it is done, with its result or what went wrong; `call` has a name, a function, arguments."""
    going: dict[Any, T] = {}
    with ExitStack() as stack:
        client = stack.enter_context(_connected(address, jobs))
        stack.callback(lambda: _quietly(client.cancel, list(going)) if going else None)  # forgets what is not done
        from distributed import as_completed

        done = as_completed(loop=client.loop, with_results=True, raise_errors=False)
        is_lost = False

        def start(item: T) -> Any:
            name, *function = call(item)
            future = client.submit(*function, pure=False, key=name)
            done.add(future)
            return future

        wanted = takewhile(lambda _: not is_lost, items)
        for item, future, result in keep_busy(wanted, start, done, AHEAD * len(client.nthreads()), going):
            is_lost = future.status not in ("finished", "error")
            yield item, _failure(future, result), result


def _failure(future: Any, result: Any) -> Exception | None:
    """Return what went wrong with an item; the result of others is, or has, the version of the worker's package."""
    if future.status == "finished":
        version = getattr(result, "version", result)
        return None if version == __version__ else VorotoolError(
            f"a worker has vorotool {version}, but this is {__version__}"
        )  # fmt: skip
    error = result[1] if future.status == "error" else "the scheduler does not answer any more"
    if isinstance(error, VorotoolError | OSError):
        return error
    return VorotoolError(f"the cluster abandoned this input: {error}")


# ---- in a worker -------------------------------------------------------------------------------------------------
def _carry_out(process: Process, task: Task) -> Outcome:
    with ONE_AT_A_TIME:
        return carry_out(process, task)


def _absolute(task: Task) -> Task:
    """Return the task for a process in another folder."""

    def path(name: str) -> str:
        return str(Path(name).absolute())

    done = task.done and replace(task.done, outputs={path(name): each for name, each in task.done.outputs.items()})
    return replace(task, path=path(task.file), outputs=tuple(map(path, task.outputs)), done=done)


def _write_band(folder: str, first: int, band: Band) -> str:
    """Compute and write a band; return the version of the package."""
    from distributed import get_worker

    threads = get_worker().state.nthreads

    def check(_: float = 0.0) -> None:
        if not (Path(folder) / "zarr.json").exists():
            raise OutputError(f"{folder} cannot be written: it is gone, or is not the same folder for all workers")

    with ONE_AT_A_TIME:
        check()
        array = open_array(folder)
        write_chunks(array, first, band.rows(threads=threads, progress=check), threads=threads, check=check)
    return __version__


# ---- the cluster -------------------------------------------------------------------------------------------------
@contextmanager
def _connected(address: str, jobs: int | None) -> Iterator[Any]:
    """Give a client of a cluster that has at least one worker."""
    try:
        import distributed
    except ImportError:
        raise UsageError("--cluster needs dask.distributed: pip install 'vorotool[distributed]'") from None
    for name in ("distributed", "distributed.client"):
        logging.getLogger(name).setLevel(logging.CRITICAL)  # what it would say is in the outcomes
    with ExitStack() as stack:
        cluster = stack.enter_context(_started(distributed, jobs)) if address == LOCAL else address
        try:
            if address != LOCAL:
                _check_address(address)
            client = distributed.Client(cluster, timeout=PATIENCE, set_as_default=False)
            stack.callback(_quietly, client.close, timeout=CLOSING)
            client.wait_for_workers(1, timeout=FIRST_WORKER)
        except TimeoutError:
            raise UsageError(f"--cluster {address}: the cluster has no workers; start some") from None
        except (OSError, ValueError) as error:
            raise UsageError(
                f"--cluster {address}: no scheduler answers there ({error}); give HOST:PORT, or local to start one"
            ) from None
        yield client


def _check_address(address: str) -> None:
    """Refuse at once what a client would wait for, or not end quietly with."""
    from distributed import Security
    from distributed.comm.addressing import get_address_host_port, normalize_address

    full = normalize_address(address)
    host, port = get_address_host_port(full, strict=True)
    if not host or not 0 < port < 1 << 16:
        raise ValueError("HOST must not be empty, and PORT from 1 to 65535")
    if full.startswith(("tls:", "wss:")) and Security().get_connection_args("client").get("ssl_context") is None:
        raise ValueError("it needs certificates: name them in distributed.comm.tls of Dask's settings")


@contextmanager
def _started(distributed: Any, jobs: int | None) -> Iterator[Any]:
    """Start a cluster on this machine. Its workers have nothing to lose when it ends, so that they are killed."""
    cluster = distributed.LocalCluster(
        n_workers=jobs or os.cpu_count(),
        threads_per_worker=1,
        memory_limit=0,
        scheduler_kwargs={"dashboard": False, "dashboard_address": ":0"},  # the usual port may be another cluster's
        silence_logs=logging.CRITICAL,
    )
    try:
        yield cluster
    finally:
        for nanny in cluster.workers.values():
            nanny.auto_restart = False
            with suppress(OSError, TypeError):  # it has gone already
                os.kill(nanny.pid, signal.SIGKILL)
        _quietly(cluster.close, timeout=CLOSING)


def _quietly(call: Callable[..., Any], *arguments: Any, **options: Any) -> None:
    """Call what nobody may answer any more, or not so fast."""
    with suppress(OSError):
        call(*arguments, **options)
