"""Bands that are computed apart give what the whole gives."""

import pickle
from fractions import Fraction

import numpy as np
import pytest

from support.few import few
from vorotool.engines.tessellation.seeding import seeds_from_points
from vorotool.engines.tessellation.tessellator import SeedBand, SeedBands, Tessellator
from vorotool.types.pixels import SQUARE, Frame, PixelSides
from vorotool.types.points.point_set import PointSet

FRAME = Frame(-3, 5, 60, 47)


def point_sets():
    rng = np.random.default_rng(3)
    yield "random", PointSet(rng.integers(-10, 70, (200, 2)))
    yield "lattice", PointSet(np.argwhere(np.ones((9, 9))) * 7)
    yield "column", PointSet(np.stack([np.full(40, 20), np.arange(40)], axis=1))
    yield "row", PointSet(np.stack([np.arange(40), np.full(40, 20)], axis=1))
    yield "fine", PointSet(rng.integers(0, 60 * 8, (100, 2)) / 8)
    yield "far", PointSet(rng.integers(-(10**6), 10**6, (50, 2)))
    yield "one", PointSet([[5, 5]])
    yield "labels", PointSet(rng.integers(0, 60, (60, 2)), rng.integers(1, 9, 60))


SIDES, HEIGHTS = [SQUARE, PixelSides((60, 13), Fraction(1, 40))], [1, 5, 47]
PAIRS_FIRST = [
    (name, points, height, SIDES[(k + i + turn) % 2])
    for turn in (0, 1)
    for k, (name, points) in enumerate(point_sets())
    for i, height in enumerate(HEIGHTS)
]


@pytest.mark.parametrize(("name", "points", "height", "sides"), few(PAIRS_FIRST, len(PAIRS_FIRST) // 2))
@pytest.mark.filterwarnings("ignore::vorotool.errors.VorotoolWarning")
def test_bands_are_those_of_the_whole(name, points, height, sides):
    seeds = seeds_from_points(points)
    whole = Tessellator(seeds, FRAME, max_distance=20, sides=sides)
    bands = SeedBands(seeds, FRAME)
    expected = {
        "labels": whole.labels(),
        "distance": whole.distances(),
        "distance2": whole.squared_distances(),
    }
    for first in range(0, FRAME.height, height):
        rows = min(height, FRAME.height - first)
        needed = bands.seeds_of(first, rows)
        for what, image in expected.items():
            band = pickle.loads(pickle.dumps(SeedBand(needed, FRAME, first, rows, what, image.dtype, sides, 20)))
            np.testing.assert_array_equal(band.rows(threads=1), image[first : first + rows], f"{name}, {what}")
