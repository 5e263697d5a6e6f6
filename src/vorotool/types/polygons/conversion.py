"""Between polygon sets and shapely geometry."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError
from vorotool.numeric.ragged import starts_of, within
from vorotool.types.polygons.polygon_set import HOLE, LINE, SHELL, PolygonSet, set_of_rings

_POINT, _LINESTRING, _LINEARRING, _POLYGON, _MULTIPOINT = 0, 1, 2, 3, 4  # type numbers of GEOS
_COLLECTIONS = (5, 6, 7)  # MultiLineString, MultiPolygon, GeometryCollection


def polygons_of_geometry(
    geometry: Sequence[Any] | NDArray[np.object_],
    described: Callable[[NDArray[np.int64]], Mapping[str, Any]] | None = None,
    *,
    takes_points: bool = False,
) -> PolygonSet:
    """Polygons and lines of shapely geometry, one feature an item; rings and lines keep their direction."""
    import shapely

    parts, owners = np.array(geometry, dtype=object), np.arange(len(geometry))
    collections = (*_COLLECTIONS, *([_MULTIPOINT] if takes_points else []))
    while np.isin(shapely.get_type_id(parts), collections).any():
        parts, index = shapely.get_parts(parts, return_index=True)
        owners = owners[index]
    there = ~(shapely.is_empty(parts) | shapely.is_missing(parts))
    parts, owners = parts[there], owners[there]
    kinds = shapely.get_type_id(parts)
    taken = (_LINESTRING, _LINEARRING, _POLYGON, *([_POINT] if takes_points else []))
    bad = np.flatnonzero(~np.isin(kinds, taken))
    if bad.size:
        at = int(bad[0])
        raise InputError(f"item {owners[at] + 1} is or holds a {parts[at].geom_type}: give polygons or lines")
    rings, polygons = shapely.get_rings(parts, return_index=True)
    lines = np.flatnonzero(kinds != _POLYGON)
    order = np.argsort(np.concatenate([polygons, lines]), kind="stable")
    rings = np.concatenate([rings, parts[lines]])[order]
    polygons = np.concatenate([polygons, lines])[order]
    first = np.diff(polygons, prepend=-1) > 0
    ring_kinds = np.where(first, np.where(np.isin(kinds[polygons], (_POINT, _LINESTRING)), LINE, SHELL), HOLE)
    fields = {"feature": owners} if described is None else described(owners)
    return set_of_rings(
        shapely.get_coordinates(rings), shapely.get_num_coordinates(rings), ring_kinds, polygons, **fields
    )


def to_shapely(polygons: PolygonSet) -> NDArray[np.object_]:
    """Shapely geometry of each polygon and line, in order; rings of fewer than three vertices are padded."""
    import shapely

    sizes, is_line = np.diff(polygons.ring_starts), polygons.is_line
    lines = polygons.ring_kind == LINE
    padded = np.where(lines, np.maximum(sizes, 2), sizes + np.maximum(1, 4 - sizes))
    place = within(padded)
    taken = np.repeat(polygons.ring_starts[:-1], padded) + np.where(place < np.repeat(sizes, padded), place, 0)
    xy, of_line = polygons.xy[taken], np.repeat(lines, padded)
    made = np.empty(len(polygons), dtype=object)
    made[is_line] = shapely.from_ragged_array(shapely.GeometryType.LINESTRING, xy[of_line], (starts_of(padded[lines]),))
    rings = np.diff(polygons.polygon_starts)[~is_line]
    made[~is_line] = shapely.from_ragged_array(
        shapely.GeometryType.POLYGON, xy[~of_line], (starts_of(padded[~lines]), starts_of(rings))
    )
    return made


def closed_ring(ring: NDArray[np.float64]) -> NDArray[np.float64]:
    """A ring with its first vertex again at the end, at least four in all: shapely wants so many."""
    return np.concatenate([ring, np.repeat(ring[:1], max(1, 4 - len(ring)), axis=0)])
