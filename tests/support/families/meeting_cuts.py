"""Scenes on a small lattice whose frames, clips and enclosures contain, overlap, touch and miss each other."""

import numpy as np
import shapely


def _box(random, side):
    while True:
        low, high = np.sort(random.integers(-1, side + 2, (2, 2)), axis=0)
        if (low < high).all():
            return shapely.box(*low, *high)


def _polygon(random, side):
    """A box, a box without another one, a triangle or a diamond: all slopes are 0, 1 or none."""
    kind, (x, y), size = random.integers(4), random.integers(-1, side + 1, 2), int(random.integers(1, 4))
    if kind == 0:
        return _box(random, side)
    if kind == 1:
        whole = _box(random, side)
        rest = [part for part in shapely.get_parts(shapely.difference(whole, _box(random, side))) if part.area]
        return rest[0] if rest else whole
    if kind == 2:
        return shapely.Polygon([(x, y), (x + size, y), (x, y + size)])
    return shapely.Polygon([(x - size, y), (x, y - size), (x + size, y), (x, y + size)])


def _line(random, side):
    way = np.array([(1, 0), (0, 1), (1, 1), (1, -1)])[random.integers(4)]
    start, size = random.integers(-2, side + 3, 2), int(random.integers(1, 2 * side)) * random.choice([-1, 1])
    return shapely.LineString([start, start + size * way])


def _site(random, side):
    kind = random.integers(3)
    if kind == 0:
        return _line(random, side // 2 + 1)
    return _polygon(random, side) if kind == 1 else shapely.Point(random.integers(-1, side + 2, 2))


def meeting_scene(seed):
    """Sites, points alone in most scenes, and the options of `voronoi`."""
    random = np.random.default_rng(seed)
    side, count, made = int(random.choice([2, 3, 4, 6])), int(random.integers(1, 6)), {}
    if random.random() < 0.6:
        sites = [shapely.Point(each) for each in random.integers(-1, side + 2, (count, 2))]
    else:
        sites = [_site(random, side) for _ in range(count)]
    if random.random() < 0.7:
        x0, y0, x1, y1 = _box(random, side).bounds
        made["frame"] = (x0, y0, x1 - x0, y1 - y0)
    if random.random() < 0.6:
        made["clip"] = [_polygon(random, side) for _ in range(int(random.integers(1, 4)))]
    if random.random() < 0.6:
        kinds = [[_line, _polygon][int(kind)] for kind in random.random(int(random.integers(1, 4))) < 0.4]
        made["enclosures"] = [kind(random, side) for kind in kinds]
        if "frame" in made and random.random() < 0.4:  # along a side of the frame
            x, y, w, h = made["frame"]
            corners = [(x, y), (x + w, y), (x + w, y + h), (x, y + h)]
            first = int(random.integers(4))
            made["enclosures"].append(shapely.LineString([corners[first], corners[first - 1]]))
    if random.random() < 0.4:
        made["max_distance"] = float(random.choice([0.25, 0.5, 1, 1.5, 3]))
    return sites, made


def moved_scene(seed):
    """The same, scaled and shifted: what met or touched does so as far as doubles tell.

    In one of 150 of them a corner or an end is on a slanted line, and the lattice has it on a side of that.
    """
    random = np.random.default_rng([seed, 1])
    (sites, made), scale = meeting_scene(seed), float(random.choice([0.1, 1 / 3, 0.7, 1]))
    shift = random.choice([0, 0.3, 1e3 / 7], 2)
    made = {key: _moved(value, scale, shift) for key, value in made.items()}
    if "frame" in made:
        x, y, w, h = made["frame"]
        x0, y0, x1, y1 = _moved(shapely.box(x, y, x + w, y + h), scale, shift).bounds
        made["frame"] = (x0, y0, x1 - x0, y1 - y0)
    return [_moved(site, scale, shift) for site in sites], made


def _moved(value, scale, shift):
    if isinstance(value, float):
        return value * scale
    return value if isinstance(value, tuple) else shapely.transform(value, lambda xy: xy * scale + shift)
