"""Checks distances between shapes, with shapely: that they are reached, and that none is beyond them."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.common import fail
from vorotool.numeric.arrays import Floats
from vorotool.numeric.curves.inverse_functions import hypotenuse
from vorotool.types.arguments import check_value
from vorotool.types.distances.distances import FROM_A, FROM_B, SMALLEST, Distances, PlacePair
from vorotool.types.polygons.polygon_set import LINE, PolygonSet
from vorotool.types.polygons.shapely_geometry import used_shapes

TOLERANCE = 1e-9
"""Of the extent: shapely computes in floating point, and parts of edges are halved until they are as short."""
INNER_PARTS = 256
"""Of the extent: how large the squares are that are not divided further inside polygons."""


def verify_distances(found: Distances) -> None:
    """Check the distances between two shapes independently of their computation.

    Both places are on their shapes, and as far apart as is said, and so is the one from the other shape. None is
    beyond: edges are halved until the distance from what is nearest at both ends, which is convex, leaves no room for
    more; what is inside polygons is divided into squares in the same way, to 1/256 of the extent. The smallest distance
    is compared with that between all edges, and no polygon may meet the other shape where it is not 0.

    Parameters
    ----------
    found : Distances
        Result of `vorotool.hausdorff` or `vorotool.distance`.

    Raises
    ------
    VerificationError
        If something is wrong; the message says what and where.

    Examples
    --------
    >>> from vorotool import hausdorff
    >>> verify_distances(hausdorff([[0, 0], [4, 0]], ["LINESTRING (0 1, 4 1)"]))
    """
    check_value(found, "found", "Distances")
    a, b = (_Checked(polygons, found.is_boundary) for polygons in found.shapes)
    places = np.concatenate([a.ends, b.ends]).reshape(-1, 2)
    extent = float(np.ptp(places, axis=0).max()) or 1.0
    tolerance = TOLERANCE * extent + 8 * float(np.spacing(np.abs(places).max()))
    for name, pair in ((FROM_A, found.from_a), (FROM_B, found.from_b), (SMALLEST, found.smallest)):
        if pair is not None:
            _check_places(name, pair, a, b, tolerance)
    if found.from_a is not None:
        _check_nothing_farther(FROM_A, found.from_a.distance, a, b, tolerance, extent)
        _check_is_from(FROM_A, found.from_a.on_a, found.from_a.distance, b, tolerance)
    if found.from_b is not None:
        _check_nothing_farther(FROM_B, found.from_b.distance, b, a, tolerance, extent)
        _check_is_from(FROM_B, found.from_b.on_b, found.from_b.distance, a, tolerance)
    if found.smallest is not None:
        _check_nothing_closer(found.smallest.distance, a, b, tolerance)


class _Checked:
    """A shape as shapely has it."""

    def __init__(self, polygons: PolygonSet, is_boundary: bool) -> None:
        import shapely

        is_last = np.zeros(len(polygons.xy), dtype=bool)
        is_last[polygons.ring_starts[1:] - 1] = np.diff(polygons.ring_starts) > 1
        is_last &= np.repeat(polygons.ring_kind == LINE, np.diff(polygons.ring_starts))
        start = np.flatnonzero(~is_last)
        self.ends = np.stack([polygons.xy[start], polygons.xy[polygons.following[start]]], axis=1)
        is_point = (self.ends[:, 0] == self.ends[:, 1]).all(axis=1)
        self.edges = np.empty(len(self.ends), dtype=object)
        self.edges[is_point] = shapely.points(self.ends[is_point, 0])
        self.edges[~is_point] = shapely.linestrings(self.ends[~is_point])
        self.tree = shapely.STRtree(self.edges)
        self.polygons, self.is_boundary = polygons, is_boundary

    @cached_property
    def regions(self) -> Any:
        """Polygons that are filled."""
        import shapely

        shapes = used_shapes(self.polygons)[~self.polygons.is_line]
        shapes = shapes[:0] if self.is_boundary else shapes
        return shapes[shapely.area(shapes) > 0]

    @cached_property
    def region_tree(self) -> Any:
        """Of these."""
        import shapely

        return shapely.STRtree(self.regions)

    def contains(self, places: Floats) -> NDArray[np.bool_]:
        """Whether places are inside polygons."""
        import shapely

        found = np.zeros(len(places), dtype=bool)
        if len(self.regions):
            found[self.region_tree.query(shapely.points(places), predicate="intersects")[0]] = True
        return found

    def nearest(self, places: Floats) -> NDArray[np.int64]:
        """The nearest edge to each place."""
        import shapely

        return np.asarray(self.tree.nearest(shapely.points(places)), dtype=np.int64)

    def from_edge(self, edge: NDArray[np.int64], places: Floats) -> Floats:
        """The distance of each place from an edge."""
        import shapely

        return np.asarray(shapely.distance(self.edges[edge], shapely.points(places)))

    def distance(self, places: Floats) -> Floats:
        """The distance of each place from the shape."""
        found = self.from_edge(self.nearest(places), places)
        found[self.contains(places)] = 0
        return found


def _check_places(name: str, pair: PlacePair, a: _Checked, b: _Checked, tolerance: float) -> None:
    for which, place, shape in (("a", pair.on_a, a), ("b", pair.on_b, b)):
        off = float(shape.distance(np.array([place]))[0])
        if not off <= tolerance:
            fail(f"{name}: the point {place} is not on {which}, but {off:g} away from it")
    apart = float(hypotenuse(*np.subtract(pair.on_a, pair.on_b)))
    if not abs(apart - pair.distance) <= tolerance:
        fail(f"{name}: the points are {apart!r} apart, but the distance is {pair.distance!r}")


def _check_is_from(name: str, place: tuple[float, float], distance: float, other: _Checked, tolerance: float) -> None:
    own = float(other.distance(np.array([place]))[0])
    if not abs(own - distance) <= tolerance:
        fail(f"{name}: the point {place} is {own!r} away from the other shape, not {distance!r}")


def _check_nothing_farther(
    name: str, distance: float, of: _Checked, other: _Checked, tolerance: float, extent: float
) -> None:
    _check_edges(name, distance, of, other, tolerance)
    if len(of.regions):
        _check_inside(name, distance, of, other, tolerance, extent)


def _check_edges(name: str, distance: float, of: _Checked, other: _Checked, tolerance: float) -> None:
    s, t = of.ends[:, 0], of.ends[:, 1]
    while len(s):
        _check_none_of(name, np.concatenate([s, t]), distance, other, tolerance)
        at_s, at_t = other.nearest(s), other.nearest(t)
        bound = np.minimum(
            np.maximum(other.from_edge(at_s, s), other.from_edge(at_s, t)),
            np.maximum(other.from_edge(at_t, s), other.from_edge(at_t, t)),
        )
        middle = (s + t) / 2
        half = np.sqrt(np.square(t - s).sum(axis=1)) / 2
        open_ = np.flatnonzero((bound > distance + tolerance) & (half > tolerance))
        reach = other.from_edge(other.nearest(middle[open_]), middle[open_])
        open_ = open_[~(other.contains(middle[open_]) & (reach > half[open_]))]
        s, t = np.concatenate([s[open_], middle[open_]]), np.concatenate([middle[open_], t[open_]])


def _check_none_of(name: str, places: Floats, distance: float, other: _Checked, tolerance: float) -> None:
    own = other.distance(places)
    at = int(own.argmax())
    if own[at] > distance + tolerance:
        fail(f"{name}: the point {tuple(places[at].tolist())} is {own[at]!r} away, farther than {distance!r}")


def _check_inside(name: str, distance: float, of: _Checked, other: _Checked, tolerance: float, extent: float) -> None:
    corners = of.ends.reshape(-1, 2)
    half = float(np.ptp(corners, axis=0).max()) / 2
    middle = ((corners.min(axis=0) + corners.max(axis=0)) / 2)[None]
    around = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    while len(middle):
        reach = half * np.sqrt(2)
        nearest = other.nearest(middle)
        is_in_other = other.contains(middle) & (other.from_edge(nearest, middle) > reach)
        is_inside = of.contains(middle)
        is_outside = ~is_inside & (of.from_edge(of.nearest(middle), middle) > reach)
        if is_inside.any():
            _check_none_of(name, middle[is_inside], distance, other, tolerance)
        places = (middle[:, None] + half * around).reshape(-1, 2)
        farthest = other.from_edge(np.repeat(nearest, 4), places).reshape(-1, 4).max(axis=1)
        middle = middle[(farthest > distance + tolerance) & ~is_in_other & ~is_outside]
        half /= 2
        if half < extent / INNER_PARTS:
            return
        middle = (middle[:, None] + half * around).reshape(-1, 2)


def _check_nothing_closer(distance: float, a: _Checked, b: _Checked, tolerance: float) -> None:
    (of, at), apart = b.tree.query_nearest(a.edges, return_distance=True, all_matches=False)
    least = int(apart.argmin())
    if apart[least] < distance - tolerance:
        fail(f"smallest: edge {of[least]} of a and {at[least]} of b are {apart[least]!r} apart, less than {distance!r}")
    if distance <= tolerance:
        return
    for which, filled, other in (("a", a, b), ("b", b, a)):
        if len(filled.regions) and filled.region_tree.query(other.edges, predicate="intersects").size:
            fail(f"smallest: a polygon of {which} meets the other shape, but the distance is {distance!r}")
