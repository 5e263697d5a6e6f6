"""The sites of what no border is in: by the distances of places there."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.voronoi.elements import NOBODY
from vorotool.engines.voronoi.local_diagrams import LocalDiagrams
from vorotool.types.polygons.used_shapes import used_shapes
from vorotool.types.voronoi.voronoi_map import OUTSIDE

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]


class NearestElements:
    """Finds the sites that places of a region are nearest to."""

    def __init__(self, local: LocalDiagrams) -> None:
        self.local = local
        graph = local.owned.graph
        degree = np.bincount(graph.segments.ravel(), minlength=len(graph.points))
        self.lone = np.flatnonzero((degree == 0) | self._has_wedge())
        self.trees: dict[int, tuple[Any, Indices]] = {}

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

        if region not in self.trees:
            local, graph = self.local, self.local.owned.graph
            count = len(graph.points)
            points = self.lone[local.point_region[self.lone] == region]
            segments = np.flatnonzero(local.segment_region == region)
            places = graph.points.astype(np.float64)
            shapes = np.concatenate(
                [shapely.points(places[points]), shapely.linestrings(places[graph.segments[segments]])]
            )
            site = local.owned.element[np.concatenate([points, count + segments])].astype(np.int64)
            self.trees[region] = shapely.STRtree(shapes), site
        return self.trees[region]
