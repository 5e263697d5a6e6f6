"""An exact check of tessellations of volumes, by another way than the one that makes them."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.common import label_array
from vorotool.engines.tessellation.frames import squared_limit
from vorotool.engines.tessellation.verify_tessellation import on_lattice, split_limit
from vorotool.errors import InputError, UsageError, VerificationError
from vorotool.numeric.checks import checked_threads
from vorotool.numeric.parallel import Progress
from vorotool.types.spacing import PixelSides, distance_as_written
from vorotool.types.volumes.label_volume import CUBE, LabelVolume
from vorotool.types.volumes.volume_seeds import VolumeSeeds
from vorotool.types.volumes.voxel_frame import VoxelFrame


def verify_volume(volume: LabelVolume, *, max_distance: float | Fraction | None = None, threads: int = 0) -> None:
    """Check that every voxel of a tessellation has the smallest label of its nearest seeds."""
    seeds, frame, sides = volume.seeds, volume.frame, volume.sides
    if seeds is None or frame is None:
        raise UsageError("the label volume carries no seeds: compute it with vorotool.tessellate")
    limit = squared_limit(distance_as_written(max_distance, sides), seeds.scale / sides.step)
    verify_label_volume(volume.labels, seeds, frame, sides=sides, max_distance2=limit, threads=threads)


def verify_label_volume(
    labels: NDArray[Any],
    seeds: VolumeSeeds,
    frame: VoxelFrame,
    *,
    sides: PixelSides = CUBE,
    max_distance2: int | None = None,
    threads: int = 0,
    progress: Progress = None,
) -> None:
    """Check the tessellation of a volume exactly, by another way than the one that makes it."""
    volume = LabelVolume(labels, frame)
    high, low = split_limit(max_distance2)
    steps = sides.units[::-1]
    x, y, z = (on_lattice(axis, side) for axis, side in zip(seeds.places.T, steps, strict=True))
    try:
        wrong = _core.volumes.verify_volume(
            label_array(volume.labels, "voxel"),
            (frame.x, frame.y, frame.z),
            x,
            y,
            z,
            seeds.labels,
            (seeds.scale * steps[0], seeds.scale * steps[1], seeds.scale * steps[2]),
            high,
            low,
            checked_threads(threads),
            progress,
        )
    except IndexError as error:
        raise InputError(
            f"the result cannot be verified: {error}; move the frame and the seeds nearer to the origin"
        ) from error
    if wrong.count:
        column, row, slice_ = wrong.first
        raise VerificationError(
            f"{wrong.count} of {frame.voxels} voxels {'is' if wrong.count == 1 else 'are'} wrong: the first, (x, y, z) "
            f"= ({frame.x + column}, {frame.y + row}, {frame.z + slice_}), has label "
            f"{volume.labels[slice_, row, column]}, not {wrong.right}"
        )
