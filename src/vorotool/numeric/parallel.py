"""Threads for work that releases the lock of the interpreter, the progress of long work, and variables of contexts."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from typing import TYPE_CHECKING, Protocol, TypedDict, TypeVar

from vorotool.numeric.checks import available_threads, checked_threads

if TYPE_CHECKING:
    from concurrent.futures import Future

Item = TypeVar("Item")
Result = TypeVar("Result")
CHUNK = 1 << 15
"""Rows that are taken at a time: what is made of them stays in the cache."""

POLL_INTERVAL = 0.1
"""Seconds between two looks at how far others are."""


def in_order(function: Callable[[Item], Result], items: Iterable[Item], threads: int) -> Iterator[Result]:
    """Map in parallel, in order, with only a few items under way, whatever their number."""
    count = threads or available_threads()
    if count == 1:
        yield from map(function, items)
        return
    from concurrent.futures import ThreadPoolExecutor  # it imports logging and more, which short jobs need not wait for

    pending: deque[Future[Result]] = deque()
    with ThreadPoolExecutor(count) as pool:
        try:
            for item in items:
                pending.append(pool.submit(function, item))
                if len(pending) > 2 * count:
                    yield pending.popleft().result()
            while pending:
                yield pending.popleft().result()
        finally:
            for future in pending:
                future.cancel()


def in_chunks(count: int, fill: Callable[[slice], None], *, threads: int = 1) -> None:
    """Call a function for chunks of rows: what it makes of one must not depend on the others."""
    chunks = [slice(begin, begin + CHUNK) for begin in range(0, count, CHUNK)]
    threads = min(checked_threads(threads) or available_threads(), max(len(chunks), 1))
    for _ in in_order(fill, chunks, threads):
        pass


def in_threads(tasks: Sequence[Callable[[Progress], Result]], threads: int, progress: Progress) -> list[Result]:
    """Do tasks, and give their results in order."""
    if len(tasks) == 1:
        return [tasks[0](progress)]
    from concurrent.futures import ThreadPoolExecutor, wait

    stop = threading.Event()
    done = [0.0] * len(tasks)

    def progress_of(k: int) -> Progress:
        def poll(fraction: float) -> None:
            if stop.is_set():
                raise KeyboardInterrupt
            done[k] = fraction

        return poll

    def work(k: int) -> Result:
        result = tasks[k](progress_of(k))
        done[k] = 1.0
        return result

    def look() -> None:
        if progress is not None:  # there may be many tasks
            progress(sum(done) / len(tasks))

    with ThreadPoolExecutor(threads) as pool:
        futures = [pool.submit(work, k) for k in range(len(tasks))]
        try:
            for future in futures:
                while wait([future], POLL_INTERVAL).not_done:
                    look()
                future.result()
                look()
        except BaseException:
            stop.set()
            pool.shutdown(cancel_futures=True)
            raise
    return [future.result() for future in futures]


def start(work: Callable[[], Result], future: Future[Result]) -> None:
    """Begin some work in a thread that does not keep the process from ending; its outcome goes to a future."""

    def run() -> None:
        if future.set_running_or_notify_cancel():
            try:
                future.set_result(work())
            except BaseException as error:  # which the waiting thread raises
                future.set_exception(error)

    threading.Thread(target=run, daemon=True).start()


class Report(Protocol):
    """Called now and then with the fraction done, from 0 to 1; what it raises stops the work."""

    def __call__(self, fraction: float, /) -> object:
        """Take notice."""


Progress = Report | None
"""None where nobody asks."""


class Run(TypedDict, total=False):
    """How work is done, for functions that only hand it on."""

    threads: int  # 0 for all
    progress: Progress


def running(threads: int, progress: Progress) -> Run:
    """Return what is handed on, after a check."""
    return {"threads": checked_threads(threads), "progress": progress}


def report(progress: Progress, fraction: float) -> None:
    """Tell who asks how much is done."""
    if progress is not None:
        progress(fraction)


@contextmanager
def scoped(variable: ContextVar[Result], value: Result) -> Iterator[None]:
    """Give a variable of the context a value for what runs within."""
    token = variable.set(value)
    try:
        yield
    finally:
        variable.reset(token)
