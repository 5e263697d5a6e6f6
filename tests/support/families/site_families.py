"""Points, lines and polygons in mixture: sites of Voronoi diagrams."""

import numpy as np
import shapely


def mixed_sites(random, count, grid=None):
    """Points, lines and polygons, some with holes, which overlap and touch; on the places of a grid if there is one."""

    def placed(xy):
        return np.round(xy / grid) * grid if grid else xy

    made = []
    for _ in range(count):
        kind, centre, radius = random.integers(4), placed(random.random(2) * 100), random.uniform(2, 25)
        if kind == 0:
            made.append(shapely.Point(centre))
        elif kind == 1:
            made.append(shapely.LineString(placed(centre + random.normal(size=(random.integers(2, 5), 2)) * radius)))
        else:
            angle = np.sort(random.random(random.integers(3, 8)) * 2 * np.pi)
            around = np.stack([np.cos(angle), np.sin(angle)], axis=1)
            shape = shapely.Polygon(placed(centre + around * radius * random.uniform(0.4, 1, (len(angle), 1))))
            if not shape.is_valid or not shape.area:
                shape = shapely.box(*centre, *(centre + 2 * (grid or 3)))
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
