"""Offsets by shapely: unions of the buffers of single edges, in which nothing is simplified; and rebuilt shapes."""

import numpy as np
import shapely

from vorotool.geometry.polygon_conversion import to_shapely
from vorotool.geometry.polygons import LINE

QUADRANT = 64
"""Chords of a quarter of shapely's circles."""


def edges_of(polygons):
    """Edges of rings and lines, and single vertices, each a geometry."""
    found = []
    for ring, kind in enumerate(polygons.ring_kind.tolist()):
        places = polygons.ring(ring)
        if kind != LINE:
            places = np.concatenate([places, places[:1]])
        if len(places) == 1:
            found.append(shapely.Point(places[0]))
        found += [shapely.LineString(pair) for pair in np.stack([places[:-1], places[1:]], axis=1)]
    return found


def bounds_of(polygons, distance):
    """Two unions of polygons that the true shape at a distance is between, the smaller one first.

    Discs are replaced by polygons inscribed in them, and by such around them.
    """
    wider = abs(distance) / np.cos(np.pi / (4 * QUADRANT))
    closed = [shape for shape, line in zip(to_shapely(polygons), polygons.is_line, strict=True) if not line]
    edges = edges_of(polygons)
    near = [shapely.union_all(shapely.buffer(edges, d, quad_segs=QUADRANT)) for d in (abs(distance), wider)]
    if distance > 0:
        return [shapely.union_all([*closed, part]) for part in near]
    return [shapely.union_all([shapely.difference(shape, part) for shape in closed]) for part in reversed(near)]


def check_offsets(made, distances):
    """Assert that shapes are valid, and between the bounds up to a part of the square of their size."""
    assert set(made.distance.tolist()) <= set(distances)
    polygons = made.polygons
    for distance in distances:
        chosen = made.distance == distance
        flat = np.array(to_shapely(made.flattened(abs(distance) * FLATTEN)), dtype=object)[chosen]
        assert shapely.is_valid(flat).all(), (distance, [shapely.is_valid_reason(shape) for shape in flat])
        whole = shapely.union_all(flat)
        least, most = bounds_of(polygons, distance)
        xy = polygons.xy
        extent = float(np.ptp(xy, axis=0).max()) + 2 * max(distance, 0)
        length = sum(shapely.length(flat))
        missing, excess = shapely.difference(least, whole).area, shapely.difference(whole, most).area
        allowed = FLATTEN * abs(distance) * length + ROUNDING * extent * (extent + length)
        assert missing <= allowed, (distance, missing, allowed)
        assert excess <= allowed, (distance, excess, allowed)
        apart = abs(made.area[chosen].sum() - sum(shapely.area(flat)))
        assert apart <= allowed, (distance, apart, allowed)


FLATTEN = 1e-5
ROUNDING = 1e-12


def check_rebuilt(again, polygons):
    """Assert that polygons are those of a skeleton, up to a part of their extent, and that none overlaps another."""
    found = to_shapely(again)
    closed = shapely.union_all([s for s, line in zip(to_shapely(polygons), polygons.is_line, strict=True) if not line])
    assert shapely.is_valid(found).all(), [shapely.is_valid_reason(shape) for shape in found]
    whole = shapely.union_all(found)
    extent = float(np.ptp(polygons.xy, axis=0).max())
    allowed = REBUILT * extent * closed.length
    assert abs(sum(shapely.area(found)) - closed.area) <= allowed
    assert shapely.symmetric_difference(whole, closed).area <= allowed
    if not closed.is_empty:
        apart = shapely.hausdorff_distance(shapely.boundary(whole), shapely.boundary(closed))
        assert apart <= REBUILT * extent, (apart, extent)


REBUILT = 1e-9
