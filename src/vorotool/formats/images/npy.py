"""NumPy's NPY files: writing row by row, and reading without trusting the header."""

from __future__ import annotations

import io
from collections.abc import Iterable
from math import prod
from typing import Any, BinaryIO, NamedTuple

import numpy as np
from numpy.typing import DTypeLike, NDArray

from vorotool.errors import InputError, LimitError
from vorotool.formats.io.limits import SourceLike
from vorotool.formats.io.row_bands import check_fits, checked

MAGIC = b"\x93NUMPY"


def write_npy(out: BinaryIO, bands: Iterable[NDArray[Any]], shape: tuple[int, int], *, dtype: DTypeLike) -> None:
    """Write an array from bands of rows: the header first, then each band as it comes.

    Parameters
    ----------
    out : binary file
        Written from its current position on; never sought.
    bands : iterable of (rows, W) arrays
        Rows from top to bottom.
    shape : (int, int)
        Height and width.
    dtype : dtype
        Type in the file, always little-endian.

    Raises
    ------
    LimitError
        If an integer does not fit in ``dtype``.

    Examples
    --------
    >>> out = io.BytesIO()
    >>> write_npy(out, [np.array([[1, 2]]), np.array([[3, 4]])], (2, 2), dtype=np.uint16)
    >>> np.load(io.BytesIO(out.getvalue())).tolist()
    [[1, 2], [3, 4]]
    """
    kind = np.dtype(dtype).newbyteorder("<")
    header = {
        "descr": np.lib.format.dtype_to_descr(kind),
        "fortran_order": False,
        "shape": tuple(map(int, shape)),
    }
    np.lib.format.write_array_header_1_0(out, header)
    for band in checked(bands, shape):
        out.write(stored(band, kind).data)


def stored(band: NDArray[Any], dtype: np.dtype[Any]) -> NDArray[Any]:
    """Contiguous rows of the given type; integers that do not fit are refused (LimitError), never wrapped."""
    if dtype.kind in "ui" and not np.can_cast(band.dtype, dtype):
        check_fits(band, int(np.iinfo(dtype).max), f"{dtype.name} pixels")
    return np.ascontiguousarray(band, dtype=dtype)


class NpyHeader(NamedTuple):
    """The header of an NPY file."""

    shape: tuple[int, ...]
    dtype: np.dtype[Any]
    fortran_order: bool
    offset: int


def npy_header(source: SourceLike) -> NpyHeader:
    """Read the header alone.

    Raises
    ------
    InputError
        If there is none, or it describes pickled objects, text, records or other things that are not numbers.
    """
    stream = io.BytesIO(source.data[:65_536])
    try:
        version = np.lib.format.read_magic(stream)
        read = {(1, 0): np.lib.format.read_array_header_1_0, (2, 0): np.lib.format.read_array_header_2_0}
        shape, fortran_order, dtype = read[version](stream)
    except Exception as error:  # a header is a Python literal: many things can be wrong with it
        reason = str(error).splitlines()[0] if str(error) else type(error).__name__
        raise InputError(f"{source.name} is not an NPY file of version 1 or 2: {reason}") from error
    if dtype.hasobject:
        raise InputError(f"{source.name} holds pickled objects, which are never loaded: save it with a number dtype")
    if dtype.kind not in "buif":
        raise InputError(f"{source.name} holds {dtype}: save it as integers or floating-point numbers")
    if any(type(side) is not int or side < 0 for side in shape):
        raise InputError(f"{source.name} has the shape {shape}: whole numbers from 0 on were expected")
    return NpyHeader(shape, dtype, fortran_order, stream.tell())


def read_npy(source: SourceLike, *, max_items: int, option: str) -> NDArray[Any]:
    """Return the array of a source, as a view of its bytes where that is possible.

    Parameters
    ----------
    source : SourceLike
        Name and content.
    max_items : int
        Largest number of items, checked before memory is taken.
    option : str
        The option that sets the limit, for the message.

    Raises
    ------
    InputError
        If the header is not usable, or the file ends before the array does.
    LimitError
        If the array has more than ``max_items`` items.
    """
    header = npy_header(source)
    items = prod(header.shape)
    if items > max_items:
        raise LimitError(f"{source.name} has {items} items, shape {header.shape}: more than {option} {max_items}")
    needed = items * header.dtype.itemsize
    present = len(source.data) - header.offset
    if present < needed:
        raise InputError(
            f"{source.name} is cut off: shape {header.shape} of {header.dtype} needs {needed} bytes, it has {present}"
        )
    flat = np.frombuffer(source.data, header.dtype, items, header.offset)
    array = flat.reshape(header.shape, order="F" if header.fortran_order else "C")
    return array.astype(header.dtype.newbyteorder("="), order="C", copy=False)
