"""Between polygon sets, shapely geometry and nested lists."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError
from vorotool.geometry.coordinates import coordinate_rows, number_array
from vorotool.geometry.polygons.polygon_set import HOLE, LINE, SHELL, PolygonSet, set_of_rings
from vorotool.geometry.ragged import starts_of, within

_LINESTRING, _LINEARRING, _POLYGON = 1, 2, 3  # type numbers of GEOS
_COLLECTIONS = (5, 6, 7)  # MultiLineString, MultiPolygon, GeometryCollection
_EXPECTED = (
    "polygons must be shapely geometry, an (n, 2) array of the vertices of one shell, "
    '{"shell": …, "holes": […]}, {"line": …}, or a list of these'
)
Part = tuple[int, Any]
"""The kind of a ring and its vertices."""


def as_polygons(source: Any) -> PolygonSet:
    """Polygons and open lines of whatever holds them; the order is kept.

    Parameters
    ----------
    source : PolygonSet, shapely geometry, (n, 2) array-like, mapping, or a list of these
        An array is the shell of one polygon; a mapping has ``shell`` and ``holes``, or ``line``. Of a list each item is
        one feature, and the polygons of a multi-part geometry are its parts. Empty geometry is left out.

    Returns
    -------
    PolygonSet
        A `PolygonSet` is returned as it is.

    Raises
    ------
    InputError
        If it is none of these, a geometry is a point, or a coordinate is not finite; the item is named.

    Examples
    --------
    >>> as_polygons([[0, 0], [4, 0], [0, 3]]).ring_start.tolist()
    [0, 3]
    >>> len(as_polygons([{"shell": [[0, 0], [9, 0], [0, 9]], "holes": [[[1, 1], [2, 1], [1, 2]]]}, {"line": [[5, 5]]}]))
    2
    """
    if isinstance(source, PolygonSet):
        return source
    if hasattr(source, "geom_type"):
        return polygons_of_geometry([source])
    if isinstance(source, Iterator):
        source = list(source)
    if isinstance(source, Mapping) or _is_ring(source):
        source = [source]
    if isinstance(source, str | bytes) or not isinstance(source, Iterable) or getattr(source, "ndim", 1) == 0:
        raise InputError(_EXPECTED)
    items = list(source)
    if items and all(hasattr(item, "geom_type") for item in items):
        return polygons_of_geometry(items)
    return _set_of_items(items)


def polygons_of_geometry(
    geometry: Sequence[Any] | NDArray[np.object_],
    described: Callable[[NDArray[np.int64]], Mapping[str, Any]] | None = None,
) -> PolygonSet:
    """Polygons and lines of shapely geometry, one feature an item; rings and lines keep their direction.

    Parameters
    ----------
    geometry : sequence of shapely geometry
        Of polygons and lines, single or several in one.
    described : callable, optional
        ``described(items)`` gives further fields of the `PolygonSet` for the items that its polygons come from; by
        default these are their features.

    Raises
    ------
    InputError
        If a geometry is a point or holds one, or a coordinate is not finite.

    Examples
    --------
    >>> import shapely
    >>> shapes = polygons_of_geometry([shapely.box(0, 0, 1, 2), shapely.LineString([(0, 0), (1, 1)])])
    >>> shapes.ring_kind.tolist(), shapes.ring_start.tolist()
    ([0, 2], [0, 4, 6])
    """
    import shapely

    parts, owners = np.array(geometry, dtype=object), np.arange(len(geometry))
    while np.isin(shapely.get_type_id(parts), _COLLECTIONS).any():
        parts, index = shapely.get_parts(parts, return_index=True)
        owners = owners[index]
    parts, owners = parts[~shapely.is_empty(parts)], owners[~shapely.is_empty(parts)]
    kinds = shapely.get_type_id(parts)
    bad = np.flatnonzero(~np.isin(kinds, (_LINESTRING, _LINEARRING, _POLYGON)))
    if bad.size:
        at = int(bad[0])
        raise InputError(f"item {owners[at] + 1} is or holds a {parts[at].geom_type}: give polygons or lines")
    rings, polygons = shapely.get_rings(parts, return_index=True)
    lines = np.flatnonzero(kinds != _POLYGON)
    order = np.argsort(np.concatenate([polygons, lines]), kind="stable")
    rings = np.concatenate([rings, parts[lines]])[order]
    polygons = np.concatenate([polygons, lines])[order]
    first = np.diff(polygons, prepend=-1) > 0
    ring_kinds = np.where(first, np.where(kinds[polygons] == _LINESTRING, LINE, SHELL), HOLE)
    fields = {"feature": owners} if described is None else described(owners)
    return set_of_rings(
        shapely.get_coordinates(rings), shapely.get_num_coordinates(rings), ring_kinds, polygons, **fields
    )


def to_shapely(polygons: PolygonSet) -> NDArray[np.object_]:
    """Shapely geometry of each polygon and line, in order; rings of fewer than three vertices are padded.

    Examples
    --------
    >>> to_shapely(as_polygons([[0, 0], [4, 0], [0, 3]]))[0].area
    6.0
    """
    import shapely

    sizes, is_line = np.diff(polygons.ring_start), polygons.is_line
    lines = polygons.ring_kind == LINE
    padded = np.where(lines, np.maximum(sizes, 2), sizes + np.maximum(1, 4 - sizes))
    place = within(padded)
    taken = np.repeat(polygons.ring_start[:-1], padded) + np.where(place < np.repeat(sizes, padded), place, 0)
    xy, of_line = polygons.xy[taken], np.repeat(lines, padded)
    made = np.empty(len(polygons), dtype=object)
    made[is_line] = shapely.from_ragged_array(shapely.GeometryType.LINESTRING, xy[of_line], (starts_of(padded[lines]),))
    rings = np.diff(polygons.polygon_start)[~is_line]
    made[~is_line] = shapely.from_ragged_array(
        shapely.GeometryType.POLYGON, xy[~of_line], (starts_of(padded[~lines]), starts_of(rings))
    )
    return made


def closed_ring(ring: NDArray[np.float64]) -> NDArray[np.float64]:
    """A ring with its first vertex again at the end, at least four in all: shapely wants so many."""
    return np.concatenate([ring, np.repeat(ring[:1], max(1, 4 - len(ring)), axis=0)])


def _is_ring(source: Any) -> bool:
    """Whether this is an array or a list of pairs of numbers."""
    if isinstance(source, np.ndarray):
        return source.ndim == 2
    try:
        return len(source) > 0 and np.ndim(source[0]) == 1 and not isinstance(source[0], Mapping)
    except (TypeError, KeyError, ValueError):
        return False


def _set_of_items(items: list[Any]) -> PolygonSet:
    xy: list[NDArray[np.float64]] = []
    kinds: list[int] = []
    polygons: list[int] = []
    feature: list[int] = []
    for index, item in enumerate(items):
        for parts in _polygons_of(item, f"item {index + 1}"):
            for kind, ring in parts:
                xy.append(ring)
                kinds.append(kind)
                polygons.append(len(feature))
            feature.append(index)
    vertices = np.concatenate(xy) if xy else np.empty((0, 2))
    return set_of_rings(vertices, [len(ring) for ring in xy], kinds, polygons, feature=feature)


def _polygons_of(item: Any, place: str) -> list[list[Part]]:
    """Rings of each polygon of one item; none of what is empty."""
    if hasattr(item, "geom_type"):
        given = polygons_of_geometry([item])
        return [
            [
                (LINE if given.is_line[polygon] else HOLE if i else SHELL, ring)
                for i, ring in enumerate(given.rings_of(polygon))
            ]
            for polygon in range(len(given))
        ]
    if not isinstance(item, Mapping):
        parts = [(SHELL, _ring(item, place))]
    elif "line" in item:
        parts = [(LINE, _ring(item["line"], f"the line of {place}"))]
    elif "shell" in item:
        holes = (_ring(hole, f"hole {i} of {place}") for i, hole in enumerate(item.get("holes") or (), 1))
        parts = [(SHELL, _ring(item["shell"], f"the shell of {place}")), *((HOLE, h) for h in holes if len(h))]
    else:
        raise InputError(f"{place} has neither shell nor line; {_EXPECTED}")
    return [parts] if len(parts[0][1]) else []


def _ring(vertices: Any, place: str) -> NDArray[np.float64]:
    array = number_array(vertices, "vertex", f"{place} is no (n, 2) array of numbers; {_EXPECTED}")
    if array.size and (array.ndim != 2 or array.shape[1] != 2):
        raise InputError(f"{place} must have shape (n, 2), but has shape {array.shape}; {_EXPECTED}")
    return coordinate_rows(array, f"{place}, vertex")
