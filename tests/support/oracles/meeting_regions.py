"""Regions of a frame, a clip and enclosures by shapely's overlays, and cells of points in these by half planes."""

import numpy as np
import shapely

NEAR = 1e-7


def regions_of_cuts(sites, default, options):
    """What is shared out, in regions, each with the sites that share it."""
    x, y, w, h = options.get("frame", default)
    shared = shapely.box(x, y, x + w, y + h)
    if "clip" in options:
        clip = shapely.union_all(options["clip"])
        shared = shapely.intersection(shared, clip) if "frame" in options else clip
    if "enclosures" not in options:
        return [(part, [*range(len(sites))]) for part in _areas(shared)]
    lines = shapely.union_all([each.boundary if each.area else each for each in options["enclosures"]])
    closed = _faces(lines)
    around = shapely.box(*shapely.total_bounds([shared, lines, *sites])).buffer(5, join_style="mitre")
    made = []
    for face in [*closed, shapely.difference(around, shapely.union_all(closed))]:
        whole = _areas(shapely.intersection(face, shared))
        if not whole:
            continue
        inner = shapely.union_all(whole)
        parts = [part for part in _faces(shapely.union_all([lines, inner.boundary])) if inner.covers(_inside(part))]
        open_lines = shapely.intersection(lines, face.buffer(-NEAR))
        is_along = shapely.intersection(open_lines, inner.boundary.buffer(NEAR)).length > 1e-5
        if len(parts) == len(whole) and not is_along:
            made.append((inner, _meeting(sites, face, _walls(face, lines))))
        else:
            walls = _walls(face, lines)
            made += [(part, _meeting(sites, part, walls.union(_walls(part, lines)))) for part in parts]
    return made


def _areas(shape):
    return [part for part in shapely.get_parts(shape) if part.area > NEAR]


def _faces(lines):
    return [*shapely.get_parts(shapely.polygonize(shapely.get_parts(lines)))]


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
