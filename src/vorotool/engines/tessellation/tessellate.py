"""Digital Voronoi tessellations of images and volumes: exact, and by the paper's propagation (sections 2.1, 2.2)."""

from __future__ import annotations

import warnings
from fractions import Fraction
from typing import TYPE_CHECKING, Any, Literal, TypedDict, Unpack, overload

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.common import label_array
from vorotool.engines.tessellation.frames import (
    as_seeds,
    asked_frame,
    band_limits,
    check_out,
    default_frame,
    label_dtype,
    report_duplicates,
    require_memory,
    require_seeds,
    sides_of,
    squared_limit,
)
from vorotool.engines.tessellation.tessellator import Tessellator
from vorotool.errors import InputError, UsageError, VerificationError, element, option
from vorotool.numeric.checks import MAX_PIXELS, checked_threads, is_choice
from vorotool.numeric.numbers import shown_number, whole_number
from vorotool.numeric.parallel import Progress, report
from vorotool.types.arguments import check_value
from vorotool.types.images import LabelImage
from vorotool.types.pixels import SQUARE, Frame, PixelSides, distance_as_written
from vorotool.types.points.seed_set import SeedSet
from vorotool.types.volumes.volume import LabelVolume, VolumeSeeds, VoxelFrame

if TYPE_CHECKING:
    from numpy.typing import DTypeLike

    from vorotool.types.points.point_set import VolumePoints
    from vorotool.types.volumes.volume import Volume
    from vorotool.typing import SeedsLike, Spacing, VolumeSeedsLike

    class _Options(TypedDict, total=False):
        """What images and volumes have in common."""

        image: bool | None
        passes: int
        max_distance: float | Fraction | None
        spacing: Spacing | None
        dtype: DTypeLike | None
        out: NDArray[Any] | None
        threads: int
        max_pixels: int
        progress: Progress

    class _ExactOptions(_Options, total=False):
        """Those of volumes."""

        method: Literal["exact"]


Method = Literal["exact", "propagation"]


@overload
def tessellate(
    seeds: Volume | LabelVolume | VolumePoints | VolumeSeeds,
    *,
    shape: tuple[int, int, int] | None = ...,
    window: tuple[int, int, int, int, int, int] | None = ...,
    **options: Unpack[_ExactOptions],
) -> LabelVolume: ...
@overload
def tessellate(
    seeds: VolumeSeedsLike,
    *,
    shape: tuple[int, int, int],
    window: None = ...,
    **options: Unpack[_ExactOptions],
) -> LabelVolume: ...
@overload
def tessellate(
    seeds: VolumeSeedsLike,
    *,
    shape: None = ...,
    window: tuple[int, int, int, int, int, int],
    **options: Unpack[_ExactOptions],
) -> LabelVolume: ...
@overload
def tessellate(
    seeds: SeedsLike,
    *,
    shape: tuple[int, int] | None = ...,
    window: tuple[int, int, int, int] | None = ...,
    method: Method = ...,
    **options: Unpack[_Options],
) -> LabelImage: ...


def tessellate(
    seeds: SeedsLike | VolumeSeedsLike,
    *,
    shape: tuple[int, ...] | None = None,
    window: tuple[int, ...] | None = None,
    image: bool | None = None,
    method: Method = "exact",
    passes: int = 2,
    max_distance: float | Fraction | None = None,
    spacing: Spacing | None = None,
    dtype: DTypeLike | None = None,
    out: NDArray[Any] | None = None,
    threads: int = 0,
    max_pixels: int = MAX_PIXELS,
    progress: Progress = None,
) -> LabelImage | LabelVolume:
    """Label every pixel, or every voxel, with its nearest seed; ties go to the smallest label.

    Parameters
    ----------
    seeds : SeedSet, points, image, VolumeSeeds, VolumePoints or volume
        Generators of the regions: points in an array, a data frame, a GeoSeries, …, or an image (a mask or a label
        image). Point i of an array has label i + 1; objects of images are those of `seeds_from_raster`. An array with
        three axes is a volume, except color images: uint8 with a last axis of three or four. Its objects are those of
        `seeds_from_volume`. Points in space are x, y, z, and need a shape of three numbers.
    shape : (H, W) or (D, H, W), optional
        Rows and columns of the image, or slices, rows and columns of the volume; the first pixel is at the origin.
    window : (x, y, w, h) or (x, y, z, w, h, d), optional
        Frame with an origin. By default the frame of the image, or the smallest one that holds the points.
    image : bool, optional
        Whether an array is an image. By default boolean arrays are images, and so are integer arrays unless they have
        two or three columns: these are points.
    method : {"exact", "propagation"}
        "propagation" is the paper's algorithm to the letter, whose labels are nearly always right; images only.
    passes : {2, 1}
        Passes of the propagation.
    max_distance : float or Fraction, optional
        Pixels farther than this from every seed get label 0.
    spacing : float, (height, width) or (depth, height, width), or "auto", optional
        Sides of a pixel and so the unit of distances; by default those of a label image, else 1. Coordinates of points
        are in pixels. A float stands for the decimal number it prints as. ``"auto"`` takes what an image or a volume
        carries: the size in its file, or the steps of the axes of an xarray; without, such a size is warned of.
    dtype : dtype, optional
        As in `Tessellator.labels`.
    out : (H, W) or (D, H, W) array, optional
        As in `Tessellator.labels`.
    threads : int
        Number of threads; 0 uses all. The result does not depend on it.
    max_pixels : int
        Larger images are refused before memory is allocated.
    progress : callable, optional
        Called with the fraction done.

    Returns
    -------
    LabelImage or LabelVolume
        The labels, with the seeds.

    Raises
    ------
    InputError
        If there is no seed, a seed is unusable, or the points have negative coordinates and no window.
    LimitError
        If the frame has more than `max_pixels` pixels, or, without a frame, the points need more than 2^28.
    UsageError
        If options contradict each other.

    References
    ----------
    Melkemi and Vandorpe, "Voronoi Diagrams and Applications", sections 2.1 and 2.2.

    Examples
    --------
    >>> tessellate([[0, 0], [2, 1]], shape=(2, 3)).labels.tolist()
    [[1, 1, 2], [1, 2, 2]]
    >>> tessellate([[0, 0], [2, 1]], shape=(2, 3), spacing=(1.5, 0.5)).labels.tolist()
    [[1, 1, 1], [2, 2, 2]]
    >>> tessellate([[0, 0, 0], [2, 0, 1]], shape=(2, 1, 3)).labels.tolist()
    [[[1, 1, 2]], [[1, 2, 2]]]
    """
    from vorotool.convert.images import check_image_choice
    from vorotool.convert.volumes import is_of_space, refuse_triples

    check_image_choice(image)
    axes = 3 if image is not True and is_of_space(seeds, shape, window) else 2
    if axes == 2:
        refuse_triples(seeds, "seeds", image=image)
    sides = sides_of(seeds, spacing, axes)
    frame = asked_frame(shape, window, axes)

    def needed_frame(made: SeedSet | VolumeSeeds) -> Any:
        if not len(made) and made.frame is None:
            return None
        whole = default_frame(made)
        require_memory(whole, max_pixels)
        return whole

    if frame is not None:
        require_memory(frame, max_pixels)
    if axes == 2:
        given: Any = as_seeds(seeds, image=image, max_pixels=max_pixels, frame=frame or needed_frame, sides=sides)
    else:
        from vorotool.engines.tessellation.volume_seeding import as_volume_seeds

        given = as_volume_seeds(seeds, max_pixels=max_pixels, check=needed_frame if frame is None else None)
    rows = labeled_rows(
        given,
        frame,
        method=method,
        passes=passes,
        max_distance=distance_as_written(max_distance, sides),
        sides=sides,
        threads=threads,
        max_pixels=max_pixels,
        progress=progress,
    )
    kind: Any = LabelImage if axes == 2 else LabelVolume
    return kind(rows.labels(dtype=dtype, out=out), rows.frame, rows.seeds, sides=sides)


def labeled_rows(
    seeds: SeedSet | VolumeSeeds,
    frame: Frame | VoxelFrame | None = None,
    *,
    method: Method = "exact",
    passes: int = 2,
    max_distance: float | Fraction | None = None,
    sides: PixelSides = SQUARE,
    strict: bool = False,
    threads: int = 0,
    max_pixels: int = MAX_PIXELS,
    progress: Progress = None,
) -> Tessellator | PropagatedRows:
    """Prepare what gives any rows or slices of a tessellation; arguments and errors as of `tessellate`."""
    if not is_choice(method, ("exact", "propagation")):
        raise UsageError(f"method is {shown_number(method)}: it must be 'exact' or 'propagation'")
    if method == "propagation":
        if not isinstance(seeds, SeedSet) or isinstance(frame, VoxelFrame):
            raise UsageError("method='propagation' applies to images only: a volume needs method='exact'")
        if max_distance is not None:
            raise UsageError("max_distance needs method='exact': the paper's propagation has no distance limit")
        if sides != SQUARE:
            raise UsageError("spacing needs method='exact': the paper's propagation needs square pixels of side 1")
        return PropagatedRows(seeds, frame, passes=passes, strict=strict, max_pixels=max_pixels, progress=progress)
    if whole_number(passes, "passes") != 2:
        raise UsageError(f"passes is {shown_number(passes)}, which needs method='propagation'")
    return Tessellator(
        seeds, frame, max_distance=max_distance, sides=sides, threads=threads, strict=strict, progress=progress
    )


def verify_rows(rows: Tessellator | PropagatedRows, *, threads: int = 0, progress: Progress = None) -> None:
    """Check every label against an independent exact nearest-seed search, band by band."""
    limit, sides = (rows.most_squared, rows.sides) if isinstance(rows, Tessellator) else (None, SQUARE)
    for first, count in band_limits(rows.frame, len(rows.seeds)):
        place = rows.frame.part(first, count)
        verify_labels(rows.labels(first, count), rows.seeds, place, max_distance2=limit, sides=sides, threads=threads)
        report(progress, (first + count) / rows.frame.shape[0])


def verify_tessellation(
    image: LabelImage | LabelVolume, *, max_distance: float | Fraction | None = None, threads: int = 0
) -> None:
    """Check that every pixel, or voxel, of a tessellation has the smallest label of its nearest seeds.

    Parameters
    ----------
    image : LabelImage or LabelVolume
        Result of `tessellate`, with its seeds and the sides of its pixels.
    max_distance : float or Fraction, optional
        The limit used for the tessellation.
    threads : int
        Number of threads; 0 uses all.

    Raises
    ------
    VerificationError
        If a label is wrong; the message names the first such pixel.
    UsageError
        If the image carries no seeds.

    Examples
    --------
    >>> verify_tessellation(tessellate([[0, 0], [2, 1]], shape=(2, 3)))
    """
    if not isinstance(image, LabelVolume):
        check_value(image, "image", "LabelImage")
    if not isinstance(image, LabelImage | LabelVolume) or image.seeds is None or image.frame is None:
        what = "volume" if isinstance(image, LabelVolume) else "image"
        raise UsageError(f"the label {what} carries no seeds: compute it with vorotool.tessellate")
    sides = image.sides
    limit = squared_limit(distance_as_written(max_distance, sides), image.seeds.scale / sides.step)
    verify_labels(image.labels, image.seeds, image.frame, max_distance2=limit, sides=sides, threads=threads)


_EXACT = option("--method exact", 'method="exact"')


def propagate(
    seeds: SeedSet,
    frame: Frame | None = None,
    *,
    passes: int = 2,
    progress: Progress = None,
) -> LabelImage:
    """Run the paper's two passes to the letter (section 2.2), with an implicit frame of zero labels."""
    if not is_choice(passes, (1, 2)):
        raise UsageError(f"passes is {shown_number(passes)}: it must be 1 or 2")
    require_seeds(seeds)
    frame = frame or default_frame(seeds)
    if seeds.scale != 1:
        raise InputError(f"the paper's propagation starts from pixels: round the seeds, or use {_EXACT}")
    x, y = seeds.x - frame.x, seeds.y - frame.y
    outside = np.flatnonzero((x < 0) | (y < 0) | (x >= frame.width) | (y >= frame.height))
    if outside.size:
        i = int(outside[0])
        raise InputError(
            f"{element('seed', i)} at ({seeds.x[i]}, {seeds.y[i]}) is outside the frame, and the paper's propagation "
            f"starts from its pixels: use a larger {option('--size', 'shape')} or {option('--window')}, or {_EXACT}"
        )
    labels = np.empty(frame.shape, np.uint32)
    _core.tessellation.propagate(x, y, seeds.labels, passes, labels, progress)
    return LabelImage(labels.astype(label_dtype(seeds.largest_label), copy=False), frame, seeds)


class PropagatedRows:
    """The paper's tessellation, held in memory, with the interface of `Tessellator` for its rows."""

    def __init__(
        self,
        seeds: SeedSet,
        frame: Frame | None = None,
        *,
        passes: int = 2,
        strict: bool = False,
        max_pixels: int = MAX_PIXELS,
        progress: Progress = None,
    ) -> None:
        require_seeds(seeds)
        self.seeds = seeds
        self.frame = frame or default_frame(seeds)
        require_memory(self.frame, max_pixels)
        self._labels = propagate(seeds, self.frame, passes=passes, progress=progress).labels
        with warnings.catch_warnings(action="ignore"):
            self._exact = Tessellator(seeds, self.frame)
        self.duplicates = self._exact.duplicates
        report_duplicates(self.duplicates, len(seeds), strict=strict)

    def labels(
        self, first: int = 0, rows: int | None = None, *, dtype: Any = None, out: NDArray[Any] | None = None
    ) -> NDArray[Any]:
        """Labels of some rows, as `Tessellator.labels` gives them."""
        found = self._labels[first : self.frame.height if rows is None else first + rows]
        if out is None:
            return found.astype(label_dtype(self.seeds.largest_label, dtype), copy=False)
        check_out(out, found.shape)
        label_dtype(self.seeds.largest_label, out.dtype)
        out[...] = found
        return out

    def compare_with_exact(self) -> dict[str, Any]:
        """Count the pixels that differ from the exact tessellation, and name the first in raster order."""
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
