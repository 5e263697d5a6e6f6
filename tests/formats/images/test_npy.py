import io
from types import SimpleNamespace

import numpy as np
import pytest

from vorotool.errors import InputError, LimitError
from vorotool.formats.images.reader import read_image
from vorotool.formats.io.arrays import npy_header, write_npy
from vorotool.formats.io.sources import Source
from vorotool.formats.parsing.reader_options import ReadOptions


def saved(array: object, **options: object) -> SimpleNamespace:
    out = io.BytesIO()
    np.save(out, array, **options)
    return SimpleNamespace(name="a.npy", data=out.getvalue())


def header_only(text: str) -> SimpleNamespace:
    text = text.ljust(117) + "\n"
    return SimpleNamespace(name="a.npy", data=b"\x93NUMPY\x01\x00" + len(text).to_bytes(2, "little") + text.encode())


@pytest.mark.parametrize("dtype", ["u1", "u2", "u4", "u8", "i4", "f4", "?"])
def test_written_as_numpy_does(dtype: str) -> None:
    values = np.random.default_rng(1).integers(0, 2, (7, 5)).astype(dtype)
    out = io.BytesIO()
    write_npy(out, [values[:3], values[3:3], values[3:]], (7, 5), dtype=dtype)
    assert out.getvalue() == saved(values).data


def test_written_values_are_never_wrapped() -> None:
    for dtype, value in (("u2", 65_536), ("u1", 256), ("i4", 2**31), ("u4", -1)):
        with pytest.raises(LimitError, match=str(value)):
            write_npy(io.BytesIO(), [np.array([[value]])], (1, 1), dtype=dtype)


@pytest.mark.parametrize("dtype", ["u1", ">u2", "<u4", ">f8", "?"])
@pytest.mark.parametrize("order", ["C", "F"])
def test_read_gives_native_contiguous_values(dtype: str, order: str) -> None:
    values = np.asarray(np.arange(12).reshape(3, 4), dtype=dtype, order=order)
    source = Source("a.npy", saved(values).data, "npy")
    found = read_image(source, ReadOptions(max_pixels=12)).values
    np.testing.assert_array_equal(found, values)
    assert found.dtype.isnative
    assert found.flags.c_contiguous


def test_header_of_many_rows_is_a_limit() -> None:
    source = header_only("{'descr': '<f8', 'fortran_order': False, 'shape': (100000000000, 3), }")
    with pytest.raises(LimitError, match=r"300000000000 pixels, more than"):
        read_image(Source("a.npy", source.data, "npy"), ReadOptions(max_pixels=100))


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
    with pytest.raises(InputError, match=message) as caught:
        npy_header(source)
    assert "a.npy" in str(caught.value)
