"""Bands that are computed apart give what the whole gives."""

import pickle
from fractions import Fraction

import numpy as np
import pytest

import vorotool
from support.few import few
from support.oracles.oracles import nearest_labels, nearest_squares
from vorotool.engines.tessellation.seeding import seeds_from_points, seeds_from_raster
from vorotool.engines.tessellation.tessellate import verify_rows
from vorotool.engines.tessellation.tessellator import SeedBand, SeedBands, Tessellator, needed_seeds
from vorotool.types.images import Raster
from vorotool.types.pixels import SQUARE, Frame, PixelSides
from vorotool.types.points.point_set import PointSet
from vorotool.types.volumes.volume import VolumeSeeds, VoxelFrame

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


# ---- Slabs of slices from the seeds that they need ----
TWO = VolumeSeeds(np.array([[0, 0, 0], [4, 0, 9]]), np.array([1, 2]))
ROW = VoxelFrame(0, 0, 0, 5, 1, 10)


@pytest.mark.parametrize(
    ("what", "dtype", "expected"),
    [
        ("labels", np.uint8, [1, 2, 2, 2, 2]),
        ("distance2", np.uint32, [25, 25, 20, 17, 16]),
        ("distance", np.float32, np.sqrt(np.float32([25, 25, 20, 17, 16]))),
    ],
)
def test_a_slice_is_that_of_the_whole(what, dtype, expected):
    assert SeedBand(TWO, ROW, 5, 1, what, np.dtype(dtype)).rows()[0, 0].tolist() == list(expected)


# ---- Leaving out the inside of objects changes nothing: every pixel against the search in all seeds ----
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


# ---- Seeds between pixels: on the finest lattice of the whole frame, by exact brute force ----
pytestmark = pytest.mark.filterwarnings("ignore:.*seeds (moved|lie)")


def test_seeds_get_the_lattice_of_the_frame_and_the_coarsest_that_holds_them():
    step = 2.0**-31
    points = np.array([[step, 1], [5, 6]])
    assert vorotool.tessellate(points, shape=(512, 512)).seeds.scale == 2**31
    assert vorotool.tessellate(points, shape=(1024, 1024)).seeds.scale == 1
    assert vorotool.tessellate(points + 0.25, shape=(1024, 1024)).seeds.scale == 4
    seeds = vorotool.seeds_from_points(vorotool.PointSet(points))
    assert seeds.scale == 2**31
    assert vorotool.tessellate(seeds, shape=(1024, 1024)).seeds.scale == 1


@pytest.mark.parametrize("origin", [0, 2**20, -(2**30)])
def test_distances_and_tables_of_fine_seeds(origin):
    rng = np.random.default_rng(1)
    points = rng.random((30, 2)) * 40 + origin
    image = vorotool.tessellate(points, window=(origin, origin, 40, 30))
    vorotool.verify_tessellation(image)
    sweep = Tessellator(image.seeds, image.frame)
    if origin >= 0:  # far from it doubles are coarser
        with pytest.raises(vorotool.LimitError, match="distance"):
            sweep.squared_distances()
    rows, columns = np.mgrid[origin : origin + 30, origin : origin + 40]
    nearest = image.seeds.sites[image.labels.astype(int) - 1]
    right = np.hypot(nearest[..., 0] - columns, nearest[..., 1] - rows)
    np.testing.assert_allclose(sweep.distances(), right, rtol=1e-6)
    table = vorotool.region_table(image, distance2=sweep.squared_distances(dtype=sweep.measured_dtype))
    farthest = [right[image.labels == label].max(initial=0) for label in table["label"]]
    np.testing.assert_allclose(np.ma.filled(table["max_distance"], 0), farthest, rtol=1e-9)
