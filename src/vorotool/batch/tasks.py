"""Tasks of a batch and their outcomes: what is sent to workers, and what they send back."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Generator, Iterator, Mapping
from dataclasses import field, replace
from itertools import islice
from pathlib import Path
from typing import Any, TypeVar

from vorotool import __version__
from vorotool.formats.io.descriptors import stream_kind
from vorotool.formats.io.sources import file_of
from vorotool.formats.io.temporaries import tagged_temporaries
from vorotool.frozen import frozen

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
