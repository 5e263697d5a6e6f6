"""Seeds inside objects, which are left out: no other pixel or voxel needs them.

A voxel is inner if its six neighbors have its value, a pixel if its four have. Let v be any voxel, and s an inner voxel
of label a other than v. One step from s towards v, along an axis, leads to a voxel of label a that is strictly nearer
to v. So of the seeds nearest to v none is inner, but for v itself.

Let v be inner, of label a, and s a seed of another label. A path from v to s of steps along the axes, each of which
goes towards s, is farther from v with each step. Its last voxel before it first leaves label a is outer, and strictly
nearer to v than s. So the outer voxels alone give v its label, and no tie: labels are right without the inner voxels.
Only distances, and whether a voxel is within one, are not: those of inner voxels are 0.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.types.pixels import Frame
from vorotool.types.points.seed_set import SeedSet
from vorotool.types.volumes.volume import VolumeSeeds
from vorotool.types.volumes.voxel_frame import VoxelFrame

CHUNK = 1 << 20
"""Seeds that are painted at a time: what that needs beside them stays small."""


def surrounded(values: NDArray[Any]) -> NDArray[np.bool_]:
    """Find the pixels or voxels whose neighbors along all axes have their value; those at the sides lack some."""
    inside = np.zeros(values.shape, bool)
    middle = (slice(1, -1),) * values.ndim
    center, found = values[middle], inside[middle]
    found[...] = True
    for axis in range(values.ndim):
        for end in (slice(None, -2), slice(2, None)):
            found &= center == values[(*middle[:axis], end, *middle[axis + 1 :])]
    return inside


def needed_seeds(seeds: SeedSet) -> NDArray[np.intp] | None:
    """Find the seeds that still give every other pixel its label, where that leaves many out."""
    if seeds.scale != 1 or not _may_be_surrounded(seeds):
        return None
    left, top = int(seeds.x.min()), int(seeds.y[0])
    width, height = int(seeds.x.max()) - left + 1, int(seeds.y[-1]) - top + 1
    if width * height > 4 * len(seeds):
        return None
    image = np.zeros((height, width), np.uint32)
    paint_seeds(image, seeds, Frame(left, top, width, height))
    if np.count_nonzero(image) != len(seeds):
        return None
    return np.flatnonzero(~surrounded(image)[image != 0])  # a mask takes values in raster order, as the seeds are


def _may_be_surrounded(seeds: SeedSet) -> bool:
    """Whether the seeds are in raster order, and most of them follow one of their label."""
    same_label = np.count_nonzero(seeds.labels[1:] == seeds.labels[:-1])
    if 2 * same_label <= len(seeds):
        return False
    same_row = seeds.y[1:] == seeds.y[:-1]
    return bool(((seeds.x[1:] > seeds.x[:-1]) | ~same_row).all() and (seeds.y[1:] >= seeds.y[:-1]).all())


def paint_seeds(rows: NDArray[Any], seeds: SeedSet, frame: Frame, value: int | None = None) -> None:
    """Set the pixels on which seeds lie, to their labels or to one value."""
    first, last = np.searchsorted(seeds.y, [frame.y, frame.y + frame.height])
    for start in range(int(first), int(last), CHUNK):
        part = slice(start, min(start + CHUNK, int(last)))
        x, y = seeds.x[part] - frame.x, seeds.y[part] - frame.y
        labels: Any = seeds.labels[part] if value is None else value
        inside = (x >= 0) & (x < frame.width)
        if not inside.all():
            x, y = x[inside], y[inside]
            labels = labels[inside] if value is None else value
        rows[y, x] = labels


def inner_runs(seeds: VolumeSeeds, part: slice) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """Find the runs of inner voxels that follow some seeds."""
    assert seeds.filled is not None
    seed = np.flatnonzero(seeds.filled[part]) + (part.start or 0)
    return seed, seeds.x[seed] + 1, seeds.x[seed + 1]


def paint_inner(slices: NDArray[Any], seeds: VolumeSeeds, frame: VoxelFrame, value: int | None = None) -> None:
    """Set the voxels inside objects to their labels or to one value."""
    if seeds.filled is None:
        return
    width = frame.width
    limits = np.searchsorted(seeds.z, frame.z + np.arange(len(slices) + 1))
    for plane, begin, stop in zip(slices, limits[:-1].tolist(), limits[1:].tolist(), strict=True):
        seed, start, end = inner_runs(seeds, slice(begin, stop))
        row = seeds.y[seed] - frame.y
        start, end = np.maximum(start - frame.x, 0), np.minimum(end - frame.x, width)
        inside = np.flatnonzero((row >= 0) & (row < frame.height) & (start < end))
        seed, row, start, end = seed[inside], row[inside], start[inside], end[inside]
        steps = np.zeros(plane.size + 1, np.int8)
        steps[row * width + start] += 1
        steps[row * width + end] -= 1
        is_inner = np.cumsum(steps[:-1], dtype=np.int8).view(bool)
        labels: Any = np.repeat(seeds.labels[seed], end - start) if value is None else value
        plane.reshape(-1)[is_inner] = labels
