"""What a clip, a frame and enclosures share out, found by shapely alone, to check Voronoi maps by."""

from __future__ import annotations

from collections import Counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.arrays import Floats
from vorotool.types.box import corners_of
from vorotool.types.polygons.conversion import to_shapely
from vorotool.types.polygons.used_shapes import used_shapes
from vorotool.types.voronoi.voronoi_map import VoronoiMap


def shared_out(cells: VoronoiMap) -> Any:
    """Give the area within the frame and the clip of a map, as geometry of shapely."""
    import shapely

    x, y, w, h = cells.frame
    box = shapely.box(x, y, x + w, y + h)
    if cells.clip is None:
        return box
    clip = used_shapes(cells.clip)
    both = shapely.get_parts(shapely.intersection(shapely.union_all(clip[shapely.area(clip) > 0]), box))
    return shapely.multipolygons(both[shapely.area(both) > 0])  # where both only touch there are lines and points


class EnclosedFaces:
    """Faces between the enclosures of a map; where these only touch, as far as doubles tell, they may meet or not."""

    def __init__(self, cells: VoronoiMap, geometry: NDArray[Any], near: float) -> None:
        import shapely

        assert cells.enclosures is not None
        given = to_shapely(cells.enclosures)
        lines = np.where(cells.enclosures.is_line, given, shapely.boundary(given))
        shared = shared_out(cells)
        border = shapely.boundary(shared)
        corners = shapely.multipoints(shapely.get_coordinates([border, *lines]))
        met, inner = (shapely.snap(each, corners, near) for each in (lines, border))
        self.readings = [
            _Faces(shared, lines, border, geometry, near),
            _Faces(shared, met, inner, geometry, near),
        ]
        apart = _apart(cells, lines, border, 2 * near)
        if (apart != lines).any():
            self.readings.append(_Faces(shared, apart, border, geometry, near))
        self.boundaries = shapely.boundary(np.concatenate([each.shapes for each in self.readings]))

    def least(self, places: Floats) -> Floats:
        """Of each place from the nearest of the sites that surely meet its face; infinity where none surely does."""
        least: Floats = np.maximum.reduce([each.least(places) for each in self.readings])
        return least

    def may_have(self, places: Floats, rows: NDArray[np.int64]) -> NDArray[np.bool_]:
        """(k,) whether a site may meet the face of each place."""
        fits: NDArray[np.bool_] = np.logical_or.reduce([each.may_have(places, rows) for each in self.readings])
        return fits


def _apart(cells: VoronoiMap, lines: NDArray[Any], border: Any, near: float) -> NDArray[Any]:
    """Take from lines their ends that are on others, or on a border, as far as doubles tell and at no vertex of it."""
    import shapely

    cuts = [each.xy for each in (cells.enclosures, cells.clip) if each is not None]
    passes = Counter(map(tuple, np.concatenate([*cuts, corners_of(cells.frame)]).tolist()))
    ends, line = shapely.get_coordinates(shapely.boundary(lines), return_index=True)
    is_lone = np.array([passes[x, y] == 1 for x, y in ends.tolist()], dtype=bool)
    ends, line = shapely.points(ends[is_lone]), line[is_lone]
    end, other = shapely.STRtree([*lines, border]).query(ends, predicate="dwithin", distance=near)
    end = np.unique(end[other != line[end]])
    made = lines.copy()
    for k in np.unique(line[end]).tolist():
        made[k] = shapely.difference(made[k], shapely.union_all(shapely.buffer(ends[end[line[end] == k]], near)))
    return made


class _Faces:
    """Faces between lines, and the sites that meet the inside of each."""

    def __init__(self, shared: Any, lines: NDArray[Any], border: Any, geometry: NDArray[Any], near: float) -> None:
        import shapely

        noded = shapely.union_all([*lines, border])
        faces = np.asarray(shapely.get_parts(shapely.polygonize(shapely.get_parts(noded))))
        self.shapes = faces[shapely.covers(shared, shapely.point_on_surface(faces))]
        cuts = shapely.union_all(lines)
        around = self._closed(cuts, shared, geometry)
        self.geometry, self.near = geometry, near
        self.sure, self.possible = (
            self._meeting(shapely.buffer(np.array([*self.shapes, *around]), step)) for step in (-near, near)
        )
        self.possible_of = self._whole_faces(shared, around)
        self.sure_of = self._without_beyond(around, cuts)
        self.tree = shapely.STRtree(self.shapes)

    def _closed(self, lines: Any, shared: Any, geometry: NDArray[Any]) -> list[Any]:
        """The faces that enclosures close by themselves, and what is around them all."""
        import shapely

        closed = [*shapely.get_parts(shapely.polygonize(shapely.get_parts(lines)))]
        bounds = shapely.box(*shapely.total_bounds([lines, shared, *geometry]))
        margin = max(bounds.length, 1.0)
        return [*closed, shapely.difference(shapely.buffer(bounds, margin), shapely.union_all(closed))]

    def _whole_faces(self, shared: Any, around: list[Any]) -> list[int]:
        """For each face the one whose sites it has: one of those around, unless lines with open ends part that."""
        import shapely

        middles = shapely.point_on_surface(self.shapes)
        found = list(range(len(self.shapes)))
        for k, each in enumerate(around):
            inside = np.flatnonzero(shapely.covers(each, middles))
            parts = shapely.get_parts(shapely.intersection(each, shared))
            if np.count_nonzero(shapely.area(parts) > 0) == len(inside):
                for face in inside.tolist():
                    found[face] = len(self.shapes) + k
        return found

    def _without_beyond(self, around: list[Any], cuts: Any) -> list[int]:
        """The same, but each face for itself where open lines may part what is around it at the frame or the clip."""
        import shapely

        found = list(self.possible_of)
        for k, each in enumerate(around):
            if shapely.intersects(cuts, shapely.buffer(each, -2 * self.near)):
                found = [face if whole == len(self.shapes) + k else whole for face, whole in enumerate(found)]
        return found

    def _meeting(self, shapes: NDArray[Any]) -> list[NDArray[np.int64]]:
        import shapely

        row, site = shapely.STRtree(self.geometry).query(shapes, predicate="intersects")
        return [site[row == k] for k in range(len(shapes))]

    def least(self, places: Floats) -> Floats:
        """Of each place from the nearest of the sites that surely meet its face; infinity where none surely does."""
        import shapely

        points = shapely.points(places)
        least = np.full(len(points), np.nan)
        place, face = self.tree.query(points, predicate="dwithin", distance=self.near)
        for each in np.unique(face).tolist():
            own = place[face == each]
            sites = self.sure[self.sure_of[each]]
            if sites.size or self.possible[self.possible_of[each]].size:
                distance = shapely.distance(self.geometry[sites][:, None], points[own][None, :])
                # a place on a line is in both faces: the farther one tells less
                least[own] = np.fmax(least[own], distance.min(axis=0, initial=np.inf))
        return np.where(np.isnan(least), np.inf, least)

    def may_have(self, places: Floats, rows: NDArray[np.int64]) -> NDArray[np.bool_]:
        """(k,) whether a site may meet the face of each place."""
        import shapely

        fits = np.zeros(len(places), dtype=bool)
        place, face = self.tree.query(shapely.points(places), predicate="dwithin", distance=self.near)
        for at, each in zip(place.tolist(), face.tolist(), strict=True):
            fits[at] |= bool((self.possible[self.possible_of[each]] == rows[at]).any())
        return fits
