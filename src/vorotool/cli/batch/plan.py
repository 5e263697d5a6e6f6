"""What the options of a batch ask for: its inputs and their outputs, the record, the table of all."""

from __future__ import annotations

import os
import re
import tempfile
from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import Any

from vorotool.batch.inputs import RECORD_ENDING, Input, expand_inputs, pages_of, read_names
from vorotool.batch.manifest import History, Manifest, digest_of_values, read_history
from vorotool.batch.name_fields import NameFields
from vorotool.batch.plan import check_outputs, output_paths, share
from vorotool.batch.tables import TABLE_FORMATS
from vorotool.batch.tasks import Task, digest_of
from vorotool.errors import OutputError, UsageError
from vorotool.formats.io.atomic_output import spoken
from vorotool.formats.io.descriptors import STANDARD, descriptor_of, is_same_output, stream_kind
from vorotool.formats.io.temporaries import new_folder, temporary_beside
from vorotool.jobs.inputs import is_several
from vorotool.jobs.job import Recipe
from vorotool.jobs.options import ALL_PAGES, Options, changed
from vorotool.jobs.targets import Target, plan_targets
from vorotool.jobs.units import check_units, lengths_in_pixels
from vorotool.plain import plain
from vorotool.products.formats import EXTENSIONS
from vorotool.products.options import GROUPS

_OF_MANY = {row.parameter for row in GROUPS["Many inputs"]}
WITHOUT_EFFECT = {
    *_OF_MANY,
    "inputs",
    "output",
    "threads",
    "quiet",
    "verbose",
    "stats",
    "no_clobber",
    "overwrite",
    "sources",
}
"""Options that change no byte of an output."""


@plain
class JointTable:
    """The table of all inputs."""

    path: str | None  # where it is written; None where it is only counted
    fmt: str
    what: str  # the result whose rows it has
    fields: NameFields  # columns of the names of inputs
    inputs: tuple[str, str] | None  # where there is a row an input, and in which format
    is_safe: bool  # texts are no formulas
    has_unit: bool  # tables have a column of their unit

    @property
    def place(self) -> str:
        """A file that is written of it."""
        assert self.path is not None or self.inputs is not None
        return self.path if self.path is not None else self.inputs[0]  # type: ignore[index]

    def target(self, path: str) -> Target:
        """Return the table of one input."""
        return Target(self.what, path, self.fmt)


@plain
class Plan:
    """What is to be done."""

    # of the command line, but `what` tells what is computed, and files of one part of the inputs have its name
    options: Options
    tasks: list[Task]
    targets: list[Target]  # what each gives, in which format; the paths are those of no input
    table: JointTable | None
    manifest: Manifest | None  # where it is recorded what was done
    notes: list[str]  # what is said before the work begins


def plan_batch(recipe: Recipe, o: Options, *, has_what: bool) -> Plan:
    """Lay out a batch; nothing is written."""
    _check_options(o)
    o, notes = named_for_shard(o)
    table = joint_table(recipe, o, has_what=has_what)
    if o.out_dir is None:
        o = changed(o, what=())
    targets = [] if o.out_dir is None else plan_targets(
        recipe.formats, o.what, output=None, fmt=o.format, out_dir=o.out_dir, source="input"
    )  # fmt: skip
    manifest, history = _record(recipe, o, targets)
    tasks = _tasks(recipe, o, targets, notes.append)
    if manifest is not None:
        tasks = [replace(task, done=manifest.done_before(task.source, history)) for task in tasks]
    if table is not None:
        o = changed(o, what=tuple(dict.fromkeys((*o.what, table.what))))
        targets.append(table.target(f"part.{table.fmt}"))
        notes += [text for text in [table.fields.note_unmatched([task.source for task in tasks])] if text]
    check_units(o, targets)
    o = lengths_in_pixels(o, o.unit)
    recipe.check(o, targets)
    return Plan(o, tasks, targets, table, manifest, notes)


def _check_options(o: Options) -> None:
    table = o.table
    inputs = _several(o)
    if o.output is not None:
        raise UsageError(f"{inputs}, but -o names one output: name a folder for all with --out-dir")
    if o.out_dir is None and table is None and o.table_inputs is None:
        raise UsageError(f"{inputs}: name a folder for their outputs with --out-dir")
    if o.out_dir is None and o.resume:
        raise UsageError("--resume needs --out-dir DIR, where it is recorded what was done")
    for name, given in o.files_of_inputs().items():
        if (kind := stream_kind(given)) is not None:
            what = "standard input" if given == STANDARD else kind
            raise UsageError(f"--{name} {given} is {what}, which not every input can read: name a file")
    if o.null and o.files_from is None:
        raise UsageError("-0 is about the list of --files-from: leave it out")
    if table is not None and o.stats is not None and is_same_output(table, o.stats):
        if descriptor_of(table) is None and table != STANDARD:
            raise UsageError(f"--stats {o.stats} is also --table: choose another name")
        raise UsageError(f"--stats {o.stats} needs --table FILE: {spoken(table)} holds the table")
    if o.cluster not in (None, "local") and o.jobs is not None:
        raise UsageError("-j is for this machine: a cluster has the workers that it has")


def _several(o: Options) -> str:
    """Return why this is a batch, by what the user typed."""
    if len(o.inputs) > 1:
        return f"{len(o.inputs)} inputs are given"
    if o.files_from is not None:
        return f"--files-from {o.files_from} lists inputs"
    if any(map(is_several, o.inputs)):
        return f"{o.inputs[0]} stands for several inputs"
    return "--page all makes each page an input" if o.page == ALL_PAGES else "--cluster is for several inputs"


def named_for_shard(o: Options) -> tuple[Options, list[str]]:
    """Give the table and the statistics of a part names of their own: parts would replace those of each other."""
    if o.shard is None:
        return o, []
    own: dict[str, Any] = {}
    for option, path in (("table", o.table), ("table_inputs", o.table_inputs), ("stats", o.stats)):
        if path is not None and name_of_part(path, *o.shard) != path:
            own[option] = name_of_part(path, *o.shard)
    named = {option.replace("_", "-"): name for option, name in own.items()}
    part, parts = o.shard
    return changed(o, **own), [f"--{option} of part {part} of {parts} is {name}" for option, name in named.items()]


def name_of_part(path: str, part: int, parts: int) -> str:
    """Name the file of one of several parts, as its manifest is named; streams and names that tell the part stay."""
    name, mark = Path(path), f"{part}-of-{parts}"
    if parts == 1 or not name.name or stream_kind(path) is not None or mark in re.split("[._]", name.name):
        return path
    return str(name.with_name(f"{name.stem}.{mark}{name.suffix}"))


def _collected(recipe: Recipe, o: Options, fmt: str, *, has_what: bool) -> str:
    """Return the result whose rows are collected: one of --what, if that is a table, else `table`."""
    has_outputs = o.out_dir is not None or o.output is not None
    if not has_what or "table" in o.what:
        chosen = ["table"]
    elif has_outputs:  # what has geometry is written by itself
        tables = [what for what in o.what if "csv" in recipe.formats[what] and "geojson" not in recipe.formats[what]]
        chosen = tables or ["table"]
    else:
        chosen = list(o.what)
    if (has_what and not has_outputs and len(o.what) > 1) or len(chosen) > 1:
        raise UsageError(
            f"--what {','.join(o.what)}: --table collects the rows of one result; other results need -o FILE or "
            "--out-dir DIR"
        )
    (what,) = chosen
    if fmt not in recipe.formats.get(what, ()) or (fmt == "json" and what in _NO_ROWS):
        possible = [name for name, those in recipe.formats.items() if "csv" in those]
        raise UsageError(f"--table cannot collect {what} as {fmt.upper()}: use --what {', '.join(possible)} as CSV")
    return what


_NO_ROWS = frozenset(["skeleton", "diagram", "offset", "parts", "cells"])
"""Results whose JSON is not a list of rows."""


def joint_table(recipe: Recipe, o: Options, *, has_what: bool) -> JointTable | None:
    """Return the table of all inputs; its format is what its name says, unless there is no other output for -f."""
    fields = NameFields.of(o.fields)
    path, inputs = o.table, o.table_inputs
    if path is None and inputs is None:
        if o.fields is not None:
            raise UsageError("--fields is for the columns of --table and --table-inputs: name such a file")
        return None
    if path is not None and inputs is not None and is_same_output(path, inputs):
        raise UsageError(f"--table-inputs {inputs} is also --table: choose another name")
    rows_of_inputs = None if inputs is None else (inputs, _table_format("--table-inputs", inputs))
    if path is None:
        fmt = "csv"
    elif o.out_dir is None and o.format is not None:
        fmt = o.format.lower()
    else:
        fmt = _table_format("--table", path)
    if fmt not in TABLE_FORMATS:
        raise _no_table("--table", path or "")
    return JointTable(
        path, fmt, _collected(recipe, o, fmt, has_what=has_what), fields, rows_of_inputs, o.safe_csv, o.unit is not None
    )


def _table_format(option: str, path: str) -> str:
    """Return the format that the name of a table says; that of a stream is CSV."""
    fmt = EXTENSIONS.get(Path(path).suffix.lower(), "" if stream_kind(path) is None else "csv")
    if fmt not in TABLE_FORMATS:
        raise _no_table(option, path)
    return fmt


def _no_table(option: str, path: str) -> UsageError:
    return UsageError(f"{option} {path} is written as CSV, TSV or JSON: name it .csv, .tsv or .json")


def folder_of_parts(command: str, o: Options, table: JointTable, stack: ExitStack) -> str:
    """Return the folder for the tables of inputs: beside the record of what was done, else one until the end."""
    if o.out_dir is not None:
        return str(Path(o.out_dir) / f".{command}.tables")
    is_beside = stream_kind(table.place) is None
    folder = Path(os.path.realpath(table.place)).parent if is_beside else Path(tempfile.gettempdir())
    try:
        return str(stack.enter_context(temporary_beside(folder / "tables", new_folder)).path)
    except OSError as error:
        raise OutputError(f"tables cannot be written in {folder}: {error.strerror}; choose another name") from error


def _record(recipe: Recipe, o: Options, targets: list[Target]) -> tuple[Manifest | None, History]:
    """Give where it is recorded what is done, and what was done before by the same options."""
    if o.out_dir is None:
        return None, History()
    digest = digest_of_values(
        {
            "options": {name: value for name, value in vars(o).items() if name not in WITHOUT_EFFECT},
            "files": {name: _digest(name, path) for name, path in o.files_of_inputs().items()},
            "outputs": [(target.what, target.fmt) for target in targets],
        }
    )
    shard = "" if o.shard is None else f".{o.shard[0]}-of-{o.shard[1]}"
    folder = Path(o.out_dir)
    manifest = Manifest(folder / f"{recipe.name}{shard}{RECORD_ENDING}", digest, folder)
    history = read_history(sorted(folder.glob(f"{recipe.name}*{RECORD_ENDING}"))) if o.resume else History()
    return manifest, history


def _digest(name: str, path: str) -> str:
    """Return the digest of a file that is read with all inputs; of that of ``--like`` its header."""
    if name != "like":
        return digest_of(path)
    from vorotool.formats.images.image_header import image_header

    return repr(image_header(path))


def _tasks(recipe: Recipe, o: Options, targets: list[Target], note: Callable[[str], None]) -> list[Task]:
    inputs = _inputs(recipe, o, note)
    folder = o.out_dir or ""  # without one there are no targets
    endings = [target.path.removeprefix(str(Path(folder) / "input")) for target in targets]
    tasks = [Task(each.source, output_paths(each.name, endings, folder)) for each in inputs]
    written = {"--stats": o.stats, "--table": o.table, "--table-inputs": o.table_inputs}
    check_outputs(tasks, folder, others=written, read=o.files_read())
    if o.shard is None:
        return tasks
    chosen = {each.source for each in share(inputs, *o.shard)}
    return [task for task in tasks if task.source in chosen]


def _inputs(recipe: Recipe, o: Options, note: Callable[[str], None]) -> list[Input]:
    from vorotool.products.inputs import NAMES_WITH, TABLE_NAMES

    geometry = recipe.geometry or "polygons"
    known = NAMES_WITH[geometry].keys() - (TABLE_NAMES if geometry == "polygons" else set())
    names = [*o.inputs, *(read_names(o.files_from, null=o.null) if o.files_from is not None else ())]
    if not names:
        advice = "name files, folders, or a list of them with --files-from"
        if o.files_from is not None:
            advice = f"--files-from {o.files_from} holds no names; write one on each line"
        raise UsageError(f"no input given: {advice}")
    found = expand_inputs(names, extensions=known, without=o.out_dir, follow=o.follow, note=note)
    return pages_of(found) if o.page == ALL_PAGES else found
