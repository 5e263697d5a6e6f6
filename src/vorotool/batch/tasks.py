"""One input of a batch, and what became of it: what is sent to those who do the work and what they send back."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import field, replace
from pathlib import Path
from typing import Any

from vorotool import __version__
from vorotool.batch.pages import path_of
from vorotool.formats.io.descriptors import stream_kind
from vorotool.formats.io.layer_names import file_of
from vorotool.formats.io.temporaries import tagged_temporaries
from vorotool.plain import plain

INPUT = ""
"""Stands for the input where digests are by the paths of outputs."""


@plain
class Task:
    """The work for one input."""

    source: str  # path of the input
    outputs: tuple[str, ...]  # paths of its outputs
    tag: str = ""  # in the names of temporary files, so that those of a killed process can be told
    # digests of the input (at `INPUT`) and of outputs when it was done before, with the same options
    done: Mapping[str, str] | None = None


@plain
class Outcome:
    """The outcome of one input."""

    code: int = 0  # the exit code that it would have alone; 0 is done
    message: str = ""  # what went wrong
    warnings: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    stats: Mapping[str, Any] = field(default_factory=dict)  # counts and sizes
    seconds: Mapping[str, float] = field(default_factory=dict)  # seconds a phase
    digest: str = ""  # SHA-256 of the input
    outputs: Mapping[str, str] = field(default_factory=dict)  # SHA-256 of the outputs, by their paths
    kept: bool = False  # nothing was done, as all was there
    version: str = __version__  # of the package that did it


Process = Callable[[str, Sequence[str]], Outcome]
"""``process(source, outputs)`` does what a command does with one input, and tells what became of it: of what goes
wrong it raises only what ends the whole program. It can be pickled."""


def carry_out(process: Process, task: Task) -> Outcome:
    """Do what is to be done with one input, unless it is done already, and take the digests of what is there then."""
    digest = digest_of(path_of(task.source))
    if task.done is not None and is_done(task, digest):
        return Outcome(digest=digest, outputs={path: task.done[path] for path in task.outputs}, kept=True)
    with tagged_temporaries(task.tag):
        outcome = process(task.source, task.outputs)
    outputs = {} if outcome.code else {path: digest_of(path) for path in task.outputs}
    return replace(outcome, digest=digest, outputs=outputs)


def is_done(task: Task, digest: str) -> bool:
    """Whether an input with this digest was done before, and its outputs are still what they were then."""
    done = task.done
    if not digest or done is None or done[INPUT] != digest or not all(path in done for path in task.outputs):
        return False
    return all(digest_of(path) == done[path] for path in task.outputs)


def digest_of(path: str) -> str:
    """SHA-256 of a file, or of the names and digests of those in a folder, as text; empty where nothing can be read."""
    path = file_of(path)
    try:
        if Path(path).is_dir():
            return _digest_of_folder(Path(path))
        if stream_kind(path) is not None:
            return ""
        with Path(path).open("rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except (OSError, ValueError):
        return ""


def _digest_of_folder(folder: Path) -> str:
    files = sorted(path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file())
    lines = [f"{digest_of(str(folder / name))} {name}\n" for name in files]
    return hashlib.sha256("".join(lines).encode()).hexdigest()
