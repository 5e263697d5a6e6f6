"""Voxels inside objects: no other voxel needs them as seeds, and on themselves they are put where that is not so.

A voxel is inner if its six neighbors have its value. Let v be any voxel, and s an inner voxel of label a other than v.
One step from s towards v, along an axis, leads to a voxel of label a that is strictly nearer to v. So of the seeds
nearest to v none is inner, but for v itself.

Let v be inner, of label a, and s a seed of another label. A path from v to s of steps along the axes, each of which
goes towards s, is farther from v with each step. Its last voxel before it first leaves label a is outer, and strictly
nearer to v than s. So the outer voxels alone give v its label, and no tie: labels are right without the inner voxels.
Only distances, and whether a voxel is within one, are not: those of inner voxels are 0.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.types.volumes.volume_seeds import VolumeSeeds
from vorotool.types.volumes.voxel_frame import VoxelFrame


def outer_voxels(volume: NDArray[Any]) -> NDArray[np.bool_]:
    """Nonzero voxels that have not their own value on all six sides."""
    outer: NDArray[np.bool_] = volume != 0
    inner = np.ones(tuple(max(side - 2, 0) for side in volume.shape), dtype=bool)
    center = volume[1:-1, 1:-1, 1:-1]
    for axis in range(3):
        for end in (slice(None, -2), slice(2, None)):
            window = [slice(1, -1)] * 3
            window[axis] = end
            inner &= center == volume[tuple(window)]
    outer[1:-1, 1:-1, 1:-1] &= ~inner
    return outer


def inner_runs(seeds: VolumeSeeds, part: slice) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """Find the runs of inner voxels that follow some seeds."""
    assert seeds.filled is not None
    seed = np.flatnonzero(seeds.filled[part]) + (part.start or 0)
    return seed, seeds.x[seed] + 1, seeds.x[seed + 1]


def paint_inner(slices: NDArray[Any], seeds: VolumeSeeds, frame: VoxelFrame, first: int, value: Any = None) -> None:
    """Set the voxels inside objects to their labels or to one value."""
    if seeds.filled is None:
        return
    width = frame.width
    limits = np.searchsorted(seeds.z, frame.z + first + np.arange(len(slices) + 1))
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
