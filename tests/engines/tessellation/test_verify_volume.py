"""The check of label volumes, against all distances in Python's integers."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import vorotool
from vorotool.engines.tessellation.tessellate import verify_labels
from vorotool.errors import InputError, UsageError, VerificationError
from vorotool.types.pixels import PixelSides, pixel_sides
from vorotool.types.volumes.volume import CUBE, LabelVolume, VolumeSeeds, VoxelFrame


def brute_force(seeds, frame, sides=CUBE, limit=None):
    """Right labels, and those that are as near, from Python's integers: no width, no rounding."""
    labels, ties = np.zeros(frame.shape, dtype=np.uint32), {}
    units = sides.units[::-1]
    places = [tuple(v * u for v, u in zip(place, units, strict=True)) for place in seeds.places.tolist()]
    for at in np.ndindex(frame.shape):
        voxel = [
            seeds.scale * unit * (origin + index)
            for unit, origin, index in zip(units, (frame.x, frame.y, frame.z), at[::-1], strict=True)
        ]
        found = [
            (sum((p - v) ** 2 for p, v in zip(place, voxel, strict=True)), label)
            for place, label in zip(places, seeds.labels.tolist(), strict=True)
        ]
        least, label = min(found, default=(0, 0))
        labels[at] = 0 if limit is not None and least > limit else label
        larger = {other for square, other in found if square == least and other != label}
        if labels[at] and larger:
            ties[at] = max(larger)
    return labels, ties


def check_both_ways(seeds, frame, sides=CUBE, limit=None, dtype=np.uint32, salt=0):
    """The right labels pass; a wrong one anywhere, and a tie that the larger label has, is found and named."""
    labels, ties = brute_force(seeds, frame, sides, limit)
    labels = labels.astype(dtype)
    options = {"sides": sides, "max_distance2": limit, "threads": 2}
    verify_labels(labels, seeds, frame, **options)
    random = np.random.default_rng(salt)
    places = [tuple(int(random.integers(size)) for size in frame.shape), *list(ties)[:2], *list(ties)[-1:]]
    for place in places:
        wrong = labels.copy()
        wrong[place] = ties.get(place, labels[place] + 1)
        z, y, x = place
        expected = (
            rf"^1 of {frame.voxels} voxels is wrong: the first, \(x, y, z\) = \({frame.x + x}, {frame.y + y}, "
            rf"{frame.z + z}\), has label {wrong[place]}, not {labels[place]}$"
        )
        with pytest.raises(VerificationError, match=expected):
            verify_labels(wrong, seeds, frame, **options)
    return ties


points = st.lists(st.tuples(*(st.integers(-8, 8) for _ in "xyz"), st.integers(1, 9)), min_size=1, max_size=12)
windows = st.tuples(*(st.integers(-4, 4) for _ in "xyz"), *(st.integers(1, 5) for _ in "whd"))


@given(
    points,
    st.sampled_from([1, 2, 4]),
    windows,
    st.tuples(st.integers(1, 4), st.integers(1, 4), st.integers(1, 4)),
    st.none() | st.integers(0, 150),
)
@settings(max_examples=30, deadline=None)
def test_random_seeds_with_ties_and_shared_labels(points, scale, window, units, limit):
    *places, labels = (np.array(v) for v in zip(*points, strict=True))
    seeds = VolumeSeeds(np.stack(places, axis=1), labels, scale)
    check_both_ways(seeds, VoxelFrame(*window), PixelSides(units), limit)


@pytest.mark.parametrize("reach", [2**31 - 40, 2**31 + 40, 2**40])
@pytest.mark.parametrize("axis", [0, 1, 2])
def test_far_seeds(reach, axis):
    """Around the bound of 64-bit distances, and at the largest coordinates: exact ties to the last unit."""
    places = np.array([[-reach, 3, 0], [reach, 3, 0], [-reach, -3, 0], [reach, -3, 1], [0, reach, 0], [0, -reach, 0]])
    labels = np.array([6, 5, 4, 3, 2, 1])
    frame = VoxelFrame(-3, -3, -3, 7, 6, 5)
    check_both_ways(VolumeSeeds(np.roll(places, axis, axis=1), labels), frame)
    corner = min(reach, 2**40 - 10)
    seeds = VolumeSeeds(np.array([[corner, 0, 0], [corner + 6, 1, 2], [-corner, 5, 1]]), np.array([2, 1, 3]))
    check_both_ways(seeds, VoxelFrame(corner, -3, -1, 9, 5, 4))
    check_both_ways(seeds, VoxelFrame(corner, -3, -1, 9, 5, 4), limit=20)
    alone = VolumeSeeds(np.roll([[reach, 3, 0]], axis, axis=1), np.array([1]))
    check_both_ways(alone, VoxelFrame(-2, -2, -2, 4, 5, 3), limit=(reach + 1) ** 2)


@pytest.mark.parametrize("far", [(2**32, 0, 0), (0, 2**32, 0), (0, 0, 2**32), (2**32, -(2**32), 2**32)])
def test_distances_that_would_wrap_around_in_64_bits(far):
    seeds = VolumeSeeds(np.array([far, (2, 1, 1)]), np.array([1, 2]))
    check_both_ways(seeds, VoxelFrame(0, 0, 0, 5, 4, 3))


@pytest.mark.parametrize("threads", [1, 2, 5])
def test_count_and_first_do_not_depend_on_threads(threads):
    random = np.random.default_rng(4)
    seeds = VolumeSeeds(random.integers(0, 60, (50, 3)), np.arange(1, 51))
    volume = vorotool.tessellate(seeds, shape=(60, 60, 60))
    labels = volume.labels.copy()
    verify_labels(labels, seeds, volume.frame, threads=threads)
    labels[[50, 7, 7, 59], [3, 9, 9, 59], [58, 33, 2, 59]] = 51
    expected = r"^4 of 216000 voxels are wrong: the first, \(x, y, z\) = \(2, 9, 7\)"
    with pytest.raises(VerificationError, match=expected):
        verify_labels(labels, seeds, volume.frame, threads=threads)


def test_every_single_wrong_voxel_is_found():
    random = np.random.default_rng(5)
    seeds = VolumeSeeds(random.integers(0, 8, (6, 3)), random.integers(1, 4, 6))
    frame = VoxelFrame(0, 0, 0, 8, 7, 6)
    labels, _ = brute_force(seeds, frame)
    for place in np.ndindex(labels.shape):
        wrong = labels.copy()
        wrong[place] = labels[place] % 4 + 1
        z, y, x = place
        with pytest.raises(VerificationError, match=rf"^1 of 336 .* \({x}, {y}, {z}\)"):
            verify_labels(wrong, seeds, frame)


def test_the_public_function():
    spacing = (1.5, 0.325, 0.325)
    points = np.random.default_rng(8).integers(0, 20, (30, 3))
    volume = vorotool.tessellate(points, shape=(20, 20, 20), spacing=spacing, max_distance=4.2)
    vorotool.verify_tessellation(volume, max_distance=4.2)
    with pytest.raises(VerificationError, match="wrong"):
        vorotool.verify_tessellation(volume)
    cubes = LabelVolume(volume.labels, volume.frame, volume.seeds)
    with pytest.raises(VerificationError, match="wrong"):
        vorotool.verify_tessellation(cubes, max_distance=4.2)
    with pytest.raises(UsageError, match="the label volume carries no seeds"):
        vorotool.verify_tessellation(LabelVolume(volume.labels))
    assert volume.sides == pixel_sides(spacing, 3)


def test_limits():
    frame, one = VoxelFrame(0, 0, 0, 1, 1, 1), np.ones((1, 1, 1), np.uint8)
    far = VolumeSeeds(np.array([[0, 0, 2**40 + 1]]), np.array([1]))
    with pytest.raises(InputError, match=r"cannot be verified: a seed lies beyond 2\^40 lattice steps"):
        verify_labels(one, far, frame)
    near = VolumeSeeds(np.array([[0, 0, 0]]), np.array([1]), 256)
    with pytest.raises(InputError, match=r"the frame reaches beyond 2\^40"):
        verify_labels(one, near, VoxelFrame(0, 2**33, 0, 1, 1, 1))
    with pytest.raises(InputError, match=r"beyond 2\^40"):
        verify_labels(one, VolumeSeeds(np.array([[0, 0, 2**62]]), np.array([1])), frame, sides=PixelSides((9, 1, 1)))
    with pytest.raises(UsageError, match="max_distance2 is -1"):
        verify_labels(one, near, frame, max_distance2=-1)
    verify_labels(one, near, frame, max_distance2=2**200)
    with pytest.raises(InputError, match="labels have shape"):
        verify_labels(np.ones((1, 1, 2), np.uint8), near, frame)


def test_what_progress_raises_stops_the_work():
    labels = np.random.default_rng(1).integers(1, 900, (30, 300, 300)).astype(np.uint16)
    seeds = VolumeSeeds(np.random.default_rng(2).integers(0, 300, (900, 3)), np.arange(1, 901))

    def stop(fraction):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        verify_labels(labels, seeds, VoxelFrame(0, 0, 0, 300, 300, 30), threads=2, progress=stop)
