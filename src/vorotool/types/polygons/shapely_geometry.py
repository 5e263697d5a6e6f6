"""Between shapely geometry and polygons, lines and points; the shapes that results use."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.errors import InputError, element
from vorotool.frozen import frozen
from vorotool.numeric.arrays import Indices, owners, ranges, starts_of, within
from vorotool.numeric.checks import index_of_rows
from vorotool.types.fields import fitting
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
        raise InputError(f"{element('item', owners[at])} is or holds a {parts[at].geom_type}: give polygons or lines")
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


_MANY = 1 << 22
"""Pairs of a place and an edge that are looked at together, in some 100 MB."""


def used_shapes(polygons: PolygonSet) -> NDArray[np.object_]:
    """Return what each polygon bounds: what is inside its shell and in none of its holes, each by the even-odd rule."""
    import shapely

    made = to_shapely(polygons)
    if not len(made):
        return made
    first = polygons.polygon_starts[:-1]
    single = polygons.is_line & (np.diff(polygons.ring_starts)[first] == 1)
    made[single] = shapely.points(polygons.xy[polygons.ring_starts[first[single]]])
    for at in np.flatnonzero(~polygons.is_line & ~shapely.is_valid(made)).tolist():
        made[at] = _bounded(list(polygons.rings_of(at)))
    return made


def with_used_rings(polygons: PolygonSet) -> tuple[PolygonSet, Indices]:
    """Replace the rings of invalid polygons by those of what they bound, see `used_shapes`; and return which."""
    invalid = np.flatnonzero(~polygons.is_line)
    if len(invalid):
        faults = _core.arrangement.polygon_faults(
            polygons.xy, polygons.ring_starts, polygons.polygon_starts, is_coverage=False, threads=1, progress=None
        )
        invalid = invalid[faults[invalid] != 0]
    if len(invalid):
        import shapely

        invalid = invalid[~shapely.is_valid(to_shapely(polygons)[invalid])]
    if not len(invalid):
        return polygons, invalid
    shapes = used_shapes(RingArrays.of(polygons).taken(invalid)[0].polygons(polygons, invalid))
    parts = polygons_of_geometry(shapes, lambda own: {"feature": own}, takes_points=True)
    kept = np.flatnonzero(np.isin(np.arange(len(polygons)), invalid, invert=True))
    source = np.concatenate([kept, invalid[parts.feature]])
    order = np.argsort(source, kind="stable")
    both = RingArrays.joined([RingArrays.of(polygons), RingArrays.of(parts)])
    number = np.concatenate([kept, len(polygons) + np.arange(len(parts))])
    return both.taken(number[order])[0].polygons(polygons, source[order]), invalid


def _bounded(rings: list[NDArray[np.float64]]) -> Any:
    """What a shell and its holes bound, of faces between all of their edges."""
    import shapely

    closed = [shapely.linestrings(np.concatenate([ring, ring[:1]])) for ring in rings]
    noded = shapely.union_all(np.array(closed, dtype=object))
    faces = np.asarray(shapely.get_parts(shapely.polygonize(shapely.get_parts(noded))))
    faces = faces[shapely.area(faces) > 0]
    places = shapely.get_coordinates(shapely.point_on_surface(faces))
    is_in = _is_within(rings[0], places)
    for hole in rings[1:]:
        is_in &= ~_is_within(hole, places)
    return shapely.union_all(faces[is_in]) if is_in.any() else closed[0]


def _is_within(ring: NDArray[np.float64], places: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Whether places are inside a ring by the even-odd rule."""
    ends = np.stack([ring, np.roll(ring, -1, axis=0)])
    upwards = np.argsort(ends[:, :, 1], axis=0, kind="stable")[:, :, None]  # both ways along an edge are the same
    a, b = np.take_along_axis(ends, upwards, axis=0)
    step = max(1, _MANY // len(ring))
    parts = [np.zeros(0, dtype=bool)]
    for begin in range(0, len(places), step):
        x, y = places[begin : begin + step, :, None].swapaxes(0, 1)
        passes = (a[:, 1] <= y) & (b[:, 1] > y)
        is_left = (b[:, 0] - a[:, 0]) * (y - a[:, 1]) < (b[:, 1] - a[:, 1]) * (x - a[:, 0])
        parts.append((passes & is_left).sum(axis=1) % 2 > 0)
    return np.concatenate(parts)


@frozen(eq=False)
class RingArrays:
    """Rings of polygons, in any order."""

    xy: NDArray[Any]  # (n, 2) array: vertices, ring after ring
    sizes: Indices  # (r,) int64 array: vertices of each ring
    kind: NDArray[np.int8]  # (r,) int8 array: see `PolygonSet`
    rings: Indices  # (p,) int64 array: rings of each polygon

    @classmethod
    def of(cls, polygons: PolygonSet) -> RingArrays:
        """Return those of a set."""
        return cls(polygons.xy, np.diff(polygons.ring_starts), polygons.ring_kind, np.diff(polygons.polygon_starts))

    @classmethod
    def joined(cls, parts: Sequence[RingArrays]) -> RingArrays:
        """Put those of several sets one after the other."""
        columns: list[Any] = [
            np.concatenate([getattr(part, name) for part in parts]) for name in ("xy", "sizes", "kind", "rings")
        ]
        return cls(*columns)

    @cached_property
    def _first_rings(self) -> Indices:
        return starts_of(self.rings)

    @cached_property
    def _first_vertices(self) -> Indices:
        return starts_of(self.sizes)

    def taken(self, chosen: NDArray[Any]) -> tuple[RingArrays, Indices, Indices]:
        """Choose polygons; gives the numbers of their rings and vertices, too."""
        rings = ranges(self._first_rings[chosen], self.rings[chosen])
        vertices = ranges(self._first_vertices[rings], self.sizes[rings])
        made = RingArrays(self.xy[vertices], self.sizes[rings], self.kind[rings], self.rings[chosen])
        return made, rings, vertices

    def bare(self, **known: Any) -> PolygonSet:
        """Make a set of polygons of which no more is known than this."""
        return fitting(
            PolygonSet,
            xy=self.xy,
            ring_starts=starts_of(self.sizes),
            ring_kind=self.kind,
            ring_polygon=owners(self.rings, np.int32),
            **({"feature": np.arange(len(self.rings))} | known),
        )

    def polygons(self, given: PolygonSet, source: NDArray[Any], **others: Any) -> PolygonSet:
        """Make a set of polygons that are described as those of another set: ids, features, properties and index."""
        own = source.tolist()
        known: dict[str, Any] = {
            "ids": None if given.ids is None else [given.ids[k] for k in own],
            "feature": given.feature[source],
            "properties": {name: [values[k] for k in own] for name, values in given.properties.items()},
            "index": index_of_rows(given.index, source),
        }
        return replace(
            given,
            xy=self.xy,
            ring_starts=starts_of(self.sizes),
            ring_kind=self.kind,
            ring_polygon=owners(self.rings),
            **(known | others),
        )


POINT, MULTIPOINT, COLLECTION = 0, 4, 7
"""Type numbers of GEOS."""


def single_points(geometry: Any) -> tuple[NDArray[np.object_], NDArray[np.int64]]:
    """Return the points of geometry that are not empty, and the item that each comes from."""
    import shapely

    points, owners = np.array(geometry, dtype=object), np.arange(len(geometry))
    while len(points) and (shapely.get_type_id(points) != POINT).any():
        points, index = shapely.get_parts(points, return_index=True)
        owners = owners[index]
    there = ~shapely.is_empty(points) if len(points) else np.zeros(0, dtype=bool)
    return points[there], owners[there]


def part_numbers(owners: NDArray[Any]) -> NDArray[np.int64]:
    """Count the points of each item from 1."""
    first = np.flatnonzero(np.diff(owners, prepend=-1))
    return within(np.diff(first, append=len(owners))) + 1
