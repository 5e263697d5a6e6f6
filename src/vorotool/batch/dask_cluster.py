"""A Dask cluster that does the tasks of a batch."""

from __future__ import annotations

import logging
import os
import signal
import threading
from collections.abc import Generator, Iterator
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

from vorotool import __version__
from vorotool.batch.pages import PageName, path_of
from vorotool.batch.tasks import Outcome, Process, Task, carry_out
from vorotool.errors import UsageError

LOCAL = "local"
PATIENCE = 10.0
"""Seconds for a scheduler to answer."""

FIRST_WORKER = 120.0
"""Seconds for a first worker to come: a cluster may just have been asked for some."""

CLOSING = 0.1
"""Seconds for taking leave: an interrupt is over within 0.2 s."""

ONE_AT_A_TIME = threading.Lock()
"""Warnings belong to a whole process, and so does memory: a worker with several threads does one task at a time."""


def cluster_results(
    process: Process, tasks: Iterator[tuple[int, Task]], *, address: str, jobs: int | None = None
) -> Generator[tuple[int, Outcome], None, None]:
    """Do tasks on a Dask cluster, whose workers see the same files by the same paths."""
    given: dict[Any, tuple[int, Task]] = {}
    with ExitStack() as stack:
        client = stack.enter_context(connected(address, jobs))
        stack.callback(_give_up, client, given)
        done = completed(client)

        def give() -> bool:
            number, task = next(tasks, (-1, None))
            if task is None:
                return False
            future = client.submit(_carry_out, process, _absolute(task), pure=False, key=f"vorotool-{task.tag}{number}")
            given[future] = number, task
            done.add(future)
            return True

        while len(given) < 2 * sum(client.nthreads().values()) and give():
            pass
        while given:
            future, result = next(done)
            number, task = given.pop(future)
            outcome = _outcome(task, future, result)
            if not outcome.code:
                give()
            yield number, outcome
            if outcome.code and future.status in ("finished", "error"):  # else there is no scheduler to give it to
                give()


@contextmanager
def connected(address: str, jobs: int | None) -> Iterator[Any]:
    """Give a client of a cluster that has at least one worker."""
    try:
        import distributed
    except ImportError:
        raise UsageError("--cluster needs dask.distributed: pip install 'vorotool[distributed]'") from None
    with ExitStack() as stack:
        yield _client(distributed, address, jobs, stack)


def completed(client: Any) -> Any:
    """Make what futures are added to; it gives them with their results, or with what went wrong, as they are done."""
    import distributed

    return distributed.as_completed(loop=client.loop, with_results=True, raise_errors=False)


def _client(distributed: Any, address: str, jobs: int | None, stack: ExitStack) -> Any:
    for name in ("distributed", "distributed.client"):
        logging.getLogger(name).setLevel(logging.CRITICAL)  # what it would say is in the outcomes
    if address != LOCAL:
        _check_address(address)
    cluster = stack.enter_context(_started(distributed, jobs)) if address == LOCAL else address
    try:
        client = distributed.Client(cluster, timeout=PATIENCE, set_as_default=False)
        stack.callback(_close, client)
        client.wait_for_workers(1, timeout=FIRST_WORKER)
    except TimeoutError:
        raise UsageError(f"--cluster {address}: nobody works there; start workers") from None
    except (OSError, ValueError) as error:
        raise UsageError(f"--cluster {address}: no scheduler answers there ({error}); check the address") from None
    return client


def _check_address(address: str) -> None:
    """Refuse at once what can be no address: a client that fails as it begins ends late, and not quietly."""
    from distributed import Security
    from distributed.comm.addressing import get_address_host_port, normalize_address, parse_address

    try:
        full = normalize_address(address)
        scheme, _ = parse_address(full)
        host, port = get_address_host_port(full, strict=True)
        if not host or not 0 < port < 1 << 16:
            raise ValueError("HOST must not be empty, and PORT from 1 to 65535")
    except ValueError as error:
        raise UsageError(
            f"--cluster {address!r} is no address of a scheduler ({error}): give HOST:PORT, or local to start a cluster"
        ) from None
    if scheme in ("tls", "wss") and Security().get_connection_args("client").get("ssl_context") is None:
        raise UsageError(
            f"--cluster {address} needs certificates: name them in distributed.comm.tls of Dask's settings"
        )


@contextmanager
def _started(distributed: Any, jobs: int | None) -> Iterator[Any]:
    """A cluster on this machine. Its workers have nothing to lose when it ends, so that they are killed."""
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
        _close(cluster)


def _close(connected: Any) -> None:
    with suppress(OSError):  # nobody answers any more, or not so fast
        connected.close(timeout=CLOSING)


def _carry_out(process: Process, task: Task) -> Outcome:
    with ONE_AT_A_TIME:
        return carry_out(process, task)


def _absolute(task: Task) -> Task:
    """The task for a process in another folder."""
    done = task.done and {name and str(Path(name).absolute()): digest for name, digest in task.done.items()}
    outputs = tuple(str(Path(path).absolute()) for path in task.outputs)
    path = str(Path(path_of(task.source)).absolute())
    source = PageName.of(path, task.source.page) if isinstance(task.source, PageName) else path
    return replace(task, source=source, outputs=outputs, done=done)


def _outcome(task: Task, future: Any, result: Any) -> Outcome:
    """The outcome of a task, in the words of this process."""
    if not isinstance(result, Outcome):
        reason = result[1] if future.status == "error" else "the scheduler does not answer any more"
        return Outcome(code=1, message=f"the cluster gave it up: {reason}")
    if result.version != __version__:
        return Outcome(code=1, message=f"a worker has vorotool {result.version}, but this is {__version__}")
    return replace(result, outputs=dict(zip(task.outputs, result.outputs.values(), strict=False)))


def _give_up(client: Any, given: dict[Any, tuple[int, Task]]) -> None:
    """Forget the tasks that are not done when the batch ends."""
    if given:
        with suppress(OSError):
            client.cancel(list(given))
