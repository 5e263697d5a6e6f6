import io
from types import SimpleNamespace

import numpy as np
import pytest

from support.readers.written import bytes_of
from support.refusals import refused
from vorotool.errors import InputError, LimitError
from vorotool.formats.images.reader import read_image
from vorotool.formats.io.arrays import npy_header, write_npy
from vorotool.formats.io.sources import Source
from vorotool.formats.parsing.reader_options import ReadOptions


def saved(array: object, **options: object) -> SimpleNamespace:
    return SimpleNamespace(name="a.npy", data=bytes_of(np.save, array, **options))


def header_only(text: str) -> SimpleNamespace:
    text = text.ljust(117) + "\n"
    return SimpleNamespace(name="a.npy", data=b"\x93NUMPY\x01\x00" + len(text).to_bytes(2, "little") + text.encode())


@pytest.mark.parametrize("dtype", ["u1", "u2", "u4", "u8", "i4", "f4", "?"])
def test_written_as_numpy_does(dtype: str) -> None:
    values = np.random.default_rng(1).integers(0, 2, (7, 5)).astype(dtype)
    assert bytes_of(write_npy, [values[:3], values[3:3], values[3:]], (7, 5), dtype=dtype) == saved(values).data


def test_written_values_are_never_wrapped() -> None:
    for dtype, value in (("u2", 65_536), ("u1", 256), ("i4", 2**31), ("u4", -1)):
        refused(LimitError, str(value), write_npy, io.BytesIO(), [np.array([[value]])], (1, 1), dtype=dtype)


@pytest.mark.parametrize("dtype", ["u1", ">u2", "<u4", ">f8", "?"])
def test_read_gives_native_contiguous_values(dtype: str) -> None:
    for order in ("C", "F"):
        values = np.asarray(np.arange(12).reshape(3, 4), dtype=dtype, order=order)
        found = read_image(Source("a.npy", saved(values).data, "npy"), ReadOptions(max_pixels=12)).values
        np.testing.assert_array_equal(found, values)
        assert (found.dtype.isnative, found.flags.c_contiguous) == (True, True)


def test_header_of_many_rows_is_a_limit() -> None:
    data = header_only("{'descr': '<f8', 'fortran_order': False, 'shape': (100000000000, 3), }").data
    words = r"300000000000 pixels, more than"
    refused(LimitError, words, read_image, Source("a.npy", data, "npy"), ReadOptions(max_pixels=100))


@pytest.mark.parametrize(
    ("source", "message"),
    [
        (saved(np.array([{}], dtype=object), allow_pickle=True), "pickled objects, which are never loaded"),
        (saved(np.array(["a"])), "holds <U1"),
        (saved(np.zeros(3, [("x", "f8")])), "save it as integers"),
        (saved(np.zeros(3, "c16")), "holds complex128"),
        (SimpleNamespace(name="a.npy", data=b""), "not an NPY file"),
        (SimpleNamespace(name="a.npy", data=b"\x93NUMPY\x09\x00"), "not an NPY file"),
        (SimpleNamespace(name="a.npy", data=saved(np.zeros(3)).data[:40]), "not an NPY file"),
        (header_only("{'descr': '<f8', 'fortran_order': False, 'shape': (-1, 2), }"), "integers of 0 or more"),
        (header_only("{'descr': '<f8', 'fortran_order': False, 'shape': (False, 2), }"), "integers of 0 or more"),
        (header_only("{'descr': '<f8', 'fortran_order': False, 'shape': (1.5, 2), }"), "not an NPY file"),
        (header_only("__import__('os').getcwd()"), "not an NPY file"),
    ],
)
def test_unusable_headers(source: SimpleNamespace, message: str) -> None:
    refused(InputError, [message, "a.npy"], npy_header, source)
