"""Tables as CSV, JSON and NPZ: read back by other libraries, and the same bytes every time."""

import csv
import io
import json
import math
import zipfile

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import vorotool
from support.readers.sources import read_as
from support.readers.written import rows_of
from vorotool.errors import UsageError
from vorotool.formats.io.sources import Source
from vorotool.formats.text.tables import write_table
from vorotool.products.formats import TABLES
from vorotool.types.table import Computed, Lookup, Table


def written(table, fmt, **options):
    out = io.BytesIO()
    write_table(out, table, fmt, **options)
    return out.getvalue()


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


def test_tsv():
    assert written(MIXED, "tsv").decode() == (
        "label\tr\tnearest_label\ttouches_frame\tname\tother\n"
        "1\t0.5\t2\t1\ta,b\t1\n"
        '2\t100000\t\t0\t\t"{""k"":[1,true]}"\n'
        '3\t0.3333333333333333\t1\t1\t"é ""q"""\t\n'
    )
    assert b"\n3\t0.333\t1\t1" in written(MIXED, "tsv", precision=3)
    assert written(Table({"r": [None, 4.0]}), "tsv") == b'r\n""\n4\n'


def test_json():
    assert json.loads(written(MIXED, "json")) == [
        {"label": 1, "r": 0.5, "nearest_label": 2, "touches_frame": True, "name": "a,b", "other": 1.0},
        {
            "label": 2,
            "r": 100000.0,
            "nearest_label": None,
            "touches_frame": False,
            "name": None,
            "other": {"k": [1, True]},
        },
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


def test_columns_of_lists_and_nested_properties():
    table = Table({"label": [1, 2]}).with_properties({"label": ["7", "8"], "box": [[1, 2], [3, 4]]})
    assert written(table, "csv") == b'voro_label,label,box\n1,7,"[1,2]"\n2,8,"[3,4]"\n'
    assert json.loads(written(table, "json"))[1] == {"voro_label": 2, "label": "8", "box": [3, 4]}
    assert written(Table({"n": [2**63, 2.5, None]}), "csv") == b'n\n9223372036854775808\n2.5\n""\n'


@pytest.mark.parametrize("fmt", TABLES)
def test_the_same_bytes_every_time(fmt):
    generator = np.random.default_rng(1)
    table = Table({"x": generator.normal(size=200_000), "label": np.arange(200_000)})
    outputs = {written(table, fmt, threads=threads) for threads in (1, 2, 3)}

    class Pipe(io.RawIOBase):
        def __init__(self):
            self.parts = []

        def writable(self):
            return True

        def write(self, data):
            self.parts.append(bytes(data))
            return len(data)

    pipe = Pipe()
    write_table(pipe, table, fmt)
    assert outputs == {b"".join(pipe.parts)}


def test_npz_holds_no_time_of_day():
    infos = zipfile.ZipFile(io.BytesIO(written(MIXED, "npz"))).infolist()
    assert {info.date_time for info in infos} == {(1980, 1, 1, 0, 0, 0)}
    assert {info.compress_type for info in infos} == {zipfile.ZIP_STORED}


def test_options_are_checked():
    with pytest.raises(UsageError, match="'xls'"):
        vorotool.write(MIXED, "a.xls")
    for precision in (0, 18, -1):
        with pytest.raises(UsageError, match=f"{precision}"):
            written(MIXED, "csv", precision=precision)


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


LAZY = Table(
    {
        "label": Lookup(np.array([7, 8, 9]), np.array([2, 0, 0, 1], dtype=np.int32)),
        "x": Lookup(np.array([0.5, 1 / 3, -2]), np.array([[1, 1], [0, 0], [2, 2], [0, 1]], dtype=np.int32)[:, 0]),
        "length": Computed(lambda rows: np.array([1.5, math.inf, 0.1, 1e300])[rows], 4),
    }
)


def test_lazy_columns_are_written_like_others():
    assert LAZY["label"].tolist() == [9, 7, 7, 8]
    plain = Table(dict(LAZY))
    for fmt in ("csv", "json"):
        assert written(LAZY, fmt) == written(plain, fmt)
        assert written(LAZY, fmt, precision=2) == written(plain, fmt, precision=2)
    arrays = np.load(io.BytesIO(written(LAZY, "npz")))
    for name in LAZY:
        np.testing.assert_array_equal(arrays[name], LAZY[name])


def test_lazy_columns_of_many_slices():
    rng = np.random.default_rng(2)
    values, index = rng.normal(size=1000), rng.integers(0, 1000, 70_000).astype(np.int32)
    table = Table({"x": Lookup(values, index), "square": Computed(lambda rows: values[index[rows]] ** 2, len(index))})
    for fmt in TABLES:
        assert len({written(table, fmt, threads=threads) for threads in (1, 2, 3)}) == 1
    read = np.loadtxt(io.BytesIO(written(table, "csv")), delimiter=",", skiprows=1)
    np.testing.assert_array_equal(read, np.stack([values[index], values[index] ** 2], axis=1))
    assert [row["x"] for row in json.loads(written(table, "json"))] == values[index].tolist()
    np.testing.assert_array_equal(np.load(io.BytesIO(written(table, "npz")))["square"], values[index] ** 2)


@settings(deadline=None)
@given(st.lists(st.tuples(st.floats(), texts, st.booleans()), max_size=20))
def test_what_is_written_as_json_is_read_back(rows):
    x, names, flags = ([row[i] for row in rows] for i in range(3))
    data = written(Table({"x": np.array(x, dtype=float), 'na"me': names, "flag": np.array(flags, dtype=bool)}), "json")
    expected = [
        {"x": v if math.isfinite(v) else None, 'na"me': name, "flag": flag}
        for v, name, flag in zip(x, names, flags, strict=True)
    ]
    assert json.loads(data) == expected
