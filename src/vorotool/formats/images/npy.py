"""Images and volumes as NPY files: written as they come, and images read without trusting the header."""

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


def write_npy(out: BinaryIO, bands: Iterable[NDArray[Any]], shape: tuple[int, ...], *, dtype: DTypeLike) -> None:
    """Write an array from bands of rows, or slabs of slices: the header first, then each as it comes."""
    kind = np.dtype(dtype).newbyteorder("<")
    header = {"descr": np.lib.format.dtype_to_descr(kind), "fortran_order": False, "shape": tuple(map(int, shape))}
    np.lib.format.write_array_header_1_0(out, header)
    for band in checked(bands, shape):
        out.write(stored(band, kind).data)


def stored(band: NDArray[Any], dtype: np.dtype[Any]) -> NDArray[Any]:
    """Contiguous rows of the given type; integers that do not fit are refused (LimitError), never wrapped."""
    if dtype.kind in "ui" and not np.can_cast(band.dtype, dtype):
        check_fits(band, int(np.iinfo(dtype).max), f"{dtype.name} pixels")
    return np.ascontiguousarray(band, dtype=dtype)


def read_npy(source: Source, *, max_items: int, option: str) -> NDArray[Any]:
    """Return the array of a source, as a view of its bytes where that is possible."""
    header = npy_header(source)
    items = prod(header.shape)
    if items > max_items:
        raise LimitError(f"{source.name} has {items} items, shape {header.shape}: more than {option} {max_items}")
    return npy_values(source, header).astype(header.dtype.newbyteorder("="), order="C", copy=False)
