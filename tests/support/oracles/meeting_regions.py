"""Regions of a frame, a clip and enclosures by shapely's overlays, and cells of points in these by half planes."""

import numpy as np
import shapely

NEAR = 1e-7
GRID = 2e-8
"""What shapely's overlays round to: lines that touch as far as doubles tell have one vertex."""


def regions_of_cuts(sites, default, options):
    """What is shared out, in regions, each with the sites that share it."""
    x, y, w, h = options.get("frame", default)
    shared = shapely.box(x, y, x + w, y + h)
    if "clip" in options:
        clip = shapely.union_all(options["clip"])
        shared = shapely.intersection(shared, clip) if "frame" in options else clip
    shared = shapely.union_all(_areas(shared))
    if "enclosures" not in options or shared.is_empty:
        return [(part, [*range(len(sites))]) for part in _areas(shared)]
    given = [each.boundary if each.area else each for each in options["enclosures"]]
    lines = shapely.union_all(given, grid_size=GRID)
    closed = _faces(lines)
    around = shapely.box(*shapely.total_bounds([shared, lines, *sites])).buffer(5, join_style="mitre")
    border = shapely.set_precision(shared, GRID).boundary
    without_open = shapely.union_all([face.boundary for face in closed])
    whole, parts = (
        [part for part in _faces(shapely.union_all([each, border], grid_size=GRID)) if shared.covers(_inside(part))]
        for each in (without_open, lines)
    )
    made = []
    for face in [*closed, shapely.difference(around, shapely.union_all(closed))]:
        inner, own = ([part for part in each if face.covers(_inside(part))] for each in (whole, parts))
        open_lines = shapely.intersection(lines, face.buffer(-NEAR))
        is_along = shapely.intersection(open_lines, border.buffer(NEAR)).length > 1e-5
        walls = _walls(face, lines)
        if len(own) == len(inner) and not is_along:
            meeting = _meeting(sites, face, walls)
            made += [(part, meeting) for part in own]
        else:
            made += [(part, _meeting(sites, part, walls.union(_walls(part, lines)))) for part in own]
    return made


def _areas(shape):
    return [part for part in shapely.get_parts(shape) if part.area > NEAR]


def _faces(lines):
    return _areas(shapely.polygonize(shapely.get_parts(lines)))


def _inside(shape):
    return shape.point_on_surface()


def _walls(face, lines):
    """What of lines is around a face; lines that only end there are not."""
    walls = shapely.get_parts(shapely.intersection(lines, face.boundary.buffer(NEAR)))
    return shapely.union_all([part for part in walls if part.length > 1e-5]).buffer(NEAR)


def _meeting(sites, face, walls):
    """Sites that are in a face, and not only on the lines around it."""
    own = []
    for k, site in enumerate(sites):
        if site.geom_type == "Point":
            meets = site.distance(face) < NEAR and not site.intersects(walls)
        else:
            outline = shapely.difference(site.boundary if site.area else site, walls)
            along = shapely.intersection(outline, face.buffer(NEAR)).length > 1e-5
            meets = along or shapely.intersection(site, face).area > 1e-6
        if meets:
            own.append(k)
    return own


def area_within(regions, sites, limit):
    """The area of what is within a limit of the sites of its region."""
    near = None if limit is None else shapely.buffer(sites, limit, quad_segs=512)
    area = 0
    for region, own in regions:
        if own:
            area += (region if near is None else shapely.intersection(region, shapely.union_all(near[own]))).area
    return area


def areas_of_points(sites, regions, limit):
    """Areas of the cells of points; a later one at the same place has none."""
    areas, xy = np.zeros(len(sites)), shapely.get_coordinates(sites)
    for region, own in regions:
        for at, k in enumerate(own):
            if any((xy[k] == xy[j]).all() for j in own[:at]):
                continue
            cell = region if limit is None else shapely.intersection(region, sites[k].buffer(limit, quad_segs=512))
            for j in own:
                if (xy[j] != xy[k]).any():
                    cell = shapely.intersection(cell, _half_plane(xy[k], xy[j]))
            areas[k] += cell.area
    return areas


def _half_plane(near, far):
    """All within 1 000 that is nearer to one place than to the other."""
    middle, way = (near + far) / 2, far - near
    along = np.array([-way[1], way[0]])
    size = 1000 / np.sqrt(way @ way)
    a, b = middle + size * along, middle - size * along
    return shapely.Polygon([a, b, b - size * way, a - size * way])
