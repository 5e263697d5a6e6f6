"""Points from NumPy's ``.npy`` files; never unpickled."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError
from vorotool.formats.io.npy_arrays import npy_header, npy_values
from vorotool.formats.io.sources import Source
from vorotool.formats.parsing.reader_options import LARGEST_LABEL, ReadOptions
from vorotool.geometry.coordinates import INEXACT, first_inexact
from vorotool.geometry.points.point_set import PointSet

_ADVICE = "save an (n, 2) or (n, 3) array of numbers with numpy.save"


def read_npy(source: Source, options: ReadOptions) -> PointSet:
    """Read an (n, 2) array of x, y or an (n, 3) array of x, y, label."""
    header = npy_header(source)
    shape = header.shape
    if header.dtype.kind == "b":
        raise InputError(f"{source.name} holds truth values, not numbers; {_ADVICE}")
    if len(shape) != 2 or shape[1] not in (2, 3):
        raise InputError(f"{source.name} holds an array of shape {shape}; {_ADVICE} (columns x, y and label)")
    options.check_sites(source.name, shape[0])
    table = npy_values(source, header)
    row = first_inexact(table[:, :2])
    if row is not None:
        raise InputError(f"{source.name}, row {row + 1}: ({table[row, 0]}, {table[row, 1]}): {INEXACT}")
    xy = np.ascontiguousarray(table[:, :2], dtype=np.float64)
    _check_finite(source.name, xy)
    return PointSet(xy, _labels(source.name, table[:, 2]) if shape[1] == 3 else None)


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
