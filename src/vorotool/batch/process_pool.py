"""Processes of this machine that do the tasks of a batch.

`ProcessPoolExecutor`, and loky like it, give up all tasks when one process dies: of 8, one of which kills its process,
7 are done here and 3 there (`tests/benchmarks/libraries.py pool`). Nor do they end a task that runs at an interrupt.
"""

from __future__ import annotations

import os
import select
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Generator, Iterator
from contextlib import suppress
from multiprocessing.connection import Connection, wait
from pathlib import Path

from vorotool.batch.tasks import Outcome, Process, Task
from vorotool.formats.io.temporaries import remove_tagged

START = "import sys; sys.path[:] = sys.argv[2:]; from vorotool.batch.pool_worker import main; main(int(sys.argv[1]))"
"""The program of a worker: modules are looked for where this process finds them, and not in the current folder."""

_ONE_THREAD = {"OPENBLAS_NUM_THREADS": "1"}
"""numpy's linear algebra, which inputs have no use for, would start threads that take time from other workers."""

PATIENCE = 0.15
"""Seconds that workers have to remove what they have begun before they are killed: kernels look for signals more
often, and an interrupt is over within 0.2 s."""


class Worker:
    """A process that does one task at a time."""

    def __init__(self, process: Process) -> None:
        ours, theirs = socket.socketpair()
        with ours, theirs:
            number = theirs.fileno()
            self._process = subprocess.Popen(
                [sys.executable, "-c", START, str(number), *sys.path],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                env=_ONE_THREAD | os.environ,
                pass_fds=(number,),
                process_group=0,
            )
            self.connection = Connection(ours.detach())
        self._task: Task | None = None
        self._send(process)

    def give(self, task: Task) -> None:
        """Hand a task over; where the process has ended this is seen when the result is asked for."""
        self._task = task
        self._send(task)

    def _send(self, value: object) -> None:
        with suppress(OSError):
            self.connection.send(value)

    def result(self) -> Outcome | None:
        """The outcome of the task, or None if the process has ended instead."""
        try:
            outcome: Outcome = self.connection.recv()
        except (EOFError, OSError):
            return None
        self._task = None
        return outcome

    def end(self) -> str:
        """Say how the process has ended, which a lost connection tells."""
        self.wait(time.monotonic() + PATIENCE)
        code = self._process.returncode
        how = f"with exit code {code}" if code >= 0 else f"by {signal.Signals(-code).name}"
        return f"the process that worked on it ended {how}"

    def stop(self) -> None:
        """Ask the process to remove what it has begun and to end; one that does nothing ends at once."""
        if self._task is None:
            self._process.kill()
        else:
            self._process.terminate()

    def wait(self, deadline: float) -> None:
        """Wait until the process has ended; if it has not by then, kill it and remove what it has left."""
        self.connection.close()
        try:
            self._process.wait(max(0.0, deadline - time.monotonic()))
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        if self._task is not None:
            remove_tagged({Path(path).parent for path in self._task.outputs}, self._task.tag)


def local_results(
    process: Process, tasks: Iterator[tuple[int, Task]], *, jobs: int
) -> Generator[tuple[int, Outcome], None, None]:
    """Do tasks in processes of this machine."""
    if hasattr(select, "poll"):  # by which a worker sees that its parent has gone
        return _socket_results(process, tasks, jobs)
    from vorotool.batch.executor_pool import executor_results

    return executor_results(process, tasks, jobs=jobs)


def _socket_results(
    process: Process, tasks: Iterator[tuple[int, Task]], jobs: int
) -> Generator[tuple[int, Outcome], None, None]:
    workers: set[Worker] = set()
    busy: dict[object, tuple[Worker, int]] = {}

    def give(worker: Worker | None) -> bool:
        number, task = next(tasks, (-1, None))
        if task is None:
            return False
        if worker is None:
            worker = Worker(process)
            workers.add(worker)
        busy[worker.connection] = worker, number
        worker.give(task)
        return True

    try:
        while len(busy) < jobs and give(None):
            pass
        while busy:
            for ready in wait([worker.connection for worker, _ in busy.values()]):
                worker, number = busy.pop(ready)
                outcome = worker.result()
                if outcome is not None and not outcome.code:
                    give(worker)
                    yield number, outcome
                elif outcome is not None:
                    yield number, outcome
                    give(worker)
                else:
                    workers.remove(worker)
                    yield number, Outcome(code=1, message=worker.end())
                    give(None)
    finally:
        for worker in workers:
            worker.stop()
        deadline = time.monotonic() + PATIENCE
        for worker in workers:
            worker.wait(deadline)
