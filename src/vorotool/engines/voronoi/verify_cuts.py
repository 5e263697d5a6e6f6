"""What a clip, a frame and enclosures share out, found by shapely alone, to check Voronoi maps by."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.arrays import Floats
from vorotool.types.box import bounds, corners_of
from vorotool.types.polygons.shapely_geometry import to_shapely, used_shapes
from vorotool.types.voronoi.voronoi_map import VoronoiMap

_BITS = 30
"""Steps of the lattice in half the extent, as bits."""


def shared_out(cells: VoronoiMap, step: float = 0, grid: float | None = None) -> Any:
    """Give the area within the frame and the clip of a map, as geometry of shapely; with a step, rounded to that."""
    import shapely

    x, y, w, h = cells.frame
    box = _rounded(shapely.box(x, y, x + w, y + h), step)
    if cells.clip is None:
        return box
    clip = shapely.get_parts(shapely.make_valid(_rounded(used_shapes(cells.clip), step)))
    clip = shapely.union_all(clip[shapely.area(clip) > 0], grid_size=grid)
    both = shapely.get_parts(shapely.intersection(clip, box, grid_size=grid))
    return shapely.multipolygons(both[shapely.area(both) > 0])  # where both only touch there are lines and points


def _rounded(geometry: Any, step: float) -> Any:
    """Round coordinates to multiples of a power of two, exactly; by none, leave them."""
    import shapely

    return shapely.transform(geometry, lambda xy: np.rint(xy / step) * step) if step else geometry


def _steps(cells: VoronoiMap) -> list[float]:
    """Give the steps that the lattice may have: a frame that cuts a clip may reach farther than the map tells."""
    import shapely

    assert cells.enclosures is not None
    corners = corners_of(cells.frame)
    placed, margin = np.concatenate([cells.polygons.xy, cells.enclosures.xy, corners]), 0.0
    if cells.clip is not None:
        clip = shapely.total_bounds(to_shapely(cells.clip)[~cells.clip.is_line]).reshape(2, 2)
        placed = np.concatenate([placed, clip])
        if (clip[0] < corners[0]).any() or (clip[1] > corners[2]).any():
            margin = float((clip[1] - clip[0]).max())
    low, high = bounds(placed)
    half = float((high / 2 - low / 2).max())
    least, most = np.frexp([half, half + margin])[1].tolist()
    return [math.ldexp(1.0, exponent - _BITS) for exponent in range(least, most + 1)]


class EnclosedFaces:
    """Faces between the enclosures of a map on its lattice; crossings there are rounded or not."""

    def __init__(self, cells: VoronoiMap, geometry: NDArray[Any], near: float) -> None:
        import shapely

        self.readings = [_Faces(cells, geometry, near, step, grid) for step in _steps(cells) for grid in (None, step)]
        self.boundaries = shapely.boundary(np.concatenate([each.shapes for each in self.readings]))

    def least(self, places: Floats) -> Floats:
        """Of each place from the nearest of the sites that surely meet its face; infinity where none surely does."""
        return np.maximum.reduce([each.least(places) for each in self.readings])

    def may_have(self, places: Floats, rows: NDArray[np.int64]) -> NDArray[np.bool_]:
        """(k,) whether a site may meet the face of each place."""
        return np.logical_or.reduce([each.may_have(places, rows) for each in self.readings])


class _Faces:
    """Faces between lines, and the sites that meet the inside of each."""

    def __init__(self, cells: VoronoiMap, geometry: NDArray[Any], near: float, step: float, grid: float | None) -> None:
        import shapely

        assert cells.enclosures is not None
        given = to_shapely(cells.enclosures)
        lines = _rounded(np.where(cells.enclosures.is_line, given, shapely.boundary(given)), step)
        shared = shared_out(cells, step, grid)
        noded = shapely.union_all([*lines, shapely.boundary(shared)], grid_size=grid)
        faces = np.asarray(shapely.get_parts(shapely.polygonize(shapely.get_parts(noded))))
        self.shapes = faces[shapely.covers(shared, shapely.point_on_surface(faces))]
        cuts = shapely.union_all(lines, grid_size=grid)
        around = self._closed(cuts, shared, geometry)
        self.geometry, self.near = geometry, near
        self.sure, self.possible = (
            self._meeting(shapely.buffer(np.array([*self.shapes, *around]), step)) for step in (-near, near)
        )
        self.possible_of, self.sure_of = self._wholes(shared, around, cuts)
        self.tree = shapely.STRtree(self.shapes)

    def _closed(self, lines: Any, shared: Any, geometry: NDArray[Any]) -> list[Any]:
        """The faces that enclosures close by themselves, and what is around them all."""
        import shapely

        closed = [*shapely.get_parts(shapely.polygonize(shapely.get_parts(lines)))]
        bounds = shapely.box(*shapely.total_bounds([lines, shared, *geometry]))
        margin = max(bounds.length, 1.0)
        return [*closed, shapely.difference(shapely.buffer(bounds, margin), shapely.union_all(closed))]

    def _wholes(self, shared: Any, around: list[Any], cuts: Any) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """For each face the one whose sites it may have, and that whose sites it surely has."""
        import shapely

        middles = shapely.point_on_surface(self.shapes)
        possible, sure = np.arange(len(self.shapes)), np.arange(len(self.shapes))
        for k, each in enumerate(around, len(self.shapes)):
            inside = shapely.covers(each, middles)
            parts = shapely.get_parts(shapely.intersection(each, shared))
            if np.count_nonzero(shapely.area(parts) > 0) != np.count_nonzero(inside):
                continue  # lines with open ends part it
            possible[inside] = k
            if not shapely.intersects(cuts, shapely.buffer(each, -2 * self.near)):
                sure[inside] = k  # else open lines may part it at the frame or the clip
        return possible, sure

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
