"""The exact digital tessellation of a frame (section 2.1), row by row."""

from __future__ import annotations

from fractions import Fraction
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.tessellation.frames import (
    check_out,
    default_frame,
    label_dtype,
    report_duplicates,
    require_seeds,
    simd_level,
    square_dtype,
    squared_limit,
)
from vorotool.engines.tessellation.interior_seeds import needed_seeds, paint_seeds
from vorotool.engines.tessellation.raster_objects import refuse_distances
from vorotool.engines.tessellation.seed_lattice import on_coarser_lattice
from vorotool.errors import InputError, LimitError, UsageError, option
from vorotool.numeric.checks import checked_threads
from vorotool.numeric.numbers import shown_number
from vorotool.numeric.parallel import Progress
from vorotool.types.pixel_frame import MAX_SIDE, Frame
from vorotool.types.points.seed_set import SeedSet
from vorotool.types.spacing import SQUARE, PixelSides


class NothingLabeled:
    """Stand-in for the core without seeds, as of an image or a volume without foreground."""

    duplicates = 0
    is_wide = False
    products_exact = True

    def __init__(self, what: str = "image") -> None:
        self._what = what

    def labels(self, rows: NDArray[Any], *_: Any) -> None:
        """Give 0 everywhere."""
        rows[...] = 0

    def squared_distances(self, *_: Any) -> None:
        """Refuse."""
        refuse_distances(self._what)

    distances = squared_distances


class Tessellator:
    """The exact tessellation of a frame, ready to give any of its rows."""

    def __init__(
        self,
        seeds: SeedSet,
        frame: Frame | None = None,
        *,
        max_distance: float | Fraction | None = None,
        sides: PixelSides = SQUARE,
        threads: int = 0,
        strict: bool = False,
        progress: Progress = None,
    ) -> None:
        require_seeds(seeds)
        self.frame = frame or default_frame(seeds)
        if max(self.frame.shape) > MAX_SIDE:
            width, height = shown_number(self.frame.width), shown_number(self.frame.height)
            raise LimitError(f"the frame is {width} x {height}: a side has at most 2^30 pixels")
        self.simd = simd_level()
        self.sides = sides
        self.seeds = seeds = on_coarser_lattice(seeds, self.frame, sides, strict=strict)
        self.most_squared = squared_limit(max_distance, seeds.scale / sides.step)
        self._threads = checked_threads(threads)
        self._progress = progress
        self._core = self._prepare()
        self.duplicates: int = self._core.duplicates
        report_duplicates(self.duplicates, len(seeds), strict=strict)

    def _prepare(self) -> _core.tessellation.Tessellation | NothingLabeled:
        seeds, frame = self.seeds, self.frame
        self._paints = False
        if not len(seeds):
            return NothingLabeled()
        needed = needed_seeds(seeds)
        self._paints = needed is not None
        chosen = slice(None) if needed is None else needed
        try:
            return _core.tessellation.Tessellation(
                seeds.x[chosen],
                seeds.y[chosen],
                seeds.labels[chosen],
                frame.x,
                frame.y,
                frame.width,
                frame.height,
                seeds.scale,
                (self.sides.x, self.sides.y),
                self.simd,
            )
        except _core.tessellation.SeedTooFarError as error:
            (index,) = error.args  # from 0, of the seeds that the core was given
            raise self._too_far(index if needed is None else int(needed[index])) from None

    def _too_far(self, index: int) -> InputError:
        seeds, frame = self.seeds, self.frame
        x, y = (int(values[index]) / seeds.scale for values in (seeds.x, seeds.y))
        most = 2**40 // (seeds.scale * max(self.sides.x, self.sides.y))
        return InputError(
            f"seed {index + 1} at ({x:.17g}, {y:.17g}) is too far from the frame, which begins at ({frame.x}, "
            f"{frame.y}), for exact arithmetic: coordinates relative to the middle of the frame must be at most "
            f"2^40 lattice steps ({most} pixels for these seeds); use a nearer {option('--window')}"
        )

    def _paint(self, rows: NDArray[Any], first: int, value: int | None = None) -> None:
        """Put the seeds on their pixels, where those that only matter there were left out."""
        if self._paints:
            place = Frame(self.frame.x, self.frame.y + first, self.frame.width, len(rows))
            paint_seeds(rows, self.seeds, place, value)

    def _progress_of(self, first: int, rows: int) -> Progress:
        """Progress while some rows are made: the fraction of the frame, rows above them included."""
        tell, height = self._progress, self.frame.height
        if tell is None:
            return None
        return lambda fraction: tell((first + fraction * rows) / height)

    @property
    def arithmetic(self) -> str:
        """The narrowest arithmetic that is exact for these seeds."""
        if self._core.is_wide:
            return "filtered float64 with int128"
        return "float64" if self._core.products_exact else "float64 with int128"

    def labels(
        self, first: int = 0, rows: int | None = None, *, dtype: Any = None, out: NDArray[Any] | None = None
    ) -> NDArray[Any]:
        """Labels of some rows of the frame."""
        kind = label_dtype(self.seeds.largest_label, getattr(out, "dtype", dtype))
        array = self._output(first, rows, kind, out)
        limit = None if self.most_squared is None else divmod(self.most_squared, 2**64)
        self._core.labels(array, first, limit, self._threads, self._progress_of(first, len(array)))
        self._paint(array, first)
        return array

    def squared_distances(
        self, first: int = 0, rows: int | None = None, *, dtype: np.dtype[Any] | None = None
    ) -> NDArray[Any]:
        """Exact squared distances to the nearest seed, in squares of a step of the sides over ``seeds.scale``."""
        array = self._output(first, rows, dtype or self.square_dtype, None)
        self._core.squared_distances(array, first, self._threads, self._progress_of(first, len(array)))
        self._paint(array, first, 0)
        return array

    def distances(self, first: int = 0, rows: int | None = None) -> NDArray[np.float32]:
        """Distances to the nearest seed in the unit of the sides, rounded once from double precision."""
        array = self._output(first, rows, np.dtype(np.float32), None)
        square = float(self.step * self.step)
        self._core.distances(array, first, square, self._threads, self._progress_of(first, len(array)))
        self._paint(array, first, 0)
        return array

    def check_distances(self) -> None:
        """Refuse distances where there are no seeds."""
        if not len(self.seeds):
            refuse_distances()

    @property
    def step(self) -> Fraction:
        """The length whose square is the unit of squared distances."""
        return self.sides.step / self.seeds.scale

    @cached_property
    def square_dtype(self) -> np.dtype[Any]:
        """The type of squared distances: the smaller one that holds the largest possible."""
        self.check_distances()
        scale, frame = self.seeds.scale, self.frame
        # No pixel is farther from its nearest seed than from this one, and none farther than a corner.
        dx = max(abs(int(self.seeds.x[0]) - scale * c) for c in (frame.x, frame.x + frame.width - 1))
        dy = max(abs(int(self.seeds.y[0]) - scale * r) for r in (frame.y, frame.y + frame.height - 1))
        dx, dy = dx * self.sides.x, dy * self.sides.y
        return square_dtype(dx * dx + dy * dy)

    @property
    def measured_dtype(self) -> np.dtype[Any]:
        """The type of squared distances that are measured only: doubles where they may not fit 64 bits."""
        try:
            return self.square_dtype
        except LimitError:
            return np.dtype(np.float64)

    def _output(self, first: int, rows: int | None, dtype: np.dtype[Any], out: NDArray[Any] | None) -> NDArray[Any]:
        rows = self.frame.height - first if rows is None else rows
        if not 0 <= first < self.frame.height or not 1 <= rows <= self.frame.height - first:
            raise UsageError(f"rows {first} to {first + rows - 1} are not all in a frame of {self.frame.height} rows")
        if out is None:
            return np.empty((rows, self.frame.width), dtype)
        check_out(out, (rows, self.frame.width))
        return out
