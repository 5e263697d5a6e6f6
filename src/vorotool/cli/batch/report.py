"""What a batch says: progress, failures, and the statistics of all inputs."""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Sequence
from contextlib import ExitStack
from types import TracebackType
from typing import Any

from vorotool.batch.tasks import Outcome, Task
from vorotool.errors import BatchError, Message
from vorotool.jobs.run_log import MakeBar, Run
from vorotool.jobs.terminal import print_text, tell
from vorotool.numeric.progress import Progress

NO_COUNTS = frozenset({"threads", "passes", "steps_per_pixel", "largest_label"})
"""Whole numbers in statistics that mean nothing when they are added."""


class Report:
    """Tells what becomes of each input: a bar on a terminal, else a line an input, unless the run is quiet."""

    def __init__(self, run: Run, total: int, bar: MakeBar | None) -> None:
        self._run, self._total, self._bar = run, total, bar
        self._stack = ExitStack()
        self._progress: Progress = None
        self._counts: Counter[str] = Counter()
        self._totals: Counter[str] = Counter()
        self._failures: list[dict[str, Any]] = []

    def __enter__(self) -> Report:
        """Show the bar."""
        if self._bar is not None and sys.stderr.isatty():
            self._progress = self._stack.enter_context(self._bar(""))
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """End the bar."""
        self._stack.close()

    def tell(self, task: Task, outcome: Outcome) -> None:
        """Say and count what became of an input."""
        status = "kept" if outcome.kept else "failed" if outcome.code else "done"
        self._counts[status] += 1
        if self._progress is not None and (outcome.warnings or outcome.code):
            print_text("\r\033[K", sys.stderr)  # in the place of the bar, which is drawn again below
        for warning in outcome.warnings:
            self._run.warn(_named(task.source, Message.of(warning)))
        if outcome.code:
            self._failures.append({"input": task.source, "exit": outcome.code, "error": outcome.message})
            tell(f"error: {_named(task.source, Message.of(outcome.message))}")
        if self._progress is not None:
            self._progress(self._counts.total() / self._total)
        elif self._bar is not None:
            tell(f"{self._counts.total()}/{self._total} {task.source}: {status}")
        for name, seconds in outcome.seconds.items():
            self._run.seconds[name] = self._run.seconds.get(name, 0.0) + seconds
        self._totals.update({name: n for name, n in outcome.stats.items() if type(n) is int and name not in NO_COUNTS})

    def finish(self, sources: Sequence[str]) -> None:
        """Put the statistics together; failures come in the order of the plan."""
        order = {source: number for number, source in enumerate(sources)}
        self._failures.sort(key=lambda failure: order[failure["input"]])
        self._run.warnings.sort()
        counts = {name: self._counts[name] for name in ("done", "kept", "failed")}
        self._run.stats |= {
            "inputs": self._total,
            **counts,
            "not_started": self._total - self._counts.total(),
            "totals": dict(sorted(self._totals.items())),
            "failures": self._failures,
        }

    def failure(self, *, keep_going: bool) -> BatchError | None:
        """What the program ends with, if inputs failed."""
        if not self._failures:
            return None
        left = self._total - self._counts.total()
        rest = f"; {left} were not started{'' if keep_going else ': --keep-going goes on'}" if left else ""
        return BatchError(f"{len(self._failures)} of {self._total} inputs failed{rest}")


def _named(source: str, message: Message) -> Message:
    """A line that names its input."""
    if message.source == source:
        return message
    return Message(f"{source}: {message}", message.kind, source=source)
