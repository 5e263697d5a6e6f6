"""One table of those of all inputs."""

from __future__ import annotations

import csv
import hashlib
import io
import json
import os
import sys
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any, BinaryIO

TABLE_FORMATS = ("csv", "json")
"""Formats that are joined row by row."""

INPUT_COLUMN = "input"


def part_path(folder: str | os.PathLike[str], source: str, fmt: str) -> str:
    """Where the table of an input is kept until all are there.

    Examples
    --------
    >>> part_path("parts", "masks/a.png", "csv")
    'parts/a25a19930b8515062e0e5216a1a5cbe8.csv'
    """
    return str(Path(folder) / f"{hashlib.sha256(os.fsencode(source)).hexdigest()[:32]}.{fmt}")


def join_tables(out: BinaryIO, parts: Sequence[tuple[str, str]], fmt: str) -> None:
    r"""Write the rows of several tables as one, after a first column that names their input.

    Parameters
    ----------
    out : binary file object
        Need not be seekable.
    parts : sequence of (str, str)
        Name of each input and path of its table, in the order of the rows. Columns that a table does not have are
        empty; all come in the order in which they are first met. One part is in memory at a time.
    fmt : {"csv", "json"}
        Of the tables, and of what is written.

    Examples
    --------
    >>> out = io.BytesIO()
    >>> join_tables(out, [("dots", "data/six-seeds.csv"), ("again", "data/six-seeds.csv")], "csv")
    >>> out.getvalue()[:26]
    b'input,x,y\ndots,4,2\ndots,12'
    """
    join = _join_csv if fmt == "csv" else _join_json
    join(out, parts)


def _columns(headers: Iterable[Sequence[str]]) -> list[str]:
    """All columns; ours takes the prefix ``voro_`` where an input has one of its name."""
    names = list(dict.fromkeys(name for header in headers for name in header))
    return [f"voro_{INPUT_COLUMN}" if INPUT_COLUMN in names else INPUT_COLUMN, *names]


# ---- CSV -----------------------------------------------------------------------------------------
def _join_csv(out: BinaryIO, parts: Sequence[tuple[str, str]]) -> None:
    csv.field_size_limit(sys.maxsize)
    names = _columns(next(_csv_rows(path), []) for _, path in parts)
    out.write(_csv_text([names]))
    for source, path in parts:
        rows = _csv_rows(path)
        header = next(rows, [])
        if header == names[1:]:
            out.write(_csv_text([source, *row] for row in rows))
        else:
            place = [header.index(name) if name in header else None for name in names[1:]]
            out.write(_csv_text([source, *("" if at is None else row[at] for at in place)] for row in rows))


def _csv_rows(path: str) -> Iterator[list[str]]:
    with Path(path).open(encoding="utf-8", errors="surrogateescape", newline="") as file:
        yield from csv.reader(file)


def _csv_text(rows: Iterable[Sequence[str]]) -> bytes:
    text = io.StringIO(newline="")
    csv.writer(text, lineterminator="\n").writerows(rows)
    return text.getvalue().encode("utf-8", "surrogateescape")


# ---- JSON ----------------------------------------------------------------------------------------
def _join_json(out: BinaryIO, parts: Sequence[tuple[str, str]]) -> None:
    name, *names = _columns(_json_header(path) for _, path in parts)
    before = b"[\n"
    for source, path in parts:
        header = _json_header(path)
        begin = f"{{{json.dumps(name)}:{json.dumps(source)},".encode()
        absent = "".join(f",{json.dumps(each, ensure_ascii=False)}:null" for each in names if each not in header)
        for row in _json_rows(path):
            out.write(before + begin + row[1:-1] + absent.encode() + b"}")
            before = b",\n"
    out.write(b"[]\n" if before == b"[\n" else b"\n]\n")


def _json_rows(path: str) -> Iterator[bytes]:
    """Text of each object: our tables have one a line."""
    with Path(path).open("rb") as file:
        yield from (line.rstrip(b",\n") for line in file if line.startswith(b"{"))


def _json_header(path: str) -> list[str]:
    row: dict[str, Any] = json.loads(next(_json_rows(path), b"{}"))
    return list(row)
