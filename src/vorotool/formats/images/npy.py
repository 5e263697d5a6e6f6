"""Images as NPY files: written row by row, and read without trusting the header."""

from __future__ import annotations

from collections.abc import Iterable
from math import prod
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import DTypeLike, NDArray

from vorotool.errors import LimitError
from vorotool.formats.io.npy_arrays import npy_header, npy_values
from vorotool.formats.io.row_bands import check_fits, checked
from vorotool.formats.io.sources import Source


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
    >>> import io
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


def read_npy(source: Source, *, max_items: int, option: str) -> NDArray[Any]:
    """Return the array of a source, as a view of its bytes where that is possible.

    Parameters
    ----------
    source : Source
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
    return npy_values(source, header).astype(header.dtype.newbyteorder("="), order="C", copy=False)
