"""Distances between shapes by bounds: of parts of edges by bisection, of parts of regions by squares.

Distances from an edge are convex: on a part of an edge or in a square the largest one is at an end or at a corner, and
the smallest of these over all edges bounds the distance from all of them. No code is shared with the library.
"""

import numpy as np
import shapely


def edges_of(geometry):
    """(n, 2, 2) edges of shapely geometry; of points twice the same."""
    found = []
    for part in shapely.get_parts(np.atleast_1d(geometry)).tolist():
        if part.geom_type == "Polygon":
            found += [edges_of(shapely.LineString(ring)) for ring in (part.exterior, *part.interiors)]
        else:
            xy = shapely.get_coordinates(part)
            found.append(np.stack([xy[:-1], xy[1:]], axis=1) if len(xy) > 1 else np.stack([xy, xy], axis=1))
    return np.concatenate(found)


def from_edges(places, edges):
    """(places, edges) distances."""
    a, way = edges[:, 0], edges[:, 1] - edges[:, 0]
    square = (way * way).sum(axis=1)
    away = places[:, None] - a
    t = np.divide((away * way).sum(axis=2), square, out=np.zeros(away.shape[:2]), where=square > 0)
    away -= np.clip(t, 0, 1)[..., None] * way
    return np.sqrt((away * away).sum(axis=2))


def region_of(geometry):
    """What is filled, as one geometry."""
    parts = shapely.get_parts(np.atleast_1d(geometry))
    return shapely.union_all(shapely.make_valid(parts[shapely.get_type_id(parts) == 3]))


def directed_bounds(a, b, *, boundary=False, tolerance=1e-10, inner=1 / 64):
    """Bounds of the largest distance from a place of a to the nearest one of b.

    Parameters
    ----------
    a, b : shapely geometry
        Polygons are filled, unless `boundary`.
    tolerance : float
        Between the bounds along edges.
    inner : float
        Between the bounds inside polygons, of the extent.

    Returns
    -------
    (float, float)
    """
    edges, of = edges_of(b), edges_of(a)
    region = shapely.GeometryCollection() if boundary else region_of(b)
    low, high = _along_edges(of, edges, region, tolerance)
    own = shapely.GeometryCollection() if boundary else region_of(a)
    if own.is_empty or own.area == 0:
        return low, high
    inside_low, inside_high = _inside(own, edges, region, low, inner * float(np.ptp(of.reshape(-1, 2), axis=0).max()))
    return max(low, inside_low), max(high, inside_high)


def _distances(places, edges, region):
    found = from_edges(places, edges).min(axis=1)
    if not region.is_empty:
        found[shapely.intersects_xy(region, *places.T)] = 0
    return found


def _along_edges(of, edges, region, tolerance):
    s, t = of[:, 0], of[:, 1]
    low, high = 0.0, 0.0
    while len(s):
        low = max(low, float(_distances(np.concatenate([s, t]), edges, region).max()))
        bound = np.maximum(from_edges(s, edges), from_edges(t, edges)).min(axis=1)
        if not region.is_empty:
            bound[shapely.covers(region, shapely.linestrings(np.stack([s, t], axis=1)))] = 0
        kept = bound > low + tolerance
        high = max(high, float(bound[~kept].max(initial=0)))
        s, t = s[kept], t[kept]
        middle = (s + t) / 2
        s, t = np.concatenate([s, middle]), np.concatenate([middle, t])
    return low, max(low, high)


def _inside(own, edges, region, low, step):
    left, bottom, right, top = own.bounds
    corners, size = np.array([[left, bottom]]), max(right - left, top - bottom)
    shapely.prepare(own)
    around = np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
    while True:
        places = corners[:, None] + size * around
        distance = from_edges(places.reshape(-1, 2), edges).reshape(len(corners), 4, -1)
        bound = distance.max(axis=1).min(axis=1)
        squares = shapely.polygons(places)
        kept = shapely.intersects(own, squares) & (bound > low)
        if not region.is_empty:
            kept &= ~shapely.covers(region, squares)
        corners, bound = corners[kept], bound[kept]
        if not len(corners):
            return low, low
        middle = corners + size / 2
        inside = shapely.intersects_xy(own, *middle.T)
        if inside.any():
            low = max(low, float(_distances(middle[inside], edges, region).max()))
        if size < step:
            return low, float(bound.max(initial=low))
        size /= 2
        corners = (corners[:, None] + size * around).reshape(-1, 2)


def smallest(a, b, *, boundary=False):
    """The smallest distance."""
    if not boundary:
        return float(
            shapely.distance(
                shapely.GeometryCollection(list(np.atleast_1d(a))), shapely.GeometryCollection(list(np.atleast_1d(b)))
            )
        )
    outlines = (
        shapely.GeometryCollection([shapely.boundary(g) if shapely.get_type_id(g) == 3 else g for g in each])
        for each in (a, b)
    )
    return float(shapely.distance(*outlines))
