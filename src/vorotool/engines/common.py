"""What several engines share: label arrays, rows of sites, and the faults that checkers report."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.errors import InputError, VerificationError
from vorotool.numeric.checks import as_array
from vorotool.numeric.parallel import Progress
from vorotool.types.spacing import SQUARE, PixelSides
from vorotool.types.table import Table


def label_array(labels: NDArray[Any], what: str = "pixel") -> NDArray[Any]:
    """Labels as the core takes them, without a copy where possible; a negative int32 becomes one >= 2^31."""
    labels = np.ascontiguousarray(labels)
    native = labels.dtype.newbyteorder("=")
    if native.itemsize == 8:
        for bad in (labels.min(initial=0), labels.max(initial=0)):
            if not 0 <= int(bad) <= 0xFFFFFFFF:
                raise InputError(f"a {what} has label {bad}: labels must be from 0 to 4294967295")
        return labels.astype(np.uint32)
    return labels.astype(native, copy=False).view(f"u{native.itemsize}")


def refuse_negative(dtype: np.dtype[Any], largest: int, what: str = "pixel") -> None:
    """Refuse negative labels: the core takes them as unsigned, so they come back beyond the signed range."""
    bits = 8 * dtype.itemsize
    if dtype.kind == "i" and bits < 64 and largest >= 1 << (bits - 1):
        raise InputError(f"a {what} has label {largest - (1 << bits)}: labels must not be negative")


def next_row(row: NDArray[Any] | None, name: str, labels: NDArray[Any]) -> NDArray[Any] | None:
    """Return a row next to a band of labels, or a slice next to a slab, in the type of the labels."""
    if row is None:
        return None
    row = as_array(row, name)
    called = f"the {'row' if labels.ndim == 2 else 'slice'} {name}"
    if row.shape != labels.shape[1:]:
        raise InputError(f"{called} has shape {row.shape}, but the labels {labels.shape}")
    row = label_array(row)
    if not np.can_cast(row.dtype, labels.dtype):
        raise InputError(f"{called} has type {row.dtype}, but the labels {labels.dtype}: use one type")
    return row.astype(labels.dtype, copy=False)


def described(array: Any) -> str:
    """Name the type and shape of what was given as an array."""
    return f"{array.dtype} of shape {array.shape}" if isinstance(array, np.ndarray) else f"a {type(array).__name__}"


def rows_of(found: NDArray[np.uint32], labels: NDArray[np.uint32]) -> tuple[NDArray[np.intp], int | None]:
    """Row of each label that occurs among the labels of the sites, and the first that is none of these."""
    rows = np.searchsorted(labels, found)
    known = rows < len(labels)
    known[known] = labels[rows[known]] == found[known]
    return rows, None if known.all() else int(found[~known][0])


def spread(values: NDArray[Any], rows: NDArray[np.intp], count: int) -> NDArray[Any]:
    """Values of the regions at their rows, 0 in the others."""
    made = np.zeros((count, *values.shape[1:]), dtype=values.dtype)
    made[rows] = values
    return made


def nearest_sites(
    labels: NDArray[np.uint32], sites: NDArray[np.float64], threads: int, progress: Progress
) -> tuple[Any, Any]:
    """Label and distance of the site nearest to each; masked where there is no other."""
    nearest: Any = _core.spatial.nearest_other_sites  # of two axes or three
    index, distance = nearest(*map(np.ascontiguousarray, sites.T), np.ascontiguousarray(labels), threads, progress)
    alone = index < 0
    label = labels.astype(np.int64)[index] if len(labels) else index
    return np.ma.array(np.where(alone, 0, label), mask=alone), np.ma.array(np.where(alone, 0.0, distance), mask=alone)


def largest_by_label(
    labels: NDArray[Any], values: NDArray[Any], wanted: NDArray[np.uint32], threads: int, progress: Progress
) -> NDArray[Any]:
    """Return the largest value in each region, 0 for labels that do not occur."""
    is_double = values.dtype == np.float64
    if is_double:  # the bits of positive doubles are in the order of their values
        values = np.ascontiguousarray(values).view(np.uint64)
    wide = np.uint64 if values.dtype.itemsize == 8 else np.uint32
    rows = np.ascontiguousarray(values).astype(wide, copy=False).reshape(-1, values.shape[-1])
    by_label: Any = _core.label_images.max_by_label  # of several types
    found: NDArray[np.uint64] = by_label(labels.reshape(rows.shape), rows, wanted, threads, progress)
    return found.view(np.float64) if is_double else found


def in_unit(table: Table, sides: PixelSides) -> Table:
    """Give a table whose lengths are steps of the sides of pixels in the unit of these."""
    if sides == SQUARE:
        return table
    from vorotool.types.scaling import scaled_table  # imports all that can be scaled

    return scaled_table(table, sides.step, of_steps=True)


def fail(message: str) -> None:
    """Raise VerificationError."""
    raise VerificationError(message)


def first_wrong(wrong: NDArray[np.bool_]) -> int | None:
    """Where the first of some faults is, if any."""
    at = np.flatnonzero(wrong)
    return int(at[0]) if at.size else None
