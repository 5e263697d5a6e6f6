"""Sites, clips and enclosures on the places of a small lattice: everything ties, touches and runs along everything."""

import numpy as np
import shapely


def _ring(random, side):
    """The polygons that a ring through random places covers by the even-odd rule."""
    while True:
        shape = shapely.make_valid(shapely.Polygon(random.integers(0, side + 1, (int(random.integers(3, 8)), 2))))
        found = [each for each in shapely.get_parts(shape) if each.geom_type == "Polygon"]
        found = found or list(shapely.get_parts(shapely.get_parts(shape)[0]))
        if found and shape.area:
            return found


def lattice_sites(random, side):
    """Points, lines, boxes and polygons."""
    made = []
    for kind in random.integers(4, size=int(random.integers(1, 9))).tolist():
        xy = random.integers(0, side + 1, (4, 2))
        low = xy[:2].min(axis=0)
        made.append(
            [
                shapely.Point(xy[0]),
                shapely.LineString(xy[: int(random.integers(2, 5))]),
                shapely.box(*low, *(low + random.integers(1, max(2, side // 2), 2))),
                _ring(random, side)[0],
            ][kind]
        )
    return made


def lattice_clip(random, side, sites):
    """One or two rings, and sometimes a site itself."""
    made = [part for _ in range(int(random.integers(1, 3))) for part in _ring(random, side)]
    return made + [site for site in sites if site.area and random.random() < 0.2]


def lattice_lines(random, side):
    """A few lines across, with open ends, and sometimes a box."""
    ends = random.integers(-1, side + 2, (int(random.integers(1, 6)), 2, 2))
    made = [shapely.LineString(each) for each in ends if (each[0] != each[1]).any()]
    low, high = np.sort(random.integers(0, side + 1, (2, 2)), axis=0)
    if random.random() < 0.5 and (low < high).all():
        made.append(shapely.box(*low, *high).exterior)
    return made
