"""Tessellations of rectangular pixels, against all distances in exact integers and against SciPy."""

from fractions import Fraction

import numpy as np
import pytest
from scipy import ndimage

from support.few import few
from vorotool.engines import masks
from vorotool.engines.tessellation.tessellate import verify_labels
from vorotool.engines.tessellation.tessellator import Tessellator
from vorotool.errors import UsageError, VerificationError
from vorotool.types.pixels import Frame, PixelSides, pixel_sides
from vorotool.types.points.seed_set import SeedSet

SIDES = [PixelSides((2, 1)), PixelSides((60, 13), Fraction(1, 40)), PixelSides((5, 7)), PixelSides((1000, 1))]
LEVELS = ("portable", "avx2", "avx512")


def all_squares(seeds, frame, sides):
    """(n, H, W) squared distances in Python's integers."""
    x = [int(v) * sides.x for v in seeds.x]
    y = [int(v) * sides.y for v in seeds.y]
    columns = [seeds.scale * sides.x * (frame.x + c) for c in range(frame.width)]
    rows = [seeds.scale * sides.y * (frame.y + r) for r in range(frame.height)]
    return np.array([[[(a - u) ** 2 + (b - v) ** 2 for a in columns] for b in rows] for u, v in zip(x, y, strict=True)])


def brute(seeds, frame, sides):
    """Labels and squared distances: of the nearest seeds the smallest label."""
    squares = all_squares(seeds, frame, sides)
    least = squares.min(axis=0)
    labels = np.where(squares == least, seeds.labels.astype(np.int64)[:, None, None], 2**32).min(axis=0)
    return labels, least


def seeds_of(random, count, frame, scale, reach):
    low = np.array([frame.x, frame.y]) * scale - reach
    high = np.array([frame.x + frame.width, frame.y + frame.height]) * scale + reach
    x, y = random.integers(low, high, (count, 2)).T
    return SeedSet(x, y, random.integers(1, count + 1, count).astype(np.uint32), scale=scale)


@pytest.mark.parametrize("sides", SIDES)
@pytest.mark.parametrize("scale", [1, 4, 256])
@pytest.mark.parametrize("seed", few(range(6), 1))
def test_every_pixel_has_the_smallest_label_of_its_nearest_seeds(sides, scale, seed):
    random = np.random.default_rng([seed, scale, sides.x])
    frame = Frame(-3, 5, int(random.integers(1, 40)), int(random.integers(1, 40)))
    seeds = seeds_of(random, int(random.integers(1, 60)), frame, scale, (0, 9, 1000)[seed % 3])
    labels, least = brute(seeds, frame, sides)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("warnings.warn", lambda *_, **__: None)  # several seeds at one place
        sweep = Tessellator(seeds, frame, sides=sides, threads=1 + seed % 2)
    assert np.array_equal(sweep.labels(), labels)
    assert np.array_equal(sweep.squared_distances(), least)
    expected = np.sqrt(least.astype(np.float64) * float((sides.step / scale) ** 2))
    assert np.array_equal(sweep.distances(), expected.astype(np.float32))
    verify_labels(labels, seeds, frame, sides=sides)
    rows = [sweep.labels(row, 1) for row in range(frame.height)]
    assert np.array_equal(np.concatenate(rows), labels)
    if len(np.unique(labels)) > 1:
        with pytest.raises(VerificationError):
            verify_labels(np.where(labels == labels.max(), labels.min(), labels), seeds, frame, sides=sides)


@pytest.mark.parametrize("level", LEVELS)
def test_the_instruction_sets_agree(level, monkeypatch):
    random = np.random.default_rng(5)
    frame, sides = Frame(0, 0, 300, 200), PixelSides((1500, 325))
    x, y = np.unique(random.integers(0, 200, (400, 2)), axis=0).T
    seeds = SeedSet(x, y, np.arange(1, len(x) + 1, dtype=np.uint32))
    expected = Tessellator(seeds, frame, sides=sides).labels()
    monkeypatch.setenv("VOROTOOL_SIMD", level)
    try:
        sweep = Tessellator(seeds, frame, sides=sides)
    except UsageError:
        pytest.skip("this machine has it not")
    assert np.array_equal(sweep.labels(), expected)
    verify_labels(expected, seeds, frame, sides=sides)


@pytest.mark.parametrize("sides", SIDES)
@pytest.mark.parametrize("limit", [0, Fraction(5, 2), 30, 77])
def test_limits_are_exact(sides, limit):
    random = np.random.default_rng(3)
    frame = Frame(0, 0, 31, 23)
    seeds = seeds_of(random, 9, frame, 1, 0)
    labels, least = brute(seeds, frame, sides)
    found = Tessellator(seeds, frame, max_distance=limit * sides.step, sides=sides).labels()
    assert np.array_equal(found, np.where(least <= limit * limit, labels, 0))


def test_large_objects_need_their_outer_pixels_only():
    image = np.zeros((24, 30), np.uint16)
    image[3:18, 3:18], image[6:23, 19:29] = 1, 2
    sides = (0.2, 1.0)
    grown = masks.expand_labels(image, float("inf"), spacing=sides)
    y, x = np.nonzero(image)
    labels, _ = brute(SeedSet(x, y, image[y, x]), Frame(0, 0, 30, 24), pixel_sides(sides))
    assert np.array_equal(grown, labels)


@pytest.mark.parametrize("spacing", [(1.5, 0.325), (1, 2), (0.1, 0.3), (Fraction(1, 3), Fraction(1, 7)), (30, 25)])
def test_distances_are_those_of_scipy(spacing):
    mask = np.random.default_rng(7).random((60, 70)) > 0.02
    ours, indices = masks.distance_transform(mask, spacing=spacing, return_indices=True)
    sampling = [float(side) for side in spacing]
    theirs = ndimage.distance_transform_edt(mask, sampling=sampling)
    np.testing.assert_allclose(ours, theirs, rtol=1e-14, atol=1e-12)
    y, x = np.indices(mask.shape)
    away = np.hypot((indices[0] - y) * sampling[0], (indices[1] - x) * sampling[1])
    np.testing.assert_allclose(away, ours, rtol=1e-14, atol=1e-12)
    if all(side == int(side) for side in spacing):
        assert np.array_equal(ours, theirs)  # whole numbers below 2^53: the last bit too


def test_a_float_is_the_decimal_that_it_is_written_as():
    labels = np.array([[1, 0, 0, 0, 0]])
    assert masks.expand_labels(labels, 0.3, spacing=0.1).tolist() == [[1, 1, 1, 1, 0]]
    assert masks.expand_labels(labels, 0.3, spacing=(5, 0.1)).tolist() == [[1, 1, 1, 1, 0]]


def test_sides_without_a_coarse_step_are_refused():
    with pytest.raises(UsageError, match="round the sides to fewer digits, or give them as fractions"):
        pixel_sides((0.3333333333333333, 1))
    assert pixel_sides((Fraction(1, 3), 1)) == PixelSides((1, 3), Fraction(1, 3))
