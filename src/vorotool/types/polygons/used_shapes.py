"""The rings of polygons as bare arrays, and what they bound as shapely geometry."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.arrays import Indices
from vorotool.numeric.equality import index_of_rows
from vorotool.numeric.ragged import owners, ranges, starts_of
from vorotool.plain import plain
from vorotool.types.polygons.conversion import polygons_of_geometry, to_shapely
from vorotool.types.polygons.polygon_set import PolygonSet

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


def with_used_rings(polygons: PolygonSet) -> PolygonSet:
    """Replace the rings of invalid polygons by those of what they bound; see `used_shapes`."""
    import shapely

    invalid = np.flatnonzero(~polygons.is_line & ~shapely.is_valid(to_shapely(polygons)))
    if not len(invalid):
        return polygons
    shapes = used_shapes(RingArrays.of(polygons).taken(invalid)[0].polygons(polygons, invalid))
    parts = polygons_of_geometry(shapes, lambda own: {"feature": own}, takes_points=True)
    assert parts.feature is not None
    kept = np.flatnonzero(np.isin(np.arange(len(polygons)), invalid, invert=True))
    source = np.concatenate([kept, invalid[parts.feature]])
    order = np.argsort(source, kind="stable")
    both = RingArrays.joined([RingArrays.of(polygons), RingArrays.of(parts)])
    number = np.concatenate([kept, len(polygons) + np.arange(len(parts))])
    return both.taken(number[order])[0].polygons(polygons, source[order])


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


@plain(eq=False)
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

    def taken(self, chosen: NDArray[Any]) -> tuple[RingArrays, Indices, Indices]:
        """Choose polygons; gives the numbers of their rings and vertices, too."""
        rings = ranges(starts_of(self.rings)[chosen], self.rings[chosen])
        vertices = ranges(starts_of(self.sizes)[rings], self.sizes[rings])
        made = RingArrays(self.xy[vertices], self.sizes[rings], self.kind[rings], self.rings[chosen])
        return made, rings, vertices

    def polygons(self, given: PolygonSet, source: NDArray[Any]) -> PolygonSet:
        """Make a set of polygons that are described as those of another set: ids, features, properties and index."""
        assert given.feature is not None
        own = source.tolist()
        return replace(
            given,
            xy=self.xy,
            ring_starts=starts_of(self.sizes),
            ring_kind=self.kind,
            ring_polygon=owners(self.rings),
            ids=None if given.ids is None else [given.ids[k] for k in own],
            feature=given.feature[source],
            properties={name: [values[k] for k in own] for name, values in given.properties.items()},
            index=index_of_rows(given.index, source),
        )
