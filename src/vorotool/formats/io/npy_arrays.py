"""NumPy's NPY files: headers by `numpy.lib.format`, arrays as views of the bytes, nothing unpickled."""

from __future__ import annotations

import io
import warnings
from math import prod
from typing import Any, BinaryIO, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError
from vorotool.formats.io.sources import Source

MAGIC = b"\x93NUMPY"
_LONGEST_HEADER = 65_536


class NpyHeader(NamedTuple):
    """The header of an NPY file."""

    shape: tuple[int, ...]
    dtype: np.dtype[Any]
    fortran_order: bool
    offset: int


def npy_header(source: Source) -> NpyHeader:
    """Read the header alone."""
    stream = io.BytesIO(source.data[:_LONGEST_HEADER])
    try:
        version = np.lib.format.read_magic(stream)  # later ones only serve structured arrays
        read = {(1, 0): np.lib.format.read_array_header_1_0, (2, 0): np.lib.format.read_array_header_2_0}
        if version not in read:
            raise ValueError(f"version {version[0]}.{version[1]}")
        with warnings.catch_warnings():  # a header written by Python 2
            warnings.simplefilter("ignore")
            shape, fortran_order, dtype = read[version](stream)
    except Exception as error:  # a header is a Python literal: many things can be wrong with it
        reason = str(error).splitlines()[0] if str(error) else type(error).__name__
        raise InputError(
            f"{source.name} is not an NPY file of version 1 or 2 ({reason}); save an array of numbers with numpy.save"
        ) from error
    if dtype.hasobject:
        raise InputError(f"{source.name} holds pickled objects, which are never loaded; save it with a number dtype")
    if dtype.kind not in "buif":
        raise InputError(f"{source.name} holds {dtype}, not numbers; save it as integers or floating-point numbers")
    if any(type(side) is not int or side < 0 for side in shape):  # a truth value is taken for a number, too
        raise InputError(f"{source.name} has the shape {shape}; expected integers of 0 or more")
    return NpyHeader(shape, dtype, fortran_order, stream.tell())


def npy_values(source: Source, header: NpyHeader) -> NDArray[Any]:
    """Give the array of a source, as a view of its bytes."""
    items = prod(header.shape)
    needed, present = items * header.dtype.itemsize, len(source.data) - header.offset
    if present < needed:
        raise InputError(
            f"{source.name} is cut off: shape {header.shape} of {header.dtype} needs {needed} bytes, it has {present}; "
            "write the file again"
        )
    flat = np.frombuffer(source.data, header.dtype, items, header.offset)
    return flat.reshape(header.shape, order="F" if header.fortran_order else "C")


def plain_values(values: NDArray[Any]) -> NDArray[Any]:
    """Give values in the order of bytes of this machine; truth values become 0 and 1."""
    if values.dtype == np.bool_:
        return values.astype(np.uint8)
    return values.astype(values.dtype.newbyteorder("="), copy=False)


def write_array(out: BinaryIO, values: NDArray[Any]) -> None:
    """Write an array of numbers: the same bytes for the same values, little-endian."""
    stored = np.ascontiguousarray(values, dtype=values.dtype.newbyteorder("<"))
    header = {"descr": np.lib.format.dtype_to_descr(stored.dtype), "fortran_order": False, "shape": values.shape}
    np.lib.format.write_array_header_1_0(out, header)
    out.write(stored.data)
