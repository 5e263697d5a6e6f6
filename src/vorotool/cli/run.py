"""Run a command: one input in this process, several as a batch."""

from __future__ import annotations

import sys
from collections.abc import Collection, Iterator, Mapping
from contextlib import contextmanager
from typing import Any

import click

from vorotool.errors import UsageError
from vorotool.formats.io.descriptors import stream_kind
from vorotool.formats.io.temporaries import committed_together
from vorotool.jobs.inputs import JobInput, check_streams, is_several
from vorotool.jobs.job import options_of_line, process_input
from vorotool.jobs.options import ALL_PAGES, Options, changed
from vorotool.jobs.refusals import check_options
from vorotool.jobs.run_log import Run
from vorotool.jobs.targets import check_cluster, check_stats, plan_targets
from vorotool.jobs.units import check_units, lengths_in_pixels, with_spacing
from vorotool.numeric.parallel import Report

STEPS = 1000
"""Steps of a progress bar."""


def run_command(command: str, values: Mapping[str, Any], sources: Mapping[str, str]) -> None:
    """Do what a command line asks for: the values of options, and whether each is typed or of the environment."""
    o = options_of_line(command, values, sources)
    read = [*(("the input", name) for name in o.inputs), *o.files_read.items()]
    if len(read) > 1:
        check_streams(read)
    from_environment = [name for name in ("jobs", "cluster") if o.sources.get(name) == "environment"]
    if from_environment:
        o = _workers_chosen(o, from_environment)
    if o.spacing is not None:
        o = with_spacing(o)
    several = _several(o)
    if not o.inputs and not several:
        raise UsageError("no input given: name a file, a folder, or - for standard input")
    if several or o.is_shared:
        from vorotool.batch.run import run_batch

        run_batch(o, several, progress_bar)
        return
    (path,) = o.inputs
    targets = plan_targets(o, path)
    if o.stats is not None:
        check_stats(o, targets, path)
    if o.cluster is not None:
        check_cluster(targets)
    if o.unit is not None:
        check_units(o, targets)
        o = lengths_in_pixels(o, o.unit)
    check_options(o, targets)
    with (
        committed_together(),  # the statistics, too
        Run(command, quiet=o.quiet, verbose=o.verbose, stats=o.stats, no_clobber=o.no_clobber, bar=progress_bar) as run,
    ):
        run.source = None if o.other else JobInput(path).name
        process_input(run, o, path, targets)


@contextmanager
def progress_bar(label: str = "") -> Iterator[Report]:
    """Show a bar on standard error; yield the function that sets the fraction done."""
    with click.progressbar(length=STEPS, label=label, file=sys.stderr) as bar:
        yield lambda fraction: bar.update(int(STEPS * fraction) - bar.pos)


def _workers_chosen(o: Options, from_environment: Collection[str]) -> Options:
    """Drop workers of the environment where one input needs none, or the command line names others."""
    typed = changed(o, **dict.fromkeys(from_environment))
    if not _several(typed):
        return typed
    if typed.jobs is not None and "cluster" in from_environment:
        return changed(o, cluster=None)
    if o.cluster is not None and "jobs" in from_environment:
        return changed(o, jobs=None)
    return o


def _several(o: Options) -> str:
    """Return why this is a batch, by what the user typed; nothing for one input, whose outputs have no record."""
    if len(o.inputs) > 1:
        return f"there are {len(o.inputs)} inputs"
    if o.files_from is not None:
        return f"--files-from {o.files_from} lists inputs"
    if any(map(is_several, o.inputs)):
        from pathlib import Path

        kind = "is a folder" if Path(o.inputs[0]).is_dir() else "stands for several inputs"
        return f"{o.inputs[0]} {kind}"
    if o.page == ALL_PAGES:
        return "--page all makes each page an input"
    if o.output is not None or not o.inputs or stream_kind(o.inputs[0]) is not None:
        return ""
    has_record = o.out_dir is not None and (o.is_shared or o.keep_going or o.jobs is not None)
    return "--cluster works on several inputs" if has_record or o.cluster is not None else ""
