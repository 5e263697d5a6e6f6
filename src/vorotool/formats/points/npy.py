"""Points from NumPy's ``.npy`` files; never unpickled."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import AS_VOLUME, InputError
from vorotool.formats.io.arrays import npy_header, npy_values
from vorotool.formats.io.sources import Source
from vorotool.formats.parsing.reader_options import LARGEST_LABEL, ReadOptions
from vorotool.numeric.coordinates import INEXACT, first_inexact
from vorotool.types.points.point_set import PointSet
from vorotool.types.values import counted

_ADVICE = "save an (n, 2) or (n, 3) array of numbers with numpy.save"


def read_npy(source: Source, options: ReadOptions) -> PointSet:
    """Read an (n, 2) array of x, y or an (n, 3) array of x, y, label."""
    header = npy_header(source)
    shape = header.shape
    if header.dtype.kind == "b":
        raise InputError(f"{source.name} holds truth values, not numbers; {_ADVICE}")
    if len(shape) != 2 or shape[1] not in (2, 3):
        other = f"; read it as a volume with {AS_VOLUME}" if len(shape) == 3 else ""
        raise InputError(f"{source.name} holds an array of shape {shape}; {_ADVICE} (columns x, y and label){other}")
    options.check_sites(source.name, shape[0])
    table = npy_values(source, header)
    xy = check_coordinates(source.name, table[:, :2])
    return PointSet(xy, npy_labels(source.name, table[:, 2]) if shape[1] == 3 else None)


def check_coordinates(name: str, table: NDArray[np.generic]) -> NDArray[np.float64]:
    """Give coordinates, a column each, as floating-point numbers, which hold them exactly and are finite."""
    row = first_inexact(table)
    if row is not None:
        raise InputError(f"{name}, row {row + 1}: ({_shown(table[row])}): {INEXACT}")
    places = np.ascontiguousarray(table, dtype=np.float64)
    is_finite = np.logical_and.reduce([np.isfinite(column) for column in places.T])  # rows this short are slow
    bad = np.flatnonzero(~is_finite)
    if bad.size:
        row = int(bad[0])
        raise InputError(
            f"{name}, row {row + 1}: ({_shown(places[row])}) is not finite; correct or remove it "
            f"({counted(bad.size, 'such row')})"
        )
    return places


def _shown(row: NDArray[np.generic]) -> str:
    return ", ".join(str(each) for each in row)


def npy_labels(name: str, values: NDArray[np.generic]) -> NDArray[np.int64]:
    """Give labels, which are whole numbers; the row of another value is named (InputError)."""
    good = (values >= 1) & (values <= LARGEST_LABEL)  # type: ignore[operator]
    good &= values == np.floor(values)
    bad = np.flatnonzero(~good)
    if bad.size:
        row = int(bad[0])
        raise InputError(
            f"{name}, row {row + 1}: the label {values[row]} is not an integer from 1 to {LARGEST_LABEL}; correct it, "
            "or save x and y alone"
        )
    return values.astype(np.int64)
