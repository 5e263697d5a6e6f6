"""Offsets by shapely: unions of the buffers of single edges, in which nothing is simplified; and rebuilt shapes."""

import re

import numpy as np
import shapely

from vorotool.types.polygons.polygon_set import LINE
from vorotool.types.polygons.shapely_geometry import RingArrays, to_shapely

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


def closed_shapes(polygons):
    """Polygons, valid ones: holes may overlap."""
    found = np.array(to_shapely(polygons), dtype=object)[~polygons.is_line]
    return shapely.make_valid(found, method="structure", keep_collapsed=False)


def near_parts(polygons, distance):
    """Two unions of what is within a distance of edges, the smaller one first: the true one is between them.

    Discs are replaced by polygons inscribed in them, and by such around them.
    """
    wider = distance / np.cos(np.pi / (4 * QUADRANT))
    edges = edges_of(polygons)
    return [shapely.union_all(shapely.buffer(edges, d, quad_segs=QUADRANT)) for d in (distance, wider)]


def check_offsets(made, distances):
    """Assert that shapes are valid, and those of shapely within the error of its chords.

    Their areas are between those with smaller and with larger discs, up to a part of the square of their size. No place
    on the curves is farther from what is within the distance of edges by shapely, or deeper in it, and none of that is
    farther from what is within the distance by these curves, or deeper: the Hausdorff distance of the two.
    """
    assert set(made.distance.tolist()) <= set(distances)
    polygons = made.polygons
    if len(polygons.xy) == 0:  # nothing is left that anything is offset from
        assert made.distance.size == 0
        return
    closed = closed_shapes(polygons)
    for distance in distances:
        flat = made.flattened(abs(distance) * FLATTEN)
        shapes = np.array(to_shapely(flat), dtype=object)[made.distance == distance]
        wrong = [reason for reason in map(shapely.is_valid_reason, shapes) if not TOUCHES_ITSELF.match(reason)]
        assert not wrong, (distance, wrong)
        shapes = shapely.make_valid(shapes)
        extent = float(np.ptp(polygons.xy, axis=0).max()) + 2 * max(distance, 0)
        near = near_parts(polygons, abs(distance))
        if distance > 0:
            bounds = [shapely.union_all([*closed, part]) for part in near]
        else:
            bounds = [shapely.union_all([shapely.difference(s, part) for s in closed]) for part in reversed(near)]
        _check_areas(shapes, made.area[made.distance == distance], distance, extent, *bounds)
        _check_places(shapes, distance, extent, *near)


def _check_areas(shapes, areas, distance, extent, least, most):
    whole, length = shapely.union_all(shapes), sum(shapely.length(shapes))
    grid = GRID * extent  # without, nearly equal polygons may have all of one for their difference
    missing, excess = (shapely.difference(*two, grid_size=grid).area for two in ((least, whole), (whole, most)))
    allowed = FLATTEN * abs(distance) * length + ROUNDING * extent * (extent + length)
    assert missing <= allowed, (distance, missing, allowed)
    assert excess <= allowed, (distance, excess, allowed)
    apart = abs(areas.sum() - sum(shapely.area(shapes)))
    assert apart <= allowed, (distance, apart, allowed)


def _check_places(shapes, distance, extent, near, wider):
    rounding = ROUNDING * extent
    chord = abs(distance) * (1 - np.cos(np.pi / (4 * QUADRANT))) + rounding
    whole = shapely.union_all(shapes)
    border = shapely.boundary(whole)
    for part in (near, wider, whole, border):
        shapely.prepare(part)
    on_curves, on_near = (shapely.points(shapely.get_coordinates(part)) for part in (whole, near))
    assert shapely.dwithin(near, on_curves, chord).all(), distance
    assert shapely.dwithin(wider, on_curves, rounding).all(), distance
    is_outside = ~shapely.contains(whole, on_near)
    is_right = ~is_outside if distance > 0 else is_outside
    assert (is_right | shapely.dwithin(border, on_near, chord)).all(), distance


TOUCHES_ITSELF = re.compile("Valid Geometry|Ring Self-intersection")
"""What may be said of a shape: at a tie a ring may touch itself in a place."""
FLATTEN = 1e-5
ROUNDING = 1e-12
GRID = 1e-13


def check_rebuilt(again, polygons):
    """Assert that the features are those of a skeleton, up to a part of their extent, and that no parts overlap."""
    assert np.isin(again.feature, polygons.feature).all()
    for feature in np.unique(polygons.feature):
        check_rebuilt_feature(of_feature(again, feature), of_feature(polygons, feature))


def of_feature(polygons, feature):
    """One feature of a set."""
    chosen = np.flatnonzero(polygons.feature == feature)
    return RingArrays.of(polygons).taken(chosen)[0].polygons(polygons, chosen)


def check_rebuilt_feature(again, polygons):
    """The same of one feature, or of all together."""
    found = to_shapely(again)
    closed = shapely.union_all(closed_shapes(polygons))
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
