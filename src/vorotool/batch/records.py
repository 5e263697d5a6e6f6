"""The record of work that is done, a line of JSON for each input; one table of all inputs, and one with a row each."""

from __future__ import annotations

import errno
import hashlib
import json
import os
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path, PurePath
from typing import Any, BinaryIO

from vorotool import __version__
from vorotool.batch.workers import Outcome, Task
from vorotool.errors import InputError, Message, OutputError, UsageError
from vorotool.formats.io.atomic_output import explained, make_folder, open_output
from vorotool.formats.text.tables import safe_text
from vorotool.frozen import frozen

RECORD_ENDING = ".manifest.jsonl"
"""Ends the names of records, which begin with the command."""

LONGEST_LINE = 2**24
"""Bytes of a line that is read; ours have hundreds, and thousands where there are many warnings."""

History = dict[str, dict[str, Any]]
"""The last line of each input, if it says that it was done: all of it is text that anybody may have written."""


def digest_of_values(values: Any) -> str:
    """Return the SHA-256 of values; what JSON does not have counts by its text."""
    return hashlib.sha256(json.dumps(values, sort_keys=True, default=str).encode()).hexdigest()


def read_history(paths: Iterable[str | os.PathLike[str]]) -> History:
    """Read manifests; a line that is torn or damaged says nothing, so that its input is done again."""
    history: History = {}
    for path in filter(Path.is_file, map(Path, paths)):
        try:
            with path.open("rb") as file:
                for line in _lines(file):
                    _take(history, line)
        except OSError as error:
            raise OutputError(f"the manifest {path} cannot be read: {error.strerror}; leave out --resume") from None
    return history


def _lines(file: BinaryIO) -> Iterator[bytes]:
    """Yield lines; those that are longer than ours can be are left out."""
    while line := file.readline(LONGEST_LINE):
        if len(line) < LONGEST_LINE:
            yield line
        while len(line) == LONGEST_LINE and line[-1:] != b"\n":
            line = file.readline(LONGEST_LINE)


def _take(history: History, line: bytes) -> None:
    """Take what a line says of an input; the lines of runs are for people."""
    try:
        record = json.loads(line)
        source, status = record["input"], record["status"]
    except (ValueError, TypeError, KeyError, RecursionError):
        return
    if isinstance(source, str) and status != "done":
        history.pop(source, None)
    elif isinstance(source, str) and _is_ours(record):
        history[source] = record


def _is_ours(record: Mapping[str, Any]) -> bool:
    """Return whether a line has digests, and no output outside the folder."""
    outputs = record.get("outputs")
    if not isinstance(outputs, dict) or any(
        PurePath(path).is_absolute() or ".." in PurePath(path).parts for path in outputs
    ):
        return False
    texts = (record.get("options"), record.get("sha256"), record.get("unit"), *outputs.values())
    return all(isinstance(text, str) for text in texts)


class Manifest:
    """The record of a batch while it runs: a line is handed to the system as soon as an input is done or failed."""

    def __init__(self, folder: str | os.PathLike[str], command: str, options: str, shard: str = "") -> None:
        self.folder, self.command, self.options = Path(folder), command, options
        self.path = self.folder / f"{command}{shard}{RECORD_ENDING}"
        self._file: BinaryIO | None = None

    def __enter__(self) -> Manifest:
        """Open the file; end a line that a killed run began."""
        make_folder(self.folder)
        with explained(str(self.path), "--out-dir"):
            self._file = self.path.open("a+b", buffering=0)
            if self._file.seek(0, os.SEEK_END):
                self._file.seek(-1, os.SEEK_END)
                if self._file.read(1) != b"\n":
                    self._file.write(b"\n")
        return self

    def __exit__(self, *_: object) -> None:
        """Close the file."""
        if self._file is not None:
            self._file.close()

    def done_before(self, source: str, history: History) -> Outcome | None:
        """Return the outcome of an input if it was done with the same options."""
        record = history.get(source)
        if record is None or record["options"] != self.options:
            return None
        outputs = {str(self.folder / path): digest for path, digest in record["outputs"].items()}
        return Outcome(digest=record["sha256"], outputs=outputs, unit=record["unit"])

    def begin(self, run: str, inputs: int) -> None:
        """Add the line of a run; its name is in the names of its temporary files."""
        self._add({"run": run, "command": self.command, "version": __version__, "inputs": inputs})

    def add(self, task: Task, outcome: Outcome) -> None:
        """Add the line of an input; one that was kept has a line already."""
        if outcome.kept:
            return
        record: dict[str, Any] = {"input": task.source, "status": outcome.status}
        if outcome.code:
            record |= {"exit": outcome.code, "error": outcome.message}
        record |= {"options": self.options, "sha256": outcome.digest}
        if not outcome.code:
            outputs = outcome.outputs.items()
            record["outputs"] = {str(PurePath(path).relative_to(self.folder)): digest for path, digest in outputs}
            record["unit"] = outcome.unit
        texts = {"warnings": outcome.warnings, "notes": outcome.notes}
        self._add(record | {name: lines for name, lines in texts.items() if lines})

    def _add(self, record: Mapping[str, Any]) -> None:
        assert self._file is not None
        line = json.dumps(record).encode() + b"\n"
        with explained(str(self.path), "--out-dir"):  # in one piece, so that lines of two processes do not mix
            if self._file.write(line) != len(line):
                raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


NO_FIELDS = re.compile("")
TABLE_FORMATS = ("csv", "tsv", "json")
"""Formats that are joined row by row."""


def name_fields(text: str | None) -> re.Pattern[str]:
    """Read a regular expression, whose named groups are columns; None has no columns."""
    try:
        pattern = NO_FIELDS if text is None else re.compile(text)
        if text is not None and not pattern.groupindex:
            raise re.error("no group has a name, (?P<name>...)")
    except (re.error, OverflowError, RecursionError) as error:
        example = "(?P<well>[A-H]\\d+)_(?P<field>\\d+)"
        raise UsageError(
            f"invalid --fields {text!r}: {error}; expected a regular expression, such as '{example}'"
        ) from None
    return pattern


def _values(fields: re.Pattern[str], source: str) -> list[str | None]:
    """Return the path of an input, and what the named groups match in it; None where they match nothing."""
    match = fields.search(source.replace("\\", "/"))
    return [source, *(match and match[name] for name in fields.groupindex)]


@frozen
class JointTable:
    """The tables that are written of all inputs."""

    path: str | None  # where the rows of all go; None where they are only counted
    fmt: str
    what: str  # the result whose rows it has
    fields: re.Pattern[str]  # whose named groups are columns of the paths of inputs
    inputs: tuple[str, str] | None  # where there is a row an input, and in which format
    is_safe: bool  # texts are not formulas

    @property
    def place(self) -> str:
        """The path of one of them."""
        return self.path or self.inputs[0]  # type: ignore[index]  # one of the two is there

    def part(self, folder: str, source: str) -> str:
        """Return where the table of an input is kept until all are there."""
        return str(Path(folder) / f"{hashlib.sha256(os.fsencode(source)).hexdigest()[:32]}.{self.fmt}")

    def write(self, done: Sequence[tuple[Task, Outcome]], *, no_clobber: bool) -> None:
        """Write the rows of all inputs that did not fail, which their last outputs have, and a row an input."""
        parts = {task.source: task.outputs[-1] for task, outcome in done if not outcome.code}
        if self.path is not None:
            _check_units(done)
            with open_output(self.path, no_clobber=no_clobber, option="--table") as out:
                join_tables(out, parts, self.fmt, self.fields, is_safe=self.is_safe)
        if self.inputs is not None:
            counts = {source: row_count(path, self.fmt) for source, path in parts.items()}
            rows = [self._row(task.source, outcome, counts.get(task.source)) for task, outcome in done]
            with open_output(self.inputs[0], no_clobber=no_clobber, option="--table-inputs") as out:
                write_inputs(out, rows, self.inputs[1], is_safe=self.is_safe)

    def _row(self, source: str, outcome: Outcome, count: int | None) -> dict[str, Any]:
        """Return the row of an input."""
        row = {"input": source, "status": outcome.status, "count": count, "error": Message.of(outcome.message) or None}
        names = ["input", *(f"voro_{name}" if name in row else name for name in self.fields.groupindex)]
        return {**dict(zip(names, _values(self.fields, source), strict=True)), **row}


def _check_units(done: Sequence[tuple[Task, Outcome]]) -> None:
    """Refuse one table of lengths in several units, or of places on several maps."""
    sources: dict[str, str] = {}
    for task, outcome in done:
        if not outcome.code:
            sources.setdefault(outcome.unit, task.source)
    if len(sources) > 1:
        (one, first), (other, second) = list(sources.items())[:2]
        raise InputError(
            f"--table would hold lengths in {one} ({first}) and in {other} ({second}): write one table per unit, or "
            "give one --pixel-size for all"
        )


def join_tables(
    out: BinaryIO, parts: Mapping[str, str], fmt: str, fields: re.Pattern[str] = NO_FIELDS, *, is_safe: bool = False
) -> None:
    """Write the rows of the tables of inputs as one, after columns of the input and of the fields of its path."""
    if fmt == "json":
        _join_json(out, parts, fields)
    else:
        _join_delimited(out, parts, b"\t" if fmt == "tsv" else b",", fields, is_safe=is_safe)


def write_inputs(out: BinaryIO, rows: Sequence[Mapping[str, Any]], fmt: str, *, is_safe: bool = False) -> None:
    """Write a row an input."""
    if fmt == "json":
        out.write(b"[\n" + b",\n".join(json.dumps(row).encode() for row in rows) + b"\n]\n")
        return
    delimiter = b"\t" if fmt == "tsv" else b","
    for row in [[*rows[0]], *(row.values() for row in rows)] if rows else []:
        out.write(delimiter.join(_field(value, is_safe=is_safe) for value in row) + b"\n")


def row_count(path: str, fmt: str) -> int:
    """Return the number of rows of a table."""
    if fmt == "json":
        return sum(1 for _ in _json_rows(path))
    return max(len(_RECORD.findall(Path(path).read_bytes())) - 1, 0)


def _columns(headers: Iterable[Iterable[bytes]], fields: re.Pattern[str]) -> tuple[list[bytes], list[bytes]]:
    """Return our columns and all others; ours take the prefix ``voro_`` where an input has one of their name."""
    names = list(dict.fromkeys(name for header in headers for name in header))
    ours = [name.encode() for name in ("input", *fields.groupindex)]
    return [b"voro_" + name if name in names else name for name in ours], names


# ---- CSV and TSV ---------------------------------------------------------------------------------
# The texts of fields stay as they were written, with their quotes.
_RECORD = re.compile(rb'(?:[^"\n]++|"[^"]*+")*+\n')
_FIELDS = {
    b",": re.compile(rb'(?:^|,)((?:[^",]++|"[^"]*+")*+)'),
    b"\t": re.compile(rb'(?:^|\t)((?:[^"\t]++|"[^"]*+")*+)'),
}


def _join_delimited(
    out: BinaryIO, parts: Mapping[str, str], delimiter: bytes, own: re.Pattern[str], *, is_safe: bool
) -> None:
    fields_of = _FIELDS[delimiter].findall
    headers = (_RECORD.match(Path(path).read_bytes()) for path in parts.values())
    ours, names = _columns((fields_of(header[0][:-1]) for header in headers if header), own)
    out.write(delimiter.join([*ours, *names]) + b"\n")
    for source, path in parts.items():
        head, *records = _RECORD.findall(Path(path).read_bytes())
        texts = [_field(value, is_safe=is_safe) for value in _values(own, source)]
        before = b"".join(text + delimiter for text in texts)
        header = fields_of(head[:-1])
        places = [header.index(name) if name in header else -1 for name in names]  # the last is empty
        for record in records:
            if header == names:
                out.write(before + record)
            else:
                fields = [*fields_of(record[:-1]), b""]
                out.write(before + delimiter.join(fields[at] for at in places) + b"\n")


def _field(value: Any, *, is_safe: bool) -> bytes:
    """Return the text of a field, in quotes where it needs them; nothing for None."""
    text = os.fsencode("" if value is None else safe_text(str(value)) if is_safe else str(value))
    return text if re.fullmatch(rb"[\w./+@=~%'-]*", text) else b'"' + text.replace(b'"', b'""') + b'"'


# ---- JSON ----------------------------------------------------------------------------------------
def _join_json(out: BinaryIO, parts: Mapping[str, str], own: re.Pattern[str]) -> None:
    ours, names = _columns(map(_json_header, parts.values()), own)
    before = b"[\n"
    for source, path in parts.items():
        header = _json_header(path)
        values = zip(ours, _values(own, source), strict=True)
        begin = b"{" + b"".join(b'"%b":%b,' % (name, json.dumps(value).encode()) for name, value in values)
        absent = b"".join(b',"%b":null' % each for each in names if each not in header)
        for row in _json_rows(path):
            out.write(before + begin + row[1:-1] + absent + b"}")
            before = b",\n"
    out.write(b"[]\n" if before == b"[\n" else b"\n]\n")


def _json_rows(path: str) -> Iterator[bytes]:
    """Yield the text of each object: our tables have one a line."""
    with Path(path).open("rb") as file:
        yield from (line.rstrip(b",\n") for line in file if line.startswith(b"{"))


def _json_header(path: str) -> list[bytes]:
    """Return the names of columns, as they are written."""
    row: dict[str, Any] = json.loads(next(_json_rows(path), b"{}"))
    return [json.dumps(name, ensure_ascii=False)[1:-1].encode() for name in row]
