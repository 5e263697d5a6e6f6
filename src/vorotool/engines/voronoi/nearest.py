"""The sites of what no border is in: by the distances of places there."""

from __future__ import annotations

from fractions import Fraction
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.voronoi.elements import NOBODY, OwnedGraph
from vorotool.engines.voronoi.regions import LocalDiagrams
from vorotool.numeric.arrays import Floats, Indices
from vorotool.types.polygons.shapely_geometry import used_shapes
from vorotool.types.voronoi.voronoi_map import OUTSIDE


class NearestElements:
    """Finds the sites that places of a region are nearest to."""

    def __init__(self, local: LocalDiagrams) -> None:
        self.local = local
        graph = local.owned.graph
        degree = np.bincount(graph.segments.ravel(), minlength=len(graph.points))
        self.lone = np.flatnonzero((degree == 0) | self._has_wedge())

    def _has_wedge(self) -> NDArray[np.bool_]:
        """(n,) whether a site smaller than those of the segments at a point may have what is nearest to the point."""
        owned, graph = self.local.owned, self.local.owned.graph
        count = len(graph.points)
        least = np.full(count, NOBODY, dtype=np.int64)
        for end in graph.segments.T:
            np.minimum.at(least, end, owned.element[count:])
        has_wedge: NDArray[np.bool_] = (least < NOBODY) & (owned.element[:count] < least)
        for point in np.flatnonzero(has_wedge).tolist():
            ends = graph.segments[(graph.segments == point).any(axis=1)]
            x, y = (graph.points[ends].astype(np.int64).sum(axis=1) - 2 * graph.points[point].astype(np.int64)).T
            level = x[:, None] * y == y[:, None] * x
            has_wedge[point] = not (level & (x[:, None] * x + y[:, None] * y < 0)).any()
        return has_wedge

    def sites(self, places: Floats, region: int) -> Indices:
        """(k,) the smallest of the sites that cover each place on the lattice, else of those nearest to it."""
        import shapely

        points = shapely.points(places)
        shapes, of_polygon = self._polygons
        covered = np.full(len(places), NOBODY, dtype=np.int64)
        row, place = shapely.STRtree(points).query(shapes, predicate="contains")
        np.minimum.at(covered, place, of_polygon[row])
        tree, site = self._tree(region)
        (place, row), distance = tree.query_nearest(points, all_matches=True, return_distance=True)
        least = np.full(len(places), NOBODY, dtype=np.int64)
        np.minimum.at(least, place, site[row])
        least[place[distance > self.local.borders.level]] = OUTSIDE
        return np.where(covered < NOBODY, covered, least)

    @cached_property
    def _polygons(self) -> tuple[Any, Indices]:
        """Polygons that have an inside, and the site of each."""
        import shapely

        shapes = used_shapes(self.local.polygons)
        kept = np.flatnonzero(shapely.area(shapes) > 0)
        return shapes[kept], self.local.site[kept].astype(np.int64)

    def _tree(self, region: int) -> tuple[Any, Indices]:
        import shapely

        local, graph = self.local, self.local.owned.graph
        count = len(graph.points)
        points = self.lone[local.point_region[self.lone] == region]
        segments = np.flatnonzero(local.segment_region == region)
        places = graph.points.astype(np.float64)
        shapes = np.concatenate([shapely.points(places[points]), shapely.linestrings(places[graph.segments[segments]])])
        return shapely.STRtree(shapes), local.owned.element[np.concatenate([points, count + segments])].astype(np.int64)


Exact = tuple[Fraction, Fraction]

MARGIN = 2.0**-40
"""Of the largest coordinate, by which rounding may make an element seem nearer or farther than it is."""


def site_at(owned: OwnedGraph, place: tuple[float, float], level: float = np.inf) -> int:
    """Give the site that covers a place in input units, else the one nearest to it, the smallest of several."""
    graph = owned.graph
    first = int(owned.element[0])
    if (owned.element == first).all() and np.isin(owned.face, (first, -1)).all() and not np.isfinite(level):
        return first
    exact = tuple((Fraction(c) - Fraction(o)) / Fraction(graph.scale) for c, o in zip(place, graph.origin, strict=True))
    at: Exact = (exact[0], exact[1])
    covering = int(owned.face[_face_at(owned, at)])
    return covering if covering >= 0 else _nearest(owned, at, level)


def _face_at(owned: OwnedGraph, at: Exact) -> int:
    """The face of the graph that a place is in or at the border of: that below the first segment above it."""
    graph = owned.graph
    if not len(graph):
        return 0
    x = graph.points[:, 0][graph.segments]
    low, high = x.min(axis=1), x.max(axis=1)
    value = float(at[0])
    near = np.flatnonzero((low <= value + 1) & (high >= value - 1))
    best: tuple[Fraction, Fraction, int] | None = None
    for k in near.tolist():
        (ax, ay), (bx, by) = graph.points[graph.segments[k]].tolist()
        is_right = ax < bx
        if not is_right:
            (ax, ay), (bx, by) = (bx, by), (ax, ay)
        if not ax <= at[0] < bx:
            continue
        slope = Fraction(by - ay, bx - ax)
        height = ay + slope * (at[0] - ax)
        # of segments that leave one point to the right the lowest has the lowest slope
        if height >= at[1] and (best is None or (height, slope) < best[:2]):
            best = (height, slope, int(graph.segment_faces[k, 1 if is_right else 0]))
    return 0 if best is None else best[2]


def _nearest(owned: OwnedGraph, at: Exact, level: float) -> int:
    graph, count = owned.graph, len(owned.graph.points)
    place = np.array([float(at[0]), float(at[1])])
    points = graph.points.astype(np.float64)
    squared = np.concatenate([_squared(points - place), _squared_of_segments(points, graph.segments, place)])
    least = float(np.sqrt(squared.min()))
    margin = MARGIN * (float(np.abs(place).max()) + float(np.abs(points).max()) + 1)
    candidates = np.flatnonzero(np.sqrt(squared) <= least + margin)
    found = [(_exact_distance(graph, int(k), at), int(owned.element[k])) for k in candidates.tolist()]
    assert count
    squared_distance, site = min(each for each in found if each[1] != NOBODY)
    return OUTSIDE if np.isfinite(level) and squared_distance > Fraction(level) ** 2 else site


def _squared(way: NDArray[np.float64]) -> NDArray[np.float64]:
    return (way * way).sum(axis=1)


def _squared_of_segments(points: NDArray[np.float64], segments: Any, place: NDArray[np.float64]) -> NDArray[np.float64]:
    a, b = points[segments[:, 0]], points[segments[:, 1]]
    way = b - a
    t = ((place - a) * way).sum(axis=1) / _squared(way)
    return _squared(a + t.clip(0, 1)[:, None] * way - place)


def _exact_distance(graph: Any, element: int, at: Exact) -> Fraction:
    """The square of the distance, exactly."""
    count = len(graph.points)
    ends = [element, element] if element < count else graph.segments[element - count]
    (ax, ay), (bx, by) = graph.points[ends].tolist()
    u, v = bx - ax, by - ay
    x, y = at[0] - ax, at[1] - ay
    length = u * u + v * v
    t = min(max(Fraction(x * u + y * v) / length, Fraction(0)), Fraction(1)) if length else Fraction(0)
    dx, dy = x - t * u, y - t * v
    return dx * dx + dy * dy
