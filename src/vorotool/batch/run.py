"""The run of a plan: one input in this process, many in workers, with what was done before in mind."""

from __future__ import annotations

import json
import os
import secrets
import sys
import tempfile
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, closing
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from vorotool.batch import workers
from vorotool.batch.plan import Plan, check_inside, plan_batch
from vorotool.batch.records import Manifest
from vorotool.batch.workers import Outcome, Results, Task, digest_of, is_done
from vorotool.errors import BatchError, Message
from vorotool.formats.io import atomic_output
from vorotool.formats.io.descriptors import stream_kind
from vorotool.formats.io.temporaries import committed_together, new_folder, remove_left, temporary_beside
from vorotool.jobs.job import process_input
from vorotool.jobs.options import ALL_PAGES, Options, changed
from vorotool.jobs.run_log import MakeBar, Run
from vorotool.jobs.targets import Target
from vorotool.jobs.terminal import explained, print_text, tell
from vorotool.jobs.units import unit_stats
from vorotool.numeric.length_units import unit_name
from vorotool.signals import end_by_exceptions

NO_COUNTS = frozenset({"threads", "passes", "steps_per_pixel", "largest_label"})
"""Whole numbers in statistics that mean nothing when they are added."""


def run_batch(o: Options, several: str, bar: MakeBar) -> None:
    """Process several inputs, or one that is alone, in this process and with the exit code that it gives on its own."""
    plan, is_alone = plan_batch(o, several), not several
    o, tasks = plan.options, plan.tasks
    if o.dry_run or (is_alone and not tasks):
        _print_plan(plan)
        return
    no_clobber = o.no_clobber and not o.resume  # of the files of all inputs
    _check_files(o, no_clobber=no_clobber)
    end_by_exceptions()
    with ExitStack() as stack:
        if plan.table is not None:
            folder = _folder_of_parts(plan, stack)
            tasks = [replace(task, outputs=(*task.outputs, plan.table.part(folder, task.source))) for task in tasks]
        if plan.manifest is not None:
            parts = [task.outputs[-1] for task in tasks] if plan.table is not None else []
            check_inside([plan.manifest.path, *parts], plan.manifest.folder)
        run = stack.enter_context(
            Run(o.command, quiet=o.quiet, verbose=o.verbose, stats=o.stats, no_clobber=no_clobber, bar=bar)
        )
        for text in plan.notes:
            run.note(text)
        report = None
        if is_alone:
            process_input(run, o, tasks[0].file, _of_task(plan.targets, tasks[0]))
            outcomes: list[Outcome | None] = [Outcome(stats=run.stats)]
        else:
            report = _Report(run, len(tasks), quiet=o.quiet)
            results = _results(plan)
            outcomes = run_tasks(tasks, results, plan.manifest, keep_going=o.keep_going, finish=report.finish)
        done = [(task, outcome) for task, outcome in zip(tasks, outcomes, strict=True) if outcome is not None]
        if plan.table is not None and len(done) == len(tasks):
            with run.phase("write --table"), committed_together():
                plan.table.write(done, no_clobber=no_clobber)
        if report is not None:
            report.summarize(tasks)
            run.stats |= unit_stats(o.unit)
    if report is not None:
        report.check(keep_going=o.keep_going)


def _print_plan(plan: Plan) -> None:
    for task in plan.tasks:
        kept = task.done is not None and is_done(task, digest_of(task.file))
        outputs = list(dict.fromkeys(task.outputs))
        record = {"input": task.source, "status": "kept" if kept else "planned", "outputs": outputs}
        print_text(json.dumps(record) + "\n")
    for text in () if plan.options.quiet else plan.notes:
        tell(f"note: {text}")


def _check_files(o: Options, *, no_clobber: bool) -> None:
    """Find out before any work whether the files of all inputs can be written."""
    for option, path in (("--stats", o.stats), ("--table", o.table), ("--table-inputs", o.table_inputs)):
        if path is not None:
            is_inside = o.out_dir is not None and Path(path).parent == Path(o.out_dir)
            atomic_output.check_output(path, no_clobber=no_clobber, makes_folder=is_inside, option=option)


def _folder_of_parts(plan: Plan, stack: ExitStack) -> str:
    """Return the folder for the tables of inputs: beside the record, else beside the table until the end."""
    assert plan.table is not None
    if plan.manifest is not None:
        return str(plan.manifest.folder / f".{plan.options.command}.tables")
    path = plan.table.place
    folder = Path(os.path.realpath(path)).parent if stream_kind(path) is None else Path(tempfile.gettempdir())
    with atomic_output.explained(path, "--table"):
        return stack.enter_context(temporary_beside(folder / "tables", new_folder)).path


# ---- the work ----------------------------------------------------------------------------------------------------
def process_one(o: Options, targets: Sequence[Target], task: Task) -> Outcome:
    """Process one input, and say nothing but in the outcome."""
    message, code = "", 0
    with Run(o.command, quiet=True, verbose=False, stats=None) as run:
        try:
            page = task.page if o.page == ALL_PAGES else o.page
            process_input(run, changed(o, page=page), task.file, _of_task(targets, task))
        except Exception as error:
            message, code = explained(error)
    notes = tuple(run.notes)
    return Outcome(code, message, tuple(run.warnings), notes, run.stats, run.seconds, unit=_unit_text(run.stats))


def _unit_text(stats: Mapping[str, Any]) -> str:
    """Return words for the unit of the results of an input."""
    if not {"pixel_size", "spacing", "unit"} & set(stats):
        return "pixels, or the units of the file"
    unit = "units without a name" if stats["unit"] is None else unit_name(stats["unit"])
    return f"{unit} in {stats['crs']}" if "crs" in stats else unit


def _of_task(targets: Sequence[Target], task: Task) -> list[Target]:
    """Return the outputs of a task."""
    return [Target(target.what, path, target.fmt) for target, path in zip(targets, task.outputs, strict=True)]


def _results(plan: Plan) -> Results:
    """Return what does the work: processes of this machine, or a cluster."""
    o = plan.options
    jobs = (os.cpu_count() or 1) if o.jobs == 0 else o.jobs
    files: dict[str, Any] = {name: str(Path(path).absolute()) for name, path in o.files_of_inputs.items()}
    options = changed(
        o,
        threads=o.threads or int(o.cluster is not None or (jobs or 1) > 1),
        stats=None if o.stats is None else os.devnull,  # statistics are made, and sent to this process
        **files,
    )
    process = partial(process_one, options, plan.targets)
    if o.cluster is None:
        return partial(workers.local_results, process, jobs=min(jobs or 1, len(plan.tasks)))
    from vorotool.batch.cluster import cluster_results

    return partial(cluster_results, process, address=o.cluster, jobs=jobs)


def run_tasks(
    tasks: Sequence[Task],
    results: Results,
    manifest: Manifest | None = None,
    *,
    keep_going: bool = False,
    finish: Callable[[Task, Outcome], None] = lambda task, outcome: None,
) -> list[Outcome | None]:
    """Start tasks in order, until one fails; record each, and return its outcome, None if it was not started."""
    name = secrets.token_hex(4)
    tasks = [replace(task, tag=f"{name}-{number}-") for number, task in enumerate(tasks)]
    outcomes: list[Outcome | None] = [None] * len(tasks)
    has_failed = False

    def feed() -> Iterator[tuple[int, Task]]:
        for numbered in enumerate(tasks):
            if has_failed and not keep_going:
                return
            yield numbered

    with ExitStack() as stack:
        if manifest is not None:
            stack.enter_context(manifest)
            folders = {Path(path).parent for task in tasks for path in task.outputs}
            remove_left(folders)
            manifest.begin(name, len(tasks))
            stack.callback(remove_left, folders, f"{name}-")
        for number, outcome in stack.enter_context(closing(results(feed()))):
            outcomes[number] = outcome
            has_failed = has_failed or outcome.code != 0
            if manifest is not None:
                manifest.add(tasks[number], outcome)
            finish(tasks[number], outcome)
    return outcomes


# ---- messages and statistics -------------------------------------------------------------------------------------
class _Report:
    """Tells what becomes of each input: a bar on a terminal, else a line an input, unless the run is quiet."""

    def __init__(self, run: Run, total: int, *, quiet: bool) -> None:
        self._run, self._total, self._quiet = run, total, quiet
        self._progress = run.progress("", after=0.0)
        self._statuses: Counter[str] = Counter()
        self._sums: Counter[str] = Counter()
        self._failures: dict[str, dict[str, Any]] = {}
        if self._progress is not None:
            self._progress(0.0)

    def finish(self, task: Task, outcome: Outcome) -> None:
        """Tell and count the outcome of a task."""
        self._statuses[outcome.status] += 1
        if self._progress is not None and (outcome.warnings or outcome.code):
            print_text("\r\033[K", sys.stderr)  # in place of the bar, which is drawn again below
        for warning in outcome.warnings:
            self._run.warn(_named(task.source, Message.of(warning)))
        if outcome.code:
            self._failures[task.source] = {"input": task.source, "exit": outcome.code, "error": outcome.message}
            tell(f"error: {_named(task.source, Message.of(outcome.message))}")
        if self._progress is not None:
            self._progress(self._statuses.total() / self._total)
        elif not self._quiet:
            tell(f"{self._statuses.total()}/{self._total} {task.source}: {outcome.status}")
        for name, seconds in outcome.seconds.items():
            self._run.seconds[name] = self._run.seconds.get(name, 0.0) + seconds
        self._sums.update({name: n for name, n in outcome.stats.items() if type(n) is int and name not in NO_COUNTS})

    def summarize(self, tasks: Sequence[Task]) -> None:
        """Put the statistics together; failures come in the order of the plan."""
        self._run.warnings.sort()
        self._run.stats |= {
            "inputs": self._total,
            **{status: self._statuses[status] for status in ("done", "kept", "failed")},
            "not_started": self._total - self._statuses.total(),
            "totals": dict(sorted(self._sums.items())),
            "failures": [self._failures[task.source] for task in tasks if task.source in self._failures],
        }

    def check(self, *, keep_going: bool) -> None:
        """Raise the error that ends the program, if inputs failed."""
        left = self._total - self._statuses.total()
        goes_on = "" if keep_going else "; --keep-going continues after a failure"
        rest = f"; {left} {'was' if left == 1 else 'were'} not started{goes_on}" if left else ""
        if self._failures:
            raise BatchError(f"{self._statuses['failed']} of {self._total} inputs failed{rest}")


def _named(source: str, message: Message) -> Message:
    """Return a line that names its input, once: that of a page begins with the name of the file."""
    if message.source == source:
        return message
    line = message.removeprefix(f"{message.source}: ") if source.startswith(f"{message.source}, page ") else message
    return Message(f"{source}: {line}", message.kind, source=source)
