"""Worker processes of this machine; the tasks that they are sent, and the outcomes that they send back.

`ProcessPoolExecutor`, and loky like it, give up all tasks when one process dies: of 8, one of which kills its process,
7 are done here and 3 there (`tests/benchmarks/libraries.py pool`). Nor do they end a task that runs at an interrupt.
"""

from __future__ import annotations

import hashlib
import os
import pickle
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Generator, Iterator, Mapping
from contextlib import suppress
from dataclasses import field, replace
from itertools import islice
from pathlib import Path
from queue import SimpleQueue
from threading import Thread
from typing import Any, NoReturn, TypeVar

from vorotool import __version__
from vorotool.formats.io.descriptors import stream_kind
from vorotool.formats.io.sources import file_of
from vorotool.formats.io.temporaries import remove_left, tagged_temporaries
from vorotool.frozen import frozen
from vorotool.signals import insist_on_the_end

T = TypeVar("T")


@frozen
class Task:
    """The work for one input."""

    source: str  # what messages, tables and the record call the input: its path, or a page of it
    outputs: tuple[str, ...]  # paths of its outputs
    path: str = ""  # the file, where `source` is more than that
    page: int | None = None
    tag: str = ""  # in the names of temporary files, so that those of a killed process are known
    done: Outcome | None = None  # how it ended before, with the same options

    @property
    def file(self) -> str:
        """The path of the input."""
        return self.path or self.source


@frozen
class Outcome:
    """The outcome of one input."""

    code: int = 0  # the exit code that this input would give on its own; 0 is done
    message: str = ""  # the error
    warnings: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    stats: Mapping[str, Any] = field(default_factory=dict)  # counts and sizes
    seconds: Mapping[str, float] = field(default_factory=dict)  # seconds a phase
    digest: str = ""  # SHA-256 of the input
    outputs: Mapping[str, str] = field(default_factory=dict)  # SHA-256 of the outputs, by their paths
    unit: str = ""  # words for the unit of lengths in the outputs
    kept: bool = False  # it was done before
    version: str = __version__  # of the package that did it

    @property
    def status(self) -> str:
        """What became of the input, in a word."""
        return "kept" if self.kept else "failed" if self.code else "done"


Process = Callable[[Task], Outcome]
"""Does what a command does with one input. It can be pickled, and raises only what ends the whole program."""

Results = Callable[[Iterator[tuple[int, Task]]], Generator[tuple[int, Outcome], None, None]]
"""Does numbered tasks, which it takes when a worker is free, and yields the outcome of each."""


def keep_busy(
    items: Iterator[T], start: Callable[[T], Any], done: Iterator[tuple[Any, Any]], most: int, going: dict[Any, T]
) -> Iterator[tuple[T, Any, Any]]:
    """Start items, `most` at a time; yield each with its key and result when it is done."""
    for item in islice(items, most):
        going[start(item)] = item
    while going:
        key, result = next(done)
        yield going.pop(key), key, result
        for item in islice(items, 1):
            going[start(item)] = item


def carry_out(process: Process, task: Task) -> Outcome:
    """Do a task, unless it was done before, and take the digests of its files."""
    digest = digest_of(task.file)
    if is_done(task, digest):
        assert task.done is not None
        return replace(task.done, outputs={path: task.done.outputs[path] for path in task.outputs}, kept=True)
    with tagged_temporaries(task.tag):
        outcome = process(task)
    outputs = {} if outcome.code else {path: digest_of(path) for path in task.outputs}
    return replace(outcome, digest=digest, outputs=outputs)


def is_done(task: Task, digest: str) -> bool:
    """Return whether an input with this digest was done before, and its outputs are unchanged."""
    if not digest or task.done is None or task.done.digest != digest:
        return False
    return all(digest_of(path) == task.done.outputs.get(path, "none") for path in task.outputs)


def digest_of(path: str) -> str:
    """Return the SHA-256 of a file, or of the names and digests in a folder; empty where nothing can be read."""
    path = file_of(path)
    try:
        if Path(path).is_dir():
            names = sorted(each.relative_to(path).as_posix() for each in Path(path).rglob("*") if each.is_file())
            lines = [f"{digest_of(str(Path(path) / name))} {name}\n" for name in names]
            return hashlib.sha256("".join(lines).encode()).hexdigest()
        if stream_kind(path) is not None:
            return ""
        with Path(path).open("rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except (OSError, ValueError):
        return ""


START = "import sys; sys.path[:] = sys.argv[1:]; from vorotool.batch.workers import main; main()"
"""The program of a worker: modules are looked for where this process finds them, and not in the current folder."""

_ONE_THREAD = {"OPENBLAS_NUM_THREADS": "1"}
"""numpy's linear algebra, which inputs have no use for, would start threads that take time from other workers."""

ENDED = 128 + signal.SIGTERM
"""The exit code of a worker that was asked to end."""

PATIENCE = 0.15
"""Seconds that workers have to remove what they have begun before they are killed: kernels look for signals more
often, and an interrupt is over within 0.2 s."""


class Worker:
    """A process that does one task at a time, which come through its standard input."""

    def __init__(self, process: Process, done: SimpleQueue[tuple[Worker, Outcome | None]]) -> None:
        self.process = subprocess.Popen(
            [sys.executable, "-c", START, *sys.path],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            env=_ONE_THREAD | os.environ,
            process_group=0,
            creationflags=getattr(subprocess, "CREATE_NEW_PROCESS_GROUP", 0),
        )
        self._task: Task | None = None
        self._tasks: SimpleQueue[Task | None] = SimpleQueue()
        self._send(process)
        self._thread = Thread(target=self._serve, args=(done,), daemon=True)
        self._thread.start()

    def give(self, task: Task) -> None:
        """Hand a task over; its outcome goes to the queue, or None if the process ends instead."""
        self._task = task
        self._tasks.put(task)

    def _serve(self, done: SimpleQueue[tuple[Worker, Outcome | None]]) -> None:
        """Send tasks, and wait for the outcome of each."""
        for task in iter(self._tasks.get, None):
            self._send(task)
            done.put((self, self._outcome()))

    def _outcome(self) -> Outcome | None:
        try:
            outcome: Outcome = pickle.load(self.process.stdout)  # type: ignore[arg-type]  # it is a pipe
        except (EOFError, OSError, pickle.UnpicklingError):
            return None
        self._task = None
        return outcome

    def _send(self, value: object) -> None:
        stream: Any = self.process.stdin
        with suppress(OSError):  # where the process has ended this is seen when the result is asked for
            pickle.dump(value, stream)
            stream.flush()

    def end(self, deadline: float) -> str:
        """Wait until the process has ended, or kill it; remove what it has left, and say how it ended."""
        try:
            code = self.process.wait(max(0.0, deadline - time.monotonic()))
        except subprocess.TimeoutExpired:
            self.process.kill()
            code = self.process.wait()
        self._tasks.put(None)
        self._thread.join()  # it sees that the pipe is closed
        with suppress(OSError), self.process:  # closes the pipes
            pass
        if self._task is not None:
            remove_left({Path(path).parent for path in self._task.outputs}, self._task.tag)
        how = f"with exit code {code}" if code >= 0 else f"by {signal.Signals(-code).name}"
        return f"the process that worked on it ended {how}"


def local_results(
    process: Process, tasks: Iterator[tuple[int, Task]], *, jobs: int
) -> Generator[tuple[int, Outcome], None, None]:
    """Do tasks in processes of this machine."""
    done: SimpleQueue[tuple[Worker, Outcome | None]] = SimpleQueue()
    workers: set[Worker] = set()
    idle: list[Worker] = []

    def start(numbered: tuple[int, Task]) -> Worker:
        worker = idle.pop() if idle else Worker(process, done)
        workers.add(worker)
        worker.give(numbered[1])
        return worker

    try:
        for (number, _), worker, outcome in keep_busy(tasks, start, iter(done.get, None), jobs, {}):
            if outcome is None:
                workers.remove(worker)
                yield number, Outcome(code=1, message=worker.end(time.monotonic() + PATIENCE))
            else:
                idle.append(worker)
                yield number, outcome
    finally:
        for worker in workers:
            worker.process.terminate()  # which removes what it has begun
        deadline = time.monotonic() + PATIENCE
        for worker in workers:
            worker.end(deadline)


# ---- in the process of a worker ----------------------------------------------------------------------------------
def main() -> None:
    """Do the tasks that come through standard input and send back their outcomes, until it is closed."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the parent decides
    signal.signal(signal.SIGTERM, _end)
    insist_on_the_end()
    source, target = os.fdopen(os.dup(0), "rb"), os.fdopen(os.dup(1), "wb")
    nothing = os.open(os.devnull, os.O_RDWR)
    os.dup2(nothing, 0)
    os.dup2(nothing, 1)
    tasks: SimpleQueue[Any] = SimpleQueue()
    Thread(target=_read, args=(source, tasks), daemon=True).start()
    try:
        process: Process = tasks.get()
        while True:
            pickle.dump(carry_out(process, tasks.get()), target)
            target.flush()
    except (SystemExit, BrokenPipeError):  # nothing is left to do or to remove
        os._exit(ENDED)


def _read(source: Any, tasks: SimpleQueue[Any]) -> None:
    """Read tasks; end the process when the parent closes the pipe, in the middle of a task, too."""
    try:
        with suppress(EOFError, pickle.UnpicklingError):
            while True:
                tasks.put(pickle.load(source))
    finally:
        os.kill(os.getpid(), signal.SIGTERM)


def _end(number: int, _frame: object) -> NoReturn:
    """End as an exception does: temporary files are removed. A second signal does not disturb this."""
    signal.signal(number, signal.SIG_IGN)
    sys.exit()
