"""`vorotool.tessellate` in three dimensions."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

from numpy.typing import NDArray

from vorotool.engines.tessellation.frames import require_memory, sides_of
from vorotool.engines.volumes.volume_frames import as_volume_seeds, asked_voxel_frame, default_voxel_frame
from vorotool.engines.volumes.volume_tessellator import VolumeSweep
from vorotool.errors import UsageError
from vorotool.numeric.numbers import shown_number, whole_number
from vorotool.numeric.parallel import Progress
from vorotool.types.pixel_frame import MAX_PIXELS
from vorotool.types.spacing import distance_as_written
from vorotool.types.volumes.label_volume import LabelVolume
from vorotool.types.volumes.volume_seeds import VolumeSeeds

if TYPE_CHECKING:
    from numpy.typing import DTypeLike

    from vorotool.typing import Spacing, VolumeSeedsLike

EXACT_PASSES = 2
"""Of `tessellate`: the value that says nothing."""


def tessellate_volume(
    seeds: VolumeSeedsLike,
    *,
    shape: tuple[int, int, int] | None = None,
    window: tuple[int, int, int, int, int, int] | None = None,
    method: str = "exact",
    passes: int = EXACT_PASSES,
    max_distance: float | Fraction | None = None,
    spacing: Spacing | None = None,
    dtype: DTypeLike | None = None,
    out: NDArray[Any] | None = None,
    threads: int = 0,
    max_pixels: int = MAX_PIXELS,
    progress: Progress = None,
) -> LabelVolume:
    """Label every voxel with its nearest seed; ties go to the smallest label. Parameters are those of `tessellate`."""
    _check_method(method, passes)
    sides = sides_of(seeds, spacing, 3)
    frame = asked_voxel_frame(shape, window)

    def require_frame(made: VolumeSeeds) -> None:
        if len(made) or made.is_empty_volume:
            require_memory(frame or default_voxel_frame(made), max_pixels)

    sweep = VolumeSweep(
        as_volume_seeds(seeds, max_pixels=max_pixels, check=require_frame),
        frame,
        sides=sides,
        max_distance=distance_as_written(max_distance, sides),
        threads=threads,
        progress=progress,
    )
    return LabelVolume(sweep.labels(dtype=dtype, out=out), sweep.frame, sweep.seeds, sides)


def _check_method(method: str, passes: int) -> None:
    if method == "propagation":
        raise UsageError("method='propagation' applies to images only: a volume needs method='exact'")
    if method != "exact":
        raise UsageError(f"method is {method!r}: it must be 'exact' in a volume")
    if whole_number(passes, "passes") != EXACT_PASSES:
        raise UsageError(f"passes is {shown_number(passes)}, which needs method='propagation' and an image")
