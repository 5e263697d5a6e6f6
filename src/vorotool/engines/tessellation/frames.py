"""Shared by digital diagrams: seeds from anything, frames, types of labels, limits."""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from numbers import Rational, Real
from operator import index
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.convert.images import as_raster, is_image
from vorotool.convert.points import as_points
from vorotool.convert.polygons import as_polygons
from vorotool.convert.spacings import asked_sides
from vorotool.engines.common import described
from vorotool.engines.tessellation.seeding import FrameOf, seeds_from_raster, seeds_in_frame
from vorotool.errors import STRICT, InputError, LimitError, UsageError, option, warn
from vorotool.numeric.numbers import real_number, shown_number
from vorotool.types.pixel_frame import MAX_PIXELS, Frame
from vorotool.types.points.label_image import LabelImage
from vorotool.types.points.point_set import PointSet
from vorotool.types.points.seed_set import SeedSet
from vorotool.types.spacing import SQUARE, PixelSides
from vorotool.types.volumes.label_volume import LabelVolume
from vorotool.types.volumes.volume_seeds import VolumeSeeds
from vorotool.types.volumes.voxel_frame import VoxelFrame

SIMD_LEVELS = ("portable", "avx2", "avx512")
BAND_PIXELS = 2**24
"""Pixels of a band when rows are streamed: large enough to keep all threads busy."""

MOST_UNASKED = 2**28
"""Pixels that a frame may have which follows from the points alone: more are likely points in map units."""


_WINDOW = option("--window X,Y,W,H", "window=(x, y, w, h)")
_FORMS = ((2, "shape must be two integers (H, W)"), (4, "window must be four integers (x, y, w, h)"))
_CELLS = option("delaunay --what cells", "voronoi_cells")
_RASTERIZED = option(
    "--cell-size C", "a Raster of vorotool.engines.tessellation.rasterized.rasterized(polygons, frame)"
)
_WIDEST_TYPE = option("--dtype uint32", 'dtype="uint32"')


def as_seeds(
    source: Any,
    name: str = "seeds",
    *,
    image: bool | None = None,
    max_pixels: int = MAX_PIXELS,
    frame: FrameOf = None,
    sides: PixelSides = SQUARE,
) -> SeedSet:
    """Give seeds from whatever `tessellate` accepts, on a lattice for the frame."""
    if isinstance(source, SeedSet):
        seeds = source
    elif is_image(source, name, image):
        raster = as_raster(source, name, max_pixels=max_pixels)
        seeds = seeds_from_raster(raster, mode="labels" if isinstance(source, LabelImage) else None)
        seeds = _moved_to(seeds, source.frame) if isinstance(source, LabelImage) else seeds
    else:
        return seeds_in_frame(_points(source, name), frame, sides=sides)
    if callable(frame):
        frame(seeds)
    return seeds


def _moved_to(seeds: SeedSet, frame: Frame | None) -> SeedSet:
    """Move the seeds of an image to where its frame is."""
    assert frame is not None  # LabelImage has filled it in
    assert seeds.sites is not None  # so has SeedSet
    x, y = frame.x * seeds.scale, frame.y * seeds.scale
    return replace(seeds, x=seeds.x + x, y=seeds.y + y, sites=seeds.sites + np.array([frame.x, frame.y]), frame=frame)


def _points(source: Any, name: str) -> PointSet:
    try:
        return as_points(source, name)
    except InputError:
        if not _holds_polygons(source):
            raise
        raise InputError(
            f"invalid {name}: expected points or an image, but got polygons or lines; give their centroids or "
            f"vertices, or {_RASTERIZED}"
        ) from None


def _holds_polygons(source: Any) -> bool:
    if isinstance(source, np.ndarray) and source.dtype != object:
        return False
    try:
        return len(as_polygons(source)) > 0
    except InputError:
        return False


def require_seeds(seeds: SeedSet | VolumeSeeds) -> None:
    """Refuse an empty list: nothing could be labeled. An image without foreground, which has a frame, is told of."""
    if not len(seeds) and seeds.frame is None:
        raise InputError("no seeds, so no pixel can be labeled: give at least one point")


def report_duplicates(duplicates: int, seeds: int, *, strict: bool) -> None:
    """Warn of several seeds at one place, or refuse them."""
    if not duplicates:
        return
    if strict:
        raise InputError(
            f"{duplicates} of {seeds} seeds lie on another seed: remove the duplicates, or leave out {STRICT}"
        )
    warn(f"{duplicates} of {seeds} seeds lie on another seed: the smallest label gets the region")


def default_frame(
    seeds: SeedSet, *, how: str = "give shape=(H, W) or window=(x, y, w, h)", instead: str = "voronoi_cells"
) -> Frame:
    """Give the frame that the input brings, else the smallest at the origin that holds the points."""
    if seeds.frame is not None:
        return seeds.frame
    nearest = least_sides({"x": seeds.x, "y": seeds.y}, seeds.scale, f"{_WINDOW}, or {_CELLS}")
    if nearest[0] * nearest[1] > MOST_UNASKED:
        raise LimitError(
            f"the smallest frame that holds the points has {nearest[0]} x {nearest[1]} pixels, more than "
            f"{MOST_UNASKED}: {how}; for points in map units use {instead}"
        )
    return Frame(0, 0, nearest[0], nearest[1])


def least_sides(places: dict[str, NDArray[np.int64]], scale: int, window: str) -> list[int]:
    """Give the sides of the smallest frame at the origin that holds seeds."""
    for name, values in places.items():
        if values.min() < 0:
            low, high = values.min() / scale, values.max() / scale
            raise InputError(
                f"points have {name} from {low:g} to {high:g}, but the default frame begins at 0: use {window}"
            )
    return [int((2 * values.max() + scale) // (2 * scale)) + 1 for values in places.values()]


def asked_frame(shape: Any, window: Any) -> Frame | None:
    """Give the frame that is asked for by ``shape`` (H, W) or ``window`` (x, y, w, h), if one is."""
    numbers = asked_numbers(shape, window, _FORMS)
    if numbers is None:
        return None
    return Frame(*numbers) if shape is None else Frame(0, 0, numbers[1], numbers[0])


def asked_numbers(shape: Any, window: Any, forms: tuple[tuple[int, str], tuple[int, str]]) -> list[int] | None:
    """Give the numbers of a shape or a window, whichever is given, or None."""
    if shape is not None and window is not None:
        raise UsageError("give shape or window, not both")
    given, (size, form) = (shape, forms[0]) if window is None else (window, forms[1])
    if given is None:
        return None
    try:
        numbers = [index(number) for number in given]
    except (TypeError, ValueError):  # as of a file that is closed
        numbers = []
    if len(numbers) != size:
        points = ": points in space have three columns, x, y and z" * ((size, len(numbers)) in ((2, 3), (4, 6)))
        raise UsageError(f"{form}, but is {shown_number(given)}{points}")
    return numbers


def require_memory(frame: Frame | VoxelFrame, max_pixels: int) -> None:
    """Refuse a frame that is too large to be held in memory."""
    count, noun = (frame.pixels, "pixels") if isinstance(frame, Frame) else (frame.voxels, "voxels")
    if count > real_number(max_pixels, "max_pixels"):
        sides = " x ".join(map(shown_number, reversed(frame.shape)))
        most = option(f"--max-pixels {shown_number(max_pixels)}")
        raise LimitError(f"the frame has {sides} = {shown_number(count)} {noun}, more than {most}")


def band_limits(frame: Frame) -> Iterator[tuple[int, int]]:
    """First row and number of rows of the bands in which a frame is streamed."""
    height = max(1, BAND_PIXELS // frame.width)
    for first in range(0, frame.height, height):
        yield first, min(height, frame.height - first)


def label_dtype(largest: int, dtype: Any = None) -> np.dtype[Any]:
    """Check or choose the type of labels up to `largest`."""
    if dtype is None:
        return np.dtype(np.uint16 if largest <= 0xFFFF else np.uint32)
    try:
        kind: np.dtype[Any] = np.dtype(dtype)
    except (TypeError, ValueError, SyntaxError):
        raise UsageError(f"dtype is {shown_number(dtype)}: use uint8, uint16, uint32 or int32") from None
    if kind not in (np.uint8, np.uint16, np.uint32, np.int32):
        raise UsageError(f"labels cannot have type {kind}: use uint8, uint16, uint32 or int32")
    if largest > np.iinfo(kind).max:
        raise LimitError(f"labels up to {largest} do not fit {kind}: use {_WIDEST_TYPE}")
    return kind


def squared_limit(max_distance: float | Fraction | None, scale: int | Fraction) -> int | None:
    """The largest squared distance in lattice steps that is within `max_distance`, of whose unit they are `scale`."""
    if max_distance is None:
        return None
    if not isinstance(max_distance, Real) or not 0 <= max_distance < float("inf"):
        raise UsageError(f"max_distance is {shown_number(max_distance)}: it must be a number, 0 or larger, and finite")
    exact = Fraction(max_distance) if isinstance(max_distance, Rational) else Fraction(float(max_distance))
    steps = exact * scale
    return int(min(steps * steps, Fraction(2**127)))


def square_dtype(largest: int) -> np.dtype[Any]:
    """Choose the type of squared distances up to `largest`: uint32 or uint64."""
    if largest >= 2**64:
        raise LimitError(
            f"squared distances of this frame may exceed 64 bits: use {option('--what distance', 'distances')}"
        )
    return np.dtype(np.uint32 if largest < 2**32 else np.uint64)


def sides_of(source: Any, spacing: Any, axes: int = 2) -> PixelSides:
    """Give the sides of the pixels as they are asked for, else those of labels that have sides."""
    if spacing is None and isinstance(source, LabelImage | LabelVolume):
        return source.sides
    return asked_sides(source, spacing, axes)


def check_out(out: Any, shape: tuple[int, ...]) -> None:
    """Refuse what is no array to write an image or a volume of this shape to."""
    usable = isinstance(out, np.ndarray) and out.shape == shape and out.flags.c_contiguous and out.flags.writeable
    if not usable:
        raise UsageError(f"out must be a writeable C-contiguous array of shape {shape}, but is {described(out)}")


def simd_level() -> str:
    """Name the instruction set of the kernels: the widest of this machine, or ``VOROTOOL_SIMD``."""
    widest: str = _core.tessellation.widest_simd()
    wanted = os.environ.get("VOROTOOL_SIMD") or widest
    available = SIMD_LEVELS[: SIMD_LEVELS.index(widest) + 1]
    if wanted not in available:
        raise UsageError(f"VOROTOOL_SIMD is {wanted!r}: this machine has {', '.join(available)}")
    return wanted
