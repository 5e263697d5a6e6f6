"""A page that shows the labels of a volume slice by slice, with the values of the one that is pointed at: one file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, BinaryIO, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vorotool.errors import LimitError, option
from vorotool.numeric.ragged import starts_of
from vorotool.render.pages.cells_html import MOST_CELLS, named_cells
from vorotool.render.pages.page_data import packed, write_page

MOST_VOXELS = 1 << 26
"""Voxels of a page: 512 x 512 x 256 of them."""

MOST_RUNS = 3_000_000
"""Runs of voxels of one label: some 30 MB of data."""

PAGE = "volume_page.html"


class Runs(NamedTuple):
    """A volume of labels as runs along its rows."""

    rows: NDArray[np.int64]  # (D * H + 1,) int64 array: where the runs of each row begin, and their number
    ends: NDArray[np.int64]  # (r,) int64 array: the column behind each run
    # (r,) int64 array: index of the label of each run among the known ones, from 1; 0 is none
    regions: NDArray[np.int64]


def runs_of(labels: NDArray[Any], known: NDArray[Any]) -> Runs:
    """Give the runs of a volume."""
    _, height, width = labels.shape
    counts, ends, regions = [], [], []
    for values in labels:
        is_last = np.ones((height, width), bool)
        is_last[:, :-1] = values[:, 1:] != values[:, :-1]
        counts.append(is_last.sum(axis=1))
        ends.append(np.nonzero(is_last)[1] + 1)
        own = values[is_last]
        regions.append(np.where(own == 0, 0, np.searchsorted(known, own) + 1))
    return Runs(starts_of(np.concatenate(counts)), np.concatenate(ends), np.concatenate(regions))


def check_volume_page(shape: tuple[int, ...], labels: int = 0, runs: int = 0) -> None:
    """Refuse a page that no browser would show."""
    depth, height, width = shape
    instead = f"use {option('--what color -f png, or --what labels', 'labels in TIFF, NPY or Zarr')}"
    if depth * height * width > MOST_VOXELS:
        size = f"{width} x {height} x {depth}"
        raise LimitError(f"{size} voxels are too many for a page, at most {MOST_VOXELS}: {instead}")
    for count, most, what in ((labels, MOST_CELLS, "labels"), (runs, MOST_RUNS, "runs of voxels")):
        if count > most:
            raise LimitError(f"{count} {what} are too many for a page, at most {most}: {instead}")


def write_volume_html(
    out: BinaryIO,
    labels: NDArray[Any],
    colors: tuple[NDArray[Any], NDArray[Any]],
    columns: Mapping[str, Sequence[Any]],
    *,
    first: int = 0,
    units: ArrayLike = (1, 1, 1),
) -> None:
    """Write a page with a slider over the slices of a volume, on which the region that is pointed at is named."""
    known, classes = np.asarray(colors[0]), np.asarray(colors[1])
    check_volume_page(labels.shape, len(known))
    runs = runs_of(labels, known)
    check_volume_page(labels.shape, len(known), len(runs.ends))
    depth, height, width = labels.shape
    _, side_y, side_x = (float(unit) for unit in np.asarray(units))
    data = {
        "width": width,
        "height": height,
        "depth": depth,
        "first": first,
        "sides": [side_x, side_y],
        "rows": packed(runs.rows, "<i4"),
        "ends": packed(runs.ends, "<i4"),
        "regions": packed(runs.regions, "<i4"),
        "classes": packed(np.append(0, classes), "<i4"),
        **named_cells([str(label) for label in known.tolist()], classes, columns),
    }
    write_page(out, PAGE, data)
