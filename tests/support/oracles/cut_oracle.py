"""Cells between cuts by shapely's overlays, polygonized faces and distances at places."""

import numpy as np
import shapely

NEAR = 1e-5


def faces_between(lines, box):
    """Faces of lines in a box, which closes them."""
    noded = shapely.union_all([*lines, box.exterior])
    return list(shapely.get_parts(shapely.polygonize(shapely.get_parts(noded))))


def regions_of_lines(lines, box, sites):
    """Faces, and the sites that meet the inside of each."""
    faces = faces_between(lines, box)
    return [(face, [k for k, site in enumerate(sites) if site.intersects(face.buffer(-1e-6))]) for face in faces]


def assert_cut_coverage(cells, area):
    """Cells have an area, and share their borders bit for bit, however coarse polylines are."""
    slack = 3e-8 * max(area, 1)
    assert abs(cells.areas.sum() - area) <= slack
    for flatten in (None, 1e-3, 1.0):
        shapes = cells.to_shapely(flatten=flatten)
        assert shapely.is_valid(shapes).all(), shapely.is_valid_reason(shapes)
        assert shapely.coverage_is_valid(shapes)
        assert abs(shapely.area(shapes).sum() - area) <= slack


def meets_itself(shapes):
    """Whether a hole meets its shell: GEOS looks at rings one by one, and takes what is beside both for overlapping."""
    parts = shapely.get_parts(shapes)
    return any(
        set(map(tuple, part.exterior.coords)) & set(map(tuple, hole.coords))
        for part in parts
        for hole in part.interiors
    )


def assert_nearest_in_regions(cells, sites, regions, *, limit=None, seed=0, count=40):
    """At random places in each region the cell is of the first of the nearest of its sites; gives how many told.

    Beyond the limit it is nobody's.
    """
    random = np.random.default_rng(seed)
    shapes = cells.to_shapely(flatten=NEAR / 10)
    told = 0
    for region, own in regions:
        x0, y0, x1, y1 = region.bounds
        points = shapely.points([x0, y0] + random.random((count, 2)) * [x1 - x0, y1 - y0])
        points = points[shapely.contains(region, points) & (shapely.distance(region.boundary, points) > NEAR)]
        if not own:
            assert not shapely.STRtree(shapes).query(points, predicate="intersects").size
            continue
        distance = np.array([shapely.distance(sites[k], points) for k in own])
        if limit is not None:
            least = distance.min(axis=0)
            assert not shapely.STRtree(shapes).query(points[least > limit + NEAR], predicate="intersects").size
            points, distance = points[least < limit - NEAR], distance[:, least < limit - NEAR]
        tie = distance <= distance.min(axis=0) + 1e-9
        clear = (tie == (distance <= distance.min(axis=0) + NEAR)).all(axis=0)
        first = np.array(own)[tie.argmax(axis=0)]
        assert (shapely.distance(shapes[first[clear]], points[clear]) < NEAR).all()
        told += int(clear.sum())
    return told
