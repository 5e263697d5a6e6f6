"""What is cut out of an area piece by piece is what is cut out of it as a whole."""

import numpy as np
import pytest
import shapely

from support.few import few
from vorotool.engines.delaunay.cells import cut_out


def coast(count, seed, holes=3):
    """A polygon of many vertices with holes, and an island."""
    random = np.random.default_rng(seed)

    def ring(x, y, size, corners):
        angle = np.sort(random.uniform(0, 2 * np.pi, corners))
        radius = size * random.uniform(0.7, 1.0, corners)
        return np.column_stack([x + radius * np.cos(angle), y + radius * np.sin(angle)])

    inner = [ring(4 * k - 4, 0, 1, 60) for k in range(holes)]
    return shapely.union_all([shapely.Polygon(ring(0, 0, 10, count), inner), shapely.Polygon(ring(20, 3, 2, 80))])


def boxes(count, seed, size):
    random = np.random.default_rng(seed)
    x, y = random.uniform(-12, 23, count), random.uniform(-12, 12, count)
    return shapely.box(x, y, x + random.uniform(0.1, size, count), y + random.uniform(0.1, size, count))


@pytest.mark.parametrize("seed", few(range(4), 1))
@pytest.mark.parametrize("size", [0.7, 6.0, 40.0])
def test_pieces_are_those_of_the_whole(seed, size):
    area, shapes = coast(1500, seed), boxes(120, seed, size)
    for ours, theirs in zip(cut_out(shapes, area), shapely.intersection(shapes, area), strict=True):
        assert ours.wkb == theirs.wkb
