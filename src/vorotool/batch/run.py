"""The run of a plan: one input in this process, many in workers, with what was done before in mind."""

from __future__ import annotations

import json
import os
import secrets
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, closing
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from vorotool.batch.manifest import Manifest
from vorotool.batch.outputs import check_inside
from vorotool.batch.plan import Plan, plan_batch
from vorotool.batch.report import Report
from vorotool.batch.tables import part_path
from vorotool.batch.tasks import Outcome, Process, Results, Task, digest_of, is_done
from vorotool.errors import InputError, OutputError
from vorotool.formats.io.atomic_output import check_output
from vorotool.formats.io.commit import committed_together
from vorotool.formats.io.descriptors import stream_kind
from vorotool.formats.io.temporaries import new_folder, remove_dead, remove_tagged, temporary_beside
from vorotool.jobs.failures import explained
from vorotool.jobs.job import Recipe, process_input
from vorotool.jobs.options import ALL_PAGES, Options, changed
from vorotool.jobs.run_log import MakeBar, Run
from vorotool.jobs.targets import Target
from vorotool.jobs.terminal import print_text, tell
from vorotool.jobs.units import unit_stats
from vorotool.numeric.length_units import unit_name
from vorotool.signals import end_by_exceptions

Finish = Callable[[Task, Outcome], None]
"""Takes each task with its outcome, as soon as it is done."""


def run_batch(recipe: Recipe, o: Options, *, is_alone: bool, bar: MakeBar) -> None:
    """Process many inputs, or one that is alone, in this process and with the exit code that it has by itself."""
    plan = plan_batch(recipe, o, is_alone=is_alone)
    o = plan.options
    if o.dry_run or (is_alone and not plan.tasks):
        _print_plan(plan)
        return
    _check_files(o)
    end_by_exceptions()
    with ExitStack() as stack:
        tasks = _with_parts(recipe, plan, stack)
        run = stack.enter_context(
            Run(recipe.name, quiet=o.quiet, verbose=o.verbose, stats=o.stats, no_clobber=o.no_clobber, bar=bar)
        )
        for text in plan.notes:
            run.note(text)
        if is_alone:
            (task,) = tasks
            process_input(recipe, run, o, task.file, _targets(plan.targets, task))
            _write_tables(run, plan, tasks, [Outcome(stats=run.stats)])
            return
        report = Report(run, len(tasks), quiet=o.quiet)
        results = _results(recipe, plan, len(tasks))
        outcomes = run_tasks(
            recipe.name, tasks, results, manifest=plan.manifest, keep_going=o.keep_going, finish=report.finish
        )
        if plan.table is not None and None not in outcomes:
            _write_tables(run, plan, tasks, [outcome for outcome in outcomes if outcome is not None])
        report.summarize([task.source for task in tasks])
        run.stats |= unit_stats(o.unit)
    if (failure := report.failure(keep_going=o.keep_going)) is not None:
        raise failure


def _print_plan(plan: Plan) -> None:
    for task in plan.tasks:
        kept = task.done is not None and is_done(task, digest_of(task.file))
        outputs = list(dict.fromkeys(task.outputs))
        record = {"input": task.source, "status": "kept" if kept else "planned", "outputs": outputs}
        print_text(json.dumps(record) + "\n")
    for text in () if plan.options.quiet else plan.notes:
        tell(f"note: {text}")


def _check_files(o: Options) -> None:
    """Find out before any work whether the files of all inputs can be written."""
    for option, path in (("stats", o.stats), ("table", o.table), ("table-inputs", o.table_inputs)):
        if path is not None:
            is_inside = o.out_dir is not None and Path(path).parent == Path(o.out_dir)
            may_replace = not o.no_clobber or o.resume
            check_output(path, no_clobber=not may_replace, makes_folder=is_inside, option=f"--{option}")


def _with_parts(recipe: Recipe, plan: Plan, stack: ExitStack) -> list[Task]:
    """Return the tasks with the tables of inputs as outputs: beside the record, else in a folder until the end.

    A record, and tables of inputs, that links would lead out of their folder are refused.
    """
    tasks, table, manifest = plan.tasks, plan.table, plan.manifest
    if table is not None:
        if manifest is not None:
            folder = str(manifest.folder / f".{recipe.name}.tables")
        else:
            is_beside = stream_kind(table.place) is None
            beside = Path(os.path.realpath(table.place)).parent if is_beside else Path(tempfile.gettempdir())
            try:
                folder = str(stack.enter_context(temporary_beside(beside / "tables", new_folder)).path)
            except OSError as error:
                raise OutputError(
                    f"tables cannot be written in {beside}: {error.strerror}; choose another name"
                ) from error
        tasks = [replace(task, outputs=(*task.outputs, part_path(folder, task.source, table.fmt))) for task in tasks]
    if manifest is not None:
        parts = [task.outputs[-1] for task in tasks] if table is not None else []
        check_inside([manifest.path, *parts], manifest.folder)
    return tasks


# ---- the work ----------------------------------------------------------------------------------------------------
def process_one(recipe: Recipe, options: Options, targets: Sequence[Target], task: Task) -> Outcome:
    """Process one input, and say nothing but in the outcome."""
    if options.page == ALL_PAGES:
        options = changed(options, page=task.page)
    message, code = "", 0
    with Run(recipe.name, quiet=True, verbose=False, stats=None) as run:
        try:
            process_input(recipe, run, options, task.file, _targets(targets, task))
        except Exception as error:
            message, code = explained(error)
    return Outcome(code, message, tuple(run.warnings), tuple(run.notes), run.stats, run.seconds)


def _targets(targets: Sequence[Target], task: Task) -> list[Target]:
    """Return the outputs of a task."""
    return [Target(target.what, path, target.fmt) for target, path in zip(targets, task.outputs, strict=True)]


def _results(recipe: Recipe, plan: Plan, count: int) -> Results:
    """Return what does the work: processes of this machine, or a cluster."""
    o = plan.options
    jobs = (os.cpu_count() or 1) if o.jobs == 0 else o.jobs
    files: dict[str, Any] = {name: str(Path(path).absolute()) for name, path in o.files_of_inputs().items()}
    options = changed(
        o,
        threads=o.threads or int(o.cluster is not None or (jobs or 1) > 1),
        stats=None if o.stats is None else os.devnull,  # statistics are made, and sent to this process
        **files,
    )
    process: Process = partial(process_one, recipe, options, plan.targets)
    if o.cluster is None:
        from vorotool.batch.workers import local_results

        return partial(local_results, process, jobs=min(jobs or 1, count))
    from vorotool.batch.cluster import cluster_results

    return partial(cluster_results, process, address=o.cluster, jobs=jobs)


def run_tasks(
    command: str,
    tasks: Sequence[Task],
    results: Results,
    *,
    manifest: Manifest | None = None,
    keep_going: bool = False,
    finish: Finish = lambda task, outcome: None,
) -> list[Outcome | None]:
    """Do tasks in order, until one fails; record the outcome of each, and return those of the tasks that were done."""
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
            for folder in folders:
                remove_dead(folder)
            manifest.begin(name, command, len(tasks))
            stack.callback(remove_tagged, folders, f"{name}-")
        for number, outcome in stack.enter_context(closing(results(feed()))):
            outcomes[number] = outcome
            has_failed = has_failed or outcome.code != 0
            if manifest is not None:
                manifest.add(tasks[number], outcome)
            finish(tasks[number], outcome)
    return outcomes


# ---- the tables --------------------------------------------------------------------------------------------------
def _write_tables(run: Run, plan: Plan, tasks: Sequence[Task], outcomes: Sequence[Outcome]) -> None:
    if plan.table is None:
        return
    with run.phase("write --table"), committed_together():
        if plan.table.path is not None:
            _check_units(tasks, outcomes)
        plan.table.write(tasks, outcomes, no_clobber=plan.options.no_clobber)


def _check_units(tasks: Sequence[Task], outcomes: Sequence[Outcome]) -> None:
    """Refuse one table of lengths in several units, or of places on several maps."""
    sources: dict[str, str] = {}
    for task, outcome in zip(tasks, outcomes, strict=True):
        if outcome.status == "done":
            sources.setdefault(_unit_text(outcome.stats), task.source)
    if len(sources) > 1:
        (one, first), (other, second) = list(sources.items())[:2]
        raise InputError(
            f"--table would hold lengths in {one} ({first}) and in {other} ({second}): write a table for each, or give "
            "one --pixel-size for all"
        )


def _unit_text(stats: Mapping[str, Any]) -> str:
    """Return words for the unit of the results of an input."""
    if not {"pixel_size", "spacing", "unit"} & set(stats):
        return "pixels, or the units of the file"
    unit = "units without a name" if stats["unit"] is None else unit_name(stats["unit"])
    return f"{unit} in {stats['crs']}" if "crs" in stats else unit
