"""Check of Voronoi maps: by their arrays alone, and by distances from the input."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.common import fail, first_wrong
from vorotool.errors import UsageError
from vorotool.numeric.arrays import Floats, Indices, dots, following, norms, owners
from vorotool.numeric.curves.inverse_functions import PI, angle_of
from vorotool.numeric.lazy import shapely
from vorotool.numeric.numbers import shown_number, whole_number
from vorotool.types.arguments import check_value
from vorotool.types.box import bounds, corners_of
from vorotool.types.polygons.shapely_geometry import to_shapely, used_shapes
from vorotool.types.voronoi.tables import flattened_arcs, site_shapes
from vorotool.types.voronoi.voronoi_map import OUTSIDE, VoronoiMap

AREA = 1e-12
"""By how much the areas of all cells may differ from that of the frame, as a part of it."""

MOVE = 2.0**-27
"""Of the extent: what vertices are moved by on a lattice of 31 bits is less, and so is what distances change by."""

ROUNDING = 2.0**-44
"""Of the largest coordinate: the rounding of places and distances."""

_ALONG = (0.0, 0.25, 0.5, 0.75, 1.0)
"""Where borders are looked at, in the parameter of their Bezier curves."""

_FINE = 2.0**-20
"""Of the extent: how near to curves the lines are that places are looked up in."""

_SEED = 20


def verify_voronoi(cells: VoronoiMap, *, places: int = 1000) -> None:
    """Check a Voronoi map independently of its computation.

    Every side of an arc is passed by one ring of its cell, rings are closed, shells go counter-clockwise and holes
    clockwise, and the areas of all cells add up to that of the frame, or of the clip in it, unless a limit or
    enclosures leave places to nobody. Along borders both sites are equally far, and none is nearer; along the limit of
    distance the site is as far as that, and no other one nearer. At random places the site of the cell is the nearest
    one, not beyond the limit, and the first of those that cover the place, or that have the vertex which it is nearest
    to; where there is no cell, all sites are beyond it. With enclosures only the sites that meet the same face count,
    and cells stay in the faces that their sites meet. What the lattice moves is allowed for.

    Parameters
    ----------
    cells : VoronoiMap
        From any source.
    places : int
        Random places in the frame, and as many borders.

    Raises
    ------
    InputError
        If `cells` is not a Voronoi map.
    VerificationError
        If a check fails; the message names the first fault.

    Examples
    --------
    >>> from dataclasses import replace
    >>> from vorotool import voronoi
    >>> cells = voronoi([[0, 0], [4, 0], [0, 4]], frame=(-2, -2, 8, 8))
    >>> verify_voronoi(cells)
    >>> verify_voronoi(replace(cells, frame=(0, 0, 1, 1)))
    Traceback (most recent call last):
    vorotool.errors.VerificationError: the cells have an area of 64.0, but the frame one of 1
    """
    check_value(cells, "cells", "VoronoiMap")
    places = whole_number(places, "places")
    if not 0 < places < 2**31:
        raise UsageError(f"places is {shown_number(places)}: give an integer from 1 to {2**31 - 1}")
    _check_rings(cells)
    _check_areas(cells)
    if len(cells) and len(cells.polygons):
        sites = _SitePlaces(cells)
        random = np.random.default_rng(_SEED)
        _check_borders(cells, sites, random, places)
        if cells.max_distance is not None:
            _check_limit(cells, sites, cells.max_distance)
        _check_places(cells, sites, random, places)


# ---- arrays ------------------------------------------------------------------------------------------
def _check_rings(cells: VoronoiMap) -> None:
    arcs = len(cells.arcs)
    low, high = cells.arcs.T
    if (at := first_wrong((low < 0) | (high >= len(cells.vertices)) | (low >= high))) is not None:
        fail(f"arc {at} is from vertex {low[at]} to {high[at]}: the first must be the smaller one")
    signed = cells.ring_arcs.astype(np.int64)
    if (at := first_wrong((signed == 0) | (np.abs(signed) > arcs))) is not None:
        fail(f"a ring passes arc {signed[at]}, which does not exist")
    arc, is_back = np.abs(signed) - 1, signed < 0
    ring = owners(np.diff(cells.ring_starts))
    cell = cells.cell_of_polygon[owners(np.diff(cells.polygon_starts))][ring]
    if (at := first_wrong(cells.sites[arc, is_back.astype(int)] != cell)) is not None:
        fail(
            f"ring {ring[at]} of cell {cell[at]} passes arc {arc[at]}, whose sides belong to sites "
            f"{cells.sites[arc[at]]}"
        )
    passed = np.bincount(2 * arc + is_back, minlength=2 * arcs)
    if (at := first_wrong(passed != (cells.sites.ravel() != OUTSIDE))) is not None:
        fail(f"arc {at // 2} is passed {passed[at]} times with its {('left', 'right')[at % 2]} side")
    begin = np.where(is_back, high[arc], low[arc])
    end = np.where(is_back, low[arc], high[arc])
    after = following(cells.ring_starts)
    if (at := first_wrong(end != begin[after])) is not None:
        fail(f"ring {ring[at]} continues at vertex {begin[after[at]]}, but arc {arc[at]} ends at {end[at]}")


def _check_areas(cells: VoronoiMap) -> None:
    """Areas by the trapezoids below curves: another sum than that of the map."""
    _, _, w, h = cells.frame
    source, target = cells.vertices[cells.arcs[:, 0]], cells.vertices[cells.arcs[:, 1]]
    control = np.where(cells.is_parabola[:, None], cells.control, (source + target) / 2)
    y0, y1, y2 = (places[:, 1] - cells.frame[1] for places in (source, control, target))
    first, second = control[:, 0] - source[:, 0], target[:, 0] - control[:, 0]
    # the integral of y dx: of products of Bernstein polynomials of degrees 2 and 1
    below = (first * (3 * y0 + 2 * y1 + y2) + second * (y0 + 2 * y1 + 3 * y2)) / 6
    below[cells.is_circle] = _below_circles(cells, source, target)
    arc, is_back = np.abs(cells.ring_arcs.astype(np.int64)) - 1, cells.ring_arcs < 0
    area = -np.bincount(
        owners(np.diff(cells.ring_starts)),
        np.where(is_back, -below[arc], below[arc]),
        minlength=len(cells.ring_starts) - 1,
    )
    largest = float(np.abs(cells.vertices).max(initial=0))
    slack = AREA * w * h + ROUNDING * largest * (w + h)
    if cells.is_circle.any() and cells.max_distance is not None:
        slack += ROUNDING * cells.max_distance * (cells.max_distance + largest)
    if (at := first_wrong(np.where(cells.is_hole, area > slack, area < -slack))) is not None:
        fail(f"ring {at} has the area {area[at]}: shells go counter-clockwise, holes clockwise")
    total = float(area.sum())
    if not (len(cells.cell_starts) > 1 and len(cells.polygons)):
        return
    whole, name = w * h, "frame" if cells.clip is None else "clip"
    cuts = [each.xy for each in (cells.clip, cells.enclosures) if each is not None]
    if cuts:  # the frame is on the lattice, too
        shared = shared_out(cells)
        whole = float(shared.area)
        extent = float(np.ptp(np.concatenate([cells.polygons.xy, *cuts]), axis=0).max())
        # where the lattice alone has something in common with the frame, shapely has nothing
        slack += MOVE * (w + h + extent + largest * 2.0**-20) * max(float(shared.length), 2 * (w + h))
    is_whole = cells.max_distance is None and cells.enclosures is None
    if total - whole > slack or (is_whole and whole - total > slack):
        fail(f"the cells have an area of {total}, but the {name} one of {whole}")


def _below_circles(cells: VoronoiMap, source: Floats, target: Floats) -> Floats:
    """The integral of y dx along circular arcs, y from the frame's."""
    center = cells.center[cells.is_circle]
    a, b = source[cells.is_circle] - center, target[cells.is_circle] - center
    first, last = angle_of(*a.T), angle_of(*b.T)
    is_left = cells.sites[cells.is_circle, 0] != OUTSIDE
    turn = np.where(is_left, np.mod(last - first, 2 * PI), -np.mod(first - last, 2 * PI))
    square = dots(a, a)
    high = center[:, 1] - cells.frame[1]
    return high * (b[:, 0] - a[:, 0]) - (square * turn - b[:, 0] * b[:, 1] + a[:, 0] * a[:, 1]) / 2


# ---- distances ---------------------------------------------------------------------------------------
class _SitePlaces:
    """The sites as geometry of shapely, and how far distances may be off."""

    def __init__(self, cells: VoronoiMap) -> None:
        given = cells.polygons
        self.geometry = site_shapes(cells)
        self.tree = shapely.STRtree(self.geometry)
        others = [each.xy for each in (cells.clip, cells.enclosures) if each is not None]
        # with others the lattice holds the frame, too
        placed = np.concatenate([given.xy, *others, *([corners_of(cells.frame)] if others else [])])
        extent = float(np.ptp(placed, axis=0).max())
        largest = float(max(np.abs(placed).max(), np.abs(cells.vertices).max(initial=0)))
        self.tolerance = MOVE * extent + ROUNDING * largest
        self.corners = {tuple(place) for place in given.xy.tolist()}
        self.faces = None if cells.enclosures is None else EnclosedFaces(cells, self.geometry, 4 * self.tolerance)

    def distances(self, site: NDArray[Any], places: Floats) -> Floats:
        """Of each place from one site."""
        return shapely.distance(self.geometry[site], shapely.points(places))

    def least(self, places: Floats) -> Floats:
        """Of each place from the nearest site, with enclosures of those that meet the face that it is in."""
        if self.faces is not None:
            return self.faces.least(places)
        found, distance = self.tree.query_nearest(shapely.points(places), return_distance=True, all_matches=False)
        least = np.empty(len(places))
        least[found[0]] = distance
        return least


def _check_borders(cells: VoronoiMap, sites: _SitePlaces, random: np.random.Generator, count: int) -> None:
    border = np.flatnonzero(cells.is_border & ~cells.is_cut)
    if len(border) > count:
        border = np.sort(random.choice(border, count, replace=False))
    for end in (0, 1):
        vertex = cells.arcs[border, end]
        place = cells.vertices[vertex]
        least = sites.least(place) if sites.faces is None else sites.distances(cells.sites[border, 0], place)
        if (at := first_wrong(np.abs(least - cells.radius[vertex]) > sites.tolerance)) is not None:
            k = int(vertex[at])
            place = tuple(cells.vertices[k].tolist())
            fail(f"vertex {k} at {place} is {least[at]} from its sites, but its radius is {cells.radius[k]}")
    source, target = cells.vertices[cells.arcs[border, 0]], cells.vertices[cells.arcs[border, 1]]
    control = np.where(cells.is_parabola[border, None], cells.control[border], (source + target) / 2)
    slack = sites.tolerance + ROUNDING * norms(control - source)
    for t in _ALONG:
        place = (1 - t) * (1 - t) * source + 2 * t * (1 - t) * control + t * t * target
        least = sites.least(place)
        for hand in (0, 1):
            site = cells.sites[border, hand]
            distance = sites.distances(site, place)
            if (at := first_wrong(~(distance <= least + slack))) is not None:
                fail(
                    f"arc {border[at]} at {tuple(place[at].tolist())} is {distance[at]} from site {site[at]}, "
                    f"but another one is {least[at]} from there"
                )


def _check_limit(cells: VoronoiMap, sites: _SitePlaces, limit: float) -> None:
    """Along what is cut, but not by the frame, the site is as far as the limit, and none is nearer."""
    x, y, w, h = cells.frame
    source, target = cells.vertices[cells.arcs[:, 0]], cells.vertices[cells.arcs[:, 1]]
    sides = np.array([x, y, x + w, y + h])
    is_along = ((np.tile(source, 2) == sides) & (np.tile(target, 2) == sides)).any(axis=1)
    is_limit = cells.is_circle
    if cells.clip is None and cells.enclosures is None:
        is_limit = is_limit | (cells.is_cut & ~is_along)
    arc = np.flatnonzero(is_limit)
    site = cells.sites[arc].max(axis=1)
    points, start = flattened_arcs(cells, max(w, h) * _FINE)
    inner = points[(start[arc] + start[arc + 1] - 1) // 2]
    middle = np.where(cells.is_circle[arc, None], inner, (source[arc] + target[arc]) / 2)
    for place in (source[arc], middle, target[arc]):
        distance, least = sites.distances(site, place), sites.least(place)
        slack = sites.tolerance
        if (at := first_wrong(~((np.abs(distance - limit) <= slack) & (least >= distance - slack)))) is not None:
            fail(
                f"arc {arc[at]} at {tuple(place[at].tolist())} is {distance[at]} from site {site[at]}, and "
                f"{least[at]} from the nearest one, but is on the limit of {limit}"
            )


def _check_places(cells: VoronoiMap, sites: _SitePlaces, random: np.random.Generator, count: int) -> None:
    x, y, w, h = cells.frame
    places = np.array([x, y]) + random.random((count, 2)) * np.array([w, h])
    points = shapely.points(places)
    shapes = cells.to_shapely(flatten=max(w, h) * _FINE)
    place, cell = shapely.STRtree(shapes).query(points, predicate="within")
    least = sites.least(places)
    distance = sites.distances(cell, places[place])
    near = max(w, h) * _FINE + sites.tolerance  # lines instead of curves
    if (at := first_wrong(~(distance <= least[place] + 2 * near))) is not None:
        fail(
            f"{tuple(places[place[at]].tolist())} is {distance[at]} from site {cell[at]}, whose cell it is in, "
            f"but another one is {least[place[at]]} from there"
        )
    if cells.max_distance is not None:
        _check_reach(cells, (places, least), (place, distance), near)
    if cells.clip is not None or sites.faces is not None:
        _check_shares(cells, sites, (places, least), (place, cell), near)
    if sites.faces is None:
        _check_ties(cells, sites, places[place], cell, shapes, near)


def _check_reach(
    cells: VoronoiMap, at_places: tuple[Floats, Floats], held: tuple[Indices, Floats], near: float
) -> None:
    """Places in cells are within the limit of their site; those in none are beyond it, if nothing else cuts cells."""
    (places, least), (place, distance) = at_places, held
    limit = cells.max_distance
    assert limit is not None
    if (at := first_wrong(distance > limit + near)) is not None:
        fail(f"{tuple(places[place[at]].tolist())} is {distance[at]} from the site of its cell: the limit is {limit}")
    if cells.clip is not None or cells.enclosures is not None:
        return
    is_free = np.ones(len(places), dtype=bool)
    is_free[place] = False
    if (at := first_wrong(is_free & (least < limit - near))) is not None:
        fail(f"{tuple(places[at].tolist())} is {least[at]} from the nearest site, and in no cell: the limit is {limit}")


def _check_shares(
    cells: VoronoiMap, sites: _SitePlaces, at_places: tuple[Floats, Floats], held: tuple[Indices, Indices], near: float
) -> None:
    """What is shared out is in cells, unless no site is near; what is not is in none, and sites stay in their faces."""
    (places, least), (place, cell) = at_places, held
    points = shapely.points(places)
    shared = shared_out(cells)
    shapely.prepare(shared)
    is_in, is_held = shapely.intersects(shared, points), np.zeros(len(places), dtype=bool)
    is_held[place] = True
    limit = np.inf if cells.max_distance is None else cells.max_distance
    is_wrong = np.where(is_in, ~is_held & (least < limit - near), is_held)
    doubtful = np.flatnonzero(is_wrong)
    is_wrong[doubtful] = shapely.distance(shapely.boundary(shared), points[doubtful]) > near
    if sites.faces is not None:
        close = shapely.STRtree(sites.faces.boundaries).query(points, predicate="dwithin", distance=near)[0]
        strange = ~sites.faces.may_have(places[place], cell)
        is_wrong[place[strange]] = True
        is_wrong[close] = False
    if (at := first_wrong(is_wrong)) is not None:
        fail(
            f"{tuple(places[at].tolist())} is in {('a' if is_held[at] else 'no')} cell, contrary to the clip or the "
            "enclosures"
        )


def _check_ties(
    cells: VoronoiMap, sites: _SitePlaces, places: Floats, cell: Indices, shapes: NDArray[Any], near: float
) -> None:
    """Where several sites cover a place, or have the vertex that it is nearest to, it belongs to the first."""
    points = shapely.points(places)
    place, site = sites.tree.query_nearest(points, all_matches=True)
    earlier = site < cell[place]
    for at, other in zip(place[earlier].tolist(), site[earlier].tolist(), strict=True):
        both = sites.geometry[[other, cell[at]]]
        feet = shapely.get_coordinates(shapely.shortest_line(points[at], both)).reshape(2, 2, 2)[:, 1].tolist()
        is_corner = feet[0] == feet[1] and tuple(feet[0]) in sites.corners
        is_covered = min(_depth(each, points[at]) for each in both) > near
        if (is_corner or is_covered) and shapely.distance(shapely.boundary(shapes[cell[at]]), points[at]) > near:
            fail(f"{tuple(places[at].tolist())} is in cell {cell[at]}, but site {other} is as near and comes first")


def _depth(geometry: Any, point: Any) -> float:
    """How far a place is from the boundary of the polygons that cover it; 0 if none does."""
    parts = shapely.get_parts(shapely.get_parts(geometry))
    covering = parts[shapely.covers(parts, point) & (shapely.area(parts) > 0)]
    return float(shapely.distance(shapely.boundary(covering), point).max(initial=0))


_BITS = 30
"""Steps of the lattice in half the extent, as bits."""


def shared_out(cells: VoronoiMap, step: float = 0, grid: float | None = None) -> Any:
    """Give the area within the frame and the clip of a map, as geometry of shapely; with a step, rounded to that."""
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
    return shapely.transform(geometry, lambda xy: np.rint(xy / step) * step) if step else geometry


def _steps(cells: VoronoiMap) -> list[float]:
    """Give the steps that the lattice may have: a frame that cuts a clip may reach farther than the map tells."""
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
        closed = [*shapely.get_parts(shapely.polygonize(shapely.get_parts(lines)))]
        bounds = shapely.box(*shapely.total_bounds([lines, shared, *geometry]))
        margin = max(bounds.length, 1.0)
        return [*closed, shapely.difference(shapely.buffer(bounds, margin), shapely.union_all(closed))]

    def _wholes(self, shared: Any, around: list[Any], cuts: Any) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """For each face the one whose sites it may have, and that whose sites it surely has."""
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
        row, site = shapely.STRtree(self.geometry).query(shapes, predicate="intersects")
        return [site[row == k] for k in range(len(shapes))]

    def least(self, places: Floats) -> Floats:
        """Of each place from the nearest of the sites that surely meet its face; infinity where none surely does."""
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
        fits = np.zeros(len(places), dtype=bool)
        place, face = self.tree.query(shapely.points(places), predicate="dwithin", distance=self.near)
        for at, each in zip(place.tolist(), face.tolist(), strict=True):
            fits[at] |= bool((self.possible[self.possible_of[each]] == rows[at]).any())
        return fits
