"""Seeds from points and from images."""

from __future__ import annotations

import warnings
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError, UsageError, VorotoolWarning
from vorotool.geometry.frame import Frame
from vorotool.geometry.points import PointSet
from vorotool.geometry.raster import Raster
from vorotool.geometry.seeds import FINEST_SCALE, SeedSet

SeedMode = Literal["pixels", "components", "labels", "centroids"]

LARGEST_COORDINATE = float(2**44)
"""Coordinates up to here, times 256, are exact in a double."""

_LUMINANCE = (0.2125, 0.7154, 0.0721)
"""Weights of red, green and blue (ITU-R BT.709, as scikit-image has them)."""


def seeds_from_points(points: PointSet, *, strict: bool = False) -> SeedSet:
    """Put points on the lattice of seeds.

    Parameters
    ----------
    points : PointSet
        Coordinates in pixels. Multiples of 1/256 are kept exactly; finer ones move to the nearest multiple.
    strict : bool
        Refuse points that would have to move.

    Returns
    -------
    SeedSet
        One seed a point, on the coarsest lattice that holds all of them.

    Raises
    ------
    InputError
        If a coordinate is beyond 2^44, or ``strict`` and a point is finer than 1/256 pixel.

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
    far = np.flatnonzero((np.abs(points.xy) > LARGEST_COORDINATE).any(axis=1))
    if far.size:
        raise InputError(
            f"point {far[0] + 1} is ({points.xy[far[0], 0]:.17g}, {points.xy[far[0], 1]:.17g}): "
            f"coordinates of seeds must be at most 2^44 pixels; scale the points"
        )
    fine = points.xy * FINEST_SCALE
    steps = np.rint(fine)
    moved = (steps != fine).any(axis=1)
    snapped = int(moved.sum())
    largest_move = 0.0
    if snapped:
        largest_move = float(np.hypot(*(fine - steps).T).max()) / FINEST_SCALE
        _report_snapped(points, moved, largest_move, strict=strict)
    lattice = steps.astype(np.int64)
    scale = _coarsest_scale(lattice)
    lattice //= FINEST_SCALE // scale
    labels = points.label_array.astype(np.uint32)
    return SeedSet(
        lattice[:, 0],
        lattice[:, 1],
        labels,
        scale=scale,
        snapped=snapped,
        largest_move=largest_move,
        **_sites_of_points(lattice / scale, labels, points),
    )


def _sites_of_points(xy: NDArray[np.float64], labels: NDArray[np.uint32], points: PointSet) -> dict[str, Any]:
    """Sites in increasing label order; points that share a label leave the choice to SeedSet."""
    if points.labels is None:
        return {"sites": xy, "site_labels": labels, "properties": points.properties}
    order = np.argsort(labels, kind="stable")
    if len(labels) and (np.diff(labels[order].astype(np.int64)) == 0).any():
        if points.properties:
            raise InputError("points that share a label cannot bring further columns: use --no-properties")
        return {}
    properties = {name: [column[i] for i in order] for name, column in points.properties.items()}
    return {"sites": xy[order], "site_labels": labels[order], "properties": properties}


def _report_snapped(points: PointSet, moved: NDArray[np.bool_], largest: float, *, strict: bool) -> None:
    count = int(moved.sum())
    if strict:
        row = int(np.flatnonzero(moved)[0])
        raise InputError(
            f"point {row + 1} is ({points.xy[row, 0]}, {points.xy[row, 1]}): seeds lie on multiples of 1/256 pixel "
            f"({count} such points); round them or leave out --strict"
        )
    warnings.warn(
        f"{count} of {len(points)} seeds moved to the nearest 1/256 pixel, by at most {largest:.6f} pixels",
        VorotoolWarning,
        stacklevel=4,
    )


def _coarsest_scale(lattice: NDArray[np.int64]) -> int:
    """The smallest power of two of steps a pixel for coordinates given in 1/256 pixel."""
    used = int(np.bitwise_or.reduce(lattice, axis=None)) & (FINEST_SCALE - 1)
    return FINEST_SCALE // (used & -used) if used else 1


def seeds_from_raster(
    raster: Raster,
    *,
    mode: SeedMode | None = None,
    connectivity: int = 8,
    threshold: float | Literal["otsu"] | None = None,
    invert: bool = False,
    strict: bool = False,
) -> SeedSet:
    """Take seeds from an image.

    Parameters
    ----------
    raster : Raster
        Nonzero pixels are foreground.
    mode : {"pixels", "components", "labels", "centroids"}, optional
        What shares a label: nothing, a connected component, or all pixels of one value; or one seed at the
        centroid of each component or label. By default components of an image of two values, else labels.
    connectivity : {8, 4}
        Neighbourhood of components.
    threshold : float or "otsu", optional
        Foreground is what is larger.
    invert : bool
        Exchange foreground and background.
    strict : bool
        Refuse centroids that would have to move to the lattice of 1/256 pixel.

    Returns
    -------
    SeedSet
        Seeds with the image's frame. Pixels and components are numbered by raster order of their first pixel.

    Raises
    ------
    InputError
        If there is no foreground, or the image looks like a photograph and no threshold is given.
    UsageError
        If options do not go together.

    Examples
    --------
    >>> seeds_from_raster(Raster(np.array([[1, 0, 1], [0, 0, 1]]))).labels.tolist()
    [1, 2, 2]
    """
    if connectivity not in (4, 8):
        raise UsageError(f"connectivity is {connectivity}: it must be 4 or 8")
    values = _foreground_values(raster, threshold, invert=invert)
    mode = mode or _default_mode(values)
    frame = Frame(0, 0, values.shape[1], values.shape[0])
    if mode == "pixels":
        y, x = np.nonzero(values)
        _require_foreground(len(x))
        labels = np.arange(1, len(x) + 1, dtype=np.uint32)
        sites = np.stack([x, y], axis=1).astype(np.float64)
        return SeedSet(x, y, labels, frame=frame, sites=sites, site_labels=labels)
    by_value = mode == "labels" or (mode == "centroids" and _default_mode(values) == "labels")
    objects = _checked_label_values(values) if by_value else _components(values, connectivity)
    return _seeds_of_objects(objects, frame, centroids_only=mode == "centroids", strict=strict)


def _foreground_values(raster: Raster, threshold: Any, *, invert: bool) -> NDArray[Any]:
    values = raster.values
    if threshold is not None:
        grey = _grey(raster)
        values = grey > (_otsu(grey) if threshold == "otsu" else threshold)
    elif raster.is_colour:
        raise InputError("a colour image holds no seeds by itself: use --threshold T or --threshold otsu")
    if values.dtype.kind == "f" and not np.isfinite(values).all():
        raise InputError("the image holds NaN or infinite values: use --threshold T, a number, or repair them")
    return values == 0 if invert else values


def _grey(raster: Raster) -> NDArray[Any]:
    """Luminance of a colour image; transparency does not count."""
    values = raster.values
    if not raster.is_colour:
        return values
    return values[:, :, :3] @ np.array(_LUMINANCE) if values.shape[2] > 2 else values[:, :, 0]


def _otsu(grey: NDArray[Any]) -> float:
    from skimage.filters import threshold_otsu

    if grey.dtype.kind == "f" and not np.isfinite(grey).all():
        raise InputError("the image holds NaN or infinite values: use --threshold T, a number, or repair them")
    if grey.min() == grey.max():
        raise InputError(f"all pixels have the value {grey.flat[0]}: --threshold otsu needs two values")
    return float(threshold_otsu(grey))


def _default_mode(values: NDArray[Any]) -> SeedMode:
    """Two values of which one is 0 are a mask; more are labels, unless they look like a photograph."""
    if values.dtype == bool:
        return "components"
    nonzero = values[values != 0]
    if nonzero.size == 0 or (nonzero.min() == nonzero.max() and nonzero.size < values.size):
        return "components"
    _refuse_photograph(values)
    return "labels"


def _refuse_photograph(values: NDArray[Any]) -> None:
    """A label image has about as many fragments as labels; a photograph falls into far more."""
    from skimage.measure import label

    distinct = len(np.unique(values))
    fractional = values.dtype.kind == "f" and bool((values != np.floor(values)).any())
    fragments = distinct if fractional else int(label(values.astype(np.int64), connectivity=1).max())
    if fractional or (fragments > 4 * distinct and fragments > 256):
        raise InputError(
            f"the image holds {distinct} values in {fragments} fragments: a photograph? use --threshold otsu, "
            f"or --seeds labels if these are labels"
        )


def _checked_label_values(values: NDArray[Any]) -> NDArray[np.int64]:
    labels = values.astype(np.int64)
    if (labels != values).any() or labels.min() < 0 or labels.max() > 0xFFFFFFFF:
        bad = values[(labels != values) | (labels < 0) | (labels > 0xFFFFFFFF)].flat[0]
        raise InputError(f"the image holds the value {bad}: labels must be integers from 0 to 4294967295")
    return labels


def _components(values: NDArray[Any], connectivity: int) -> NDArray[np.int64]:
    from skimage.measure import label

    components: NDArray[np.int64] = label(values != 0, connectivity=2 if connectivity == 8 else 1)
    return components


def _require_foreground(count: int) -> None:
    if count == 0:
        raise InputError("the image has no foreground, so nothing could be labelled: use --invert or --threshold")


def _counted(values: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """Distinct labels, the index of each pixel's, and the pixels of each: by a table unless labels are sparse."""
    if values.max() > 4 * values.size + 65536:
        return np.unique(values, return_inverse=True, return_counts=True)
    counts = np.bincount(values)
    labels = np.flatnonzero(counts)
    return labels, (np.cumsum(counts > 0) - 1)[values], counts[labels]


def _seeds_of_objects(objects: NDArray[np.int64], frame: Frame, *, centroids_only: bool, strict: bool) -> SeedSet:
    """Seeds of a label image: all pixels of each label, or its centroid."""
    y, x = np.nonzero(objects)
    _require_foreground(len(x))
    labels, index, area = _counted(objects[y, x])
    # Sums of coordinates stay below 2^53, so the centroid is the rounded quotient of two exact integers.
    sites = np.stack([np.bincount(index, weights=x) / area, np.bincount(index, weights=y) / area], axis=1)
    site_labels = labels.astype(np.uint32)
    area = area.astype(np.int64)
    if not centroids_only:
        return SeedSet(
            x,
            y,
            site_labels[index],
            frame=frame,
            sites=sites,
            site_labels=site_labels,
            object_area=area,
        )
    seeds = seeds_from_points(PointSet(sites, labels), strict=strict)
    return SeedSet(
        seeds.x,
        seeds.y,
        seeds.labels,
        scale=seeds.scale,
        frame=frame,
        sites=sites,
        site_labels=site_labels,
        object_area=area,
        snapped=seeds.snapped,
        largest_move=seeds.largest_move,
    )
