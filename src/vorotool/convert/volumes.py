"""Volumes and their seeds from arrays."""

from __future__ import annotations

from typing import Any

import numpy as np

from vorotool.convert.features import HeldFeatures, held_features
from vorotool.convert.tables import is_table, volume_points_of_table
from vorotool.errors import InputError, LimitError, element
from vorotool.numeric.checks import (
    MAX_PIXELS,
    column_names,
    described,
    is_masked_array,
    items_of,
    naming,
    refuse_paths,
    unexpected,
)
from vorotool.numeric.coordinates import number_array
from vorotool.numeric.lazy import shapely
from vorotool.numeric.numbers import real_number
from vorotool.types.images import LabelImage, Raster
from vorotool.types.points.point_set import VolumePoints
from vorotool.types.volumes.volume import LabelVolume, Volume, VolumeSeeds

AXES = 3

EXPECTED = "a volume: a Volume, a LabelVolume, or a 3-D array of truth values or integers"


def is_volume(values: Any) -> bool:
    """Whether an array has three axes, of which the last one is not that of colors."""
    try:
        shape = np.shape(values) if isinstance(values, list | tuple) else getattr(values, "shape", ())
    except ValueError:  # lists of several lengths
        return False
    if not isinstance(shape, tuple):  # a module has functions of such names
        return False
    is_color = getattr(values, "dtype", None) == np.uint8 and shape[-1:] in ((3,), (4,))
    return len(shape) == AXES and not is_color


def is_of_space(source: Any, shape: Any = None, window: Any = None) -> bool:
    """Tell whether seeds are those of a volume: by their type, their shape, or what is asked for."""
    if isinstance(source, Volume | LabelVolume | VolumePoints | VolumeSeeds):
        return True
    if row_width(source) == 2:  # points of the plane, of which another shape is wrong
        return False
    for given, numbers in ((shape, AXES), (window, 2 * AXES)):
        if given is not None and np.ndim(given) == 1:
            return len(given) == numbers
    return hasattr(source, "shape") and is_volume(source)


def refuse_triples(source: Any, name: str, *, image: bool | None = None) -> None:
    """Refuse an array or a list of triples where no volume is asked for: they may be points."""
    if not image and row_width(source) == AXES:
        raise InputError(
            f"invalid {name}: expected shape (n, 2), but got {described(source)}: for points in space give shape=(D, "
            f"H, W) as well; {name}[:, :2] drops z"
        )


def row_width(source: Any) -> int | None:
    """How many numbers a row of a list of points has; None of what is none, as are tables and images by their type."""
    if column_names(source) is not None or isinstance(source, Raster | LabelImage):
        return None
    if isinstance(source, list | tuple) and source and isinstance(source[0], list | tuple | np.ndarray):
        return len(source[0]) if all(np.ndim(each) == 0 for each in source[0]) else None
    shape, kind = getattr(source, "shape", ()), getattr(getattr(source, "dtype", None), "kind", "f")
    return shape[1] if isinstance(shape, tuple) and len(shape) == AXES - 1 and kind in "iuf" else None


def as_volume(source: Any, name: str, *, is_gray: bool = False, max_pixels: int = MAX_PIXELS) -> Volume:
    """Give a volume from whatever holds it."""
    if isinstance(source, Volume):
        return source
    if isinstance(source, LabelVolume):
        return Volume(source.labels, source.grid)
    with naming(name):
        refuse_paths(source, texts=True)
        shape = getattr(source, "shape", None)
        if isinstance(shape, tuple) and len(shape) != AXES:
            raise unexpected(source, EXPECTED)
        if not isinstance(source, np.ndarray) and isinstance(shape, tuple):
            _check_size(shape, max_pixels)
        try:
            array = source if is_masked_array(source) else np.asarray(source)
        except (TypeError, ValueError):
            raise unexpected(source, EXPECTED) from None
        if array.ndim != AXES or array.dtype.kind not in "biuf":
            raise unexpected(source, EXPECTED)
        if array.dtype.kind == "f" and not is_gray:
            how = f"vorotool.seeds_from_volume({name}, threshold=…) takes gray values"
            raise InputError(f"expected truth values or integers, but got {described(array)}; {how}")
        return Volume(array)


def _check_size(shape: tuple[int, ...], max_pixels: int) -> None:
    depth, height, width = shape
    voxels = depth * height * width
    if voxels > real_number(max_pixels, "max_pixels"):
        raise LimitError(
            f"it has {width} x {height} x {depth} = {voxels} voxels, more than max_pixels {max_pixels}: the "
            "command line reads volumes of TIFF, NPY and Zarr slice by slice"
        )


POINTS_EXPECTED = (
    "points in space: an (n, 3) array of numbers, a data frame with columns x, y, z, or points of shapely with a z"
)


def as_volume_points(source: Any, name: str = "points") -> VolumePoints:
    """Give points of space from whatever holds them; the order is kept."""
    if isinstance(source, VolumePoints):
        return source
    with naming(name):
        return _points_of(source)


def _points_of(source: Any) -> VolumePoints:
    if isinstance(source, VolumeSeeds):
        labels = None if source.site_labels is None else source.site_labels.astype(np.int64)
        return VolumePoints(source.sites, labels, source.properties, source.index)
    refuse_paths(source)
    source = items_of(source)
    is_plain = isinstance(source, np.ndarray) and source.dtype.names is None and source.dtype.kind not in "OU"
    held = None if is_plain else held_features(source)
    if held is not None:
        return _of_features(held, source)
    if not is_plain and is_table(source):
        return volume_points_of_table(source)
    said = f"expected {POINTS_EXPECTED}, but got {described(source)}"
    array = number_array(source, "point", said, axes=3)
    if array.size and (array.ndim != 2 or array.shape[1] != 3):
        raise InputError(said if hasattr(source, "shape") else f"{said} of shape {array.shape}")
    return VolumePoints(source if is_masked_array(source) else array)


def _of_features(held: HeldFeatures, source: Any) -> VolumePoints:
    """Points of shapely, each with a z."""
    said = f"expected {POINTS_EXPECTED}, but got {described(source)}"
    if not held.is_all_shapely:
        raise InputError(said)
    wrong = np.flatnonzero((shapely.get_type_id(held.geometry) != 0) | ~shapely.has_z(held.geometry))
    if wrong.size:
        item = held.geometry[wrong[0]]
        what = (
            "None" if item is None else f"a {item.geom_type} without z" if item.geom_type == "Point" else item.geom_type
        )
        raise InputError(f"{said}: {element('point', wrong[0])} is {what}")
    xyz = shapely.get_coordinates(held.geometry, include_z=True)
    return VolumePoints(xyz, None, held.properties, held.index)
