"""One input with options of many: its share, its plan, its table."""

from __future__ import annotations

import json
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path

from vorotool.batch.inputs import Input
from vorotool.batch.plan import share
from vorotool.batch.tables import part_path
from vorotool.cli.batch.plan import JointTable, folder_of_parts, joint_table, named_for_shard
from vorotool.errors import UsageError
from vorotool.formats.io.atomic_output import check_output, is_same_file, spoken
from vorotool.formats.io.descriptors import STANDARD, descriptor_of, is_same_output
from vorotool.jobs.job import Recipe, process_input
from vorotool.jobs.options import Options, changed
from vorotool.jobs.run_log import MakeBar, Run
from vorotool.jobs.targets import Target, check_stats, plan_targets
from vorotool.jobs.terminal import print_text, tell
from vorotool.jobs.units import check_units, lengths_in_pixels


def run_one(recipe: Recipe, o: Options, *, has_what: bool, bar: MakeBar) -> None:
    """Process one input as a batch would, in this process; its outputs may be files that `-o` names."""
    (source,) = o.inputs
    if o.null:
        raise UsageError("-0 is about the list of --files-from: leave it out")
    if o.resume:
        raise UsageError("--resume needs --out-dir DIR, where it is recorded what was done, and a file as its input")
    o, notes = named_for_shard(o)
    table = joint_table(recipe, o, has_what=has_what)
    targets = _targets(recipe, o, source, has_table=table is not None)
    check_stats(o, targets, source)
    if table is not None:
        _check_table(o, table, targets, source)
        o = changed(o, what=tuple(dict.fromkeys((*(o.what if targets else ()), table.what))))
        notes += [text for text in [table.fields.note_unmatched([source])] if text]
    planned = targets if table is None else [*targets, table.target(f"part.{table.fmt}")]
    check_units(o, planned)
    o = lengths_in_pixels(o, o.unit)
    recipe.check(o, planned)
    if o.shard is not None and not share([Input(source, Path(source).name)], *o.shard):
        notes = [f"{source} is in part 1 of {o.shard[1]}: nothing is done for part {o.shard[0]}"]
    elif not o.dry_run:
        _process(recipe, o, source, targets, table, notes, bar)
        return
    else:
        outputs = list(dict.fromkeys(target.path for target in targets))
        print_text(json.dumps({"input": source, "status": "planned", "outputs": outputs}) + "\n")
    for text in () if o.quiet else notes:
        tell(f"note: {text}")


def _targets(recipe: Recipe, o: Options, source: str, *, has_table: bool) -> list[Target]:
    """Lay out the outputs; without -o or --out-dir a table of its own is the only one."""
    if has_table and o.output is None and o.out_dir is None:
        return []
    return plan_targets(recipe.formats, o.what, output=o.output, fmt=o.format, out_dir=o.out_dir, source=source)


def _check_table(o: Options, table: JointTable, targets: Sequence[Target], source: str) -> None:
    """Refuse a table that would replace the input or another output."""
    inputs = None if table.inputs is None else table.inputs[0]
    named = {option: path for option, path in (("--table", table.path), ("--table-inputs", inputs)) if path is not None}
    for option, path in named.items():
        is_open = path == STANDARD or descriptor_of(path) is not None
        for role, other in () if is_open else (("the input", source), *o.files_read().items()):
            if is_same_file(Path(path), other):
                raise UsageError(f"{option} {path} is also {role}, which is never replaced: choose another name")
        outputs = [(f"the output of {target.what}", target.path) for target in targets]
        for role, other in [*outputs, *([("--stats", o.stats)] if o.stats else [])]:
            if is_same_output(path, other):
                where = spoken(path) if is_open else path
                raise UsageError(f"{option} {path}: {where} is also {role}; choose another name")
        check_output(path, no_clobber=o.no_clobber, option=option)


def _process(
    recipe: Recipe,
    o: Options,
    source: str,
    targets: Sequence[Target],
    table: JointTable | None,
    notes: Sequence[str],
    bar: MakeBar,
) -> None:
    with ExitStack() as stack:
        planned = list(targets)
        if table is not None:
            folder = folder_of_parts(recipe.name, changed(o, out_dir=None), table, stack)
            planned.append(table.target(part_path(folder, source, table.fmt)))
        run = stack.enter_context(
            Run(recipe.name, quiet=o.quiet, verbose=o.verbose, stats=o.stats, no_clobber=o.no_clobber, bar=bar)
        )
        for text in notes:
            run.note(text)
        process_input(recipe, run, o, source, planned)
        if table is not None:
            from vorotool.cli.batch.run_many import write_tables

            with run.phase("write --table"):
                write_tables(table, [(source, planned[-1].path)], {source: (False, "")}, no_clobber=o.no_clobber)
