"""Many inputs: what each command does with one, done with all of them."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from vorotool.batch.pages import PageName, path_of
from vorotool.batch.plan import check_inside
from vorotool.batch.run import Results, run_batch
from vorotool.batch.tables import join_tables, part_path, row_count, write_inputs
from vorotool.batch.tasks import Outcome, Process, Task, digest_of, is_done
from vorotool.cli.batch.plan import JointTable, Plan, folder_of_parts, plan_batch
from vorotool.cli.batch.report import Report
from vorotool.errors import InputError, Message
from vorotool.formats.io.atomic_output import check_output, open_output
from vorotool.formats.io.commit import committed_together
from vorotool.jobs.failures import explained
from vorotool.jobs.job import Recipe, process_input
from vorotool.jobs.options import ALL_PAGES, Options, changed
from vorotool.jobs.run_log import MakeBar, Run
from vorotool.jobs.targets import Target
from vorotool.jobs.terminal import print_text, tell
from vorotool.jobs.units import unit_stats
from vorotool.numeric.length_units import unit_name
from vorotool.signals import end_by_exceptions


def process_one(
    recipe: Recipe, options: Options, kinds: Sequence[tuple[str, str]], source: str, outputs: Sequence[str]
) -> Outcome:
    """Process one input, and say nothing but in the outcome."""
    targets = [Target(what, path, fmt) for (what, fmt), path in zip(kinds, outputs, strict=True)]
    if options.page == ALL_PAGES:
        options = changed(options, page=source.page if isinstance(source, PageName) else None)
    source = path_of(source)
    message, code = "", 0
    with Run(recipe.name, quiet=True, verbose=False, stats=None) as run:
        try:
            process_input(recipe, run, options, source, targets)
        except Exception as error:
            message, code = explained(error)
    return Outcome(code, message, tuple(run.warnings), tuple(run.notes), run.stats, run.seconds)


def run_many(recipe: Recipe, o: Options, *, has_what: bool, bar: MakeBar) -> None:
    """Process many inputs."""
    plan = plan_batch(recipe, o, has_what=has_what)
    o = plan.options
    if o.dry_run:
        _print_plan(plan)
        for text in () if o.quiet else plan.notes:
            tell(f"note: {text}")
        return
    _check_files(o)
    end_by_exceptions()
    with ExitStack() as stack:
        tasks = plan.tasks
        if plan.table is not None:
            folder = folder_of_parts(recipe.name, o, plan.table, stack)
            tasks = [_with_part(task, folder, plan.table.fmt) for task in tasks]
        _check_records(plan, tasks)
        run = stack.enter_context(
            Run(recipe.name, quiet=o.quiet, verbose=o.verbose, stats=o.stats, no_clobber=o.no_clobber, bar=bar)
        )
        for text in plan.notes:
            run.note(text)
        with Report(run, len(tasks), None if o.quiet else bar) as report:
            outcomes = run_batch(
                recipe.name,
                tasks,
                _results(recipe, plan, len(tasks)),
                manifest=plan.manifest,
                keep_going=o.keep_going,
                told=report.tell,
            )
        if plan.table and None not in outcomes:
            with run.phase("write --table"), committed_together():
                _write_table(plan.table, tasks, outcomes, no_clobber=o.no_clobber)
        report.finish([task.source for task in tasks])
        run.stats |= unit_stats(o.unit)
    if (failure := report.failure(keep_going=o.keep_going)) is not None:
        raise failure


def _print_plan(plan: Plan) -> None:
    for task in plan.tasks:
        kept = task.done is not None and is_done(task, digest_of(path_of(task.source)))
        record = {"input": task.source, "status": "kept" if kept else "planned", "outputs": task.outputs}
        print_text(json.dumps(record) + "\n")


def _check_files(o: Options) -> None:
    """Find out before any work whether the files of all inputs can be written."""
    for option, path in (("stats", o.stats), ("table", o.table), ("table-inputs", o.table_inputs)):
        if path is not None:
            is_inside = o.out_dir is not None and Path(path).parent == Path(o.out_dir)
            may_replace = not o.no_clobber or o.resume
            check_output(path, no_clobber=not may_replace, makes_folder=is_inside, option=f"--{option}")


def _with_part(task: Task, folder: str, fmt: str) -> Task:
    return replace(task, outputs=(*task.outputs, part_path(folder, task.source, fmt)))


def _check_records(plan: Plan, tasks: Sequence[Task]) -> None:
    """Refuse a record, and tables of inputs, that links would lead out of the folder that they are in."""
    if plan.manifest is not None:
        parts = [task.outputs[-1] for task in tasks] if plan.table else []
        check_inside([plan.manifest.path, *parts], plan.manifest.folder)


def _results(recipe: Recipe, plan: Plan, count: int) -> Results:
    """Who does the work."""
    o = plan.options
    jobs = (os.cpu_count() or 1) if o.jobs == 0 else o.jobs
    files: dict[str, Any] = {name: str(Path(path).absolute()) for name, path in o.files_of_inputs().items()}
    options = changed(
        o,
        threads=o.threads or int(o.cluster is not None or (jobs or 1) > 1),
        stats=None if o.stats is None else os.devnull,  # statistics are made, and sent to this process
        **files,
    )
    kinds = [(target.what, target.fmt) for target in plan.targets]
    process: Process = partial(process_one, recipe, options, kinds)
    if o.cluster is None:
        from vorotool.batch.process_pool import local_results

        return partial(local_results, process, jobs=min(jobs or 1, count))
    from vorotool.batch.dask_cluster import cluster_results

    return partial(cluster_results, process, address=o.cluster, jobs=jobs)


def _check_units(tasks: Sequence[Task], outcomes: Sequence[Outcome | None]) -> None:
    """Refuse one table of lengths in several units, or of places on several maps."""
    seen: dict[str, str] = {}
    for task, outcome in zip(tasks, outcomes, strict=True):
        if outcome is not None and not outcome.code and not outcome.kept:
            seen.setdefault(_unit_text(outcome.stats), task.source)
    if len(seen) > 1:
        (one, first), (other, second) = list(seen.items())[:2]
        raise InputError(
            f"--table would hold lengths in {one} ({first}) and in {other} ({second}): give each of them a table, or "
            "one --pixel-size to all"
        )


def _unit_text(stats: Mapping[str, Any]) -> str:
    """Words for the unit of what was made of an input."""
    if not {"pixel_size", "spacing", "unit"} & set(stats):
        return "pixels, or the units of the file"
    unit = "units without a name" if stats["unit"] is None else unit_name(stats["unit"])
    return f"{unit} in {stats['crs']}" if "crs" in stats else unit


def _write_table(
    table: JointTable, tasks: Sequence[Task], outcomes: Sequence[Outcome | None], *, no_clobber: bool
) -> None:
    parts = [
        (task.source, task.outputs[-1])
        for task, outcome in zip(tasks, outcomes, strict=True)
        if outcome is not None and not outcome.code
    ]
    if table.path is not None:
        _check_units(tasks, outcomes)
    states = [None if outcome is None else (outcome.kept, outcome.message) for outcome in outcomes]
    write_tables(table, parts, dict(zip([task.source for task in tasks], states, strict=True)), no_clobber=no_clobber)


def write_tables(
    table: JointTable,
    parts: Sequence[tuple[str, str]],
    states: Mapping[str, tuple[bool, str] | None],
    *,
    no_clobber: bool,
) -> None:
    """Write the rows of all inputs that were done, and a row an input, which may have failed."""
    if table.path is not None:
        with open_output(table.path, no_clobber=no_clobber, option="--table") as out:
            join_tables(out, parts, table.fmt, fields=table.fields, is_safe=table.is_safe, has_unit=table.has_unit)
    if table.inputs is None:
        return
    path, fmt = table.inputs
    counts = {source: row_count(part, table.fmt) for source, part in parts}
    rows = []
    for source, state in states.items():
        kept, message = state or (False, "")
        status = "kept" if kept else "done" if source in counts else "failed"
        own = dict(zip(table.fields.names, table.fields.values(source), strict=True))
        named = {f"voro_{name}" if name in _OF_INPUTS else name: value for name, value in own.items()}
        known = {"status": status, "count": counts.get(source), "error": Message.of(message) or None}
        rows.append({"input": source, **named, **known})
    with open_output(path, no_clobber=no_clobber, option="--table-inputs") as out:
        write_inputs(out, rows, fmt, is_safe=table.is_safe)


_OF_INPUTS = ("input", "status", "count", "error")
"""Columns of the table of inputs."""
