from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from vorotool.engines.tessellation.tessellate import verify_labels
from vorotool.errors import InputError, UsageError, VerificationError
from vorotool.types.pixels import Frame
from vorotool.types.points.seed_set import SeedSet


def brute_force(seeds, frame, limit=None):
    """Right labels from Python integers: no width, no rounding."""
    labels = np.zeros(frame.shape, dtype=np.uint32)
    triples = list(zip(seeds.x.tolist(), seeds.y.tolist(), seeds.labels.tolist(), strict=True))
    for r in range(frame.height):
        for c in range(frame.width):
            x, y = seeds.scale * (frame.x + c), seeds.scale * (frame.y + r)
            d2, label = min((((sx - x) ** 2 + (sy - y) ** 2, label) for sx, sy, label in triples), default=(0, 0))
            labels[r, c] = 0 if limit is not None and d2 > limit else label
    return labels


def check_both_ways(seeds, frame, limit=None, dtype=np.uint32):
    """The right labels pass; any other label at any pixel is found and named."""
    labels = brute_force(seeds, frame, limit).astype(dtype)
    verify_labels(labels, seeds, frame, max_distance2=limit, threads=2)
    random = np.random.default_rng(0)
    r, c = (int(random.integers(size)) for size in frame.shape)
    wrong = labels.copy()
    wrong[r, c] = labels[r, c] + 1
    expected = (
        rf"^1 of {frame.pixels} pixels? is wrong: the first, \(x, y\) = \({frame.x + c}, {frame.y + r}\), "
        rf"has label {wrong[r, c]}, not {labels[r, c]}$"
    )
    with pytest.raises(VerificationError, match=expected.replace("pixels?", "pixels")):
        verify_labels(wrong, seeds, frame, max_distance2=limit, threads=2)


def seed_sets(low, high, most=25):
    point = st.tuples(st.integers(low, high), st.integers(low, high), st.integers(1, 9))
    return st.lists(point, min_size=1, max_size=most)


@given(
    seed_sets(-15, 15),
    st.sampled_from([1, 2, 4]),
    st.tuples(st.integers(-8, 8), st.integers(-8, 8), st.integers(1, 12), st.integers(1, 12)),
    st.none() | st.integers(0, 300),
)
@settings(max_examples=25, deadline=None)
def test_random_seeds_with_ties_and_shared_labels(points, scale, window, limit):
    x, y, labels = (np.array(v) for v in zip(*points, strict=True))
    check_both_ways(SeedSet(x, y, labels, scale), Frame(*window), limit)


@pytest.mark.parametrize("reach", [2**31 - 40, 2**31 + 40, 2**40])
def test_far_seeds(reach):
    """Around the bound of 64-bit distances, and at the largest coordinates: exact ties to the last unit."""
    x = np.array([-reach, reach, -reach, reach, 0, 0])
    y = np.array([3, 3, -3, -3, reach, -reach])
    check_both_ways(SeedSet(x, y, np.array([6, 5, 4, 3, 2, 1])), Frame(-9, -9, 19, 18))
    corner = min(reach, 2**40 - 10)
    seeds = SeedSet(np.array([corner, corner + 6, corner + 20 - reach]), np.array([0, 1, 5]), np.array([2, 1, 3]))
    check_both_ways(seeds, Frame(corner, -3, 9, 9))
    check_both_ways(seeds, Frame(corner, -3, 9, 9), limit=20)
    check_both_ways(SeedSet(-x[:1] - 8, y[:1], np.array([1])), Frame(-9, -9, 5, 5), limit=(reach - 1) ** 2)


@pytest.mark.parametrize("far", [(2**32, 0), (0, 2**32), (2**32, 2**32), (-(2**32), 2**32)])
def test_distances_that_would_wrap_around_in_64_bits(far):
    seeds = SeedSet(np.array([far[0], 5]), np.array([far[1], 2]), np.array([1, 2]))
    check_both_ways(seeds, Frame(0, 0, 8, 6))


@pytest.mark.parametrize("threads", [1, 2, 3, 4, 5])
def test_count_and_first_do_not_depend_on_threads(threads):
    random = np.random.default_rng(4)
    seeds = SeedSet(random.integers(0, 300, 50), random.integers(0, 300, 50), np.arange(1, 51))
    rows, columns = np.indices((300, 300))
    labels = ((columns[..., None] - seeds.x) ** 2 + (rows[..., None] - seeds.y) ** 2).argmin(axis=2) + 1
    verify_labels(labels, seeds, Frame(0, 0, 300, 300), threads=threads)
    labels[[150, 7, 299], [3, 288, 299]] = 51
    with pytest.raises(VerificationError, match=r"^3 of 90000 pixels are wrong: the first, \(x, y\) = \(288, 7\)"):
        verify_labels(labels, seeds, Frame(0, 0, 300, 300), threads=threads)


def test_limits():
    seeds = SeedSet(np.array([2**40 + 1]), np.array([0]), np.array([1]))
    with pytest.raises(InputError, match=r"cannot be verified: a seed lies beyond 2\^40 lattice steps"):
        verify_labels(np.ones((1, 1), dtype=np.uint8), seeds, Frame(0, 0, 1, 1))
    near = SeedSet(np.array([0]), np.array([0]), np.array([1]), 256)
    with pytest.raises(InputError, match=r"a seed lies beyond 2\^40"):
        verify_labels(np.ones((1, 1), dtype=np.uint8), near, Frame(2**33, 0, 1, 1))
    with pytest.raises(UsageError, match="max_distance2 is -1"):
        verify_labels(np.ones((1, 1), dtype=np.uint8), near, Frame(0, 0, 1, 1), max_distance2=-1)
    verify_labels(np.ones((1, 1), dtype=np.uint8), near, Frame(0, 0, 1, 1), max_distance2=2**200)
    with pytest.raises(InputError, match="labels have shape"):
        verify_labels(np.ones((1, 2), dtype=np.uint8), near, Frame(0, 0, 1, 1))
