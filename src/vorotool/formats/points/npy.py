"""Points from NumPy's ``.npy`` files; never unpickled."""

from __future__ import annotations

import io
import math
import warnings

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError
from vorotool.formats.io.sources import Source
from vorotool.formats.parsing.reader_options import LARGEST_LABEL, PointOptions
from vorotool.geometry.coordinates import INEXACT, first_inexact
from vorotool.geometry.points.point_set import PointSet

_ADVICE = "save an (n, 2) or (n, 3) array of numbers with numpy.save"


def read_npy(source: Source, options: PointOptions) -> PointSet:
    """Read an (n, 2) array of x, y or an (n, 3) array of x, y, label."""
    shape, fortran_order, dtype, offset = _read_header(source)
    _check_kind(source.name, shape, dtype)
    options.check_sites(source.name, shape[0])
    needed = math.prod(shape) * dtype.itemsize
    if len(source.data) - offset < needed:
        raise InputError(
            f"{source.name} is truncated: shape {shape} of {dtype} needs {needed} bytes after the header, "
            f"but there are {len(source.data) - offset}; write the file again"
        )
    values = np.frombuffer(source.data, dtype, math.prod(shape), offset)
    table = values.reshape(shape, order="F" if fortran_order else "C")
    row = first_inexact(table[:, :2])
    if row is not None:
        raise InputError(f"{source.name}, row {row + 1}: ({table[row, 0]}, {table[row, 1]}): {INEXACT}")
    xy = np.ascontiguousarray(table[:, :2], dtype=np.float64)
    _check_finite(source.name, xy)
    return PointSet(xy, _labels(source.name, table[:, 2]) if shape[1] == 3 else None)


def _read_header(source: Source) -> tuple[tuple[int, ...], bool, np.dtype[np.generic], int]:
    stream = io.BytesIO(source.data)
    try:
        version = np.lib.format.read_magic(stream)
        if version not in ((1, 0), (2, 0)):  # later ones only serve structured arrays
            raise InputError(f"{source.name}: version {version} of the NPY format is not read; {_ADVICE}")
        read = np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
        with warnings.catch_warnings():  # a header written by Python 2
            warnings.simplefilter("ignore")
            shape, fortran_order, dtype = read(stream)
    except InputError:
        raise
    except Exception as error:  # NumPy evaluates the header as a literal, which fails in many ways
        reason = str(error).splitlines()[0] if str(error) else type(error).__name__
        raise InputError(f"{source.name}: the NPY header cannot be read ({reason}); {_ADVICE}") from None
    return shape, fortran_order, dtype, stream.tell()


def _check_kind(name: str, shape: tuple[int, ...], dtype: np.dtype[np.generic]) -> None:
    if dtype.hasobject:
        raise InputError(f"{name} holds pickled Python objects, which are never loaded; {_ADVICE}")
    if dtype.kind not in "iuf":
        raise InputError(f"{name} holds values of type {dtype}, not numbers; {_ADVICE}")
    if len(shape) != 2 or shape[1] not in (2, 3) or type(shape[0]) is not int or shape[0] < 0:
        raise InputError(f"{name} holds an array of shape {shape}; {_ADVICE} (columns x, y and label)")


def _check_finite(name: str, xy: NDArray[np.float64]) -> None:
    finite = np.isfinite(xy)
    bad = np.flatnonzero(~(finite[:, 0] & finite[:, 1]))  # an `all` along rows this short is slow
    if bad.size:
        row = int(bad[0])
        raise InputError(
            f"{name}, row {row + 1}: ({xy[row, 0]}, {xy[row, 1]}) is not finite; correct or remove it "
            f"({bad.size} such rows)"
        )


def _labels(name: str, values: NDArray[np.generic]) -> NDArray[np.int64]:
    good = (values >= 1) & (values <= LARGEST_LABEL)  # type: ignore[operator]
    good &= values == np.floor(values)
    bad = np.flatnonzero(~good)
    if bad.size:
        row = int(bad[0])
        raise InputError(
            f"{name}, row {row + 1}: the label {values[row]} is not a whole number from 1 to "
            f"{LARGEST_LABEL}; correct it, or save x and y alone"
        )
    return values.astype(np.int64)
