"""Leaving out the inside of objects changes nothing: every pixel against the search in all seeds."""

import numpy as np
import pytest

from support.few import few
from support.oracles.oracles import nearest_labels, nearest_squares
from vorotool.engines.tessellation.seeding import seeds_from_raster
from vorotool.engines.tessellation.tessellate import verify_rows
from vorotool.engines.tessellation.tessellator import Tessellator, needed_seeds
from vorotool.types.images import Raster
from vorotool.types.pixels import Frame


def objects(kind, rng):
    """Large objects, and what lies thinly inside them: pixels of other labels, holes, touching parts."""
    image = np.kron(rng.integers(0 if kind == "gaps" else 1, 5, (3, 4)), np.ones((9, 8), int))
    for _ in range(12):
        row, column = rng.integers(image.shape)
        image[row, column] = {"specks": rng.integers(1, 40), "gaps": 0, "holes": 0, "whole": image[row, column]}[kind]
    return image


@pytest.mark.parametrize("kind", ["specks", "gaps", "holes", "whole"])
@pytest.mark.parametrize("number", few(range(5), 2))
@pytest.mark.parametrize("frame", [None, Frame(-7, 4, 30, 40), Frame(5, 5, 9, 7), Frame(100, -60, 4, 3)])
def test_against_all_seeds(kind, number, frame):
    seeds = seeds_from_raster(Raster(objects(kind, np.random.default_rng(number))), mode="labels")
    needed = needed_seeds(seeds)
    assert needed is not None
    assert len(needed) < len(seeds)
    sweep = Tessellator(seeds, frame)
    window = (sweep.frame.x, sweep.frame.y, sweep.frame.width, sweep.frame.height)
    np.testing.assert_array_equal(sweep.labels(), nearest_labels(seeds.x, seeds.y, seeds.labels, window))
    squares = nearest_squares(seeds.x, seeds.y, window)
    np.testing.assert_array_equal(sweep.squared_distances(), squares)
    np.testing.assert_array_equal(sweep.distances(), np.sqrt(squares).astype(np.float32))
    half = sweep.frame.height // 2
    np.testing.assert_array_equal(sweep.labels(half, 1)[0], sweep.labels()[half])
    near = Tessellator(seeds, frame, max_distance=1).labels()
    np.testing.assert_array_equal(near, nearest_labels(seeds.x, seeds.y, seeds.labels, window, most_squared=1))
    verify_rows(sweep)
