"""The tessellation of volumes by frames and seeds between voxels, against all distances in whole numbers."""

from fractions import Fraction

import numpy as np
import pytest

import vorotool
from vorotool.engines.tessellation.frames import band_limits
from vorotool.engines.tessellation.tessellator import Tessellator
from vorotool.engines.tessellation.volume_seeding import seeds_from_xyz
from vorotool.errors import InputError, LimitError, UsageError
from vorotool.types.pixels import PixelSides, pixel_sides
from vorotool.types.points.point_set import VolumePoints
from vorotool.types.volumes.volume import LabelVolume, VolumeSeeds, VoxelFrame


def brute(seeds, frame, units=(1, 1, 1)):
    """Labels and squared distances in lattice steps: of the nearest seeds the smallest label."""
    starts, sides = (frame.z, frame.y, frame.x), frame.shape
    axes = [unit * seeds.scale * (start + np.arange(side, dtype=np.int64))
            for unit, start, side in zip(units, starts, sides, strict=True)]  # fmt: skip
    least = np.full(frame.shape, 2**62)
    nearest = np.zeros(frame.shape, np.int64)
    for k in np.argsort(seeds.labels, kind="stable"):
        at = seeds.places[k, ::-1]
        z, y, x = ((axis - unit * place) ** 2 for axis, unit, place in zip(axes, units, at, strict=True))
        square = z[:, None, None] + y[:, None] + x
        nearer = square < least
        least[nearer], nearest[nearer] = square[nearer], seeds.labels[k]
    return nearest, least


@pytest.mark.filterwarnings("ignore:.*lie on another seed")
@pytest.mark.parametrize("scale", [1, 2, 16, 256])
@pytest.mark.parametrize("origin", [(0, 0, 0), (-7, 3, 12), (10**6, -(10**6), 5), (2**36, 0, -(2**36))])
@pytest.mark.parametrize("units", [(1, 1, 1), (7, 2, 3)])
def test_frames_and_seeds_between_voxels(origin, scale, units):
    if max(map(abs, origin)) > 2**30 and scale > 1:
        origin = tuple(each // 16 for each in origin)
    random = np.random.default_rng([scale, units[0]])
    frame = VoxelFrame(*origin, 19, 14, 11)
    near = random.integers(-6 * scale, 20 * scale, (60, 3)) + scale * np.array(origin)
    labels = random.integers(1, 40, 60).astype(np.uint32)
    seeds = VolumeSeeds(near, labels, scale=scale)
    limit = Fraction(int(random.integers(1, 9)), 2)
    sweep = Tessellator(seeds, frame, sides=PixelSides(units, Fraction(1, 2)), max_distance=limit)
    nearest, least = brute(seeds, frame, units)
    within = least <= (limit * scale * 2) ** 2
    assert np.array_equal(sweep.labels(), np.where(within, nearest, 0))
    assert np.array_equal(sweep.squared_distances(), least)
    assert sweep.step == Fraction(1, 2 * scale)
    assert np.array_equal(sweep.distances(), np.sqrt(least * float(sweep.step**2)).astype(np.float32))
    whole = Tessellator(seeds, frame, sides=PixelSides(units, Fraction(1, 2)), threads=3)
    for first, count in ((0, 1), (4, 5), (10, 1)):
        assert np.array_equal(whole.labels(first, count), nearest[first : first + count])
        assert np.array_equal(whole.squared_distances(first, count), least[first : first + count])


@pytest.mark.parametrize("dtype", ["uint8", "uint16", "uint32", "int32"])
def test_labels_of_every_type(dtype):
    random = np.random.default_rng(2)
    points = random.integers(0, 12, (30, 3))
    points = np.unique(points, axis=0)
    made = vorotool.tessellate(points, shape=(12, 12, 12), dtype=dtype)
    assert made.labels.dtype == dtype
    assert np.array_equal(made.labels, brute(made.seeds, made.frame)[0])
    out = np.empty((12, 12, 12), dtype)
    again = vorotool.tessellate(points, shape=(12, 12, 12), out=out, threads=1)
    assert again.labels is out
    assert np.array_equal(out, made.labels)


def test_points_have_a_frame_of_their_own():
    points = VolumePoints([[2, 1, 0], [7.25, 5.5, 3]])
    assert vorotool.tessellate(points).shape == (4, 7, 8)
    with pytest.raises(InputError, match=r"z from -1 to 3, .* use window=\(x, y, z, w, h, d\)"):
        vorotool.tessellate(VolumePoints([[0, 0, -1], [0, 0, 3]]))
    with pytest.raises(
        LimitError, match=r"frame that holds the points has 1001 x 1001 x 1001 voxels.*shape=\(D, H, W\)"
    ):
        vorotool.tessellate(VolumePoints([[1000, 1000, 1000]]))


@pytest.mark.parametrize("spacing", [2, (3, 1, 2), (1.5, 0.325, 0.325), (Fraction(1, 3), 1, Fraction(1, 7))])
def test_spacing_and_distances_in_its_unit(spacing):
    random = np.random.default_rng(8)
    points = np.unique(random.integers(0, 15, (40, 3)), axis=0)
    made = vorotool.tessellate(points, shape=(9, 14, 15), spacing=spacing, max_distance=1.3)
    sides = pixel_sides(spacing, 3)
    assert made.sides == sides
    nearest, least = brute(made.seeds, made.frame, sides.units)
    assert np.array_equal(made.labels, np.where(least * sides.step**2 <= Fraction(13, 10) ** 2, nearest, 0))
    again = vorotool.tessellate(LabelVolume(made.labels, sides=sides))
    assert again.sides == sides


# ---- refusals --------------------------------------------------------------------------------------
POINTS = np.array([[1.0, 2, 0], [4, 4, 3]])


@pytest.mark.parametrize(
    ("asked", "error", "match"),
    [
        ({}, InputError, r"invalid seeds: expected shape \(n, 2\), but .* \(2, 3\): .* give shape="),
        ({"shape": (5, 6)}, InputError, r"give shape=\(D, H, W\) as well; seeds\[:, :2\]"),
        ({"shape": (5, 6, 7), "window": (0, 0, 0, 7, 6, 5)}, UsageError, "give shape or window, not both"),
        ({"shape": (5, 6, 7.5)}, UsageError, r"shape must be three integers \(D, H, W\), but is"),
        ({"window": (0, 0, 0, 1, 2, 3.5)}, UsageError, r"window must be six integers \(x, y, z, w, h, d\), but is"),
        ({"shape": (5, 0, 7)}, InputError, "the frame is 7 x 0 x 5 voxels"),
        ({"shape": (5, 6, 7), "method": "propagation"}, UsageError, "a volume needs method='exact'"),
        ({"shape": (5, 6, 7), "method": "fast"}, UsageError, "method is 'fast': it must be 'exact'"),
        ({"shape": (5, 6, 7), "passes": 1}, UsageError, "passes is 1, which needs method='propagation'"),
        ({"shape": (5, 6, 7), "spacing": (1, 2)}, UsageError, r"or 3 of them, \(depth, height, width\)"),
        ({"shape": (5, 6, 7), "max_pixels": 209}, LimitError, "the frame has 7 x 6 x 5 = 210 voxels, more than max"),
        ({"shape": (5, 6, 7), "max_distance": -1}, UsageError, "max_distance is -1"),
        ({"shape": (5, 6, 7), "dtype": "float32"}, UsageError, "labels cannot have type float32"),
        ({"shape": (5, 6, 7), "out": np.zeros((5, 6), np.uint8)}, UsageError, r"array of shape \(5, 6, 7\), but is"),
        ({"window": (0, 0, 2**43, 2, 2, 2)}, InputError, r"seed 1 at \(1, 2, 0\) is too far from the frame"),
    ],
)
def test_what_does_not_go_is_refused(asked, error, match):
    with pytest.raises(error, match=match):
        vorotool.tessellate(POINTS, **asked)


@pytest.mark.parametrize(
    ("seeds", "match"),
    [
        (np.zeros((4, 4)), r"invalid seeds: expected points in space: an \(n, 3\) array"),
        (np.zeros((4, 5, 6)), r"invalid seeds: expected truth values or integers.*vorotool.seeds_from_volume\(seeds"),
        (np.zeros((0, 3)), "no seeds"),
        ({"x": [1], "y": [2]}, "expected columns x, y, z"),
    ],
)
def test_what_is_no_seed_of_a_volume_is_refused(seeds, match):
    with pytest.raises(InputError, match=match):
        vorotool.tessellate(seeds, shape=(4, 5, 6))


def test_squares_that_may_exceed_64_bits_are_refused_and_distances_are_not():
    sides = PixelSides((2**21 - 1, 1, 1))
    seeds = VolumeSeeds(np.array([[0, 0, 0]]), np.array([1]), scale=256)
    sweep = Tessellator(seeds, VoxelFrame(0, 0, 0, 1, 1, 12), sides=sides)
    assert sweep.arithmetic == "int128"
    with pytest.raises(LimitError, match=r"may exceed 64 bits.*use distances"):
        sweep.squared_distances()
    assert sweep.distances()[:, 0, 0].tolist() == [np.float32((2**21 - 1) * z) for z in range(12)]


def test_slices_outside_of_the_frame_are_refused():
    sweep = Tessellator(seeds_from_xyz([[0, 0, 0]]), VoxelFrame(0, 0, 0, 2, 2, 4))
    for first, slices in ((4, 1), (-1, 2), (2, 3), (0, 0)):
        with pytest.raises(UsageError, match="not all in a frame of 4 slices"):
            sweep.labels(first, slices)


def test_progress_goes_up_to_one():
    told = []
    seeds = seeds_from_xyz(np.random.default_rng(1).integers(0, 90, (9, 3)))
    sweep = Tessellator(seeds, VoxelFrame(0, 0, 0, 90, 90, 90), progress=told.append)
    for first, slices in band_limits(sweep.frame):
        sweep.labels(first, slices)
    assert told == sorted(told)
    assert all(0 <= part <= 1 for part in told)
