"""Between polygon sets and shapely geometry."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError
from vorotool.geometry.polygons.polygon_set import HOLE, LINE, SHELL, PolygonSet, set_of_rings

_LINESTRING, _LINEARRING, _POLYGON = 1, 2, 3  # type numbers of GEOS
_COLLECTIONS = (5, 6, 7)  # MultiLineString, MultiPolygon, GeometryCollection


def polygons_of_geometry(
    geometry: Sequence[Any] | NDArray[np.object_],
    described: Callable[[NDArray[np.int64]], Mapping[str, Any]] | None = None,
) -> PolygonSet:
    """Polygons and lines of shapely geometry, one feature an item; rings and lines keep their direction.

    Parameters
    ----------
    geometry : sequence of shapely geometry
        Of polygons and lines, single or several in one. None, and what is empty, is left out.
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
    there = ~(shapely.is_empty(parts) | shapely.is_missing(parts))
    parts, owners = parts[there], owners[there]
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
    >>> to_shapely(set_of_rings([[0, 0], [4, 0], [0, 3]], [3], [SHELL], [0]))[0].area
    6.0
    """
    import shapely

    made = np.empty(len(polygons), dtype=object)
    for index, is_line in enumerate(polygons.is_line):
        rings = list(polygons.rings_of(index))
        if is_line:
            made[index] = shapely.LineString(rings[0] if len(rings[0]) > 1 else rings[0].repeat(2, axis=0))
        else:
            shell, *holes = [closed_ring(ring) for ring in rings]
            made[index] = shapely.Polygon(shell, holes)
    return made


def closed_ring(ring: NDArray[np.float64]) -> NDArray[np.float64]:
    """A ring with its first vertex again at the end, at least four in all: shapely wants so many."""
    return np.concatenate([ring, np.repeat(ring[:1], max(1, 4 - len(ring)), axis=0)])
