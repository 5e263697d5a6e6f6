"""An exact check of digital tessellations, by another way than the one that makes them."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.common import label_array
from vorotool.errors import InputError, UsageError, VerificationError
from vorotool.numeric.checks import checked_threads
from vorotool.numeric.parallel import Progress
from vorotool.types.images import LabelImage
from vorotool.types.pixels import Frame, PixelSides
from vorotool.types.points.seed_set import SeedSet
from vorotool.types.volumes.volume import LabelVolume, VolumeSeeds
from vorotool.types.volumes.voxel_frame import VoxelFrame

_FARTHEST = 2**61


def verify_labels(
    labels: NDArray[Any],
    seeds: SeedSet | VolumeSeeds,
    frame: Frame | VoxelFrame,
    *,
    max_distance2: int | None = None,
    sides: PixelSides | None = None,
    threads: int = 0,
    progress: Progress = None,
) -> None:
    """Check the tessellation of an image or a volume exactly, by another way than the one that makes it."""
    is_flat = isinstance(frame, Frame)
    array = (LabelImage(labels, frame) if isinstance(frame, Frame) else LabelVolume(labels, frame)).labels
    cell = "pixel" if is_flat else "voxel"
    units = (1,) * array.ndim if sides is None else sides.units[::-1]
    # seen from the middle, as the engine has them; a volume lies where it is
    corner = tuple(-(side // 2) for side in frame.shape[::-1]) if is_flat else frame.origin
    places = [
        _from_origin(values, seeds.scale * (start - first), unit)
        for values, start, first, unit in zip(seeds.coordinates, frame.origin, corner, units, strict=True)
    ]
    steps, limit = tuple(seeds.scale * unit for unit in units), _halves(max_distance2)
    verify: Any = _core.tessellation.verify_tessellation if is_flat else _core.volumes.verify_volume
    try:
        wrong = verify(
            label_array(array, cell),
            *(corner if is_flat else (corner,)),
            *places,
            seeds.labels,
            steps,
            *limit,
            checked_threads(threads),
            progress,
        )
    except IndexError as error:
        raise InputError(
            f"the result cannot be verified: {error}; move the frame and the seeds nearer to "
            f"{'each other' if is_flat else 'the origin'}"
        ) from error
    if wrong.count:
        first = (wrong.column, wrong.row) if is_flat else wrong.first
        place = tuple(start + at for start, at in zip(frame.origin, first, strict=True))
        raise VerificationError(
            f"{wrong.count} of {array.size} {cell}s {'is' if wrong.count == 1 else 'are'} wrong: the first, "
            f"({', '.join('xyz'[: array.ndim])}) = {place}, has label {array[first[::-1]]}, not {wrong.right}"
        )


def _from_origin(coordinates: NDArray[np.int64], origin: int, side: int) -> NDArray[np.int64]:
    """Return coordinates relative to an origin in steps of the sides, as far as the core takes them."""
    if abs(origin) > _FARTHEST:
        raise InputError(
            "the result cannot be verified: the frame is too far from the origin for its lattice; move the frame nearer"
        )
    most = 2**62 // side  # what would not fit is left beyond the limit of the core
    return (coordinates.clip(-2 * _FARTHEST, 2 * _FARTHEST) - origin).clip(-most, most) * side


def _halves(limit: int | None) -> tuple[int | None, int]:
    """Halves of a 128-bit limit; no squared distance exceeds 128 bits."""
    if limit is None or limit >= 1 << 128:
        return None, 0
    if limit < 0:
        raise UsageError(f"max_distance2 is {limit}: it must not be negative")
    return int(limit) >> 64, int(limit) & 0xFFFFFFFFFFFFFFFF
