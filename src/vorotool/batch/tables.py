"""One table of those of all inputs."""

from __future__ import annotations

import csv
import hashlib
import json
import os
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, BinaryIO

from vorotool.batch.name_fields import NameFields
from vorotool.errors import InputError
from vorotool.formats.text.tables import safe_text

TABLE_FORMATS = ("csv", "tsv", "json")
"""Formats that are joined row by row."""


def part_path(folder: str | os.PathLike[str], source: str, fmt: str) -> str:
    """Where the table of an input is kept until all are there."""
    return str(Path(folder) / f"{hashlib.sha256(os.fsencode(source)).hexdigest()[:32]}.{fmt}")


def join_tables(
    out: BinaryIO,
    parts: Sequence[tuple[str, str]],
    fmt: str,
    *,
    fields: NameFields | None = None,
    is_safe: bool = False,
    has_unit: bool = False,
) -> None:
    """Write the rows of several tables as one, after columns that name their input and what its name tells."""
    fields = fields or NameFields()
    if has_unit:
        _check_units(parts, fmt)
    if fmt == "json":
        _join_json(out, parts, fields)
    else:
        _join_delimited(out, parts, b"\t" if fmt == "tsv" else b",", fields, is_safe=is_safe)


def write_inputs(out: BinaryIO, rows: Sequence[Mapping[str, Any]], fmt: str, *, is_safe: bool = False) -> None:
    """Write a row an input."""
    if fmt == "json":
        lines = [json.dumps(row).encode() for row in rows]
        out.write(b"[\n" + b",\n".join(lines) + b"\n]\n")
        return
    delimiter = b"\t" if fmt == "tsv" else b","
    for row in [{name: name for name in rows[0]}, *rows] if rows else []:
        out.write(delimiter.join(_field(value, is_safe=is_safe) for value in row.values()) + b"\n")


def row_count(path: str, fmt: str) -> int:
    """Return the number of rows of a table."""
    if fmt == "json":
        return sum(1 for _ in _json_rows(path))
    return max(len(_RECORD.findall(Path(path).read_bytes())) - 1, 0)


def _check_units(parts: Sequence[tuple[str, str]], fmt: str) -> None:
    """Refuse tables in different units; those without rows are in none."""
    first: tuple[str, str] | None = None
    for source, path in parts:
        row = _first_row(path, fmt)
        if row is None:
            continue
        unit = row.get("voro_unit", row.get("unit"))
        said = f"in {unit}" if unit else "in no unit"
        if first is not None and first[1] != said:
            raise InputError(
                f"{source} is {said}, but {first[0]} {first[1]}: give --pixel-size for all, or a --table to each unit"
            )
        first = first or (source, said)


def _first_row(path: str, fmt: str) -> dict[str, Any] | None:
    if fmt == "json":
        row: dict[str, Any] | None = json.loads(next(_json_rows(path), b"null"))
        return row
    with Path(path).open(encoding="utf-8", errors="surrogateescape", newline="") as file:
        return next(csv.DictReader(file, dialect="excel-tab" if fmt == "tsv" else "excel"), None)


def _columns(headers: Iterable[Iterable[bytes]], fields: NameFields) -> tuple[list[bytes], list[bytes]]:
    """Our columns and all others; ours take the prefix ``voro_`` where an input has one of their name."""
    names = list(dict.fromkeys(name for header in headers for name in header))
    ours = [name.encode() for name in ("input", *fields.names)]
    return [b"voro_" + name if name in names else name for name in ours], names


# ---- CSV and TSV ---------------------------------------------------------------------------------
# The texts of fields stay as they were written, with their quotes.
_RECORD = re.compile(rb'(?:[^"\n]++|"[^"]*+")*+\n')
_FIELDS = {
    b",": re.compile(rb'(?:^|,)((?:[^",]++|"[^"]*+")*+)'),
    b"\t": re.compile(rb'(?:^|\t)((?:[^"\t]++|"[^"]*+")*+)'),
}


def _join_delimited(
    out: BinaryIO, parts: Sequence[tuple[str, str]], delimiter: bytes, own: NameFields, *, is_safe: bool
) -> None:
    fields_of = _FIELDS[delimiter].findall
    ours, names = _columns((tuple(_header(path, delimiter)) for _, path in parts), own)
    out.write(delimiter.join([*ours, *names]) + b"\n")
    for source, path in parts:
        header, *records = _RECORD.findall(Path(path).read_bytes())
        texts = [_field(value, is_safe=is_safe) for value in (source, *own.values(source))]
        before = b"".join(text + delimiter for text in texts)
        place = _places(fields_of(header[:-1]), names)
        for record in records:
            if place is None:
                out.write(before + record)
            else:
                fields = [*fields_of(record[:-1]), b""]
                out.write(before + delimiter.join(fields[at] for at in place) + b"\n")


def _header(path: str, delimiter: bytes) -> list[bytes]:
    found = _RECORD.match(Path(path).read_bytes())
    return [] if found is None else _FIELDS[delimiter].findall(found[0][:-1])


def _places(header: list[bytes], names: list[bytes]) -> list[int] | None:
    """Where each column is, at the end those that are not; None if all are where they should be."""
    return None if header == names else [header.index(name) if name in header else -1 for name in names]


def _field(value: Any, *, is_safe: bool) -> bytes:
    """Return the text of a field; nothing for None."""
    text = "" if value is None else str(value)
    return _quoted(safe_text(text) if is_safe else text)


def _quoted(name: str) -> bytes:
    text = os.fsencode(name)
    return text if re.fullmatch(rb"[\w./+@=~%'-]*", text) else b'"' + text.replace(b'"', b'""') + b'"'


# ---- JSON ----------------------------------------------------------------------------------------
def _join_json(out: BinaryIO, parts: Sequence[tuple[str, str]], own: NameFields) -> None:
    ours, names = _columns((_json_header(path) for _, path in parts), own)
    before = b"[\n"
    for source, path in parts:
        header = _json_header(path)
        values = zip(ours, (source, *own.values(source)), strict=True)
        begin = b"{" + b"".join(b'"%b":%b,' % (name, json.dumps(value).encode()) for name, value in values)
        absent = b"".join(b',"%b":null' % each for each in names if each not in header)
        for row in _json_rows(path):
            out.write(before + begin + row[1:-1] + absent + b"}")
            before = b",\n"
    out.write(b"[]\n" if before == b"[\n" else b"\n]\n")


def _json_rows(path: str) -> Iterator[bytes]:
    """Text of each object: our tables have one a line."""
    with Path(path).open("rb") as file:
        yield from (line.rstrip(b",\n") for line in file if line.startswith(b"{"))


def _json_header(path: str) -> list[bytes]:
    """Names of columns, as they are written."""
    row: dict[str, Any] = json.loads(next(_json_rows(path), b"{}"))
    return [json.dumps(name, ensure_ascii=False)[1:-1].encode() for name in row]
