"""Tables as CSV, JSON and NPZ: read back by other libraries, and the same bytes every time."""

import csv
import io
import json
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from support.readers.sources import read_as
from support.readers.written import bytes_of, rows_of
from vorotool.formats.io.sources import Source
from vorotool.formats.text.tables import write_table
from vorotool.products.formats import TABLES
from vorotool.types.table import Table


def written(table, fmt, **options):
    return bytes_of(write_table, table, fmt, **options)


MIXED = Table(
    {
        "label": np.array([1, 2, 3], dtype=np.uint16),
        "r": np.array([0.5, 100000.0, 1 / 3]),
        "nearest_label": np.ma.array([2, 0, 1], mask=[False, True, False]),
        "touches_frame": np.array([True, False, True]),
        "name": ["a,b", None, 'é "q"'],
        "other": np.array([1.0, {"k": [1, True]}, math.nan], dtype=object),
    }
)


def test_csv():
    assert written(MIXED, "csv").decode() == (
        "label,r,nearest_label,touches_frame,name,other\n"
        '1,0.5,2,1,"a,b",1\n'
        '2,100000,,0,,"{""k"":[1,true]}"\n'
        '3,0.3333333333333333,1,1,"é ""q""",\n'
    )
    assert b"\n3,0.333,1,1" in written(MIXED, "csv", precision=3)


def test_json():
    assert json.loads(written(MIXED, "json")) == [
        {"label": 1, "r": 0.5, "nearest_label": 2, "touches_frame": True, "name": "a,b", "other": 1.0},
        {"label": 2, "r": 1e5, "nearest_label": None, "touches_frame": False, "name": None, "other": {"k": [1, True]}},
        {"label": 3, "r": 1 / 3, "nearest_label": 1, "touches_frame": True, "name": 'é "q"', "other": None},
    ]
    assert json.loads(written(MIXED, "json", precision=2))[2]["r"] == 0.33
    assert written(MIXED, "json").count(b"\n") == 5


def test_npz():
    arrays = np.load(io.BytesIO(written(MIXED, "npz")), allow_pickle=False)
    assert set(arrays) == {*MIXED, "nearest_label_missing", "name_missing", "other_missing"}
    assert arrays["label"].tolist() == [1, 2, 3]
    assert arrays["nearest_label"].tolist() == [2, 0, 1]
    assert arrays["nearest_label_missing"].tolist() == [False, True, False]
    assert arrays["touches_frame"].dtype == bool
    assert arrays["name"].tolist() == ["a,b", "", 'é "q"']
    assert arrays["other"].tolist() == ["1", '{"k":[1,true]}', ""]


def test_never_nan():
    table = Table({"r": np.ma.array([1.0, math.nan, math.inf, 4.0], mask=[True, False, False, False])})
    assert written(table, "csv") == b'r\n""\n""\n""\n4\n'
    assert json.loads(written(table, "json")) == [{"r": None}] * 3 + [{"r": 4.0}]
    arrays = np.load(io.BytesIO(written(table, "npz")))
    assert arrays["r"].tolist() == [0, 0, 0, 4]
    assert arrays["r_missing"].tolist() == [True, True, True, False]


def test_empty_tables():
    table = Table({"label": np.array([], dtype=int), "name": []})
    assert written(table, "csv") == b"label,name\n"
    assert written(table, "json") == b"[]\n"
    assert np.load(io.BytesIO(written(table, "npz")))["label"].shape == (0,)
    assert written(Table({}), "csv") == b""
    assert written(Table({}), "json") == b"[]\n"


@pytest.mark.parametrize("fmt", TABLES)
def test_the_same_bytes_every_time(fmt):
    generator = np.random.default_rng(1)
    table = Table({"x": generator.normal(size=200_000), "label": np.arange(200_000)})
    outputs = {written(table, fmt, threads=threads) for threads in (1, 2, 3)}

    class Pipe(io.BytesIO):
        def seekable(self):
            return False

    pipe = Pipe()
    write_table(pipe, table, fmt)
    assert outputs == {pipe.getvalue()}


finite = st.floats(allow_nan=False, allow_infinity=False)
texts = st.text(st.characters(exclude_categories=["Cs"], exclude_characters="\0"), max_size=12)


@pytest.mark.parametrize(("fmt", "dialect"), [("csv", "excel"), ("tsv", "excel-tab")])
@settings(deadline=None)
@given(rows=st.lists(st.tuples(finite, finite, texts), max_size=20))
def test_what_is_written_as_text_is_read_back(fmt, dialect, rows):
    x, y, names = ([row[i] for row in rows] for i in range(3))
    data = written(Table({"x": np.array(x), "y": np.array(y), "name": names}), fmt)
    points = read_as(Source(f"t.{fmt}", data))
    np.testing.assert_array_equal(points.xy, np.array([x, y]).T.reshape(-1, 2))
    assert points.properties.get("name", []) == names
    by_csv = rows_of(data, csv.get_dialect(dialect).delimiter)
    assert [row["name"] for row in by_csv] == names
    assert [float(row["x"]) for row in by_csv] == x


@settings(deadline=None)
@given(st.lists(st.tuples(st.floats(), texts, st.booleans()), max_size=20))
def test_what_is_written_as_json_is_read_back(rows):
    x, names, flags = ([row[i] for row in rows] for i in range(3))
    data = written(Table({"x": np.array(x, dtype=float), 'na"me': names, "flag": np.array(flags, dtype=bool)}), "json")
    finite = [value if math.isfinite(value) else None for value in x]
    assert [list(row.values()) for row in json.loads(data)] == list(map(list, zip(finite, names, flags, strict=True)))
    assert all(list(row) == ["x", 'na"me', "flag"] for row in json.loads(data))
