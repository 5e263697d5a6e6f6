"""Tables that were written as JSON and NPZ are read back as points, as those in CSV are."""

import json
import zipfile

import numpy as np
import pytest

import vorotool
from support.readers.written import bytes_of
from support.refusals import refused
from vorotool.errors import InputError, LimitError, UsageError

POINTS = [[0.5, 0.25], [4, 0], [0, 3], [4, 0], [-1.5e-7, 1e9]]


@pytest.fixture
def write(tmp_path):
    def put(fmt, table=None):
        path = tmp_path / f"table.{fmt}"
        if table is None:
            mesh = vorotool.delaunay(vorotool.PointSet(POINTS, labels=[7, 3, 9, 4, 5]))
            table = vorotool.point_table(mesh)
        vorotool.write(table, path)
        return path

    return put


def test_values_keep_their_types_and_what_is_missing_is_none(write):
    table = vorotool.Table({"x": [1, 2], "y": [3, 4], "n": np.ma.array([5, 6], mask=[0, 1]), "t": ["a", "b"]})
    for fmt in ("json", "npz"):
        assert vorotool.read(write(fmt, table)).properties == {"n": [5, None], "t": ["a", "b"]}


def saved(tmp_path, **arrays):
    np.savez(tmp_path / "a.npz", **arrays)
    return tmp_path / "a.npz"


@pytest.mark.parametrize(
    ("arrays", "words"),
    [
        ({"x": np.zeros(2), "y": np.zeros(3)}, "is not a table: it holds arrays of 2 to 3 values"),
        ({}, "is not a table: it holds no arrays"),
        ({"x": np.zeros((2, 2)), "y": np.zeros(2)}, r"x\.npy has the shape \(2, 2\)"),
        ({"x": np.array([None]), "y": np.zeros(1)}, r"x\.npy is of type object"),
        ({"x": np.zeros(2), "y": np.array([1, np.nan])}, "row 2"),
        ({"x": np.array(["a"]), "y": np.zeros(1)}, "row 1"),
        ({"x": np.array([2**60 + 1]), "y": np.zeros(1)}, r"row 1"),
        ({"u": np.zeros(1), "v": np.zeros(1)}, "no coordinate columns"),
    ],
)
def test_what_is_no_table_of_points_is_refused(tmp_path, arrays, words):
    refused(InputError, words, vorotool.read, saved(tmp_path, **arrays))


def test_compressed_and_damaged_archives_are_refused(tmp_path):
    np.savez_compressed(tmp_path / "a.npz", x=np.zeros(10**6), y=np.zeros(10**6))
    refused(InputError, r"x\.npy is compressed", vorotool.read, tmp_path / "a.npz")
    whole = saved(tmp_path, x=np.arange(50.0), y=np.arange(50.0)).read_bytes()
    for length in range(0, len(whole), 7):
        (tmp_path / "b.npz").write_bytes(whole[:length])
        refused(InputError, "", vorotool.read, tmp_path / "b.npz", geometry="points")


def test_a_header_that_announces_more_than_there_is(tmp_path):
    data = bytes_of(np.lib.format.write_array_header_1_0, {"descr": "<f8", "fortran_order": False, "shape": (10**15,)})
    with zipfile.ZipFile(tmp_path / "a.npz", "w") as archive:
        archive.writestr("x.npy", data)
    refused((InputError, LimitError), "", vorotool.read, tmp_path / "a.npz")


def test_rows_of_json_are_alike(tmp_path):
    path = tmp_path / "a.json"
    for rows, words in (
        ([{"x": 1, "y": 2}, {"x": 1}], "row 2: .* has other fields than the first"),
        ([{"x": 1, "y": 2}, 5], "row 2: 5 has other fields"),
        ([{"x": 1, "y": None}], "row 1: y is None, not a finite number"),
        ([{"x": 1, "y": True}], "row 1: y is True, not a finite number"),
    ):
        path.write_text(json.dumps(rows))
        refused(InputError, words, vorotool.read, path, geometry="points")
    path.write_text(json.dumps([{"x": 1, "y": 2, "label": 0.5}]))
    refused(InputError, r"the label 0\.5", vorotool.read, path, geometry="points", columns="x,y,label")


def test_columns_are_for_tables(tmp_path):
    (tmp_path / "a.json").write_text("[[1, 2], [3, 4]]")
    with pytest.raises(UsageError, match="columns applies to delimited text and tables"):
        vorotool.read(tmp_path / "a.json", columns="x,y")
