"""Where a command goes: one input is processed here and now, several are a batch."""

from __future__ import annotations

from collections.abc import Hashable
from types import SimpleNamespace

from vorotool.batch.inputs import is_several
from vorotool.cli.batch.progress_bar import progress_bar
from vorotool.cli.options.shared import BATCH_OPTIONS
from vorotool.errors import UsageError
from vorotool.formats.io.descriptors import input_identity
from vorotool.jobs.job import Recipe, process_input
from vorotool.jobs.run_log import Run
from vorotool.jobs.targets import check_stats, files_read, plan_targets
from vorotool.jobs.units import check_units

STREAMED = ("files_from", "clip", "overlay")
"""Options that name what is read."""


def run_command(recipe: Recipe, o: SimpleNamespace) -> None:
    """Do what a command line asks for.

    Parameters
    ----------
    recipe : Recipe
        Of the command.
    o : namespace
        Options of the command line, ``inputs`` among them.

    Raises
    ------
    UsageError
        If there is no input, or options do not go together.
    """
    _check_streams(o)
    if _is_batch(o):
        from vorotool.cli.batch.run_many import run_many

        run_many(recipe, o)
        return
    if not o.inputs:
        raise UsageError("0 inputs are given: name files, a folder, or - for standard input")
    (source,) = o.inputs
    targets = plan_targets(recipe.formats, o.what, output=o.output, fmt=o.format, out_dir=o.out_dir, source=source)
    check_stats(o.stats, targets, source, files_read(o))
    if o.cluster is not None and any(target.fmt != "zarr" for target in targets):
        raise UsageError("--cluster with -o writes a Zarr store: name it .zarr, or a folder with --out-dir")
    recipe.check_options(o, targets)
    check_units(o, targets)
    with Run(
        recipe.name, quiet=o.quiet, verbose=o.verbose, stats=o.stats, no_clobber=o.no_clobber, bar=progress_bar
    ) as run:
        process_input(recipe, run, o, source, targets)


def _check_streams(o: SimpleNamespace) -> None:
    """Refuse two names of one stream: whoever reads it first leaves nothing for the other."""
    named = [(name, "the input") for name in o.inputs]
    named += [(name, f"--{option.replace('_', '-')}") for option in STREAMED if (name := getattr(o, option, None))]
    readers: dict[Hashable, str] = {}
    for name, reader in named:
        identity = input_identity(name)
        if identity is None:
            continue
        if identity in readers:
            other = readers[identity]
            raise UsageError(
                f"{reader} {name} and {other} are one stream, which is read once: name a file for one of the two"
            )
        readers[identity] = f"{reader} {name}"


def _is_batch(o: SimpleNamespace) -> bool:
    """Whether inputs are shared out; a cluster may also share out the bands of the one output of one input."""
    if len(o.inputs) > 1 or any(map(is_several, o.inputs)):
        return True
    one = ("cluster", "jobs") if o.cluster is not None and o.output is not None and o.inputs else ()
    return any(getattr(o, name, None) for name in BATCH_OPTIONS if name not in one)
