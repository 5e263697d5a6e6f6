"""Points of space from whatever a caller holds."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from vorotool.convert.features import HeldFeatures, held_features
from vorotool.convert.tables import is_table, volume_points_of_table
from vorotool.errors import InputError
from vorotool.numeric.checks import is_masked_array
from vorotool.numeric.coordinates import number_array
from vorotool.numeric.descriptions import described, items_of, naming, refuse_paths
from vorotool.types.volumes.volume_points import VolumePoints
from vorotool.types.volumes.volume_seeds import VolumeSeeds

EXPECTED = (
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
        assert source.sites is not None  # VolumeSeeds has filled them in
        labels = None if source.site_labels is None else source.site_labels.astype(np.int64)
        return VolumePoints(source.sites, labels, source.properties, source.index)
    refuse_paths(source)
    if isinstance(source, Iterator):
        source = items_of(source)
    is_plain = isinstance(source, np.ndarray) and source.dtype.names is None and source.dtype.kind not in "OU"
    held = None if is_plain else held_features(source)
    if held is not None:
        return _of_features(held, source)
    if not is_plain and is_table(source):
        return volume_points_of_table(source)
    said = f"expected {EXPECTED}, but got {described(source)}"
    array = number_array(source, "point", said, axes=3)
    if array.size and (array.ndim != 2 or array.shape[1] != 3):
        raise InputError(said if hasattr(source, "shape") else f"{said} of shape {array.shape}")
    return VolumePoints(source if is_masked_array(source) else array)


def _of_features(held: HeldFeatures, source: Any) -> VolumePoints:
    """Points of shapely, each with a z."""
    import shapely

    said = f"expected {EXPECTED}, but got {described(source)}"
    if not held.is_all_shapely:
        raise InputError(said)
    wrong = np.flatnonzero((shapely.get_type_id(held.geometry) != 0) | ~shapely.has_z(held.geometry))
    if wrong.size:
        item = held.geometry[wrong[0]]
        what = (
            "None" if item is None else f"a {item.geom_type} without z" if item.geom_type == "Point" else item.geom_type
        )
        raise InputError(f"{said}: point {wrong[0] + 1} is {what}")
    xyz = shapely.get_coordinates(held.geometry, include_z=True)
    return VolumePoints(xyz, None, held.properties, held.index)
