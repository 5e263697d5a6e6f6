"""Polygons and open lines from whatever a caller holds: one conversion for all functions."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.convert.features import (
    HeldFeatures,
    held_features,
    is_geojson,
    is_shapely,
    joined_parts,
)
from vorotool.convert.tables import is_table
from vorotool.errors import InputError, element, warn
from vorotool.numeric.checks import described, items_of, naming, refuse_paths, unexpected
from vorotool.numeric.coordinates import coordinate_rows, number_array
from vorotool.numeric.crs import note_degrees
from vorotool.products.formats import resolved
from vorotool.types.images import LabelImage, Raster
from vorotool.types.polygons.polygon_set import HOLE, LINE, SHELL, PolygonSet, set_of_rings
from vorotool.types.polygons.shapely_geometry import polygons_of_geometry, to_shapely

EXPECTED = (
    "polygons or lines of shapely, geopandas, GeoJSON or WKT, an (n, 2) array of the vertices of one shell, "
    '{"shell": …, "holes": […]}, {"line": …}, or a list of these'
)
Part = tuple[int, Any]
"""The kind of a ring and its vertices."""


def as_polygons(source: Any, name: str = "polygons") -> PolygonSet:
    """Give polygons and open lines from whatever holds them; the order is kept."""
    if isinstance(source, PolygonSet):
        return source
    with naming(name):
        return _polygons_in(source, name)


def as_geometry(source: Any, name: str) -> tuple[NDArray[np.object_], Any]:
    """Return the same as shapely geometry, and the ``crs`` member; geometry of shapely as it is."""
    if not isinstance(source, PolygonSet):
        with naming(name):
            refuse_paths(source)
            held = held_features(source)
        if held is not None and held.is_all_shapely:
            return held.geometry, held.crs
    polygons = as_polygons(source, name)
    return to_shapely(polygons), polygons.crs


def _polygons_in(source: Any, name: str) -> PolygonSet:
    refuse_paths(source)
    if isinstance(source, Raster | LabelImage):
        raise unexpected(source, f"polygons; for an image use vorotool.outlines({name})")
    source = items_of(source)
    if getattr(source, "ndim", 0) == 2 and getattr(source, "dtype", None) == np.dtype(bool):  # of NumPy or xarray
        return resolved("engines.label_images.outlines:outlines")(source)
    held = held_features(source)
    if held is not None:
        polygons = _of_features(held)
        note_degrees(polygons, name, warn)
        return polygons
    if is_table(source) and not isinstance(source, Mapping):
        raise unexpected(source, EXPECTED)
    if isinstance(source, Mapping) or is_ring(source):
        source = [source]
    if not isinstance(source, Iterable) or getattr(source, "ndim", 1) == 0:
        raise unexpected(source, EXPECTED)
    items = list(source)
    return _of_features(HeldFeatures(items)) if all(map(is_shapely, items)) else _set_of_items(items, name)


def _of_features(held: HeldFeatures) -> PolygonSet:
    if not held.is_all_shapely:
        return _set_of_items(held.items, "polygons", held)
    return polygons_of_geometry(held.geometry, lambda owners: {"feature": owners, **held.described(owners)})


def is_ring(source: Any) -> bool:
    """Whether this is an array or a list of pairs of numbers."""
    if isinstance(source, np.ndarray):
        return source.ndim == 2
    try:
        return len(source) > 0 and np.ndim(source[0]) == 1 and not isinstance(source[0], Mapping)
    except (TypeError, KeyError, ValueError, IndexError):
        return False


def _set_of_items(items: Any, name: str, held: HeldFeatures | None = None) -> PolygonSet:
    xy: list[NDArray[np.float64]] = []
    kinds: list[int] = []
    polygons: list[int] = []
    feature: list[int] = []
    for index, item in enumerate(items):
        for parts in _polygons_of(item, element("item", index), name):
            for kind, ring in parts:
                xy.append(ring)
                kinds.append(kind)
                polygons.append(len(feature))
            feature.append(index)
    vertices = np.concatenate(xy) if xy else np.empty((0, 2))
    known = {} if held is None else held.described(np.array(feature, dtype=np.int64))
    return set_of_rings(vertices, [len(ring) for ring in xy], kinds, polygons, feature=feature, **known)


def _polygons_of(item: Any, place: str, name: str) -> list[list[Part]]:
    """Rings of each polygon of one item; none of what is empty."""
    if _are_vertices(item):
        return [[(SHELL, item)]] if len(item) else []
    if item is None:
        return []
    if is_shapely(item):
        given = polygons_of_geometry([item])
        return [
            [
                (LINE if given.is_line[polygon] else HOLE if i else SHELL, ring)
                for i, ring in enumerate(given.rings_of(polygon))
            ]
            for polygon in range(len(given))
        ]
    if is_geojson(item):
        return [parts for kind, coordinates in joined_parts(item) for parts in _rings_of(kind, coordinates, place)]
    if not isinstance(item, Mapping):
        parts = [(SHELL, _ring(item, place, name))]
    elif "line" in item:
        parts = [(LINE, _ring(item["line"], f"the line of {place}", name))]
    elif "shell" in item:
        inner = _listed(item.get("holes"), f"holes of {place}")
        holes = (_ring(hole, f"hole {i} of {place}", name) for i, hole in enumerate(inner, 1))
        parts = [(SHELL, _ring(item["shell"], f"the shell of {place}", name)), *((HOLE, h) for h in holes if len(h))]
    else:
        raise InputError(f"{place} has neither shell nor line; expected {EXPECTED}")
    return [parts] if len(parts[0][1]) else []


def _rings_of(kind: str, coordinates: Any, place: str) -> list[list[Part]]:
    """Rings of a simple geometry of GeoJSON; heights are left out."""
    if kind == "Point":
        raise InputError(f"{place} is or holds a Point: give polygons or lines")
    if kind == "LineString":
        line = _flat_ring(coordinates, f"the line of {place}")
        return [[(LINE, line)]] if len(line) else []
    given = _listed(coordinates, f"coordinates of {place}")
    rings = [_flat_ring(ring, f"ring {number} of {place}") for number, ring in enumerate(given, 1)]
    if not rings or not len(rings[0]):
        return []
    return [[(HOLE if number else SHELL, ring) for number, ring in enumerate(rings) if len(ring)]]


def _listed(rings: Any, what: str) -> list[Any]:
    if rings is None:
        return []
    if isinstance(rings, str | bytes) or not isinstance(rings, Iterable):
        raise InputError(f"{what} are {described(rings)}: give a list of rings")
    return list(rings)


def _flat_ring(positions: Any, place: str) -> NDArray[np.float64]:
    array = number_array(positions, "vertex", f"{place} is not a list of positions [x, y]")
    if array.ndim == 2 and array.shape[1] > 2:
        array = array[:, :2]
    return _ring(array, place, "polygons")


def _are_vertices(item: Any) -> bool:
    """Whether this is an array of doubles as rings are kept; what it holds is copied when all rings are joined."""
    return type(item) is np.ndarray and item.dtype == np.float64 and item.ndim == 2 and item.shape[1] == 2


def _ring(vertices: Any, place: str, name: str) -> NDArray[np.float64]:
    if _are_vertices(vertices):
        return vertices
    if isinstance(vertices, str | bytes) or not (isinstance(vertices, Iterable) or hasattr(vertices, "__array__")):
        raise InputError(f"{place} is {described(vertices)}; expected {EXPECTED}")
    array = number_array(vertices, "vertex", f"{place} is not an (n, 2) array of numbers; expected {EXPECTED}")
    if array.size and (array.ndim != 2 or array.shape[1] != 2):
        raise InputError(f"{place} must have shape (n, 2), but has shape {array.shape}; {_advice(array, name)}")
    return coordinate_rows(array, f"{place}, vertex")


def _advice(array: NDArray[Any], name: str) -> str:
    if array.ndim == 2 and array.shape[1] == 3:
        return f"vertices have two coordinates; {name}[:, :2] drops the others"
    if array.ndim == 2 and array.shape[0] == 2:
        return "give the transpose, .T"
    if array.ndim == 2 and min(array.shape) > 3:
        return f"for an image use vorotool.outlines({name})"
    return f"expected {EXPECTED}"
