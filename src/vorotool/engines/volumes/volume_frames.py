"""Shared by tessellations of volumes: seeds from anything, frames, the slabs in which they are streamed."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from vorotool.convert.volumes import as_volume, is_volume
from vorotool.engines.tessellation.frames import BAND_PIXELS, MOST_UNASKED, asked_numbers, least_sides
from vorotool.engines.volumes.volume_seeding import Check, seeds_from_volume, seeds_from_xyz
from vorotool.errors import LimitError, option
from vorotool.types.pixel_frame import MAX_PIXELS
from vorotool.types.volumes.label_volume import LabelVolume
from vorotool.types.volumes.volume import Volume
from vorotool.types.volumes.volume_seeds import VolumeSeeds
from vorotool.types.volumes.voxel_frame import VoxelFrame

_FORMS = (
    (3, "shape must be three integers (D, H, W)"),
    (6, "window must be six integers (x, y, z, w, h, d)"),
)
_VOXELS_A_SEED, _MOST_VOXELS = 64, 2**27
"""Of a slab."""

_WINDOW = option("--window X,Y,Z,W,H,D", "window=(x, y, z, w, h, d)")


def as_volume_seeds(
    source: Any, name: str = "seeds", *, max_pixels: int = MAX_PIXELS, check: Check = None
) -> VolumeSeeds:
    """Give seeds from whatever `tessellate` accepts in three dimensions."""
    if isinstance(source, VolumeSeeds):
        seeds = source
    elif isinstance(source, LabelVolume):
        seeds = _moved_to(seeds_from_volume(source, mode="labels"), source.frame)
    elif isinstance(source, Volume) or _is_array_of_voxels(source):
        seeds = seeds_from_volume(as_volume(source, name, max_pixels=max_pixels))
    else:
        return seeds_from_xyz(source, check=check, name=name)
    if check is not None:
        check(seeds)
    return seeds


def _is_array_of_voxels(source: Any) -> bool:
    """Whether it has three axes; where a volume is asked for, the last one is not that of colors."""
    return is_volume(source) or len(getattr(source, "shape", ())) == 3


def _moved_to(seeds: VolumeSeeds, frame: VoxelFrame | None) -> VolumeSeeds:
    """Move the seeds of a volume to where its frame is."""
    assert frame is not None  # LabelVolume has filled it in
    assert seeds.sites is not None  # so has VolumeSeeds
    origin = np.array([frame.x, frame.y, frame.z])
    if not origin.any():
        return seeds
    return replace(seeds, places=seeds.places + origin * seeds.scale, sites=seeds.sites + origin, frame=frame)


def asked_voxel_frame(shape: Any, window: Any) -> VoxelFrame | None:
    """Give the frame that is asked for by ``shape`` (D, H, W) or ``window`` (x, y, z, w, h, d), if one is."""
    numbers = asked_numbers(shape, window, _FORMS)
    if numbers is None:
        return None
    return VoxelFrame(*numbers) if shape is None else VoxelFrame(0, 0, 0, *reversed(numbers))


def default_voxel_frame(
    seeds: VolumeSeeds, *, how: str = "give shape=(D, H, W) or window=(x, y, z, w, h, d)"
) -> VoxelFrame:
    """Give the frame that the input brings, else the smallest at the origin that holds the points."""
    if seeds.frame is not None:
        return seeds.frame
    sides = least_sides({"x": seeds.x, "y": seeds.y, "z": seeds.z}, seeds.scale, _WINDOW)
    if sides[0] * sides[1] * sides[2] > MOST_UNASKED:
        raise LimitError(
            f"the smallest frame that holds the points has {' x '.join(map(str, sides))} voxels, more than "
            f"{MOST_UNASKED}: {how}"
        )
    return VoxelFrame(0, 0, 0, *sides)


def slab_limits(frame: VoxelFrame, seeds: int = 0) -> Iterator[tuple[int, int]]:
    """First slice and number of slices of the slabs in which a frame is streamed."""
    wanted = min(max(BAND_PIXELS, _VOXELS_A_SEED * seeds), _MOST_VOXELS)
    step = max(1, wanted // (frame.width * frame.height))
    for first in range(0, frame.depth, step):
        yield first, min(step, frame.depth - first)
