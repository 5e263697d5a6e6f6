"""Points, lines and polygons in mixture: sites of Voronoi diagrams."""

import numpy as np
import shapely


def mixed_sites(random, count, grid=None):
    """Points, lines and polygons, some with holes, which overlap and touch; on the places of a grid if there is one."""

    def placed(xy):
        return np.round(xy / grid) * grid if grid else xy

    made = []
    for _ in range(count):
        kind, center, radius = random.integers(4), placed(random.random(2) * 100), random.uniform(2, 25)
        if kind == 0:
            made.append(shapely.Point(center))
        elif kind == 1:
            made.append(shapely.LineString(placed(center + random.normal(size=(random.integers(2, 5), 2)) * radius)))
        else:
            angle = np.sort(random.random(random.integers(3, 8)) * 2 * np.pi)
            around = np.stack([np.cos(angle), np.sin(angle)], axis=1)
            shape = shapely.Polygon(placed(center + around * radius * random.uniform(0.4, 1, (len(angle), 1))))
            if not shape.is_valid or not shape.area:
                shape = shapely.box(*center, *(center + 2 * (grid or 3)))
            hole = shape.buffer(-radius / 10).simplify(radius / 20)
            if kind == 3 and hole.geom_type == "Polygon" and not hole.is_empty and random.random() < 0.3:
                shape = shape.difference(hole)
            made.append(shape)
    return made


def row_houses(rows, columns):
    """Houses in rows that share their walls, some of them deeper: a shared wall is a part of the next one's."""
    made = []
    for row in range(rows):
        for column in range(columns):
            depth = 8 + (row * 7 + column * 3) % 4
            made.append(shapely.box(column * 6, row * 20, column * 6 + 6, row * 20 + depth))
    return made


def squares(side, gap=1.0):
    """A lattice of squares: everything ties."""
    return [
        shapely.box(x * (1 + gap), y * (1 + gap), x * (1 + gap) + 1, y * (1 + gap) + 1)
        for y in range(side)
        for x in range(side)
    ]


# ---- whole numbers, so that symmetries of the square and powers of two move every place exactly ---------------
def clusters(random, count):
    """Points, lines and polygons with corners in a few clusters: much is alike, and little far from it."""
    centers = random.integers(-(2**20), 2**20, (3, 2))
    reach = 2 ** int(random.integers(2, 7))
    return [_shape(centers[random.integers(3)] + random.integers(0, reach, (4, 2)), random) for _ in range(count)]


def coarse(random, count):
    """Shapes on few places, which touch, overlap and share their walls."""
    side = int(random.integers(3, 9))
    return [_shape(random.integers(0, side, (4, 2)), random) for _ in range(count)]


def bridges(random, count):
    """Long thin shapes from one cluster to another: small angles, and borders far away."""
    centers = random.integers(-(2**16), 2**16, (2, 2))
    return [_shape(centers[[0, 1, 1, 0]] + random.integers(0, 9, (4, 2)), random) for _ in range(count)]


def nested(random, count):
    """Squares in each other in any order, some of them twice."""
    sides = random.integers(1, max(2, count // 2) + 1, count)
    return [shapely.box(-4 * side, -4 * side, 4 * side, 4 * side) for side in sides.tolist()]


def rows(random, count):
    """Row houses, of any depth, in any order."""
    depth = random.integers(4, 12, count)
    places = np.stack([random.permutation(count) % 5 * 6, np.arange(count) // 5 * 20], axis=1)
    made = [shapely.box(x, y, x + 6, y + deep) for (x, y), deep in zip(places.tolist(), depth.tolist(), strict=True)]
    return [made[k] for k in random.permutation(count)]


def squares_in_any_order(random, count):
    """A lattice of squares with some left out."""
    side = int(np.ceil(np.sqrt(count)))
    made = squares(side, int(random.integers(0, 4)))
    return [made[k] for k in random.permutation(len(made))[:count]]


def apart(random, count):
    """Shapes without a tie that has area: no place is on two of them."""
    cells = random.permutation(64)[:count]
    corners = np.stack([cells % 8, cells // 8], axis=1) * 64
    return [_shape(corner + random.integers(0, 48, (4, 2)), random) for corner in corners]


WHOLE = (clusters, coarse, bridges, nested, rows, squares_in_any_order, apart)


def _shape(corners, random):
    """A point, a line, or a polygon, of some of four corners, such that all of it counts."""
    kind = int(random.integers(4))
    if kind < 2:
        return shapely.Point(corners[0]) if kind == 0 or (corners[0] == corners[1]).all() else _line(corners[:2])
    if kind == 2:
        return _line(corners)
    polygon = shapely.Polygon(corners)
    return polygon if polygon.is_valid and polygon.area else shapely.Point(corners[0])


def _line(corners):
    steps = np.any(np.diff(corners, axis=0) != 0, axis=1)
    kept = corners[np.append(True, steps)]
    return shapely.LineString(kept) if len(kept) > 1 else shapely.Point(kept[0])
