"""Digital Voronoi tessellations: exact, and by the paper's propagation (sections 2.1 and 2.2)."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterator
from fractions import Fraction
from functools import cached_property
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.label_arrays import Progress, checked_threads
from vorotool.engines.seeding import seeds_from_points, seeds_from_raster
from vorotool.engines.verification import verify_label_image
from vorotool.errors import InputError, LimitError, UsageError, VorotoolWarning
from vorotool.geometry.frame import MAX_PIXELS, MAX_SIDE, Frame
from vorotool.geometry.label_image import LabelImage
from vorotool.geometry.points import PointSet
from vorotool.geometry.raster import Raster
from vorotool.geometry.seeds import SeedSet

Method = Literal["exact", "propagation"]

SIMD_LEVELS = ("portable", "avx2", "avx512")
BAND_PIXELS = 2**24
"""Pixels of a band when rows are streamed: large enough to keep all threads busy."""


class Tessellator:
    """The exact tessellation of a frame, ready to give any of its rows.

    Parameters
    ----------
    seeds : SeedSet
        At least one seed.
    frame : Frame, optional
        The pixels to label; by default `default_frame` of the seeds.
    max_distance : float or Fraction, optional
        Pixels farther than this from every seed get label 0.
    threads : int
        0 uses all.
    strict : bool
        Refuse several seeds at one place.
    progress : callable, optional
        Called now and then with the fraction done of the rows asked for.

    Raises
    ------
    InputError
        If there is no seed, or one is too far away for exact arithmetic.

    Warns
    -----
    VorotoolWarning
        If several seeds lie at one place: the smallest label has the region.

    Notes
    -----
    A row sweep with dead seeds dropped for good: memory grows with the seeds and the width, not with the
    frame. Every row is the same whatever the band it is computed in, the threads and the instruction set.

    Examples
    --------
    >>> sweep = Tessellator(seeds_from_points(PointSet([[0, 0], [4, 0]])), Frame(0, 0, 5, 1))
    >>> sweep.labels().tolist()
    [[1, 1, 1, 2, 2]]
    """

    def __init__(
        self,
        seeds: SeedSet,
        frame: Frame | None = None,
        *,
        max_distance: float | Fraction | None = None,
        threads: int = 0,
        strict: bool = False,
        progress: Progress = None,
    ) -> None:
        require_seeds(seeds)
        self.seeds = seeds
        self.frame = frame or default_frame(seeds)
        if max(self.frame.shape) > MAX_SIDE:
            raise LimitError(f"the frame is {self.frame.width} x {self.frame.height}: a side has at most 2^30 pixels")
        self.simd = simd_level()
        self.most_squared = squared_limit(max_distance, seeds.scale)
        self._threads = checked_threads(threads)
        self._progress = progress
        self._core = self._prepare()
        self.duplicates: int = self._core.duplicates
        report_duplicates(self.duplicates, len(seeds), strict=strict)

    def _prepare(self) -> _core.Tessellation:
        seeds, frame = self.seeds, self.frame
        try:
            return _core.Tessellation(
                seeds.x,
                seeds.y,
                seeds.labels,
                frame.x,
                frame.y,
                frame.width,
                frame.height,
                seeds.scale,
                self.simd,
            )
        except _core.SeedTooFarError as error:
            raise InputError(
                f"{error} for exact arithmetic: coordinates relative to the middle of the frame must be at most "
                f"2^40 lattice steps ({2**40 // seeds.scale} pixels for these seeds); use a nearer --window"
            ) from None

    @property
    def arithmetic(self) -> str:
        """The narrowest arithmetic that is exact for these seeds."""
        if self._core.is_wide:
            return "int128"
        return "float64" if self._core.products_exact else "float64 with int128"

    def labels(
        self, first: int = 0, rows: int | None = None, *, dtype: Any = None, out: NDArray[Any] | None = None
    ) -> NDArray[Any]:
        """Labels of some rows of the frame.

        Parameters
        ----------
        first, rows : int
            The first row and the number of rows; by default all.
        dtype : dtype, optional
            uint8, uint16, uint32 or int32; by default uint16 where the labels fit, else uint32.
        out : (rows, W) array, optional
            Written instead of a new array; C-contiguous, of one of these types.

        Returns
        -------
        (rows, W) array
            `out` if it was given.

        Raises
        ------
        UsageError
            If the labels do not fit the type, or `out` has another shape or layout.
        """
        kind = label_dtype(self.seeds.largest_label, out.dtype if out is not None else dtype)
        array = self._output(first, rows, kind, out)
        limit = None if self.most_squared is None else divmod(self.most_squared, 2**64)
        self._core.labels(array, first, limit, self._threads, self._progress)
        return array

    def squared_distances(self, first: int = 0, rows: int | None = None) -> NDArray[Any]:
        """Exact squared distances to the nearest seed, in units of 1 / ``seeds.scale``² square pixels.

        Returns
        -------
        (rows, W) array
            uint32 where every distance of the frame fits, else uint64.

        Raises
        ------
        LimitError
            If a squared distance may exceed 64 bits.
        """
        array = self._output(first, rows, self.square_dtype, None)
        self._core.squared_distances(array, first, self._threads, self._progress)
        return array

    def distances(self, first: int = 0, rows: int | None = None) -> NDArray[np.float32]:
        """Distances to the nearest seed in pixels, rounded once from double precision."""
        array = self._output(first, rows, np.dtype(np.float32), None)
        self._core.distances(array, first, self._threads, self._progress)
        return array

    @cached_property
    def square_dtype(self) -> np.dtype[Any]:
        """The type of squared distances: the smaller one that holds the largest possible."""
        scale, frame = self.seeds.scale, self.frame
        # No pixel is farther from its nearest seed than from this one, and none farther than a corner.
        dx = max(abs(int(self.seeds.x[0]) - scale * c) for c in (frame.x, frame.x + frame.width - 1))
        dy = max(abs(int(self.seeds.y[0]) - scale * r) for r in (frame.y, frame.y + frame.height - 1))
        largest = dx * dx + dy * dy
        if largest >= 2**64:
            raise LimitError("squared distances of this frame may exceed 64 bits: use --what distance")
        return np.dtype(np.uint32 if largest < 2**32 else np.uint64)

    def _output(self, first: int, rows: int | None, dtype: np.dtype[Any], out: NDArray[Any] | None) -> NDArray[Any]:
        rows = self.frame.height - first if rows is None else rows
        if not 0 <= first < self.frame.height or not 1 <= rows <= self.frame.height - first:
            raise UsageError(f"rows {first} to {first + rows - 1} are not all in a frame of {self.frame.height} rows")
        if out is None:
            return np.empty((rows, self.frame.width), dtype)
        if out.shape != (rows, self.frame.width) or not out.flags.c_contiguous or not out.flags.writeable:
            raise UsageError(
                f"out must be a writeable C-contiguous array of shape {(rows, self.frame.width)}, "
                f"but has shape {out.shape}"
            )
        return out


def tessellate(
    seeds: Any,
    *,
    shape: tuple[int, int] | None = None,
    window: tuple[int, int, int, int] | None = None,
    method: Method = "exact",
    passes: int = 2,
    max_distance: float | Fraction | None = None,
    dtype: Any = None,
    out: NDArray[Any] | None = None,
    threads: int = 0,
    max_pixels: int = MAX_PIXELS,
    progress: Progress = None,
) -> LabelImage:
    """Label every pixel with its nearest seed; ties go to the smallest label.

    Parameters
    ----------
    seeds : SeedSet, PointSet, Raster, or (n, 2) array-like or shapely points
        Where the regions come from. Point i of an array has label i + 1.
    shape : (H, W), optional
        Rows and columns of the image; pixel (0, 0) is at the origin.
    window : (x, y, w, h), optional
        The same with an origin. By default an image's own frame, or what just holds the points.
    method : {"exact", "propagation"}
        "propagation" is the paper's algorithm to the letter, whose labels are nearly always right.
    passes : {2, 1}
        Passes of the propagation.
    max_distance : float or Fraction, optional
        Pixels farther than this from every seed get label 0.
    dtype, out
        As in `Tessellator.labels`.
    threads : int
        0 uses all. The result does not depend on it.
    max_pixels : int
        Larger images are refused before memory is taken.

    Returns
    -------
    LabelImage

    Raises
    ------
    InputError
        If there is no seed, a seed is unusable, or the points have negative coordinates and no window.
    LimitError
        If the frame has more than `max_pixels` pixels.
    UsageError
        If options do not go together.

    References
    ----------
    Melkemi and Vandorpe, "Voronoi Diagrams and Applications", sections 2.1 and 2.2.

    Examples
    --------
    >>> tessellate([[0, 0], [2, 1]], shape=(2, 3)).labels.tolist()
    [[1, 1, 2], [1, 2, 2]]
    """
    seed_set = as_seeds(seeds)
    if shape is not None and window is not None:
        raise UsageError("give shape or window, not both")
    frame = Frame(*window) if window is not None else Frame(0, 0, shape[1], shape[0]) if shape is not None else None
    if len(seed_set):
        require_memory(frame or default_frame(seed_set), max_pixels)
    if method == "propagation":
        if max_distance is not None:
            raise UsageError("max_distance needs method='exact': the paper's propagation has no distance limit")
        return propagate(seed_set, frame, passes=passes, dtype=dtype, out=out, progress=progress)
    if method != "exact":
        raise UsageError(f"method is {method!r}: it must be 'exact' or 'propagation'")
    sweep = Tessellator(seed_set, frame, max_distance=max_distance, threads=threads, progress=progress)
    return LabelImage(sweep.labels(dtype=dtype, out=out), sweep.frame, seed_set)


def propagate(
    seeds: SeedSet,
    frame: Frame | None = None,
    *,
    passes: int = 2,
    dtype: Any = None,
    out: NDArray[Any] | None = None,
    progress: Progress = None,
) -> LabelImage:
    """Run the paper's two passes to the letter (section 2.2), with an implicit frame of zero labels.

    Parameters
    ----------
    seeds : SeedSet
        Seeds on pixels of the frame.
    passes : {2, 1}
        1 stops after the first passes, as in the paper's Figure 1; pixels not reached keep 0.

    Returns
    -------
    LabelImage

    Raises
    ------
    InputError
        If there is no seed, or one is not on a pixel of the frame.

    Examples
    --------
    >>> seeds = seeds_from_points(PointSet([[2, 0], [1, 2], [0, 6]]))
    >>> propagate(seeds, Frame(0, 0, 14, 8)).labels[7, 13]  # 2 is nearer: sqrt 169 against sqrt 170
    np.uint16(1)
    """
    if passes not in (1, 2):
        raise UsageError(f"passes is {passes}: it must be 1 or 2")
    require_seeds(seeds)
    frame = frame or default_frame(seeds)
    if seeds.scale != 1:
        raise InputError("the paper's propagation starts from pixels: round the seeds, or use --method exact")
    x, y = seeds.x - frame.x, seeds.y - frame.y
    outside = np.flatnonzero((x < 0) | (y < 0) | (x >= frame.width) | (y >= frame.height))
    if outside.size:
        i = int(outside[0])
        raise InputError(
            f"seed {i + 1} at ({seeds.x[i]}, {seeds.y[i]}) is outside the frame, and the paper's propagation starts "
            f"from its pixels: use a larger --size or --window, or --method exact"
        )
    kind = label_dtype(seeds.largest_label, out.dtype if out is not None else dtype)
    labels = np.empty(frame.shape, np.uint32)
    _core.propagate(x, y, seeds.labels, passes, labels, progress)
    if out is None:
        return LabelImage(labels.astype(kind, copy=False), frame, seeds)
    out[...] = labels
    return LabelImage(out, frame, seeds)


class PropagatedRows:
    """The paper's tessellation, held in memory, with the interface of `Tessellator` for its rows.

    Parameters
    ----------
    seeds, frame, passes, progress
        As for `propagate`.
    max_pixels : int
        Larger frames are refused before memory is taken.

    Examples
    --------
    >>> seeds = seeds_from_points(PointSet([[2, 0], [1, 2], [0, 6]]))
    >>> PropagatedRows(seeds, Frame(0, 0, 14, 8)).compare_with_exact()["wrong_pixels"]
    1
    """

    def __init__(
        self,
        seeds: SeedSet,
        frame: Frame | None = None,
        *,
        passes: int = 2,
        max_pixels: int = MAX_PIXELS,
        progress: Progress = None,
    ) -> None:
        require_seeds(seeds)
        self.seeds = seeds
        self.frame = frame or default_frame(seeds)
        require_memory(self.frame, max_pixels)
        self._labels = propagate(seeds, self.frame, passes=passes, progress=progress).labels
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            self._exact = Tessellator(seeds, self.frame)
        self.duplicates = self._exact.duplicates
        report_duplicates(self.duplicates, len(seeds), strict=False)

    def labels(self, first: int = 0, rows: int | None = None, *, dtype: Any = None) -> NDArray[Any]:
        """Labels of some rows, as `Tessellator.labels` gives them."""
        rows = self.frame.height - first if rows is None else rows
        kind = label_dtype(self.seeds.largest_label, dtype)
        return self._labels[first : first + rows].astype(kind, copy=False)

    def compare_with_exact(self) -> dict[str, Any]:
        """Count the pixels that differ from the exact tessellation, and name the first in raster order.

        Returns
        -------
        dict
            ``wrong_pixels``, and ``first_wrong``: None, or ``x``, ``y``, ``label`` and ``exact_label``.
        """
        count, first = 0, None
        for start, rows in band_limits(self.frame):
            found, exact = self.labels(start, rows), self._exact.labels(start, rows)
            wrong = found != exact
            count += int(wrong.sum())
            if first is None and wrong.any():
                row, column = (int(v) for v in np.unravel_index(int(wrong.argmax()), wrong.shape))
                first = {
                    "x": self.frame.x + column,
                    "y": self.frame.y + start + row,
                    "label": int(found[row, column]),
                    "exact_label": int(exact[row, column]),
                }
        return {"wrong_pixels": count, "first_wrong": first}


def band_limits(frame: Frame) -> Iterator[tuple[int, int]]:
    """First row and number of rows of the bands in which a frame is streamed."""
    height = max(1, BAND_PIXELS // frame.width)
    for first in range(0, frame.height, height):
        yield first, min(height, frame.height - first)


def verify_rows(rows: Tessellator | PropagatedRows, *, threads: int = 0) -> None:
    """Check every label against an independent exact nearest-seed search, band by band.

    Raises
    ------
    VerificationError
        If a label is wrong; the first such pixel is named.

    Examples
    --------
    >>> verify_rows(Tessellator(seeds_from_points(PointSet([[0, 0], [4, 0]])), Frame(0, 0, 5, 3)))
    """
    for first, count in band_limits(rows.frame):
        frame = Frame(rows.frame.x, rows.frame.y + first, rows.frame.width, count)
        limit = rows.most_squared if isinstance(rows, Tessellator) else None
        verify_label_image(rows.labels(first, count), rows.seeds, frame, max_distance2=limit, threads=threads)


def verify_tessellation(image: LabelImage, *, max_distance: float | Fraction | None = None, threads: int = 0) -> None:
    """Check that every pixel of a tessellation has the smallest label of its nearest seeds.

    Parameters
    ----------
    image : LabelImage
        With its seeds, as `tessellate` gives it.
    max_distance : float or Fraction, optional
        The limit that the tessellation was made with.
    threads : int
        0 uses all.

    Raises
    ------
    VerificationError
        If a label is wrong; the first such pixel is named.
    UsageError
        If the image carries no seeds.

    Examples
    --------
    >>> verify_tessellation(tessellate([[0, 0], [2, 1]], shape=(2, 3)))
    """
    if image.seeds is None or image.frame is None:
        raise UsageError("the label image carries no seeds: make it with vorotool.tessellate")
    limit = squared_limit(max_distance, image.seeds.scale)
    verify_label_image(image.labels, image.seeds, image.frame, max_distance2=limit, threads=threads)


def require_seeds(seeds: SeedSet) -> None:
    """Refuse an empty list: nothing could be labelled."""
    if len(seeds) == 0:
        raise InputError("there are no seeds, so nothing could be labelled: give at least one point")


def report_duplicates(duplicates: int, seeds: int, *, strict: bool) -> None:
    """Warn of several seeds at one place, or refuse them."""
    if not duplicates:
        return
    if strict:
        raise InputError(
            f"{duplicates} of {seeds} seeds lie on another seed: remove the duplicates, or leave out --strict"
        )
    warnings.warn(
        f"{duplicates} of {seeds} seeds lie on another seed: the smallest label has the region",
        VorotoolWarning,
        stacklevel=4,
    )


def as_seeds(source: Any) -> SeedSet:
    """Seeds from whatever `tessellate` accepts."""
    if isinstance(source, SeedSet):
        return source
    if isinstance(source, Raster):
        return seeds_from_raster(source)
    if isinstance(source, PointSet):
        return seeds_from_points(source)
    if hasattr(source, "geom_type"):
        from shapely import get_coordinates

        return seeds_from_points(PointSet(get_coordinates(source)))
    try:
        xy = np.asarray([(p.x, p.y) if hasattr(p, "geom_type") else p for p in source], dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError("seeds must be an (n, 2) array of numbers, shapely points, or an image") from None
    return seeds_from_points(PointSet(xy))


def default_frame(seeds: SeedSet) -> Frame:
    """Give the frame that the input brings, else the smallest at the origin that holds the points.

    Raises
    ------
    InputError
        If a coordinate is negative: such points need a window.

    Examples
    --------
    >>> default_frame(seeds_from_points(PointSet([[2, 1], [7.25, 5.5]]))).shape
    (7, 8)
    """
    if seeds.frame is not None:
        return seeds.frame
    for name, values in (("x", seeds.x), ("y", seeds.y)):
        if values.min() < 0:
            low, high = values.min() / seeds.scale, values.max() / seeds.scale
            raise InputError(f"points span {name} {low:g}..{high:g}: use --window X,Y,W,H, or delaunay --what cells")
    nearest = [int((2 * v.max() + seeds.scale) // (2 * seeds.scale)) + 1 for v in (seeds.x, seeds.y)]
    return Frame(0, 0, nearest[0], nearest[1])


def require_memory(frame: Frame, max_pixels: int) -> None:
    """Refuse a frame that is too large to be held in memory."""
    if frame.pixels > max_pixels:
        raise LimitError(
            f"the frame has {frame.width} x {frame.height} = {frame.pixels} pixels, more than --max-pixels {max_pixels}"
        )


def label_dtype(largest: int, dtype: Any = None) -> np.dtype[Any]:
    """Check or choose the type of labels up to `largest`."""
    if dtype is None:
        return np.dtype(np.uint16 if largest <= 0xFFFF else np.uint32)
    kind: np.dtype[Any] = np.dtype(dtype)
    if kind not in (np.uint8, np.uint16, np.uint32, np.int32):
        raise UsageError(f"labels cannot have type {kind}: use uint8, uint16, uint32 or int32")
    if largest > np.iinfo(kind).max:
        raise UsageError(f"labels up to {largest} do not fit {kind}: use --dtype uint32")
    return kind


def squared_limit(max_distance: float | Fraction | None, scale: int) -> int | None:
    """The largest squared distance in lattice steps that is within `max_distance` pixels."""
    if max_distance is None:
        return None
    if not max_distance >= 0 or max_distance == float("inf"):
        raise UsageError(f"max_distance is {max_distance}: it must be 0 or larger, and finite")
    return int(min((Fraction(max_distance) * scale) ** 2, Fraction(2**127)))


def simd_level() -> str:
    """Name the instruction set of the kernels: the widest of this machine, or ``VOROTOOL_SIMD``."""
    widest: str = _core.widest_simd()
    wanted = os.environ.get("VOROTOOL_SIMD") or widest
    available = SIMD_LEVELS[: SIMD_LEVELS.index(widest) + 1]
    if wanted not in available:
        raise UsageError(f"VOROTOOL_SIMD is {wanted!r}: this machine has {', '.join(available)}")
    return wanted
