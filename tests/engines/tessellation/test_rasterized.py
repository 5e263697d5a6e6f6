"""Polygons and lines as pixels: by exact rationals pixel by pixel, and by shapely where nothing is on an edge."""

from fractions import Fraction

import numpy as np
import pytest
import shapely

from support.few import few
from vorotool.engines.tessellation.rasterized import rasterized
from vorotool.errors import InputError
from vorotool.types.pixels import Frame
from vorotool.types.polygons.polygon_set import HOLE, LINE, SHELL, PolygonSet

FRAME = Frame(0, 0, 12, 9)


def polygon_set(polygons):
    """From lists of rings, each a kind and its vertices."""
    rings = [(kind, np.asarray(xy, float), number) for number, each in enumerate(polygons) for kind, xy in each]
    return PolygonSet(
        np.concatenate([xy for _, xy, _ in rings]),
        np.cumsum([0, *(len(xy) for _, xy, _ in rings)]),
        [kind for kind, _, _ in rings],
        [number for _, _, number in rings],
    )


def is_inside(rings, x, y):
    """By the even-odd rule, a center on an edge being right of it, and below one that is level."""
    crossings = 0
    for ring in rings:
        for (ax, ay), (bx, by) in zip(ring, np.roll(ring, -1, axis=0), strict=True):
            a, b = (Fraction(float(ax)), Fraction(float(ay))), (Fraction(float(bx)), Fraction(float(by)))
            if a[1] > b[1]:
                a, b = b, a
            if a[1] <= y < b[1]:
                crossings += a[0] + (y - a[1]) * (b[0] - a[0]) / (b[1] - a[1]) <= x
    return crossings % 2 == 1


def expected(polygons, frame=FRAME):
    labels = np.zeros(frame.shape, int)
    for y in range(frame.height):
        for x in range(frame.width):
            for number, each in enumerate(polygons):
                rings = [np.asarray(xy, float) - (frame.x, frame.y) for _, xy in each]
                if is_inside(rings, x, y):
                    labels[y, x] = number + 1
                    break
    return labels


@pytest.mark.parametrize("step", [1, 2, 4, 1000003])
@pytest.mark.parametrize("seed", few(range(12), 4))
def test_polygons_with_any_rings(seed, step):
    """Vertices on centers, on sides, in general places; crossing rings, and what reaches beyond the frame."""
    rng = np.random.default_rng(seed)

    def ring(count):
        return np.round(rng.uniform(-3, 14, (count, 2)) * step) / step

    shapes = [[(SHELL, ring(5))], [(SHELL, ring(4)), (HOLE, ring(3))], [(SHELL, ring(3))]]
    assert (rasterized(polygon_set(shapes), FRAME) == expected(shapes)).all()


@pytest.mark.parametrize("seed", few(range(30), 10))
def test_lines_in_general_places(seed):
    rng = np.random.default_rng(seed)
    lines = [rng.uniform(-3, 14, (4, 2)), rng.uniform(0, 9, (2, 2))]
    made = rasterized(polygon_set([[(LINE, line)] for line in lines]), FRAME)
    for y, x in np.ndindex(FRAME.shape):
        box = shapely.box(x - 0.5, y - 0.5, x + 0.5, y + 0.5)
        met = [k + 1 for k, line in enumerate(lines) if shapely.LineString(line).intersection(box).length > 0]
        assert made[y, x] == (met[0] if met else 0)


def test_lines_through_corners_and_along_sides():
    def pixels(*line):
        return sorted((int(x), int(y)) for y, x in np.argwhere(rasterized(polygon_set([[(LINE, line)]]), FRAME)))

    diagonal = [(0, 0), (1, 1), (2, 2), (3, 3)]
    assert pixels((0, 0), (3, 3)) == pixels((3, 3), (0, 0)) == diagonal
    assert pixels((3, 0), (0, 3)) == [
        (0, 3),
        (1, 2),
        (1, 3),
        (2, 1),
        (2, 2),
        (3, 0),
        (3, 1),
    ]  # corners are below, right
    assert pixels((0.5, 0), (0.5, 2)) == [(1, 0), (1, 1), (1, 2)]
    assert pixels((0, 0.5), (2, 0.5)) == [(0, 1), (1, 1), (2, 1)]
    assert pixels((4, 4), (4, 4)) == [(4, 4)]
    assert pixels((-5, -5), (-1, -1)) == pixels((20, 0), (20, 5)) == []
    assert pixels((-9, 4), (99, 4)) == [(x, 4) for x in range(12)]
    assert pixels((2, -1e6), (2, 1e6)) == [(2, y) for y in range(9)]


def test_what_is_too_far():
    with pytest.raises(InputError, match="more than 2\\^44 pixels"):
        rasterized(polygon_set([[(LINE, [(0, 0), (1e30, 1)])]]), FRAME)
    assert not rasterized(PolygonSet(np.empty((0, 2)), [0], [], []), FRAME).any()
