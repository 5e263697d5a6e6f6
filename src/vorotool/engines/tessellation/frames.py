"""Shared by digital diagrams: seeds from anything, frames, types of labels, limits."""

from __future__ import annotations

import os
from collections.abc import Sequence
from fractions import Fraction
from math import prod
from numbers import Rational, Real
from operator import index
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.common import described
from vorotool.engines.tessellation.seeding import FrameOf, moved_to, seeds_from_raster, seeds_in_frame
from vorotool.errors import STRICT, InputError, LimitError, UsageError, option, warn
from vorotool.numeric.checks import MAX_PIXELS
from vorotool.numeric.numbers import real_number, shown_number
from vorotool.products.formats import resolved
from vorotool.types.images import LabelImage
from vorotool.types.pixels import CELL, SQUARE, Frame, PixelSides
from vorotool.types.points.point_set import PointSet
from vorotool.types.points.seed_set import SeedSet
from vorotool.types.volumes.volume import LabelVolume, VolumeSeeds, VoxelFrame

SIMD_LEVELS = ("portable", "avx2", "avx512")
BAND_PIXELS = 2**24
"""Pixels of a band when rows are streamed: large enough to keep all threads busy."""

MOST_UNASKED = 2**28
"""Pixels that a frame may have which follows from the points alone: more are likely points in map units."""


_VOXELS_A_SEED, _MOST_VOXELS = 64, 2**27
"""Of a slab of a volume."""

_CELLS = option("delaunay --what cells", "voronoi_cells")
_WINDOW = {
    2: f"{option('--window X,Y,W,H', 'window=(x, y, w, h)')}, or {_CELLS}",
    3: option("--window X,Y,Z,W,H,D", "window=(x, y, z, w, h, d)"),
}
_FORMS = {
    2: ("shape must be two integers (H, W)", "window must be four integers (x, y, w, h)"),
    3: ("shape must be three integers (D, H, W)", "window must be six integers (x, y, z, w, h, d)"),
}
_HOW = {
    2: "give shape=(H, W) or window=(x, y, w, h)",
    3: "give shape=(D, H, W) or window=(x, y, z, w, h, d)",
}
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
    from vorotool.convert.images import as_raster, is_image

    if isinstance(source, SeedSet):
        seeds = source
    elif is_image(source, name, image):
        raster = as_raster(source, name, max_pixels=max_pixels)
        seeds = seeds_from_raster(raster, mode="labels" if isinstance(source, LabelImage) else None)
        seeds = moved_to(seeds, source.frame) if isinstance(source, LabelImage) else seeds
    else:
        return seeds_in_frame(_points(source, name), frame, sides=sides)
    if callable(frame):
        frame(seeds)
    return seeds


def _points(source: Any, name: str) -> PointSet:
    from vorotool.convert.points import as_points

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
        return len(resolved("convert.polygons:as_polygons")(source)) > 0
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


def default_frame(seeds: Any, *, how: str | None = None, instead: str = "voronoi_cells") -> Any:
    """Give the frame that the input brings, else the smallest at the origin that holds the points."""
    if seeds.frame is not None:
        return seeds.frame
    axes = len(seeds.coordinates)
    sides = _least_sides(seeds.coordinates, seeds.scale)
    if prod(sides) > MOST_UNASKED:
        size = f"{' x '.join(map(str, sides))} {CELL[axes]}s, more than {MOST_UNASKED}"
        of_map = f"; for points in map units use {instead}" if axes == 2 else ""
        raise LimitError(f"the smallest frame that holds the points has {size}: {how or _HOW[axes]}{of_map}")
    return frame_at((0,) * axes, sides)


def frame_at(origin: Sequence[int], size: Sequence[int]) -> Any:
    """Give the frame of an image or a volume of a width, a height and maybe a depth."""
    return Frame(*origin, *size) if len(size) == 2 else VoxelFrame(*origin, *size)


def _least_sides(coordinates: Sequence[NDArray[np.int64]], scale: int) -> list[int]:
    """Give the sides of the smallest frame at the origin that holds seeds."""
    for name, values in zip("xyz", coordinates, strict=False):
        if values.min() < 0:
            low, high = values.min() / scale, values.max() / scale
            raise InputError(
                f"points have {name} from {low:g} to {high:g}, but the default frame begins at 0: use "
                f"{_WINDOW[len(coordinates)]}"
            )
    return [int((2 * values.max() + scale) // (2 * scale)) + 1 for values in coordinates]


def asked_frame(shape: Any, window: Any, axes: int = 2) -> Any:
    """Give the frame that is asked for by the shape of an array, or by a window, if one is."""
    if shape is not None and window is not None:
        raise UsageError("give shape or window, not both")
    given, size = (shape, axes) if window is None else (window, 2 * axes)
    if given is None:
        return None
    try:
        numbers = [index(number) for number in given]
    except (TypeError, ValueError):  # as of a file that is closed
        numbers = []
    if len(numbers) != size:
        points = ": points in space have three columns, x, y and z" * ((size, len(numbers)) in ((2, 3), (4, 6)))
        raise UsageError(f"{_FORMS[axes][window is not None]}, but is {shown_number(given)}{points}")
    return frame_at(numbers[:axes], numbers[axes:]) if shape is None else frame_at((0,) * axes, numbers[::-1])


def require_memory(frame: Frame | VoxelFrame, max_pixels: int) -> None:
    """Refuse a frame that is too large to be held in memory."""
    count = prod(frame.shape)
    if count > real_number(max_pixels, "max_pixels"):
        sides = " x ".join(map(shown_number, reversed(frame.shape)))
        most = option(f"--max-pixels {shown_number(max_pixels)}")
        noun = CELL[len(frame.shape)]
        raise LimitError(f"the frame has {sides} = {shown_number(count)} {noun}s, more than {most}")


def band_limits(frame: Frame | VoxelFrame, seeds: int = 0) -> list[tuple[int, int]]:
    """List the first row or slice, and the number of them, of the bands in which a frame is streamed."""
    whole, *across = frame.shape
    wanted = BAND_PIXELS
    if len(across) == 2:
        wanted = min(max(wanted, _VOXELS_A_SEED * seeds), _MOST_VOXELS)
    step = max(1, wanted // prod(across))
    return [(first, min(step, whole - first)) for first in range(0, whole, step)]


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


def square_dtype(largest: int, axes: int = 2) -> np.dtype[Any]:
    """Choose the type of squared distances up to `largest`: uint32 or uint64."""
    if largest >= 2**64:
        what = "frame" if axes == 2 else "volume"
        sides = "" if axes == 2 else "round the sides of voxels to fewer digits, or "
        raise LimitError(
            f"squared distances of this {what} may exceed 64 bits: {sides}use {option('--what distance', 'distances')}"
        )
    return np.dtype(np.uint32 if largest < 2**32 else np.uint64)


def sides_of(source: Any, spacing: Any, axes: int = 2) -> PixelSides:
    """Give the sides of the pixels as they are asked for, else those of labels that have sides."""
    if spacing is None and isinstance(source, LabelImage | LabelVolume):
        return source.sides
    from vorotool.convert.spacings import asked_sides

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
