"""Messages and statistics of a batch: progress, failures, totals."""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Sequence
from typing import Any

from vorotool.batch.tasks import Outcome, Task
from vorotool.errors import BatchError, Message
from vorotool.jobs.run_log import Run
from vorotool.jobs.terminal import print_text, tell

NO_COUNTS = frozenset({"threads", "passes", "steps_per_pixel", "largest_label"})
"""Whole numbers in statistics that mean nothing when they are added."""


class Report:
    """Tells what becomes of each input: a bar on a terminal, else a line an input, unless the run is quiet."""

    def __init__(self, run: Run, total: int, *, quiet: bool) -> None:
        self._run, self._total, self._quiet = run, total, quiet
        self._progress = run.progress("", after=0.0)
        if self._progress is not None:
            self._progress(0.0)
        self._counts: Counter[str] = Counter()
        self._totals: Counter[str] = Counter()
        self._failures: list[dict[str, Any]] = []

    def finish(self, task: Task, outcome: Outcome) -> None:
        """Tell and count the outcome of a task."""
        self._counts[outcome.status] += 1
        if self._progress is not None and (outcome.warnings or outcome.code):
            print_text("\r\033[K", sys.stderr)  # in place of the bar, which is drawn again below
        for warning in outcome.warnings:
            self._run.warn(_named(task.source, Message.of(warning)))
        if outcome.code:
            self._failures.append({"input": task.source, "exit": outcome.code, "error": outcome.message})
            tell(f"error: {_named(task.source, Message.of(outcome.message))}")
        if self._progress is not None:
            self._progress(self._counts.total() / self._total)
        elif not self._quiet:
            tell(f"{self._counts.total()}/{self._total} {task.source}: {outcome.status}")
        for name, seconds in outcome.seconds.items():
            self._run.seconds[name] = self._run.seconds.get(name, 0.0) + seconds
        self._totals.update({name: n for name, n in outcome.stats.items() if type(n) is int and name not in NO_COUNTS})

    def summarize(self, sources: Sequence[str]) -> None:
        """Put the statistics together; failures come in the order of the plan."""
        order = {source: number for number, source in enumerate(sources)}
        self._failures.sort(key=lambda failure: order[failure["input"]])
        self._run.warnings.sort()
        self._run.stats |= {
            "inputs": self._total,
            **{name: self._counts[name] for name in ("done", "kept", "failed")},
            "not_started": self._total - self._counts.total(),
            "totals": dict(sorted(self._totals.items())),
            "failures": self._failures,
        }

    def failure(self, *, keep_going: bool) -> BatchError | None:
        """Return the error that ends the program, if inputs failed."""
        if not self._failures:
            return None
        left = self._total - self._counts.total()
        rest = f"; {left} were not started{'' if keep_going else ': --keep-going goes on'}" if left else ""
        return BatchError(f"{len(self._failures)} of {self._total} inputs failed{rest}")


def _named(source: str, message: Message) -> Message:
    """Return a line that names its input."""
    if message.source == source:
        return message
    return Message(f"{source}: {message}", message.kind, source=source)
