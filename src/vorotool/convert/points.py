"""Points from whatever a caller holds: one conversion for all functions."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.convert.features import HeldFeatures, held_features, is_shapely, joined_parts, report_missing
from vorotool.convert.tables import columns_of_features, is_table, points_of_table
from vorotool.errors import InputError, element, warn
from vorotool.numeric.checks import (
    described,
    index_of_rows,
    is_masked_array,
    items_of,
    naming,
    refuse_paths,
    unexpected,
)
from vorotool.numeric.coordinates import MOST_AXES, number_array
from vorotool.numeric.crs import note_degrees
from vorotool.numeric.lazy import shapely
from vorotool.numeric.numbers import pair_of_doubles, shown_number
from vorotool.products.registry import is_of
from vorotool.types.points.point_set import LABEL, PointSet, labels_of
from vorotool.types.polygons.shapely_geometry import part_numbers, single_points

_PAIRS, PAIRS_OR_TRIPLES = "(n, 2)", "(n, 2) or, in space, (n, 3)"
"""Shapes of arrays that functions take."""


def as_points(source: Any, name: str = "points", *, shapes: str = _PAIRS) -> PointSet:
    """Give points from whatever holds them; the order is kept. Messages name the shapes that the caller takes."""
    if isinstance(source, PointSet):
        return source
    with naming(name):
        return _points_of(source, name, shapes)


def as_place(source: Any, name: str) -> tuple[float, float]:
    """Give one place: of two numbers, or of a point in any form."""
    if not (isinstance(source, str | Mapping | PointSet) or is_shapely(source) or hasattr(source, "crs")):
        return pair_of_doubles(source, name)
    points = as_points(source, name)
    if len(points) != 1:
        raise InputError(f"invalid {name}: expected one point, but got {len(points)}")
    return float(points.xy[0, 0]), float(points.xy[0, 1])


def _points_of(source: Any, name: str, shapes: str) -> PointSet:
    if isinstance(source, np.ndarray) and source.dtype.names is None and source.dtype.kind not in "OU":
        return PointSet(_checked(source, name, shapes))
    if is_of(source, "SeedSet"):
        labels = None if source.site_labels is None else source.site_labels.astype(np.int64)
        frame = None if source.frame is None else source.frame.box
        return PointSet(source.sites, labels, source.properties, y_axis=source.y_axis, index=source.index, frame=frame)
    if is_of(source, "PolygonSet"):
        raise InputError("these are polygons or lines: give points, for example their centroids or vertices")
    if is_of(source, "Raster", "LabelImage"):
        raise unexpected(source, f"points; for an image use vorotool.seeds_from_raster({name})")
    refuse_paths(source)
    source = items_of(source)
    held = held_features(source)
    if held is not None:
        points = _points_of_features(held)
        note_degrees(points, name, warn)
        return points
    if is_table(source):
        return points_of_table(source, name)
    return PointSet(_checked(source, name, shapes))


# ---- arrays ----------------------------------------------------------------------------------------
def _checked(source: Any, name: str, shapes: str) -> NDArray[Any]:
    """Give an array of numbers whose shape is that of points, or say what to give."""
    if type(source) is np.ndarray and source.dtype.kind in "iuf" and source.ndim == 2 and source.shape[1] == 2:
        return source
    others = "a data frame with columns x, y, or points of shapely, geopandas, GeoJSON or WKT"
    expected = f"an {shapes} array of numbers, {others}"
    if isinstance(source, Mapping | str | bytes) or not (isinstance(source, Iterable) or hasattr(source, "__array__")):
        raise unexpected(source, expected)
    pairs = source if hasattr(source, "dtype") else _pairs(source)
    try:
        array = number_array(pairs, "point", f"expected {expected}, but got {described(source)}")
    except InputError as error:
        raise InputError(f"{error.marked}{_unevenness(pairs)}") from None
    shape = array.shape
    if array.size == 0 or (array.ndim == 2 and shape[1] == 2):
        return pairs if is_masked_array(pairs) else array
    said = f"expected shape {shapes}, but got {described(source if hasattr(source, 'shape') else array)}"
    if shape == (2,):
        raise InputError(f"{said}: one point is [[x, y]]")
    if array.ndim == 2 and shape[1] == 3:
        raise InputError(f"{said}: points have two coordinates; {name}[:, :2] drops the others")
    if array.ndim == 2 and (shape[0] == 2 or (shape[0] == 3 and shapes != _PAIRS)):
        raise InputError(f"{said}: give {name}.T")
    if array.ndim == 2 and min(shape) > MOST_AXES:
        raise InputError(f"{said}: for an image use vorotool.seeds_from_raster({name})")
    raise InputError(said)


def _unevenness(items: Any) -> str:
    """Name the first item of a list that has another number of coordinates than the first, if there is one."""
    counts = [len(each) if isinstance(each, list | tuple) else 1 for each in items] if isinstance(items, list) else []
    other = next((k for k, count in enumerate(counts) if count != counts[0]), None)
    return "" if other is None else f", in which point [0] has {counts[0]} numbers and point [{other}] {counts[other]}"


def _pairs(source: Any) -> Any:
    """Give a list in which points of shapely are pairs of numbers, as the others are."""
    items = list(source) if isinstance(source, Iterable) else np.asarray(source)
    if isinstance(items, list) and any(map(is_shapely, items)):
        return [_position(item, element("point", number)) for number, item in enumerate(items)]
    return items


def _position(point: Any, place: str) -> Any:
    if not is_shapely(point):
        return point
    if point.geom_type != "Point" or point.is_empty:
        raise _no_point(f"{'an empty' if point.is_empty else 'a'} {point.geom_type}", place)
    return point.x, point.y


def _no_point(what: str, place: str) -> InputError:
    return InputError(f"{place} is {what}: give points, such as the centroid or the vertices of a polygon or line")


# ---- features --------------------------------------------------------------------------------------
def _points_of_features(held: HeldFeatures) -> PointSet:
    xy, owners = _positions(held)
    if not held.is_map:  # what has an index says itself which are left out
        report_missing(held, owners)
    properties = {name: [values[k] for k in owners.tolist()] for name, values in held.properties.items()}
    ids = None if held.ids is None else [held.ids[k] for k in owners.tolist()]
    properties = columns_of_features(ids, properties, part_numbers(owners).tolist() if held.is_map else [])
    index = index_of_rows(held.index, owners)
    labels = labels_of(properties[LABEL]) if LABEL in properties else None
    if labels is not None:
        del properties[LABEL]
    return PointSet(xy, labels, properties, y_axis=held.y_axis, crs=held.crs, index=index)


def _positions(held: HeldFeatures) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Coordinates of all points, and the feature of each."""
    if held.is_all_shapely:
        return _positions_of_geometry(held)
    positions, owners = [], []
    for number, item in enumerate(held.items):
        place = element("point", number)
        found = list(_positions_of(item, place))
        positions.extend(found)
        owners.extend([number] * len(found))
    return number_array(positions, "point"), np.array(owners, dtype=np.int64)


def _positions_of_geometry(held: HeldFeatures) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    geometry = held.geometry
    there = ~shapely.is_missing(geometry) & ~shapely.is_empty(geometry)
    kept = np.flatnonzero(there)
    parts, items = geometry[kept], kept
    while len(parts):
        wrong = np.flatnonzero(~np.isin(shapely.get_type_id(parts), (0, 4, 7)))
        if wrong.size:
            raise _no_point(f"a {parts[wrong[0]].geom_type}", element("point", items[wrong[0]]))
        nested = shapely.get_type_id(parts) == 7
        parts, index = shapely.get_parts(parts[nested], return_index=True)
        items = items[nested][index]
    points, owners = single_points(geometry[kept])
    return shapely.get_coordinates(points), kept[owners]


def _positions_of(item: Any, place: str) -> Iterator[Any]:
    """Give the positions of one item: of shapely, of GeoJSON, or a pair of numbers among these."""
    if item is None:
        return
    if is_shapely(item):
        xy, _ = _positions_of_geometry(HeldFeatures([item], is_map=True))
        yield from xy.tolist()
    elif isinstance(item, Mapping):
        for kind, coordinates in joined_parts(item):
            if kind != "Point":
                raise _no_point(f"a {kind}", place)
            if not isinstance(coordinates, Sequence | np.ndarray) or len(coordinates) < 2:
                raise InputError(f"{place} has the coordinates {shown_number(coordinates)}: give two numbers")
            yield list(coordinates)[:2]  # a height is left out
    else:
        yield item
