"""The plan of a batch: its inputs and their outputs, the joint table, the record. Nothing is written."""

from __future__ import annotations

import os
import re
import stat
import sys
from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path, PurePath
from typing import Any

from vorotool import __version__
from vorotool.batch.inputs import Input, expand_inputs, pages_of, read_names
from vorotool.batch.records import (
    RECORD_ENDING,
    TABLE_FORMATS,
    JointTable,
    Manifest,
    digest_of_values,
    name_fields,
    read_history,
)
from vorotool.batch.workers import Task, digest_of
from vorotool.errors import OutputError, UsageError
from vorotool.formats.io.descriptors import STANDARD, descriptor_of, is_same_output, stream_kind
from vorotool.formats.io.sources import file_of, without_gz
from vorotool.frozen import frozen
from vorotool.jobs.options import ALL_PAGES, Options, changed
from vorotool.jobs.refusals import check_options
from vorotool.jobs.targets import Target, check_cluster, plan_targets
from vorotool.jobs.units import check_units, lengths_in_pixels
from vorotool.products.commands import COMMANDS
from vorotool.products.formats import EXTENSIONS
from vorotool.products.options import GROUPS

WITHOUT_EFFECT = {
    *(row.parameter for row in GROUPS["Many inputs"]),
    *("inputs", "output", "threads", "quiet", "verbose", "stats", "no_clobber", "overwrite"),
    *("max_pixels", "max_sites", "sources"),
}
"""Options that change no byte of an output."""

_NO_ROWS = frozenset(["skeleton", "diagram", "offset", "parts", "cells"])
"""Results whose JSON is not a list of rows."""


@frozen
class Plan:
    """What is to be done."""

    # of the command line, but `what` has all that is computed, and files of one part of the inputs have its name
    options: Options
    tasks: list[Task]
    targets: list[Target]  # what each task writes, in which format; the paths are those of no input
    table: JointTable | None
    manifest: Manifest | None  # where it is recorded what was done
    notes: list[str]  # what is said before the work begins


def plan_batch(o: Options, several: str) -> Plan:
    """Lay out a batch; `several` says why there are several inputs, nothing of one that is processed here and now."""
    _check_options(o, several)
    is_alone = not several
    o, notes = _named_for_shard(o)
    table = _joint_table(o)
    if o.out_dir is None and o.output is None and table is not None:
        o, targets = changed(o, what=()), []
    else:
        source = o.inputs[0] if is_alone else "input"
        targets = plan_targets(o, source)
    if is_alone and o.cluster is not None:
        check_cluster(targets)
    tasks = _tasks(o, targets, notes, is_alone=is_alone)
    manifest = None if o.out_dir is None or is_alone else _manifest(o, targets)
    if manifest is not None and o.resume:
        history = read_history(sorted(manifest.folder.glob(f"{o.command}*{RECORD_ENDING}")))
        tasks = [replace(task, done=manifest.done_before(task.source, history)) for task in tasks]
    if table is not None:
        o = changed(o, what=tuple(dict.fromkeys((*o.what, table.what))))
        targets.append(Target(table.what, f"part.{table.fmt}", table.fmt))
        left = [task.source for task in tasks if table.fields.search(task.source.replace("\\", "/")) is None]
        number = f"{len(left)} of {len(tasks)} inputs"
        notes += [f"--fields does not match {number}, such as {each}: their fields are empty" for each in left[:1]]
    check_units(o, targets)
    o = lengths_in_pixels(o, o.unit)
    check_options(o, targets)
    return Plan(o, tasks, targets, table, manifest, notes)


def _check_options(o: Options, several: str) -> None:
    """Refuse options that do not go together."""
    if o.resume and (o.out_dir is None or not several):
        raise UsageError("--resume needs --out-dir DIR, which has the record of what was done, and files as inputs")
    if not several:
        return
    if o.output is not None:
        raise UsageError(f"{several}, but -o names one output: name a folder for all with --out-dir")
    if o.out_dir is None and o.table is None and o.table_inputs is None:
        raise UsageError(f"{several}: name a folder for their outputs with --out-dir")
    for name, path in o.files_of_inputs.items():
        if (kind := stream_kind(path)) is not None:
            what = "standard input" if path == STANDARD else kind
            raise UsageError(f"--{name} {path} is {what}, which not every input can read: name a file")
    if o.cluster not in (None, "local") and o.jobs is not None:
        raise UsageError("-j sets worker processes on this machine, not on a cluster: leave it out")


# ---- the inputs and their outputs --------------------------------------------------------------------------------
def _tasks(o: Options, targets: list[Target], notes: list[str], *, is_alone: bool) -> list[Task]:
    """Return the tasks of the shard, after a check of all."""
    if is_alone:
        inputs = [Input(o.inputs[0], Path(o.inputs[0]).name)]
        tasks = [Task(o.inputs[0], tuple(target.path for target in targets))]
    else:
        inputs = _inputs(o, notes.append)
        folder = o.out_dir or ""  # without one there are no targets
        endings = [target.path.removeprefix(str(Path(folder) / "input")) for target in targets]
        tasks = [Task(each.source, output_paths(each.name, endings, folder), each.path, each.page) for each in inputs]
    options = {"--table": o.table, "--table-inputs": o.table_inputs, "--stats": o.stats}
    written = {option: path for option, path in options.items() if path is not None}
    check_outputs(tasks, None if is_alone else o.out_dir, written, o.files_read)
    if o.shard is None:
        return tasks
    chosen = {each.source for each in share(inputs, *o.shard)}
    if is_alone and not chosen:
        notes.append(f"{o.inputs[0]} is in part 1 of {o.shard[1]}: nothing is done for part {o.shard[0]}")
    return [task for task in tasks if task.source in chosen]


def _inputs(o: Options, note: Callable[[str], None]) -> list[Input]:
    from vorotool.products.inputs import NAMES_WITH, TABLE_NAMES

    geometry = COMMANDS[o.command].reads or "polygons"
    known = NAMES_WITH[geometry].keys() - (TABLE_NAMES if geometry == "polygons" else set())
    names = [*o.inputs, *(read_names(o.files_from, null=o.null) if o.files_from is not None else ())]
    if not names:
        raise UsageError(f"no input given: --files-from {o.files_from} holds no names; write one per line")
    inputs = expand_inputs(names, extensions=known, without=o.out_dir, follow=o.follow, note=note)
    return pages_of(inputs) if o.page == ALL_PAGES else inputs


def share(inputs: list[Input], part: int, parts: int) -> list[Input]:
    """Return one part of the inputs: every `parts`-th in the order of their names, beginning with number `part`."""
    ranked = sorted(range(len(inputs)), key=lambda i: (PurePath(inputs[i].name).as_posix(), inputs[i].source))
    return [inputs[i] for i in sorted(ranked[part - 1 :: parts])]


def _named_for_shard(o: Options) -> tuple[Options, list[str]]:
    """Give the tables and the statistics of a part names of their own: parts would replace those of each other."""
    named: dict[str, Any] = {}
    for option in ("table", "table_inputs", "stats") if o.shard is not None else ():
        path = getattr(o, option)
        if path is not None and (name := _name_of_part(path, *o.shard)) != path:
            named[option] = name
    part = "" if o.shard is None else "part {} of {}".format(*o.shard)
    return changed(o, **named), [f"--{name.replace('_', '-')} of {part} is {path}" for name, path in named.items()]


def _name_of_part(path: str, part: int, parts: int) -> str:
    """Return the name of a part's file, like that of its manifest; streams and names that have the part stay."""
    name, mark = Path(path), f"{part}-of-{parts}"
    if parts == 1 or not name.name or stream_kind(path) is not None or mark in re.split("[._]", name.name):
        return path
    return str(name.with_name(f"{name.stem}.{mark}{name.suffix}"))


# ---- the joint table and the record ------------------------------------------------------------------------------
def _joint_table(o: Options) -> JointTable | None:
    """Return the table of all inputs; -f is its format where there is no other output."""
    if o.table is None and o.table_inputs is None:
        return None
    inputs = None if o.table_inputs is None else (o.table_inputs, _table_format("--table-inputs", o.table_inputs))
    has_outputs = o.out_dir is not None or o.output is not None
    fmt = "csv" if o.table is None else _table_format("--table", o.table, None if has_outputs else o.format)
    what = _collected(o, fmt)
    return JointTable(o.table, fmt, what, name_fields(o.fields), inputs, o.safe_csv)


def _table_format(option: str, path: str, fmt: str | None = None) -> str:
    """Return the format of a table, by default by its name; a stream is CSV."""
    usual = "" if stream_kind(path) is None else "csv"
    fmt = fmt.lower() if fmt is not None else EXTENSIONS.get(Path(path).suffix.lower(), usual)
    if fmt not in TABLE_FORMATS:
        raise UsageError(f"{option} {path} is written as CSV, TSV or JSON: name it .csv, .tsv or .json")
    return fmt


def _collected(o: Options, fmt: str) -> str:
    """Return the result whose rows are collected: one of --what, if that is a table, else `table`."""
    formats = {what: each.formats for what, each in o.products.items()}
    option = "--table-inputs" if o.table is None else "--table"
    has_what, has_outputs = "what" in o.sources, o.out_dir is not None or o.output is not None
    if not has_what or "table" in o.what:
        results = ["table"]
    elif has_outputs:  # results with geometry are written by themselves
        tables = [what for what in o.what if "csv" in formats[what] and "geojson" not in formats[what]]
        results = tables or ["table"]
    else:
        results = list(o.what)
    if (has_what and not has_outputs and len(o.what) > 1) or len(results) > 1:
        raise UsageError(
            f"--what {','.join(o.what)}: {option} collects the rows of one result; other results need -o FILE or "
            "--out-dir DIR"
        )
    (what,) = results
    if fmt not in formats.get(what, ()) or (fmt == "json" and what in _NO_ROWS):
        possible = [name for name, each in formats.items() if "csv" in each]
        raise UsageError(f"{option} cannot collect {what} as {fmt.upper()}: use --what {', '.join(possible)} as CSV")
    return what


def _manifest(o: Options, targets: list[Target]) -> Manifest:
    """Return the record of this batch, or of this part of it."""
    digest = digest_of_values(
        {
            "version": __version__,
            "options": {name: value for name, value in vars(o).items() if name not in WITHOUT_EFFECT},
            "files": {name: _digest(name, path) for name, path in o.files_of_inputs.items()},
            "outputs": [(target.what, target.fmt) for target in targets],
        }
    )
    shard = "" if o.shard is None else ".{}-of-{}".format(*o.shard)
    return Manifest(o.out_dir, o.command, digest, shard)


def _digest(name: str, path: str) -> str:
    """Return the digest of a file that is read with all inputs; of that of ``--like`` its header."""
    if name != "like":
        return digest_of(path)
    from vorotool.formats.images.image_header import image_header

    return repr(image_header(path))


# ---- checks of outputs -------------------------------------------------------------------------------------------
def output_paths(name: str, endings: Sequence[str], folder: str | os.PathLike[str]) -> tuple[str, ...]:
    """Return the paths of the outputs of an input."""
    stem = Path(folder) / PurePath(without_gz(os.path.normpath(name))).with_suffix("")
    return tuple(f"{stem}{ending}" for ending in endings)


def check_outputs(
    tasks: Sequence[Task], folder: str | None, options: Mapping[str, str], read: Mapping[str, str]
) -> None:
    """Refuse outputs that would replace an input or one another, or lie outside their folder, if they have one.

    `options` are the files that options write, `read` those that are read with all inputs.
    """
    owners = _owners(tasks)
    for number, (option, path) in enumerate(options.items()):
        before = list(options.items())[:number]
        roles = [f"{each} {other}" for each, other in before if is_same_output(path, other)]
        roles += [f"the output of {owner}" for owner in _owners_of(path, owners, folder)]
        if roles:
            raise UsageError(f"{option} {path} is also {roles[0]}: choose another name")
        place = Path(os.path.realpath(path))
        if place.name.endswith(RECORD_ENDING) and folder and place.parent == Path(os.path.realpath(folder)):
            raise UsageError(f"{option} {path} is the name of a record that --resume reads: choose another name")
    _check_inputs(tasks, options, read, "name" if folder is None else "--out-dir")
    if folder is not None:
        check_inside((path for task in tasks for path in task.outputs), folder)


def _owners(tasks: Sequence[Task]) -> dict[str, str]:
    """Return the input of each output; no two inputs may have the same one."""
    owners: dict[str, str] = {}
    sources: set[str] = set()
    for task in tasks:
        if task.source in sources:
            raise UsageError(f"{task.source} is named twice: leave one out")
        sources.add(task.source)
        for path in dict.fromkeys(task.outputs):  # results may be layers of one file
            owner = owners.setdefault(_comparable(path), task.source)
            if owner != task.source:
                instead = "name the folder above both, to keep their subfolders"
                if PurePath(owner).parent == PurePath(task.source).parent:
                    instead = f"name only the files that are meant, such as {PurePath(owner).with_stem('*')}"
                raise UsageError(f"{owner} and {task.source} would both be written to {path}: rename one, or {instead}")
    return owners


def _owners_of(path: str, owners: Mapping[str, str], folder: str | None) -> list[str]:
    """Return the inputs whose output has a path."""
    if folder is None:
        return [source for each, source in owners.items() if is_same_output(path, each)]
    owner = owners.get(_comparable(str(Path(folder) / os.path.relpath(path, folder or "."))))
    return [] if owner is None else [owner]


def _comparable(path: str) -> str:
    """Return a path as it is compared: the usual file systems of macOS take A and a for the same."""
    return path.casefold() if sys.platform == "darwin" else path


def _check_inputs(tasks: Sequence[Task], options: Mapping[str, str], read: Mapping[str, str], other: str) -> None:
    """Refuse outputs that are there already and are read, by a link or by the same name."""
    sources: dict[Hashable, str] = {_identity(path): f"file of {option}, {path}" for option, path in read.items()}
    sources |= {_identity(task.file): f"input {task.file}" for task in tasks}
    sources.pop(None, None)
    outputs = [(path, path, other) for task in tasks for path in task.outputs if path != STANDARD]
    is_open = {path: path == STANDARD or descriptor_of(path) is not None for path in options.values()}
    outputs += [(path, f"{option} {path}", "name") for option, path in options.items() if not is_open[path]]
    for path, label, instead in outputs:
        if (role := sources.get(_identity(path))) is not None:
            raise UsageError(f"{label} is also the {role}, which is never replaced: choose another {instead}")


def _identity(path: str) -> tuple[int, int] | None:
    """Return the identity of a file or folder; None for what is not there, and for streams."""
    try:
        found = os.fstat(0) if path == STANDARD else Path(file_of(path)).stat()
    except (OSError, ValueError):
        return None
    is_held = stat.S_ISREG(found.st_mode) or stat.S_ISDIR(found.st_mode)
    return (found.st_dev, found.st_ino) if is_held else None


def check_inside(paths: Iterable[str | os.PathLike[str]], folder: str | os.PathLike[str]) -> None:
    """Refuse files that would be written outside a folder, through links in it."""
    inside, known = Path(os.path.realpath(folder)), set[Path]()
    for path in map(Path, paths):
        place = path if path.is_symlink() else path.parent
        if place not in known and not Path(os.path.realpath(place)).is_relative_to(inside):
            raise OutputError(f"{path} would lie outside {inside}, through a link: remove the link")
        known.add(place)
