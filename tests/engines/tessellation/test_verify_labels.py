"""The check of label images and volumes, against all distances in Python's integers."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import vorotool
from support.oracles.oracles import nearest_seeds
from vorotool.engines.tessellation.tessellate import verify_labels
from vorotool.errors import InputError, UsageError, VerificationError
from vorotool.types.pixels import Frame, PixelSides
from vorotool.types.points.seed_set import SeedSet
from vorotool.types.volumes.volume import LabelVolume, VolumeSeeds, VoxelFrame


def seeds_of(places, labels, scale=1):
    places, labels = np.asarray(places), np.asarray(labels)
    return SeedSet(*places.T, labels, scale) if places.shape[1] == 2 else VolumeSeeds(places, labels, scale)


def frame_of(window):
    return (Frame if len(window) == 4 else VoxelFrame)(*window)


def check_both_ways(places, labels, window, *, scale=1, units=(1, 1, 1), limit=None):
    """The right labels pass; a wrong one anywhere, and a tie that the larger label has, is found and named."""
    seeds, frame, n = seeds_of(places, labels, scale), frame_of(window), len(window) // 2
    first, last, least = nearest_seeds(places, labels, window, scale, units)
    right = np.where(least <= limit, first, 0) if limit is not None else first
    options = {"sides": PixelSides(units[:n]), "max_distance2": limit, "threads": 2}
    verify_labels(right, seeds, frame, **options)
    random = np.random.default_rng(0)
    ties = [tuple(place) for place in np.argwhere((first != last) & (right > 0)).tolist()]
    for place in [tuple(int(random.integers(side)) for side in right.shape), *ties[:2], *ties[-1:]]:
        wrong = right.copy()
        wrong[place] = last[place] if place in ties else right[place] + 1
        at = ", ".join(str(start + k) for start, k in zip(window[:n], place[::-1], strict=True))
        found = rf"^1 of {right.size} .*\({at}\), has label {wrong[place]}, not {right[place]}$"
        with pytest.raises(VerificationError, match=found):
            verify_labels(wrong, seeds, frame, **options)


def windows(n, most):
    return st.tuples(*[st.integers(-8, 8)] * n, *[st.integers(1, most)] * n)


def places_and_labels(n):
    return st.lists(st.tuples(*[st.integers(-15, 15)] * n, st.integers(1, 9)), min_size=1, max_size=15)


@pytest.mark.parametrize("n", [2, 3])
@given(data=st.data(), scale=st.sampled_from([1, 2, 4]), limit=st.none() | st.integers(0, 300))
@settings(max_examples=25, deadline=None)
def test_random_seeds_with_ties_and_shared_labels(n, data, scale, limit):
    rows = np.array(data.draw(places_and_labels(n)))
    window, units = data.draw(windows(n, 16 - 4 * n)), data.draw(st.tuples(*[st.integers(1, 4)] * n))
    check_both_ways(rows[:, :n], rows[:, n], window, scale=scale, units=units, limit=limit)


@pytest.mark.parametrize("reach", [2**31 - 40, 2**31 + 40, 2**40])
@pytest.mark.parametrize(("n", "axis"), [(2, 0), (3, 0), (3, 1), (3, 2)])
def test_far_seeds(reach, n, axis):
    """Around the bound of 64-bit distances, and at the largest coordinates: exact ties to the last unit."""
    places = np.array([[-reach, 3, 0], [reach, 3, 0], [-reach, -3, 0], [reach, -3, 1], [0, reach, 0], [0, -reach, 0]])
    near = [-3] * n + [7, 6, 5][:n]
    check_both_ways(np.roll(places[:, :n], axis, axis=1), [6, 5, 4, 3, 2, 1], near)
    corner = min(reach, 2**40 - 10)
    far = np.array([[corner, 0, 0], [corner + 6, 1, 2], [corner + 20 - reach, 5, 1]])[:, :n]
    for limit in (None, 20):
        check_both_ways(far, [2, 1, 3], [corner, -3, -1][:n] + [9, 9, 4][:n], limit=limit)
    check_both_ways(np.roll([[reach, 3, 0][:n]], axis, axis=1), [1], near, limit=(reach + 1) ** 2)


@pytest.mark.parametrize("far", [(1, 0), (0, 1), (1, 1), (-1, 1), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, -1, 1)])
def test_distances_that_would_wrap_around_in_64_bits(far):
    n = len(far)
    check_both_ways([[2**32 * each for each in far], [5, 2, 1][:n]], [1, 2], [0] * n + [8, 6, 3][:n])


@pytest.mark.parametrize("threads", [1, 2, 3, 5])
@pytest.mark.parametrize(("n", "side", "at"), [(2, 300, "288, 7"), (3, 60, "33, 9, 7")])
def test_count_and_first_do_not_depend_on_threads(n, side, at, threads):
    seeds = seeds_of(np.random.default_rng(4).integers(0, side, (50, n)), np.arange(1, 51))
    image = vorotool.tessellate(seeds, shape=(side,) * n)
    labels = image.labels.copy()
    verify_labels(labels, seeds, image.frame, threads=threads)
    labels[[[150, 7, 299], [50, 7, 59]][n - 2], [[3, 288, 299], [3, 9, 59]][n - 2], *[[58, 33, 59]] * (n - 2)] = 51
    with pytest.raises(VerificationError, match=rf"^3 of {side**n} .* \({at}\)"):
        verify_labels(labels, seeds, image.frame, threads=threads)


@pytest.mark.parametrize("window", [(0, 0, 8, 7), (0, 0, 0, 8, 7, 6)])
def test_every_single_wrong_label_is_found(window):
    random, n = np.random.default_rng(5), len(window) // 2
    places, numbers = random.integers(0, 8, (6, n)), random.integers(1, 4, 6)
    labels = nearest_seeds(places, numbers, window)[0]
    for place in np.ndindex(labels.shape):
        wrong = labels.copy()
        wrong[place] = labels[place] % 4 + 1
        with pytest.raises(VerificationError, match=rf"^1 of {labels.size} .* \({', '.join(map(str, place[::-1]))}\)"):
            verify_labels(wrong, seeds_of(places, numbers), frame_of(window))


def test_the_public_function():
    spacing = (1.5, 0.325, 0.325)
    points = np.random.default_rng(8).integers(0, 20, (30, 3))
    volume = vorotool.tessellate(points, shape=(20, 20, 20), spacing=spacing, max_distance=4.2)
    vorotool.verify_tessellation(volume, max_distance=4.2)
    cubes = LabelVolume(volume.labels, volume.frame, volume.seeds)
    for wrong, options in ((volume, {}), (cubes, {"max_distance": 4.2})):
        with pytest.raises(VerificationError, match="wrong"):
            vorotool.verify_tessellation(wrong, **options)
    with pytest.raises(UsageError, match="carries no seeds"):
        vorotool.verify_tessellation(LabelVolume(volume.labels))
    image = vorotool.tessellate([[3, 3], [12, 9], [5, 14]], shape=(16, 16))
    vorotool.verify_tessellation(image)
    image.labels[7, 2] = 3
    with pytest.raises(VerificationError, match="1"):
        vorotool.verify_tessellation(image)


@pytest.mark.parametrize("n", [2, 3])
def test_limits(n):
    frame, one = frame_of([0] * n + [1] * n), np.ones((1,) * n, np.uint8)
    near = seeds_of([[0] * n], [1], 256)
    for seeds, where, units in (
        (seeds_of([[0] * (n - 1) + [2**40 + 1]], [1]), frame, (1,) * n),
        (near, frame_of([0, 2**33, 0][:n] + [1] * n), (1,) * n),
        (seeds_of([[0] * (n - 1) + [2**62]], [1]), frame, (9, 1, 1)[:n]),
    ):
        with pytest.raises(InputError, match=r"beyond 2\^40"):
            verify_labels(one, seeds, where, sides=PixelSides(units))
    with pytest.raises(UsageError, match="-1"):
        verify_labels(one, near, frame, max_distance2=-1)
    verify_labels(one, near, frame, max_distance2=2**200)
    with pytest.raises(InputError, match="labels have shape"):
        verify_labels(np.ones((1,) * (n - 1) + (2,), np.uint8), near, frame)
