"""The exact digital tessellation of an image (section 2.1) or a volume, row by row or slice by slice."""

from __future__ import annotations

from fractions import Fraction
from functools import cached_property
from typing import Any, Literal, Protocol

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
from vorotool.engines.tessellation.raster_objects import refuse_distances
from vorotool.engines.tessellation.seeding import on_coarser_lattice
from vorotool.errors import InputError, LimitError, UsageError, element, option
from vorotool.frozen import frozen
from vorotool.numeric.checks import checked_threads
from vorotool.numeric.numbers import shown_number
from vorotool.numeric.parallel import Progress
from vorotool.types.pixels import CELL, MAX_SIDE, Frame, PixelSides
from vorotool.types.points.seed_set import SeedSet
from vorotool.types.volumes.volume import VolumeSeeds, VoxelFrame

_WHOLE = {2: "image", 3: "volume"}


class NothingLabeled:
    """Stand-in for the core without seeds, as of an image or a volume without foreground."""

    duplicates = 0
    is_wide = False
    products_exact = True

    def __init__(self, what: str) -> None:
        self._what = what

    def labels(self, rows: NDArray[Any], *_: Any) -> None:
        """Give 0 everywhere."""
        rows[...] = 0

    def squared_distances(self, *_: Any) -> None:
        """Refuse."""
        refuse_distances(self._what)

    distances = squared_distances


class Tessellator:
    """The exact tessellation of a frame, ready to give any of its rows, or of its slices where it is a volume."""

    seeds: Any  # SeedSet, or VolumeSeeds
    frame: Any  # Frame, or VoxelFrame

    def __init__(
        self,
        seeds: SeedSet | VolumeSeeds,
        frame: Frame | VoxelFrame | None = None,
        *,
        max_distance: float | Fraction | None = None,
        sides: PixelSides | None = None,
        threads: int = 0,
        strict: bool = False,
        progress: Progress = None,
        way: str = "quicker",
    ) -> None:
        require_seeds(seeds)
        self.axes = len(seeds.coordinates)
        self.frame = frame or default_frame(seeds)
        if max(self.frame.shape) > MAX_SIDE:
            size = " x ".join(map(shown_number, reversed(self.frame.shape)))
            raise LimitError(f"the frame is {size}: a side has at most 2^30 {CELL[self.axes]}s")
        self.simd = simd_level()
        self.sides = sides or PixelSides((1,) * self.axes)
        self.seeds = on_coarser_lattice(seeds, self.frame, self.sides, strict=strict)
        self.most_squared = squared_limit(max_distance, self.seeds.scale / self.sides.step)
        self._threads = checked_threads(threads)
        self._progress = progress
        self._leaves_out = False  # seeds that only matter where they lie
        self._core = self._prepare(way)
        self.duplicates: int = self._core.duplicates
        report_duplicates(self.duplicates, len(seeds), strict=strict)

    def _prepare(self, way: str) -> Any:
        seeds, frame, size = self.seeds, self.frame, self.frame.shape[::-1]
        if not len(seeds):
            return NothingLabeled(_WHOLE[self.axes])
        needed = needed_seeds(seeds) if self.axes == 2 else None
        self._leaves_out = needed is not None or getattr(seeds, "filled", None) is not None
        chosen = slice(None) if needed is None else needed
        arrays: Any = [values[chosen] for values in (*seeds.coordinates, seeds.labels)]
        rest: Any = (seeds.scale, self.sides.units[::-1], self.simd)
        try:
            if self.axes == 2:
                return _core.tessellation.Tessellation(*arrays, *frame.origin, *size, *rest)
            in_space: Any = _core.volumes.VolumeTessellation
            return in_space(*arrays, frame.origin, size, *rest, way, self._threads)
        except _core.tessellation.SeedTooFarError as error:
            (index,) = error.args  # from 0, of the seeds that the core was given
            raise self._too_far(index if needed is None else int(needed[index])) from None

    def _too_far(self, index: int) -> InputError:
        scale, cell = self.seeds.scale, CELL[self.axes]
        place = ", ".join(f"{int(values[index]) / scale:.17g}" for values in self.seeds.coordinates)
        sides = "" if self.axes == 2 else ", or round the sides of voxels to fewer digits"
        return InputError(
            f"{element('seed', index)} at ({place}) is too far from the frame, which begins at {self.frame.origin}, "
            "for exact arithmetic: coordinates relative to its middle must be at most 2^40 lattice steps "
            f"({2**40 // (scale * max(self.sides.units))} {cell}s for these seeds); use a nearer "
            f"{option('--window')}{sides}"
        )

    def _paint(self, part: NDArray[Any], first: int, value: int | None = None) -> None:
        """Put the seeds where they lie, if those that only matter there were left out."""
        if self._leaves_out:
            paint: Any = paint_seeds if self.axes == 2 else paint_inner
            paint(part, self.seeds, self.frame.part(first, len(part)), value)

    def _progress_of(self, first: int, count: int) -> Progress:
        """Progress while some rows are made: the fraction of the frame, rows above them included."""
        tell, whole = self._progress, self.frame.shape[0]
        if tell is None:
            return None
        return lambda fraction: tell((first + fraction * count) / whole)

    @property
    def arithmetic(self) -> str:
        """The narrowest arithmetic that is exact for these seeds."""
        if self._core.is_wide:
            return "filtered float64 with int128" if self.axes == 2 else "int128"
        return "float64" if self._core.products_exact else "float64 with int128"

    def labels(
        self, first: int = 0, count: int | None = None, *, dtype: Any = None, out: NDArray[Any] | None = None
    ) -> NDArray[Any]:
        """Labels of some rows or slices of the frame."""
        kind = label_dtype(self.seeds.largest_label, getattr(out, "dtype", dtype))
        array = self._output(first, count, kind, out)
        limit = None if self.most_squared is None else divmod(self.most_squared, 2**64)
        written = array.view(np.uint32) if kind == np.int32 else array
        self._core.labels(written, first, limit, self._threads, self._progress_of(first, len(array)))
        if limit is not None:  # without one, the seeds that are left have the label of those that are not
            self._paint(array, first)
        return array

    def squared_distances(
        self,
        first: int = 0,
        count: int | None = None,
        *,
        dtype: np.dtype[Any] | None = None,
        out: NDArray[Any] | None = None,
    ) -> NDArray[Any]:
        """Exact squared distances to the nearest seed, in squares of a step of the sides over ``seeds.scale``."""
        array = self._output(first, count, np.dtype(dtype or self.square_dtype), out)
        self._core.squared_distances(array, first, self._threads, self._progress_of(first, len(array)))
        self._paint(array, first, 0)
        return array

    def distances(self, first: int = 0, count: int | None = None) -> NDArray[np.float32]:
        """Distances to the nearest seed in the unit of the sides, rounded once from double precision."""
        array = self._output(first, count, np.dtype(np.float32), None)
        square = float(self.step * self.step)
        self._core.distances(array, first, square, self._threads, self._progress_of(first, len(array)))
        self._paint(array, first, 0)
        return array

    def computed(self, what: str, dtype: np.dtype[Any]) -> NDArray[Any]:
        """Labels, distances or squared distances (``distance2``) of the whole frame."""
        if what == "labels":
            return self.labels(dtype=dtype)
        return self.distances() if what == "distance" else self.squared_distances(dtype=dtype)

    def measured(self, first: int, count: int, dtype: np.dtype[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
        """Labels of some rows or slices, and squared distances that are measured only."""
        return self.labels(first, count, dtype=dtype), self.squared_distances(first, count, dtype=self.measured_dtype)

    def check_distances(self) -> None:
        """Refuse distances where there are no seeds."""
        if not len(self.seeds):
            refuse_distances(_WHOLE[self.axes])

    @property
    def step(self) -> Fraction:
        """The length whose square is the unit of squared distances."""
        return self.sides.step / self.seeds.scale

    @cached_property
    def square_dtype(self) -> np.dtype[Any]:
        """The type of squared distances: the smaller one that holds the largest possible."""
        self.check_distances()
        scale, frame, largest = self.seeds.scale, self.frame, 0
        # No pixel is farther from its nearest seed than from this one, and none farther than a corner.
        for values, start, side, unit in zip(
            self.seeds.coordinates, frame.origin, frame.shape[::-1], self.sides.units[::-1], strict=True
        ):
            farthest = unit * max(abs(int(values[0]) - scale * end) for end in (start, start + side - 1))
            largest += farthest * farthest
        return square_dtype(largest, self.axes)

    @property
    def measured_dtype(self) -> np.dtype[Any]:
        """The type of squared distances that are measured only: doubles where they may not fit 64 bits."""
        try:
            return self.square_dtype
        except LimitError:
            if self.axes != 2:
                raise
            return np.dtype(np.float64)

    def _output(self, first: int, count: int | None, dtype: np.dtype[Any], out: NDArray[Any] | None) -> NDArray[Any]:
        whole, *across = self.frame.shape
        count = whole - first if count is None else count
        if not 0 <= first < whole or not 1 <= count <= whole - first:
            what = "rows" if self.axes == 2 else "slices"
            raise UsageError(f"{what} {first} to {first + count - 1} are not all in a frame of {whole} {what}")
        if out is None:
            return np.empty((count, *across), dtype)
        check_out(out, (count, *across))
        if out.dtype != dtype:
            raise UsageError(f"out must be of type {dtype}, but is of type {out.dtype}")
        return out


Quantity = Literal["labels", "distance", "distance2", "diagram"]


class Band(Protocol):
    """Some rows of an image, or slices of a volume, computed where they are asked for: it can be pickled."""

    def rows(self, *, threads: int = 0, progress: Progress = None) -> NDArray[Any]:
        """Compute them."""


def with_neighbors(frame: Frame | VoxelFrame, first: int, count: int) -> tuple[int, int]:
    """Give the first row or slice and their number, with one more on each side where the frame has one."""
    begin, end = max(first - 1, 0), min(first + count + 1, frame.shape[0])
    return begin, end - begin


@frozen
class SeedBand:
    """Rows or slices of a tessellation, with the seeds that they need."""

    seeds: SeedSet | VolumeSeeds  # enough of them
    frame: Frame | VoxelFrame  # the whole one
    first: int
    count: int
    what: Quantity  # what is computed
    dtype: np.dtype[Any]  # its type, which is that of the whole
    sides: PixelSides | None = None  # of a pixel or voxel, in whose unit distances are
    max_distance: float | Fraction | None = None

    def rows(self, *, threads: int = 0, progress: Progress = None) -> NDArray[Any]:
        """Compute the rows or slices."""
        is_diagram = self.what == "diagram"
        begin, count = self.first, self.count
        if is_diagram:
            begin, count = with_neighbors(self.frame, begin, count)
        sweep = Tessellator(
            self.seeds,
            self.frame.part(begin, count),
            max_distance=self.max_distance,
            sides=self.sides,
            threads=threads,
            progress=progress,
        )
        if is_diagram:
            from vorotool.engines.label_images.regions import diagram_of

            return diagram_of(sweep.labels(), threads=threads)[self.first - begin :][: self.count]
        return sweep.computed(self.what, self.dtype)


class SeedBands:
    """Cuts seeds into those that bands of rows or slices need."""

    def __init__(self, seeds: SeedSet | VolumeSeeds, frame: Frame | VoxelFrame) -> None:
        self.frame, self.seeds = frame, seeds
        filled = getattr(seeds, "filled", None)
        keys: Any = (seeds.labels, *seeds.coordinates)
        order = np.lexsort(keys)  # rows stay whole, with what is inside objects
        places = [values[order] for values in seeds.coordinates]
        is_first = np.ones(len(order), bool)  # of those at one place: the one with the smallest label
        is_first[1:] = np.logical_or.reduce([values[1:] != values[:-1] for values in places])
        self._places = [values[is_first] for values in places]
        self._labels = seeds.labels[order][is_first]
        self._filled = None if filled is None else filled[order][is_first]
        across = self._places[:-1]
        by_column = np.lexsort(across[::-1])
        steps = [values[by_column][1:] != values[by_column][:-1] for values in across]
        self._column = np.empty(len(by_column), np.int64)
        self._column[by_column] = np.append(0, np.cumsum(np.logical_or.reduce(steps)))[: len(by_column)]
        self._columns = int(self._column.max(initial=-1)) + 1

    def band(
        self,
        what: Quantity,
        dtype: np.dtype[Any],
        first: int,
        count: int,
        *,
        sides: PixelSides | None = None,
        max_distance: float | Fraction | None = None,
    ) -> SeedBand:
        """Give some rows or slices as what computes them anywhere."""
        own = with_neighbors(self.frame, first, count) if what == "diagram" else (first, count)
        return SeedBand(self.seeds_of(*own), self.frame, first, count, what, dtype, sides, max_distance)

    def seeds_of(self, first: int, count: int) -> SeedSet | VolumeSeeds:
        """Give the seeds that some rows or slices of the frame need, from the first to the last."""
        scale, along = self.seeds.scale, self._places[-1]
        top = scale * (self.frame.origin[-1] + first)
        before, behind = np.searchsorted(along, [top, top + scale * count])
        above, below = self._nearest(np.arange(before)), self._nearest(np.arange(behind, len(along))[::-1])
        chosen = np.concatenate([above, np.arange(before, behind), below])
        places = [values[chosen] for values in self._places]
        known: dict[str, Any] = {"scale": scale, "frame": self.seeds.frame, "site_labels": np.empty(0, np.uint32)}
        if len(places) == 2:
            x, y = places
            return SeedSet(x, y, self._labels[chosen], sites=np.empty((0, 2)), **known)
        if self._filled is not None:
            known["filled"] = filled = np.zeros(len(chosen), bool)
            filled[len(above) : len(chosen) - len(below)] = self._filled[before:behind]
        return VolumeSeeds(np.array(places).T, self._labels[chosen], sites=np.empty((0, 3)), **known)

    def _nearest(self, seeds: NDArray[np.intp]) -> NDArray[np.intp]:
        """The last seed in each column, of seeds in the order in which they come nearer."""
        nearest = np.full(self._columns, -1)
        nearest[self._column[seeds]] = seeds  # of values for one index the last one stays
        return np.sort(nearest[nearest >= 0])


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
