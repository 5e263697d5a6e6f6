"""Voronoi diagrams of any shapes by shapely's distances at places, and what is true of every map of cells."""

import warnings

import numpy as np
import shapely

from vorotool import voronoi
from vorotool.errors import RepairWarning

EQUAL, NEARLY = 1e-14, 1e-8
"""Of the extent: distances that differ by less than the first tie, by less than the second are not decided."""


QUARTER = 64
"""Chords of a quarter of a circle in buffers."""


def quietly(sites, **options):
    """Make a map without a word on what is repaired."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RepairWarning)
        return voronoi(sites, **options)


def distances_of(geometry, places):
    """(sites, places) distances; infinity from a site without places."""
    points = shapely.points(places)
    return np.array(
        [
            np.full(len(points), np.inf) if each is None or each.is_empty else shapely.distance(each, points)
            for each in geometry
        ]
    ).reshape(len(geometry), len(points))


def places_on_borders(cells, random, count):
    """Places on borders of cells, and the borders that they are on."""
    arc = random.choice(np.flatnonzero(cells.is_border), count)
    t = random.random((count, 1))
    source, target = cells.vertices[cells.arcs[arc, 0]], cells.vertices[cells.arcs[arc, 1]]
    control = np.where(cells.is_parabola[arc][:, None], cells.control[arc], (source + target) / 2)
    return (1 - t) ** 2 * source + 2 * t * (1 - t) * control + t * t * target, arc


def assert_is_coverage(cells):
    """Cells share their borders and fill the frame, however coarse polylines are."""
    x, y, w, h = cells.frame
    rounded = 2.0**-50 * (abs(x) + abs(y) + w + h) * (w + h)  # corners of a frame far from the origin
    assert abs(cells.areas.sum() - w * h) <= 1e-12 * w * h + rounded
    for flatten in (None, max(w, h) * 1e-3, max(w, h)):
        shapes = cells.to_shapely(flatten=flatten)
        assert shapely.is_valid(shapes).all(), shapely.is_valid_reason(shapes)
        assert shapely.coverage_is_valid(shapes)
        assert abs(shapely.area(shapes).sum() - w * h) <= 1e-11 * w * h + rounded
    fine = cells.to_shapely(flatten=max(w, h) * 1e-7)
    np.testing.assert_allclose(shapely.area(fine), cells.areas, rtol=1e-5, atol=1e-6 * w * h)
    np.testing.assert_allclose(shapely.length(fine), cells.perimeters, rtol=1e-6, atol=1e-6 * (w + h))
    return fine


def assert_nearest(geometry, cells, *, seed=0, count=200):
    """At random places and close to borders the cell is that of the first of the nearest sites; gives how many told."""
    random = np.random.default_rng(seed)
    x, y, w, h = cells.frame
    extent = max(w, h)
    places = np.array([x, y]) + random.random((count, 2)) * [w, h]
    if cells.is_border.any():
        near, arc = places_on_borders(cells, random, count)
        distance = distances_of(geometry, near)
        least = distance.min(axis=0)
        far = np.nan_to_num(np.abs(cells.control[arc] - near)).max(axis=1) + extent
        for hand in (0, 1):
            assert (np.abs(distance[cells.sites[arc, hand], np.arange(count)] - least) <= 1e-7 * far).all()
        places = np.concatenate(
            [places, near + random.normal(size=(count, 2)) * extent * 10.0 ** -random.uniform(2, 6, (count, 1))]
        )
    places = places[((places > [x, y]) & (places < [x + w, y + h])).all(axis=1)]
    distance = distances_of(geometry, places)
    least = distance.min(axis=0)
    ties = distance <= least + EQUAL * extent
    shapes = assert_is_coverage(cells)
    points = shapely.points(places)
    found = np.full(len(points), -1)
    at, cell = shapely.STRtree(shapes).query(points, predicate="intersects")
    found[at] = cell
    assert (found >= 0).all()
    is_told = (ties == (distance <= least + NEARLY * extent)).all(axis=0)
    is_told &= shapely.distance(shapely.boundary(shapes[found]), points) > 1e-6 * extent
    np.testing.assert_array_equal(found[is_told], ties.argmax(axis=0)[is_told])
    return int(is_told.sum())


def assert_is_within(geometry, cells):
    """Each cell is that of the map without a limit, within a buffer of its site; and they share their borders."""
    limit, (x, y, w, h) = cells.max_distance, cells.frame
    extent = max(w, h)
    fine = extent * 1e-6
    whole = quietly(geometry, frame=cells.frame).to_shapely(flatten=fine)
    shapes = cells.to_shapely(flatten=fine)
    near = shapely.buffer(_as_array(geometry), limit, quad_segs=QUARTER)
    wanted = shapely.intersection(whole, near)
    off = 2 * limit * (1 - np.cos(np.pi / 4 / QUARTER)) + 2 * fine
    room = off * np.maximum(shapely.length(wanted), shapely.length(shapes)) + 1e-9 * extent * extent
    assert (shapely.area(shapely.symmetric_difference(wanted, shapes)) <= room).all()
    assert (np.abs(shapely.area(wanted) - cells.areas) <= room).all()
    frame = shapely.box(x, y, x + w, y + h)
    together = shapely.union_all(near).intersection(frame)
    assert abs(together.area - cells.areas.sum()) <= room.sum() + off * together.length
    np.testing.assert_allclose(shapely.length(shapes), cells.perimeters, rtol=1e-4, atol=1e-4 * extent)
    for flatten in (None, extent * 1e-3, extent):
        made = cells.to_shapely(flatten=flatten)
        assert shapely.is_valid(made).all(), shapely.is_valid_reason(made)
        assert shapely.coverage_is_valid(made)


def _as_array(geometry):
    places = np.empty(len(geometry), dtype=object)
    places[:] = [each if isinstance(each, shapely.Geometry) else shapely.Point(each) for each in geometry]
    return places
