"""The tasks of a batch where a process cannot hand an open descriptor down to another, as on Windows.

`concurrent.futures` has what starts processes there. When one of them dies it gives up all tasks that are being done:
all of these fail, and other processes go on with the next ones. Tasks that run at an interrupt are finished.
"""

from __future__ import annotations

import signal
from collections.abc import Generator, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from multiprocessing import get_context
from pathlib import Path

from vorotool.batch.tasks import Outcome, Process, Task, carry_out
from vorotool.formats.io.temporaries import remove_tagged


def executor_results(
    process: Process, tasks: Iterator[tuple[int, Task]], *, jobs: int
) -> Generator[tuple[int, Outcome], None, None]:
    """Do tasks in processes of this machine."""
    pool = _new_pool(jobs)
    busy: dict[Future[Outcome], tuple[int, Task]] = {}

    def give() -> bool:
        number, task = next(tasks, (-1, None))
        if task is None:
            return False
        busy[pool.submit(carry_out, process, task)] = number, task
        return True

    try:
        while len(busy) < jobs and give():
            pass
        while busy:
            done, _ = wait(busy, return_when=FIRST_COMPLETED)
            if any(isinstance(future.exception(), BrokenProcessPool) for future in done):
                pool.shutdown()
                pool, done = _new_pool(jobs), set(busy)
            for future in done:
                number, task = busy.pop(future)
                yield number, _outcome(future, task)
            while len(busy) < jobs and give():
                pass
    finally:
        pool.shutdown(cancel_futures=True)


def _new_pool(jobs: int) -> ProcessPoolExecutor:
    # the parent decides what an interrupt ends
    return ProcessPoolExecutor(
        jobs, mp_context=get_context("spawn"), initializer=signal.signal, initargs=(signal.SIGINT, signal.SIG_IGN)
    )


def _outcome(future: Future[Outcome], task: Task) -> Outcome:
    try:
        return future.result()
    except BrokenProcessPool:
        remove_tagged({Path(path).parent for path in task.outputs}, task.tag)
        return Outcome(code=1, message="a process that worked at the same time ended")
