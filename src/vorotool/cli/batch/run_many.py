"""Many inputs: what each command does with one, done with all of them."""

from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from dataclasses import replace
from functools import partial
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import click

from vorotool.batch.plan import check_inside
from vorotool.batch.run import Results, run_batch
from vorotool.batch.tables import join_tables, part_path
from vorotool.batch.tasks import Outcome, Process, Task, digest_of, is_done
from vorotool.cli.batch.plan import INPUT_FILES, Plan, plan_batch
from vorotool.cli.batch.progress_bar import progress_bar
from vorotool.cli.batch.report import Report
from vorotool.errors import OutputError
from vorotool.formats.io.atomic_output import check_output, open_output
from vorotool.formats.io.descriptors import stream_kind
from vorotool.formats.io.temporaries import new_folder, temporary_beside
from vorotool.jobs.failures import explained
from vorotool.jobs.job import Recipe, process_input
from vorotool.jobs.run_log import Run
from vorotool.jobs.targets import Target
from vorotool.jobs.units import unit_stats
from vorotool.signals import end_by_exceptions


def process_one(
    recipe: Recipe, options: Mapping[str, Any], kinds: Sequence[tuple[str, str]], source: str, outputs: Sequence[str]
) -> Outcome:
    """Process one input, and say nothing but in the outcome.

    Parameters
    ----------
    recipe : Recipe
        Of the command.
    options : mapping
        Of the command line.
    kinds : sequence of (str, str)
        What is written, and in which format.
    source : str
        The input.
    outputs : sequence of str
        Their paths.
    """
    targets = [Target(what, path, fmt) for (what, fmt), path in zip(kinds, outputs, strict=True)]
    message, code = "", 0
    with Run(recipe.name, quiet=True, verbose=False, stats=None) as run:
        try:
            process_input(recipe, run, SimpleNamespace(**options), source, targets)
        except Exception as error:
            message, code = explained(error)
    return Outcome(code, message, tuple(run.warnings), tuple(run.notes), run.stats, run.seconds)


def run_many(recipe: Recipe, o: SimpleNamespace) -> None:
    """Process many inputs.

    Parameters
    ----------
    recipe : Recipe
        Of the command.
    o : namespace
        Options of the command line.

    Raises
    ------
    BatchError
        If some inputs failed.
    """
    plan = plan_batch(recipe, o)
    if o.dry_run:
        _print_plan(plan)
        for text in () if o.quiet else plan.notes:
            click.echo(f"note: {text}", err=True)
        return
    _check_files(o)
    end_by_exceptions()
    with ExitStack() as stack:
        tasks = _with_parts(plan, _folder_of_parts(recipe, o, stack)) if plan.table else plan.tasks
        _check_records(plan, tasks)
        run = stack.enter_context(
            Run(recipe.name, quiet=o.quiet, verbose=o.verbose, stats=o.stats, no_clobber=o.no_clobber, bar=progress_bar)
        )
        for text in plan.notes:
            run.note(text)
        with Report(run, len(tasks), quiet=o.quiet) as report:
            outcomes = run_batch(
                recipe.name,
                tasks,
                _results(recipe, o, plan, len(tasks)),
                manifest=plan.manifest,
                keep_going=o.keep_going,
                told=report.tell,
            )
        if plan.table and None not in outcomes:
            with run.phase("write --table"):
                _write_table(o, plan.table, tasks, outcomes)
        report.finish([task.source for task in tasks])
        run.stats |= unit_stats(o)
    if (failure := report.failure(keep_going=o.keep_going)) is not None:
        raise failure


def _print_plan(plan: Plan) -> None:
    for task in plan.tasks:
        kept = task.done is not None and is_done(task, digest_of(task.source))
        record = {"input": task.source, "status": "kept" if kept else "planned", "outputs": task.outputs}
        click.echo(json.dumps(record))


def _check_files(o: SimpleNamespace) -> None:
    """Find out before any work whether the files of all inputs can be written."""
    for option in ("stats", "table"):
        path = getattr(o, option, None)
        if path is not None:
            is_inside = o.out_dir is not None and Path(path).parent == Path(o.out_dir)
            may_replace = not o.no_clobber or o.resume
            check_output(path, no_clobber=not may_replace, makes_folder=is_inside, option=f"--{option}")


def _folder_of_parts(recipe: Recipe, o: SimpleNamespace, stack: ExitStack) -> str:
    """Where the tables of inputs are kept: with the record of what was done, else until the end."""
    if o.out_dir is not None:
        return str(Path(o.out_dir) / f".{recipe.name}.tables")
    is_beside = stream_kind(o.table) is None
    folder = Path(os.path.realpath(o.table)).parent if is_beside else Path(tempfile.gettempdir())
    try:
        return str(stack.enter_context(temporary_beside(folder / "tables", new_folder)).path)
    except OSError as error:
        raise OutputError(f"tables cannot be written in {folder}: {error.strerror}; choose another name") from error


def _with_parts(plan: Plan, folder: str) -> list[Task]:
    assert plan.table is not None
    return [replace(task, outputs=(*task.outputs, part_path(folder, task.source, plan.table))) for task in plan.tasks]


def _check_records(plan: Plan, tasks: Sequence[Task]) -> None:
    """Refuse a record, and tables of inputs, that links would lead out of the folder that they are in."""
    if plan.manifest is not None:
        parts = [task.outputs[-1] for task in tasks] if plan.table else []
        check_inside([plan.manifest.path, *parts], plan.manifest.folder)


def _results(recipe: Recipe, o: SimpleNamespace, plan: Plan, count: int) -> Results:
    """Who does the work."""
    jobs = (os.cpu_count() or 1) if o.jobs == 0 else o.jobs
    options = {
        **vars(o),
        "threads": o.threads or int(o.cluster is not None or (jobs or 1) > 1),
        "stats": None if o.stats is None else os.devnull,  # statistics are made, and sent to this process
        **{name: str(Path(getattr(o, name)).absolute()) for name in INPUT_FILES if getattr(o, name, None)},
    }
    kinds = [(target.what, target.fmt) for target in plan.targets]
    process: Process = partial(process_one, recipe, options, kinds)
    if o.cluster is None:
        from vorotool.batch.process_pool import local_results

        return partial(local_results, process, jobs=min(jobs or 1, count))
    from vorotool.batch.dask_cluster import cluster_results

    return partial(cluster_results, process, address=o.cluster, jobs=jobs)


def _write_table(o: SimpleNamespace, fmt: str, tasks: Sequence[Task], outcomes: Sequence[Outcome | None]) -> None:
    parts = [
        (task.source, task.outputs[-1])
        for task, outcome in zip(tasks, outcomes, strict=True)
        if outcome is not None and not outcome.code
    ]
    with open_output(o.table, no_clobber=o.no_clobber, option="--table") as out:
        join_tables(out, parts, fmt, is_safe=o.safe_csv)
