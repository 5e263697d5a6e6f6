"""Rows of tables of regions: one a site."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.numeric.progress import Progress
from vorotool.types.spacing import SQUARE, PixelSides
from vorotool.types.table import Table


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
