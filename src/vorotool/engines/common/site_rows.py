"""Rows of tables of regions: one a site."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.geometry.progress import Progress
from vorotool.geometry.spacing import SQUARE, PixelSides
from vorotool.geometry.table import Table


def rows_of(found: NDArray[np.uint32], labels: NDArray[np.uint32]) -> tuple[NDArray[np.intp], int | None]:
    """Row of each label that occurs among the labels of the sites, and the first that is none of these.

    Parameters
    ----------
    found, labels : array
        Increasing.

    Examples
    --------
    >>> rows_of(np.array([2, 9], np.uint32), np.array([1, 2, 5], np.uint32))
    (array([1, 3]), 9)
    """
    rows = np.searchsorted(labels, found)
    known = rows < len(labels)
    known[known] = labels[rows[known]] == found[known]
    return rows, None if known.all() else int(found[~known][0])


def spread(values: NDArray[Any], rows: NDArray[np.intp], count: int) -> NDArray[Any]:
    """Values of the regions at their rows, 0 in the others.

    Examples
    --------
    >>> spread(np.array([7, 8]), np.array([0, 2]), 4).tolist()
    [7, 0, 8, 0]
    """
    made = np.zeros((count, *values.shape[1:]), dtype=values.dtype)
    made[rows] = values
    return made


def nearest_sites(
    labels: NDArray[np.uint32], sites: NDArray[np.float64], threads: int, progress: Progress
) -> tuple[Any, Any]:
    """Label and distance of the site nearest to each; masked where there is no other.

    Parameters
    ----------
    labels : (n,) uint32 array
        Of the sites; ties go to the smallest.
    sites : (n, 2) or (n, 3) float64 array
        Places.

    Examples
    --------
    >>> labels, distances = nearest_sites(np.array([4, 7], np.uint32), np.array([[0.0, 0, 0], [1, 2, 2]]), 1, None)
    >>> labels.tolist(), distances.tolist()
    ([7, 4], [3.0, 3.0])
    """
    nearest: Any = _core.spatial.nearest_other_sites  # of two axes or three
    index, distance = nearest(*map(np.ascontiguousarray, sites.T), np.ascontiguousarray(labels), threads, progress)
    alone = index < 0
    label = labels.astype(np.int64)[index] if len(labels) else index
    return np.ma.array(np.where(alone, 0, label), mask=alone), np.ma.array(np.where(alone, 0.0, distance), mask=alone)


def largest_by_label(
    labels: NDArray[Any], values: NDArray[Any], wanted: NDArray[np.uint32], threads: int, progress: Progress
) -> NDArray[Any]:
    """Return the largest value in each region, 0 for labels that do not occur.

    Parameters
    ----------
    labels : array
        Of the pixels or voxels, as `label_array` gives it.
    values : array of the same shape
        Integers or float64, none of them negative.
    wanted : (n,) uint32 array
        Increasing.

    Examples
    --------
    >>> labels, values = np.array([[1, 1, 4]], np.uint8), np.array([[3, 8, 2]])
    >>> largest_by_label(labels, values, np.array([1, 7], np.uint32), 1, None).tolist()
    [8, 0]
    """
    is_double = values.dtype == np.float64
    if is_double:  # the bits of positive doubles are in the order of their values
        values = np.ascontiguousarray(values).view(np.uint64)
    wide = np.uint64 if values.dtype.itemsize == 8 else np.uint32
    rows = np.ascontiguousarray(values).astype(wide, copy=False).reshape(-1, values.shape[-1])
    by_label: Any = _core.label_images.max_by_label  # of several types
    found: NDArray[np.uint64] = by_label(labels.reshape(rows.shape), rows, wanted, threads, progress)
    return found.view(np.float64) if is_double else found


def in_unit(table: Table, sides: PixelSides) -> Table:
    """Give a table whose lengths are steps of the sides of pixels in the unit of these.

    Examples
    --------
    >>> from fractions import Fraction
    >>> in_unit(Table({"length": np.array([2.0])}), PixelSides(step=Fraction(3, 2)))["length"].tolist()
    [3.0]
    """
    if sides == SQUARE:
        return table
    from vorotool.geometry.any.scaling import scaled_table  # imports all that can be scaled

    return scaled_table(table, sides.step, of_steps=True)
