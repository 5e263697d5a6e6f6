"""Points from NPY files."""

import math

import numpy as np
import pytest

from support.readers.point_reading import error_of, npy, read
from vorotool.errors import LimitError


@pytest.mark.parametrize("dtype", ["f8", ">f8", "f4", "i2", "u1", ">i8"])
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
        (
            npy(np.array([[1, "a"]], dtype=object), allow_pickle=True),
            "holds pickled objects, which are never loaded",
        ),
        (npy(np.array([["1", "2"]])), "holds <U1, not numbers"),
        (npy(np.array([[1j, 2]])), "holds complex128, not numbers"),
        (npy(np.ones((3, 2), bool)), "holds truth values, not numbers; save an (n, 2)"),
        (npy(np.zeros((3, 4))), "holds an array of shape (3, 4); save an (n, 2) or (n, 3) array"),
        (npy(np.zeros(4)), "holds an array of shape (4,)"),
        (npy(np.zeros((1, 2), dtype=[("x", "f8")])), "holds [('x', '<f8')], not numbers"),
        (
            npy(np.zeros((5, 2)))[:-1],
            "is cut off: shape (5, 2) of float64 needs 80 bytes, it has 79; write the file again",
        ),
        (b"\x93NUMPY\x01\x00", "is not an NPY file of version 1 or 2 ("),
        (b"", "is not an NPY file of version 1 or 2 ("),
        (header("{"), "is not an NPY file of version 1 or 2 ("),
        (header("(" * 5000), "is not an NPY file of version 1 or 2 ("),
        (header("{'descr': '<f8'}"), "is not an NPY file of version 1 or 2 ("),
        (header(SHAPE.format("(2, 2)"), size=65535), "is not an NPY file of version 1 or 2 ("),
        (header(SHAPE.format("(-1, 2)")), "has the shape (-1, 2); whole numbers from 0 on"),
        (header(SHAPE.format("(1, 2)"), b"\x03\x00"), "is not an NPY file of version 1 or 2 (version 3.0)"),
        (
            npy(np.array([[1, 2], [3, math.nan]])),
            "row 2: (3.0, nan) is not finite; correct or remove it (1 such rows)",
        ),
        (
            npy(np.array([[1.0, 2, 1], [3, 4, 0.5]])),
            "row 2: the label 0.5 is not a whole number from 1 to 4294967295",
        ),
        (npy(np.array([[1, 2, -1]])), "row 1: the label -1 is not a whole number"),
        (npy(np.array([[1.0, 2, math.nan]])), "row 1: the label nan is not a whole number"),
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
