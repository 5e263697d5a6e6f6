"""Doing what is planned, wherever it is done, with what was done before in mind."""

from __future__ import annotations

import secrets
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import closing
from dataclasses import replace
from pathlib import Path

from vorotool.batch.manifest import Manifest
from vorotool.batch.tasks import Outcome, Task
from vorotool.formats.io.temporaries import remove_dead, remove_tagged

Results = Callable[[Iterator[tuple[int, Task]]], Generator[tuple[int, Outcome], None, None]]
"""Does numbered tasks, which it takes when there is somebody to do them, and yields what became of each."""

Told = Callable[[Task, Outcome], None]


def run_tasks(
    tasks: Sequence[Task], results: Results, *, keep_going: bool = False, told: Told | None = None
) -> list[Outcome | None]:
    """Do tasks."""
    outcomes: list[Outcome | None] = [None] * len(tasks)
    failed = False

    def feed() -> Iterator[tuple[int, Task]]:
        for number, task in enumerate(tasks):
            if failed and not keep_going:
                return
            yield number, task

    with closing(results(feed())) as done:
        for number, outcome in done:
            outcomes[number] = outcome
            failed = failed or outcome.code != 0
            if told is not None:
                told(tasks[number], outcome)
    return outcomes


def run_batch(
    command: str,
    tasks: Sequence[Task],
    results: Results,
    *,
    manifest: Manifest | None = None,
    keep_going: bool = False,
    told: Told | None = None,
) -> list[Outcome | None]:
    """Do tasks, and record what becomes of them."""
    run = secrets.token_hex(4)
    tasks = [replace(task, tag=f"{run}-{number}-") for number, task in enumerate(tasks)]
    if manifest is None:
        return run_tasks(tasks, results, keep_going=keep_going, told=told)

    def tell(task: Task, outcome: Outcome) -> None:
        manifest.add(task, outcome)
        if told is not None:
            told(task, outcome)

    folders = {Path(path).parent for task in tasks for path in task.outputs}
    with manifest:
        for folder in folders:
            remove_dead(folder)
        manifest.begin(run, command, len(tasks))
        try:
            return run_tasks(tasks, results, keep_going=keep_going, told=tell)
        finally:
            remove_tagged(folders, f"{run}-")
