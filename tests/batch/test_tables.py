"""The table of all inputs holds the rows of each."""

import json

import numpy as np
import pytest

from support.readers.written import bytes_of, rows_of
from vorotool.batch.records import join_tables
from vorotool.formats.text.tables import write_table
from vorotool.types.table import Table

PLAIN = Table({"label": [1, 2], "x": np.ma.array([0.1, 5], mask=[False, True])})
ODD = Table({"label": [7], "note": ['a "b", c\nd'], "x": [1e22]}).with_properties({"ü": ["é"], "input": [3.5]})
EMPTY = Table({"label": np.zeros(0, int), "x": np.zeros(0)})


def joined(folder, tables, fmt, names="abcdef"):
    parts = []
    for name, table in zip(names, tables, strict=False):
        path = folder / f"{name}.{fmt}"
        with path.open("wb") as out:
            write_table(out, table, fmt)
        parts.append((name, str(path)))
    return bytes_of(join_tables, dict(parts), fmt), [(folder / f"{name}.{fmt}").read_bytes() for name, _ in parts]


def test_rows_are_the_same_bytes(tmp_path):
    data, (first, second) = joined(tmp_path, [PLAIN, PLAIN], "csv")
    rows = [line for part in (first, second) for line in part.splitlines()[1:]]
    assert data.splitlines() == [b"input,label,x", b"a," + rows[0], b"a," + rows[1], b"b," + rows[2], b"b," + rows[3]]
    data, (first, second) = joined(tmp_path, [PLAIN, PLAIN], "json")
    assert [row.removeprefix(b'{"input":"a",') for row in data.splitlines()[1:3]] == [
        row.removeprefix(b"{") for row in (first.splitlines()[1], first.splitlines()[2] + b",")
    ]


@pytest.mark.parametrize("fmt", ["csv", "tsv", "json"])
def test_columns_of_any_table(tmp_path, fmt):
    data, _ = joined(tmp_path, [PLAIN, EMPTY, ODD], fmt)
    if fmt != "json":
        read = rows_of(data, "\t" if fmt == "tsv" else ",")
        none, text = "", str
    else:
        read, none, text = json.loads(data), None, lambda value: value
    names = ["voro_input", "label", "x", "note", "ü", "input"]
    assert set(read[0]) == set(names)
    assert [row["voro_input"] for row in read] == ["a", "a", "c"]
    assert [row["note"] for row in read] == [none, none, 'a "b", c\nd']
    assert [row["x"] for row in read] == [text(0.1), none, 1e22 if fmt == "json" else "1e+22"]
    assert [(row["ü"], row["input"]) for row in read] == [(none, none), (none, none), ("é", text(3.5))]


@pytest.mark.parametrize("fmt", ["csv", "json"])
def test_quoting_is_that_of_single_tables(tmp_path, fmt):
    """Fields that need quotes are quoted as the core quotes them."""
    texts = ["", " a ", "a,b", '"', "x\ny", "x\ry", "ü", "'", "#", "\t", "1", '""', "a;b"]
    data, (single,) = joined(tmp_path, [Table({"label": range(len(texts)), "text": texts})], fmt)
    if fmt == "csv":
        assert data == b"input,label,text\n" + b"".join(b"a," + row for row in lines_of(single))
    else:
        assert data == single.replace(b'{"label"', b'{"input":"a","label"')


def lines_of(data):
    """Rows, with the ends of lines in quotes."""
    rows = [b""]
    for line in data.split(b"\n", 1)[1].splitlines(keepends=True) or [b""]:
        rows[-1] += line
        if rows[-1].count(b'"') % 2 == 0 and line.endswith(b"\n"):
            rows.append(b"")
    return [row for row in rows if row]


@pytest.mark.parametrize("fmt", ["csv", "json"])
def test_no_rows(tmp_path, fmt):
    assert joined(tmp_path, [EMPTY, EMPTY], fmt)[0] == (b"input,label,x\n" if fmt == "csv" else b"[]\n")
    assert joined(tmp_path, [], fmt)[0] == (b"input\n" if fmt == "csv" else b"[]\n")


def test_names_that_are_no_text(tmp_path):
    path = tmp_path / "a.csv"
    path.write_bytes(b"label\n1\n")
    assert bytes_of(join_tables, {"\udcff,b": str(path)}, "csv") == b'input,label\n"\xff,b",1\n'


def test_long_fields(tmp_path):
    data, _ = joined(tmp_path, [Table({"label": [1], "text": ["a" * 200_000]})], "csv")
    assert len(data) > 200_000
