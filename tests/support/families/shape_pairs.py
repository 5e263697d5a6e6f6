"""Pairs of shapes, as lists of geometry of shapely: apart, crossing, touching, equal, one inside the other."""

import numpy as np
import shapely


def _places(random, count):
    places = random.uniform(-1, 1, (count, 2)) * random.choice([0.5, 2, 5]) + random.uniform(-3, 3, 2)
    return np.round(places) if random.random() < 0.4 else places


def _parts(geometry):
    """Simple parts."""
    return [one for each in shapely.get_parts(np.atleast_1d(geometry)) for one in shapely.get_parts(each).tolist()]


def _points(random):
    return _parts(shapely.MultiPoint(_places(random, random.integers(1, 6))))


def _line(random):
    return [shapely.LineString(_places(random, random.integers(2, 8)))]


def _polygon(random):
    places = _places(random, random.integers(3, 10))
    around = places[np.argsort(np.arctan2(*(places - places.mean(axis=0)).T))]
    return _parts(shapely.make_valid(shapely.Polygon(around)))


def _with_hole(random):
    whole = shapely.union_all(_polygon(random))
    middle = np.array(whole.centroid.coords[0])
    hole = shapely.make_valid(shapely.transform(whole, lambda xy: (xy - middle) * 0.4 + middle))
    left = whole.difference(hole)
    return _parts(whole if left.is_empty else left)


def _mixed(random):
    return _with_hole(random) + _line(random) + _points(random)


_SHAPES = (_points, _line, _polygon, _with_hole, _mixed)


def of_any_kind(random):
    """Two shapes of any two kinds."""
    return [_SHAPES[random.integers(len(_SHAPES))](random) for _ in range(2)]


def lines(random):
    """Two lines."""
    return _line(random), _line(random)


def polygons(random):
    """Two polygons, perhaps with holes."""
    return _with_hole(random), _with_hole(random)


def moved(random):
    """A shape and the same in another place: its edges are parallel, and many places are as far."""
    shape = _SHAPES[random.integers(1, len(_SHAPES))](random)
    way = random.integers(-2, 3, 2) * random.choice([0.5, 0.1])
    return shape, [shapely.transform(each, lambda xy: xy + way) for each in shape]


def inside(random):
    """A shape in another one, or around it."""
    outer = _with_hole(random)
    middle = np.array(shapely.union_all(outer).centroid.coords[0])
    inner = [shapely.transform(each, lambda xy: (xy - middle) * 0.5 + middle) for each in _with_hole(random)]
    return (outer, inner) if random.random() < 0.5 else (inner, outer)


def touching(random):
    """Shapes with an edge, a part of one or a vertex in common."""
    shape = _polygon(random)
    ring = shapely.get_coordinates(max(shape, key=shapely.length))
    if len(ring) < 2:
        return shape, shape
    share = random.choice([0.5, 1.0])
    a, b = ring[0], ring[0] + share * (ring[1] - ring[0])
    return shape, [shapely.LineString([a, b]) if random.random() < 0.5 else shapely.Point(b), *_line(random)]


FAMILIES = (of_any_kind, lines, polygons, moved, inside, touching)
