"""The exact digital tessellation of a volume (section 2.1, with one more axis), slice by slice."""

from __future__ import annotations

from fractions import Fraction
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.tessellation.frames import (
    check_out,
    label_dtype,
    report_duplicates,
    require_seeds,
    simd_level,
    squared_limit,
)
from vorotool.engines.tessellation.raster_objects import refuse_distances
from vorotool.engines.tessellation.tessellator import NothingLabeled
from vorotool.engines.volumes.inner_voxels import paint_inner
from vorotool.engines.volumes.volume_frames import default_voxel_frame
from vorotool.errors import InputError, LimitError, UsageError, option
from vorotool.numeric.checks import checked_threads
from vorotool.numeric.parallel import Progress
from vorotool.types.spacing import PixelSides
from vorotool.types.volumes.label_volume import CUBE
from vorotool.types.volumes.volume_seeds import VolumeSeeds
from vorotool.types.volumes.voxel_frame import VoxelFrame


class VolumeSweep:
    """The exact tessellation of a volume, ready to give any of its slices."""

    def __init__(
        self,
        seeds: VolumeSeeds,
        frame: VoxelFrame | None = None,
        *,
        sides: PixelSides = CUBE,
        max_distance: float | Fraction | None = None,
        threads: int = 0,
        strict: bool = False,
        progress: Progress = None,
        way: str = "quicker",
    ) -> None:
        require_seeds(seeds)
        self.seeds = seeds
        self.frame = frame or default_voxel_frame(seeds)
        self.simd = simd_level()
        self.sides = sides
        self.most_squared = squared_limit(max_distance, seeds.scale / sides.step)
        self._threads = checked_threads(threads)
        self._progress = progress
        self._core = self._prepare(way)
        self.duplicates: int = self._core.duplicates
        report_duplicates(self.duplicates, len(seeds), strict=strict)

    def _prepare(self, way: str) -> _core.volumes.VolumeTessellation | NothingLabeled:
        seeds, frame = self.seeds, self.frame
        if not len(seeds):
            return NothingLabeled("volume")
        unit_z, unit_y, unit_x = self.sides.units
        try:
            return _core.volumes.VolumeTessellation(
                seeds.x,
                seeds.y,
                seeds.z,
                seeds.labels,
                (frame.x, frame.y, frame.z),
                (frame.width, frame.height, frame.depth),
                seeds.scale,
                (unit_x, unit_y, unit_z),
                self.simd,
                way,
                self._threads,
            )
        except _core.tessellation.SeedTooFarError as error:
            raise self._too_far(*error.args) from None

    def _too_far(self, index: int) -> InputError:
        seeds, frame = self.seeds, self.frame
        place = ", ".join(f"{value / seeds.scale:.17g}" for value in seeds.places[index].tolist())
        most = 2**40 // (seeds.scale * max(self.sides.units))
        return InputError(
            f"seed {index + 1} at ({place}) is too far from the frame, which begins at ({frame.x}, {frame.y}, "
            f"{frame.z}), for exact arithmetic: coordinates relative to the middle of the frame must be at most 2^40 "
            f"lattice steps ({most} voxels for these seeds); use a nearer {option('--window')}, or round the sides of "
            "voxels to fewer digits"
        )

    def _progress_of(self, first: int, slices: int) -> Progress:
        """Progress while some slices are made: the fraction of the frame, slices before them included."""
        tell, depth = self._progress, self.frame.depth
        if tell is None:
            return None
        return lambda fraction: tell((first + fraction * slices) / depth)

    @property
    def arithmetic(self) -> str:
        """The narrowest arithmetic that is exact for these seeds."""
        if self._core.is_wide:
            return "int128"
        return "float64" if self._core.products_exact else "float64 with int128"

    def labels(
        self, first: int = 0, slices: int | None = None, *, dtype: Any = None, out: NDArray[Any] | None = None
    ) -> NDArray[Any]:
        """Labels of some slices of the frame."""
        kind = label_dtype(self.seeds.largest_label, getattr(out, "dtype", dtype))
        array = self._output(first, slices, kind, out)
        limit = None if self.most_squared is None else divmod(self.most_squared, 2**64)
        written = array.view(np.uint32) if kind == np.int32 else array
        self._core.labels(written, first, limit, self._threads, self._progress_of(first, len(array)))
        if limit is not None:  # without one, inner voxels have their labels: the outer ones are nearest
            paint_inner(array, self.seeds, self.frame, first)
        return array

    def squared_distances(
        self,
        first: int = 0,
        slices: int | None = None,
        *,
        dtype: np.dtype[Any] | None = None,
        out: NDArray[Any] | None = None,
    ) -> NDArray[Any]:
        """Exact squared distances to the nearest seed, in squares of a step of the sides over ``seeds.scale``."""
        array = self._output(first, slices, np.dtype(dtype or self.square_dtype), out)
        self._core.squared_distances(array, first, self._threads, self._progress_of(first, len(array)))
        paint_inner(array, self.seeds, self.frame, first, 0)
        return array

    def distances(self, first: int = 0, slices: int | None = None) -> NDArray[np.float32]:
        """Distances to the nearest seed in the unit of the sides, rounded once from double precision."""
        array = self._output(first, slices, np.dtype(np.float32), None)
        square = float(self.step * self.step)
        self._core.distances(array, first, square, self._threads, self._progress_of(first, len(array)))
        paint_inner(array, self.seeds, self.frame, first, 0)
        return array

    def check_distances(self) -> None:
        """Refuse distances where there are no seeds."""
        if not len(self.seeds):
            refuse_distances("volume")

    @property
    def step(self) -> Fraction:
        """The length whose square is the unit of squared distances."""
        return self.sides.step / self.seeds.scale

    @cached_property
    def square_dtype(self) -> np.dtype[Any]:
        """The type of squared distances: the smaller one that holds the largest possible."""
        self.check_distances()
        frame, scale = self.frame, self.seeds.scale
        # No voxel is farther from its nearest seed than from this one, and none farther than a corner.
        x, y, z = self.seeds.places[0].tolist()
        largest = 0
        for at, start, side, unit in (
            (x, frame.x, frame.width, self.sides.units[2]),
            (y, frame.y, frame.height, self.sides.units[1]),
            (z, frame.z, frame.depth, self.sides.units[0]),
        ):
            farthest = unit * max(abs(at - scale * end) for end in (start, start + side - 1))
            largest += farthest * farthest
        if largest >= 2**64:
            raise LimitError(
                "squared distances of this volume may exceed 64 bits: round the sides of voxels to fewer digits, or "
                f"use {option('--what distance', 'distances')}"
            )
        return np.dtype(np.uint32 if largest < 2**32 else np.uint64)

    def _output(self, first: int, slices: int | None, dtype: np.dtype[Any], out: NDArray[Any] | None) -> NDArray[Any]:
        depth = self.frame.depth
        slices = depth - first if slices is None else slices
        if not 0 <= first < depth or not 1 <= slices <= depth - first:
            raise UsageError(f"slices {first} to {first + slices - 1} are not all in a frame of {depth} slices")
        shape = (slices, self.frame.height, self.frame.width)
        if out is None:
            return np.empty(shape, dtype)
        check_out(out, shape)
        if out.dtype != dtype:
            raise UsageError(f"out must be of type {dtype}, but is of type {out.dtype}")
        return out
