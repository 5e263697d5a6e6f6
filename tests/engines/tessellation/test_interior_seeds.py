"""Leaving out the inside of objects changes nothing: every pixel against the search in all seeds."""

import numpy as np
import pytest

from support.few import few
from support.oracles.oracles import nearest_labels, nearest_squares
from vorotool import _core
from vorotool.engines.tessellation.frames import simd_level
from vorotool.engines.tessellation.interior_seeds import needed_seeds
from vorotool.engines.tessellation.seeding import seeds_from_raster
from vorotool.engines.tessellation.tessellate import verify_rows
from vorotool.engines.tessellation.tessellator import Tessellator
from vorotool.errors import InputError
from vorotool.types.pixel_frame import Frame
from vorotool.types.points.raster import Raster
from vorotool.types.points.seed_set import SeedSet


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


def test_seeds_that_stay_as_they_are():
    y, x = (k.ravel() for k in np.indices((6, 6)))
    ones = np.ones(36, int)
    assert needed_seeds(SeedSet(x, y, ones)) is not None
    assert needed_seeds(SeedSet(x, y, np.arange(1, 37))) is None  # no two share a label
    assert needed_seeds(SeedSet(x, y, ones, scale=2)) is None  # between pixels
    assert needed_seeds(SeedSet(9 * x, y, ones)) is None  # sparse
    assert needed_seeds(SeedSet(x[::-1], y[::-1], ones)) is None  # another order
    assert needed_seeds(SeedSet(np.repeat(x, 2), np.repeat(y, 2), np.repeat(ones, 2))) is None  # two at one place


def test_the_seed_that_is_too_far_is_counted_from_1():
    x, y = np.array([0, 5, 2**43]), np.array([0, 1, 2])
    with pytest.raises(InputError, match=r"seed 3 at \(8796093022208, 2\) is too far from the frame"):
        Tessellator(SeedSet(x, y, np.array([1, 2, 3])), Frame(0, 0, 4, 4))
    row = np.arange(8)
    seeds = SeedSet(np.tile(row, 8), np.repeat(row, 8) + 2**42, np.ones(64, int))
    assert needed_seeds(seeds) is not None
    with pytest.raises(InputError, match=r"seed 1 at \(0, 4398046511104\)"):
        Tessellator(seeds, Frame(0, 0, 4, 4))


def test_the_core_says_by_number_which_seed_is_too_far():
    x, y = np.array([0, 2**60]), np.zeros(2, np.int64)
    with pytest.raises(_core.tessellation.SeedTooFarError) as error:
        _core.tessellation.Tessellation(x, y, np.array([1, 2], np.uint32), 0, 0, 4, 4, 1, (1, 1), simd_level())
    assert error.value.args == (1,)
