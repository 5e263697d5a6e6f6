"""Seeds from points and from images."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import reduce
from math import ceil, floor
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, get_args

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.tessellation.cleaned_masks import Cleaning, cleaned_values
from vorotool.engines.tessellation.raster_objects import (
    LARGEST_LABEL,
    Note,
    check_objects,
    default_objects,
    foreground_values,
    label_values,
    numbered_components,
    report_no_foreground,
)
from vorotool.errors import STRICT, InputError, LimitError, element, option, warn
from vorotool.numeric.checks import index_of_rows
from vorotool.numeric.curves.inverse_functions import hypotenuse
from vorotool.numeric.numbers import whole_number
from vorotool.types.arguments import check_value
from vorotool.types.pixels import CELL, SQUARE, Frame, PixelSides
from vorotool.types.points.point_set import PointSet
from vorotool.types.points.seed_set import SCALES, SeedSet
from vorotool.types.values import counted
from vorotool.types.volumes.volume import FINEST_SCALE

if TYPE_CHECKING:
    from vorotool.types.points.point_set import PointSet, VolumePoints
    from vorotool.typing import ImageLike, PointsLike, RealLike

_CENTROIDS = option("--seeds centroids", 'mode="centroids"')

SeedMode = Literal["pixels", "components", "labels", "centroids"]

COUNTED = 1 << 22
"""Entries that are counted at a time."""

FrameOf = Frame | Callable[[SeedSet], Frame | None] | None
"""The frame that seeds are for, or a function that returns it, or raises an error for seeds that cannot be used."""


def seeds_from_points(points: PointsLike, *, frame: Frame | None = None, strict: bool = False) -> SeedSet:
    """Convert points to seeds on a lattice.

    Parameters
    ----------
    points : PointSet, array, data frame, GeoSeries, …
        As `delaunay` takes them; coordinates in pixels. What is finer than the finest lattice of the frame, 2^-31 pixel
        for 512 x 512 pixels, moves to the nearest multiple of its step.
    frame : Frame, optional
        The whole image that is to be labeled; by default the least one at the origin that holds the points.
    strict : bool
        Refuse points that would have to move.

    Returns
    -------
    SeedSet
        One seed a point, on the coarsest lattice that holds all of them.

    Raises
    ------
    InputError
        If a coordinate is beyond 2^44, or ``strict`` and a point is finer than the lattice.

    Warns
    -----
    VorotoolWarning
        If points were moved: how many, and the largest move.

    Examples
    --------
    >>> seeds = seeds_from_points(PointSet([[0.5, 2], [7, 5]]))
    >>> seeds.scale, seeds.x.tolist()
    (2, [1, 14])
    """
    if frame is not None:
        check_value(frame, "frame", "Frame")
    from vorotool.convert.points import as_points

    return seeds_in_frame(as_points(points), frame, strict=strict)


def seeds_in_frame(points: PointSet, frame: FrameOf, *, sides: PixelSides = SQUARE, strict: bool = False) -> SeedSet:
    """Put points on the lattice of the frame that they need: see `seeds_from_points`."""
    whole, needed = None, frame if isinstance(frame, Frame) else least_frame(points.xy)
    while needed != whole:  # again, where a seed that decides on the frame moved, or the frame is another one
        whole = needed
        seeds, snapped = _on_lattice(points, finest_scale(points.xy, whole, sides), strict=strict)
        needed = (frame(seeds) if callable(frame) else frame) or least_frame(points.xy)
    report_snapped(points.xy, snapped, strict=strict)
    return seeds


def _on_lattice(points: PointSet, finest: int, *, strict: bool) -> tuple[SeedSet, SnappedPlaces]:
    """Put points on a lattice with at most so many steps a pixel."""
    snapped = snapped_places(points.xy, finest)
    labels = points.label_array.astype(np.uint32)
    seeds = SeedSet(
        snapped.steps[:, 0],
        snapped.steps[:, 1],
        labels,
        scale=snapped.scale,
        snapped=snapped.moves,
        largest_move=snapped.largest_move,
        y_axis=points.y_axis,
        **sites_of_points(points.xy, labels, points, strict=strict),
    )
    return seeds, snapped


def seeds_from_raster(
    raster: ImageLike,
    *,
    mode: SeedMode | None = None,
    connectivity: int = 8,
    threshold: float | Literal["otsu"] | None = None,
    invert: bool = False,
    min_area: RealLike | None = None,
    fill_holes: bool | RealLike = False,
    strict: bool = False,
    max_sites: int = LARGEST_LABEL,
    note: Note = None,
) -> SeedSet:
    """Extract seeds from an image.

    Parameters
    ----------
    raster : Raster, LabelImage, or (H, W) array of any library
        Nonzero pixels are foreground.
    mode : {"pixels", "components", "labels", "centroids"}, optional
        What shares a label: nothing, a connected component, or all pixels of one value; or one seed at the
        centroid of each component or label. By default components of a mask, whose only value besides 0 is 1, 255,
        the largest of its type, or True; else labels.
    connectivity : {8, 4}
        Neighborhood of components.
    threshold : float or "otsu", optional
        Pixels above the threshold are foreground.
    invert : bool
        Exchange foreground and background.
    min_area : number, optional
        Leave out objects of a mask with fewer pixels, their filled holes included.
    fill_holes : bool or number
        Whether to fill the holes of the objects of a mask first; a number fills those of at most so many pixels.
    strict : bool
        Refuse an image without foreground, and centroids that would have to move to the lattice of seeds.
    max_sites : int
        More seeds, which are the foreground pixels unless centroids are taken, are refused before memory is allocated
        for them.
    note : callable, optional
        Called with a text if an image was taken for a mask or for labels and that may surprise.

    Returns
    -------
    SeedSet
        Seeds with the image's frame. Pixels and components are numbered by raster order of their first pixel.

    Raises
    ------
    InputError
        If the image looks like a photograph and no threshold is given, or holds labels where a mask is to be cleaned;
        or there is no foreground, and `strict`.
    LimitError
        If there are more seeds than `max_sites`.
    UsageError
        If options contradict each other.

    Warns
    -----
    VorotoolWarning
        If there is no foreground, hence no seed.

    Examples
    --------
    >>> seeds_from_raster(np.array([[1, 0, 1], [0, 0, 1]])).labels.tolist()
    [1, 2, 2]
    """
    from vorotool.convert.images import as_raster

    check_objects(mode, get_args(SeedMode), connectivity)
    max_sites = whole_number(max_sites, "max_sites")
    raster = as_raster(raster, "raster", is_gray=True)
    values = foreground_values(raster, threshold, invert=invert)
    frame = Frame(0, 0, values.shape[1], values.shape[0])
    if cleaning := Cleaning.of(min_area, fill_holes):
        values = cleaned_values(values, cleaning, mode, connectivity=connectivity, missing=raster.mask).mask
    if not values.any():
        report_no_foreground(strict=strict)
        return replace(_no_seeds(frame, has_objects=mode != "pixels"), y_axis=raster.y_axis, grid=raster.grid)
    kind = default_objects(values, note=note) if mode in (None, "centroids") else mode
    if kind == "pixels":
        x, y = _foreground(values, max_sites)
        labels = np.arange(1, len(x) + 1, dtype=np.uint32)
        sites = np.stack([x, y], axis=1).astype(np.float64)
        return SeedSet(
            x, y, labels, frame=frame, sites=sites, site_labels=labels, y_axis=raster.y_axis, grid=raster.grid
        )
    objects = label_values(values) if kind == "labels" else numbered_components(values, connectivity)
    made = _seeds_of_objects(objects, frame, centroids_only=mode == "centroids", max_sites=max_sites, strict=strict)
    return replace(made, y_axis=raster.y_axis, grid=raster.grid)


def _no_seeds(frame: Frame, *, has_objects: bool) -> SeedSet:
    """Of an image without foreground; with the columns that others have."""
    nothing = np.empty(0, dtype=np.int64)
    labels = np.empty(0, np.uint32)
    area = nothing if has_objects else None
    return SeedSet(nothing, nothing, labels, frame=frame, sites=np.empty((0, 2)), site_labels=labels, object_area=area)


def _foreground(objects: NDArray[Any], most: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Columns and rows of the nonzero pixels, in raster order; counted before memory is taken for them."""
    count = int(np.count_nonzero(objects))
    if count > most:
        raise LimitError(
            f"the image has {count} foreground pixels, more than {option(f'--max-sites {most}')}: use "
            f"{_CENTROIDS}, or a larger limit"
        )
    x = np.flatnonzero(objects)
    width = objects.shape[1]
    y = x // width
    x -= y * width
    return x, y


def _seeds_of_objects(
    objects: NDArray[Any], frame: Frame, *, centroids_only: bool, max_sites: int, strict: bool
) -> SeedSet:
    """Seeds of a label image: all pixels of each label, or its centroid."""
    x, y = _foreground(objects, objects.size if centroids_only else max_sites)
    labels = objects[y, x].astype(np.uint32, copy=False)
    distinct, index = numbered(labels)
    area = sums(index, len(distinct))
    # Sums of coordinates stay below 2^53, so the centroid is the rounded quotient of two exact integers.
    sites = np.stack([sums(index, len(distinct), weights) / area for weights in (x, y)], axis=1)
    known: dict[str, Any] = {
        "frame": frame,
        "sites": sites,
        "site_labels": distinct.astype(np.uint32),
        "object_area": area,
    }
    if not centroids_only:
        return SeedSet(x, y, labels, **known)
    if len(distinct) > max_sites:
        raise LimitError(f"the image has {len(distinct)} objects, more than {option(f'--max-sites {max_sites}')}")
    seeds = seeds_in_frame(PointSet(sites, distinct), frame, strict=strict)
    return replace(seeds, properties={}, index=None, **known)


def moved_to(seeds: Any, frame: Any) -> Any:
    """Move the seeds of an image or a volume to where its frame is."""
    origin = np.array(frame.origin)
    if not origin.any():
        return seeds
    moved = [values + start * seeds.scale for values, start in zip(seeds.coordinates, frame.origin, strict=True)]
    places = dict(zip("xy", moved, strict=True)) if len(moved) == 2 else {"places": np.array(moved).T}
    return replace(seeds, **places, sites=seeds.sites + origin, frame=frame)


# ---- sums by label over long lists, without copies of them


def numbered(labels: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
    """Give the distinct labels, and the index of each one among them: by a table unless the labels are sparse."""
    largest = int(labels.max())
    if largest > 4 * labels.size + 65536:
        return np.unique(labels, return_inverse=True)
    present = np.zeros(largest + 1, bool)
    for part in parts(len(labels), COUNTED):
        present[labels[part]] = True
    distinct = np.flatnonzero(present)
    if len(distinct) == largest:
        return distinct, labels - labels.dtype.type(1)  # labels 1 to n: the commonest
    return distinct, (np.cumsum(present, dtype=np.uint32) - np.uint32(1))[labels]


def parts(count: int, size: int) -> Iterator[slice]:
    """Cut a list of so many into slices of a size."""
    for start in range(0, count, size):
        yield slice(start, start + size)


def sums(index: NDArray[Any], kinds: int, weights: NDArray[Any] | None = None) -> NDArray[Any]:
    """Give the sums of weights by index, part by part: NumPy would copy all of both to 64 bits."""
    total = np.zeros(kinds, np.int64 if weights is None else np.float64)
    for part in parts(len(index), max(COUNTED, kinds)):
        total += np.bincount(index[part], None if weights is None else weights[part], minlength=kinds)
    return total


LARGEST_COORDINATE = float(2**44)
"""Coordinates up to here, times 256, are exact in a double."""

_MOST_STEPS = 2**40
"""The bound of the exact arithmetic: see `src/core/tessellation/sweep_arithmetic.hpp`."""

_MOST_COUNTED = 2**61
"""Coordinates in steps, seen from the origin, stay below: sums of them fit 64 bits."""

_LARGE_MOVE = 2.0**-20
"""Seeds of decimals move by less, in pixels or voxels, where the lattice is not coarse for the frame."""


class SnappedPlaces(NamedTuple):
    """Places on the coarsest lattice that holds them."""

    steps: NDArray[np.int64]  # (n, axes) int64 array: in steps of 1 / `scale`
    scale: int  # a power of two, at most `finest`
    moved: NDArray[np.bool_]  # (n,) bool array: which of them lay on none of these lattices
    largest_move: float  # the largest of their moves, in pixels or voxels
    finest: int  # the steps a pixel or voxel of the finest of these lattices

    @property
    def moves(self) -> int:
        """How many were moved."""
        return int(self.moved.sum())


def finest_scale(places: NDArray[np.float64], frame: Frame, sides: PixelSides = SQUARE) -> int:
    """Give the steps a pixel of the finest lattice on which a tessellation is computed exactly."""
    low, high = (frame.x, frame.y), (frame.x + frame.width, frame.y + frame.height)
    of_frame = _scale_within(low, high, sides)
    if len(places):
        low = (min(low[0], floor(places[:, 0].min())), min(low[1], floor(places[:, 1].min())))
        high = (max(high[0], ceil(places[:, 0].max())), max(high[1], ceil(places[:, 1].max())))
    return max(_scale_within(low, high, sides), min(of_frame, FINEST_SCALE))


def _scale_within(low: tuple[int, int], high: tuple[int, int], sides: PixelSides) -> int:
    """Give the largest power of two of steps a pixel for a box of pixels."""
    extent = max((b - a) * side for a, b, side in zip(low, high, (sides.x, sides.y), strict=True))
    most: int = min(_MOST_STEPS // extent, _MOST_COUNTED // max(map(abs, low + high)))
    return SCALES[max(most.bit_length() - 1, 0)]


def least_frame(places: NDArray[np.float64]) -> Frame:
    """Give the frame that is likely to be asked for later: the least at the origin that holds the points."""
    low = [min(floor(column.min(initial=0)), 0) for column in places.T]
    high = [floor(column.max(initial=0) + 0.5) + 1 for column in places.T]
    return Frame(low[0], low[1], high[0] - low[0], high[1] - low[1])


def on_coarser_lattice(seeds: Any, frame: Any, sides: PixelSides, *, strict: bool) -> Any:
    """Give seeds of a lattice that is too fine for a frame on the finest one that is not."""
    if seeds.scale <= FINEST_SCALE or not len(seeds):
        return seeds
    places = np.stack([seeds.x, seeds.y], axis=1) / seeds.scale
    finest = finest_scale(places, frame, sides)
    if seeds.scale <= finest:
        return seeds
    snapped = snapped_places(places, finest)
    report_snapped(places, snapped, strict=strict)
    return replace(
        seeds,
        x=snapped.steps[:, 0],
        y=snapped.steps[:, 1],
        scale=snapped.scale,
        snapped=max(seeds.snapped, snapped.moves),
        largest_move=seeds.largest_move + snapped.largest_move,
    )


def snapped_places(places: NDArray[np.float64], finest: int = FINEST_SCALE) -> SnappedPlaces:
    """Put places on the lattice; what is finer than its steps moves to the nearest multiple."""
    far = np.flatnonzero((np.abs(places) > LARGEST_COORDINATE).any(axis=1))
    if far.size:
        raise InputError(
            f"{element('point', far[0])} is ({', '.join(f'{each:.17g}' for each in places[far[0]].tolist())}): "
            f"coordinates of seeds must be at most 2^44 {CELL[places.shape[1]]}s; scale the points"
        )
    fine = places * finest
    steps = np.rint(fine)
    moved = (steps != fine).any(axis=1)
    largest_move = 0.0
    if moved.any():
        moves = fine - steps
        largest = moves[int(np.argmax(sum(column * column for column in moves.T)))]
        largest_move = float(reduce(hypotenuse, largest)) / finest
    lattice = steps.astype(np.int64)
    scale = _coarsest_scale(lattice, finest)
    lattice //= finest // scale
    return SnappedPlaces(lattice, scale, moved, largest_move, finest)


def sites_of_points(
    places: NDArray[np.float64], labels: NDArray[np.uint32], points: PointSet | VolumePoints, *, strict: bool
) -> dict[str, Any]:
    """Give the sites in increasing label order; points that share a label leave the choice to the type of the seeds."""
    if points.labels is None:
        return {"sites": places, "site_labels": labels, "properties": points.properties, "index": points.index}
    order = np.argsort(labels, kind="stable")
    if len(labels) and (np.diff(labels[order].astype(np.int64)) == 0).any():
        return {"properties": _columns_of_regions(points.properties, labels, order, strict=strict)}
    properties = {name: [column[i] for i in order] for name, column in points.properties.items()}
    index = index_of_rows(points.index, order)
    return {"sites": places[order], "site_labels": labels[order], "properties": properties, "index": index}


def _columns_of_regions(
    columns: Mapping[str, Sequence[Any]], labels: NDArray[np.uint32], order: NDArray[np.integer], *, strict: bool
) -> dict[str, list[Any]]:
    """Return columns with one value a label, in the order of labels: those in which points of a label agree."""
    ordered = labels[order]
    first = order[np.searchsorted(ordered, ordered)]
    chosen = order[np.flatnonzero(np.diff(ordered, prepend=0))]
    kept = {
        name: [column[i] for i in chosen.tolist()]
        for name, column in columns.items()
        if all(column[a] == column[b] for a, b in zip(order.tolist(), first.tolist(), strict=True))
    }
    if len(kept) < len(columns):
        dropped = ", ".join(name for name in columns if name not in kept)
        what = f"points of one label differ in {dropped}"
        if strict:
            raise InputError(f"{what}: remove these columns, or leave out {STRICT}")
        warn(f"{what}: these columns are dropped from the results")
    return kept


def report_snapped(places: NDArray[np.float64], snapped: SnappedPlaces, *, strict: bool) -> None:
    """Refuse places that moved to the lattice, or warn if one moved far; the seeds have the count in any case."""
    count, cell = snapped.moves, CELL[places.shape[1]]
    step = f"1/{snapped.finest}" if snapped.finest <= FINEST_SCALE else f"2^-{snapped.finest.bit_length() - 1}"
    if not count:
        return
    if strict:
        row = int(np.flatnonzero(snapped.moved)[0])
        raise InputError(
            f"{element('point', row)} is ({', '.join(map(str, places[row].tolist()))}): seeds lie on multiples of "
            f"{step} {cell} ({counted(count, 'such point')}); round them or leave out {STRICT}"
        )
    if snapped.largest_move >= _LARGE_MOVE:
        warn(
            f"{count} of {len(places)} seeds moved to the nearest {step} {cell}, by at most "
            f"{snapped.largest_move:.2g} {cell}s"
        )


def _coarsest_scale(lattice: NDArray[np.int64], finest: int) -> int:
    """Give the smallest power of two of steps a pixel for coordinates in the finest ones."""
    used = int(np.bitwise_or.reduce(lattice, axis=None)) & (finest - 1)
    return finest // (used & -used) if used else 1
