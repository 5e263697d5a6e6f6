"""Where a command goes: one input is processed here and now, several are a batch."""

from __future__ import annotations

from collections.abc import Mapping

import click
from click.core import ParameterSource

from vorotool.batch.inputs import is_several
from vorotool.cli.batch.progress_bar import progress_bar
from vorotool.errors import UsageError
from vorotool.formats.io.commit import committed_together
from vorotool.formats.io.descriptors import stream_kind
from vorotool.jobs.inputs import check_streams
from vorotool.jobs.job import Recipe, process_input
from vorotool.jobs.options import ALL_PAGES, Options, changed
from vorotool.jobs.run_log import Run
from vorotool.jobs.targets import check_stats, plan_targets
from vorotool.jobs.units import check_units, lengths_in_pixels, with_spacing


def run_command(recipe: Recipe, o: Options) -> None:
    """Do what a command line asks for."""
    check_streams([*(("the input", name) for name in o.inputs), *o.files_read().items()])
    o = with_spacing(_without_environment(o))
    if _is_batch(o):
        from vorotool.cli.batch.run_many import run_many

        run_many(recipe, o)
        return
    if not o.inputs:
        raise UsageError("0 inputs are given: name files, a folder, or - for standard input")
    if o.is_shared:
        from vorotool.cli.batch.one_input import run_one

        run_one(recipe, o)
        return
    (source,) = o.inputs
    targets = plan_targets(recipe.formats, o.what, output=o.output, fmt=o.format, out_dir=o.out_dir, source=source)
    check_stats(o, targets, source)
    if o.cluster is not None and any(target.fmt != "zarr" for target in targets):
        raise UsageError("--cluster with -o writes a Zarr store: name it .zarr, or a folder with --out-dir")
    check_units(o, targets)
    o = lengths_in_pixels(o, o.unit)
    recipe.check(o, targets)
    with (
        committed_together(),  # the statistics, too
        Run(
            recipe.name, quiet=o.quiet, verbose=o.verbose, stats=o.stats, no_clobber=o.no_clobber, bar=progress_bar
        ) as run,
    ):
        process_input(recipe, run, o, source, targets)


def _without_environment(o: Options) -> Options:
    """Leave out workers that the environment names where one input needs none, or other workers are typed."""
    source = click.get_current_context().get_parameter_source
    has_jobs, has_cluster = (source(name) == ParameterSource.ENVIRONMENT for name in ("jobs", "cluster"))
    if not has_jobs and not has_cluster:
        return o
    kept = changed(o, jobs=None if has_jobs else o.jobs, cluster=None if has_cluster else o.cluster)
    if not _is_batch(kept):
        return kept
    if not has_cluster:
        return kept if o.cluster is not None else o
    return changed(o, cluster=None) if kept.jobs is not None else changed(o, jobs=None)


def refuse_several(named: Mapping[str, str]) -> None:
    """Refuse folders and patterns where one file each is compared with another: that makes no batch."""
    for name, path in named.items():
        if is_several(path):
            raise UsageError(f"{name} {path} stands for several files, but two are compared: name one file each")


def _is_batch(o: Options) -> bool:
    """Whether there are several inputs, or one whose outputs and record are in a folder."""
    if len(o.inputs) > 1 or any(map(is_several, o.inputs)) or o.files_from is not None or o.page == ALL_PAGES:
        return True
    if o.output is not None or not o.inputs or stream_kind(o.inputs[0]) is not None:
        return False
    has_folder = o.out_dir is not None and (o.is_shared or o.keep_going or o.jobs is not None)
    return has_folder or o.cluster is not None
