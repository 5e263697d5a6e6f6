"""Points from NPY files."""

import math

import numpy as np
import pytest

from support.few import few
from support.readers.point_reading import error_of, npy, read
from vorotool.errors import LimitError


@pytest.mark.parametrize("dtype", few(["f8", ">i8", ">f8", "f4", "i2", "u1"], 2))
@pytest.mark.parametrize("order", ["C", "F"])
def test_npy(dtype, order):
    array = np.array([[1, 2, 7], [3, 4, 9]], dtype=dtype, order=order)
    points = read(npy(array), "a.npy")
    assert points.xy.tolist() == [[1, 2], [3, 4]]
    assert points.labels.tolist() == [7, 9]
    assert read(npy(array[:, :2]), "a.npy").labels is None
    assert len(read(npy(array[:0]), "a.npy")) == 0


def header(text, version=b"\x01\x00", size=None):
    padded = text.encode() + b"\n"
    return b"\x93NUMPY" + version + (len(padded) if size is None else size).to_bytes(2, "little") + padded


SHAPE = "{{'descr': '<f8', 'fortran_order': False, 'shape': {}}}"


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (npy(np.array([[1, "a"]], dtype=object), allow_pickle=True), "holds pickled objects, which are never loaded"),
        (npy(np.array([["1", "2"]])), "holds <U1, not numbers"),
        (npy(np.array([[1j, 2]])), "holds complex128, not numbers"),
        (npy(np.ones((3, 2), bool)), "holds truth values, not numbers; save an (n, 2)"),
        (npy(np.zeros((3, 4))), "(3, 4)"),
        (npy(np.zeros(4)), "holds an array of shape (4,)"),
        (npy(np.zeros((1, 2), dtype=[("x", "f8")])), "holds [('x', '<f8')], not numbers"),
        (npy(np.zeros((5, 2)))[:-1], "(5, 2)"),
        (b"\x93NUMPY\x01\x00", "version 1"),
        (b"", "version 1"),
        (header("{"), "version 1"),
        (header("(" * 5000), "version 1"),
        (header("{'descr': '<f8'}"), "version 1"),
        (header(SHAPE.format("(2, 2)"), size=65535), "version 1"),
        (header(SHAPE.format("(-1, 2)")), "(-1, 2)"),
        (header(SHAPE.format("(1, 2)"), b"\x03\x00"), "version 1"),
        (npy(np.array([[1, 2], [3, math.nan]])), "row 2"),
        (npy(np.array([[1.0, 2, 1], [3, 4, 0.5]])), "row 2"),
        (npy(np.array([[1, 2, -1]])), "row 1"),
        (npy(np.array([[1.0, 2, math.nan]])), "row 1"),
    ],
)
def test_bad_npy(data, message):
    found = error_of(data, "a.npy")
    assert found.startswith("a.npy")
    assert message in found
    assert ";" in found


def test_the_limit_of_npy():
    data = header(SHAPE.format("(100000000000, 2)"))
    assert "holds 100000000000 points, more than the limit of 4294967295" in error_of(data, "a.npy", LimitError)
    assert "more than the limit of 5: raise max_sites" in error_of(
        npy(np.zeros((6, 2))), "a.npy", LimitError, max_sites=5
    )
