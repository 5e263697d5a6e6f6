"""The tessellation of volumes by frames and seeds between voxels, against all distances in whole numbers."""

from fractions import Fraction

import numpy as np
import pytest
from scipy import ndimage
from skimage import segmentation

import vorotool
from support.few import few
from support.oracles.oracles import nearest_seeds
from vorotool import _core
from vorotool.engines import masks
from vorotool.engines.masks import bare_seeds
from vorotool.engines.tessellation.frames import band_limits
from vorotool.engines.tessellation.tessellator import Tessellator
from vorotool.engines.tessellation.volume_seeding import seeds_from_xyz
from vorotool.errors import InputError, LimitError, UsageError
from vorotool.types.pixels import PixelSides, pixel_sides
from vorotool.types.points.point_set import VolumePoints
from vorotool.types.volumes.volume import LabelVolume, VolumeSeeds, VoxelFrame


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
    nearest, _, least = nearest_seeds(near, labels, (*origin, 19, 14, 11), scale, units)
    within = least <= (limit * scale * 2) ** 2
    assert np.array_equal(sweep.labels(), np.where(within, nearest, 0))
    assert np.array_equal(sweep.squared_distances(), least)
    assert sweep.step == Fraction(1, 2 * scale)
    assert np.array_equal(sweep.distances(), np.sqrt(least * float(sweep.step**2)).astype(np.float32))
    whole = Tessellator(seeds, frame, sides=PixelSides(units, Fraction(1, 2)), threads=3)
    for first, count in ((0, 1), (4, 5), (10, 1)):
        assert np.array_equal(whole.labels(first, count), nearest[first : first + count])
        assert np.array_equal(whole.squared_distances(first, count), least[first : first + count])


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
    nearest, _, least = nearest_seeds(made.seeds.places, made.seeds.labels, (0, 0, 0, 15, 14, 9), 1, sides.units)
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
        ({"window": (0, 0, 2**43, 2, 2, 2)}, InputError, r"seed \[0\] at \(1, 2, 0\) is too far from the frame"),
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


# ---- Tessellations of volumes, against all distances in exact integers, SciPy and scikit-image ----
WAYS = ("rows", "bricks")
KINDS = ("uniform", "lattice", "plane", "line", "sphere", "outside")


pytestmark = pytest.mark.filterwarnings("ignore:.*lie on another seed")


def swept(places, labels, shape, **known):
    """The sweep of voxels: slice, row and column of each."""
    return Tessellator(bare_seeds(places, labels, shape), **known)


def brute(places, labels, shape, units):
    """Labels and squared distances; the places, too, have slices first."""
    first, _, least = nearest_seeds(places[:, ::-1], labels, (0, 0, 0, *shape[::-1]), 1, units)
    return first, least


def seeds_of(random, kind, count, shape):
    places = random.integers(0, shape, (count, 3))
    if kind == "lattice":
        places -= places % 4
    elif kind in ("plane", "line"):
        places[:, 0] = shape[0] // 2
        if kind == "line":
            places[:, random.integers(1, 3)] = 0
    elif kind == "sphere":
        way = random.normal(size=(count, 3))
        middle = np.array(shape) // 2
        places = np.rint(middle + 8 * way / np.linalg.norm(way, axis=1)[:, None]).astype(np.int64)
    elif kind == "outside":
        places = random.integers(-60, np.array(shape) + 60, (count, 3))
    return places, random.integers(1, count + 1, count).astype(np.uint32)


@pytest.mark.parametrize(
    ("units", "arithmetic"),
    [((1, 1, 1), "float64"), ((9001, 1, 30011), "float64 with int128"), ((2**20, 3, 2**21 - 1), "int128")],
)
@pytest.mark.parametrize("kind", KINDS)
def test_every_arithmetic_is_exact(units, arithmetic, kind):
    random = np.random.default_rng(4)
    places, labels = seeds_of(random, kind, 80, (17, 21, 25))
    sweep = swept(places, labels, (17, 21, 25), sides=PixelSides(units))
    assert kind == "outside" or sweep.arithmetic == arithmetic
    nearest, least = brute(places, labels, (17, 21, 25), units)
    assert np.array_equal(sweep.labels(), nearest)
    assert np.array_equal(sweep.squared_distances(), least)
    assert np.array_equal(sweep.distances(), np.sqrt(least.astype(float)).astype(np.float32))


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("spread", few(["farther than a word holds", "many at one place", "far apart"], 1))
def test_seeds_are_sorted_alike_by_any_number_of_threads(way, spread):
    random = np.random.default_rng(12)
    shape = (24, 20, 28)
    places = random.integers(0, shape, (60_000, 3))
    if spread != "many at one place":
        far = 2**14 if spread == "far apart" else 2**33
        places[::2] += random.integers(1, far, (30_000, 3)) * np.array([2, -1, 1]) * 32
    labels = random.integers(1, 2**32, len(places), dtype=np.uint32)
    sweeps = [swept(places, labels, shape, threads=threads, way=way) for threads in (1, 2, 5)]
    inside = np.flatnonzero(np.all((places >= 0) & (places < shape), axis=1))
    own = np.full(shape, 2**32)
    np.minimum.at(own, tuple(places[inside].T), labels[inside].astype(np.int64))
    made = sweeps[0].labels()
    assert np.array_equal(made[own < 2**32], own[own < 2**32])
    assert sweeps[0].duplicates == len(places) - len(np.unique(places, axis=0))
    for sweep in sweeps[1:]:
        assert sweep.duplicates == sweeps[0].duplicates
        assert np.array_equal(sweep.labels(), made)
        assert np.array_equal(sweep.distances(), sweeps[0].distances())


@pytest.mark.parametrize("density", few([0.2, 0.003], 1))
@pytest.mark.parametrize("units", [(1, 1, 1), (60, 13, 13)])
@pytest.mark.parametrize("first_label", few([2**31, 1], 1))
def test_both_ways_agree_where_blocks_are_cut(density, units, first_label):
    random = np.random.default_rng(10)
    shape = (150, 20, 300)  # more slices, rows and columns than a block has, and not a multiple
    places = random.integers(0, shape, (int(density * np.prod(shape)), 3))
    places = places[(places[:, 0] < 60) | (places[:, 2] < 40)]  # an empty part
    labels = first_label + random.permutation(len(places)).astype(np.uint32)
    sides = PixelSides(units)
    rows, bricks = (swept(places, labels, shape, sides=sides, threads=2, way=way) for way in WAYS)
    assert np.array_equal(rows.labels(), bricks.labels())
    assert np.array_equal(rows.squared_distances(), bricks.squared_distances())
    assert np.array_equal(rows.labels(40, 7), bricks.labels(40, 7))


def test_outputs_are_written_where_they_are_given():
    random = np.random.default_rng(11)
    places, labels = random.integers(0, 20, (30, 3)), np.arange(1, 31, dtype=np.uint32)
    sweep = swept(places, labels, (20, 20, 20))
    for dtype in (np.uint8, np.uint16, np.uint32, np.int32):
        out = np.empty((20, 20, 20), dtype)
        assert sweep.labels(out=out) is out
        assert np.array_equal(out, sweep.labels())
    squares = np.empty((3, 20, 20), np.uint32)
    assert sweep.squared_distances(2, 3, out=squares) is squares
    assert np.array_equal(squares, sweep.squared_distances()[2:5])
    with pytest.raises(UsageError, match="of shape"):
        sweep.labels(out=np.empty((20, 20), np.uint16))
    with pytest.raises(UsageError, match="of type uint32"):
        sweep.squared_distances(out=np.empty((20, 20, 20), np.uint64))
    with pytest.raises(ValueError, match="the way is"):
        swept(places, labels, (20, 20, 20), way="best")


def test_outputs_that_do_not_fit_are_refused():
    made = _core.volumes.VolumeTessellation(
        *np.zeros((3, 1), np.int64), np.ones(1, np.uint32), (0, 0, 0), (4, 4, 4), 1, (1, 1, 1), "portable"
    )
    for shape in ((5, 4, 4), (4, 5, 4), (4, 4, 5)):
        with pytest.raises(ValueError, match="does not fit"):
            made.labels(np.empty(shape, np.uint16), 0, None, 1, None)
    with pytest.raises(ValueError, match="sides of a voxel"):
        _core.volumes.VolumeTessellation(
            *np.zeros((3, 1), np.int64), np.ones(1, np.uint32), (0, 0, 0), (4, 4, 4), 1, (0, 1, 1), "portable"
        )


# ---- functions of users ----------------------------------------------------------------------------
@pytest.mark.parametrize("spacing", [None, 2, (3, 1, 2), (1.5, 0.325, 0.325), (Fraction(1, 3), 1, Fraction(1, 7))])
@pytest.mark.parametrize("part", few([0.02, 0.5, 0.001], 1))
def test_distances_are_those_of_scipy(spacing, part):
    random = np.random.default_rng(3)
    mask = random.random((20, 31, 27)) > part
    mask[0, 0, 0] = False
    ours, indices = masks.distance_transform(mask, spacing=spacing, return_indices=True)
    sampling = [float(side) for side in np.broadcast_to(1 if spacing is None else spacing, 3)]
    theirs = ndimage.distance_transform_edt(mask, sampling=sampling)
    np.testing.assert_allclose(ours, theirs, rtol=0, atol=1e-12)
    if all(side == int(side) for side in sampling):
        assert np.array_equal(ours, theirs)
    assert not mask[tuple(indices)].any()
    way = (indices - np.indices(mask.shape)) * np.array(sampling)[:, None, None, None]
    np.testing.assert_allclose(np.sqrt((way**2).sum(axis=0)), ours, rtol=0, atol=1e-12)


@pytest.mark.parametrize("distance", [0, 1, 2.5, float("inf")])
@pytest.mark.parametrize("spacing", [None, (3, 1, 2), 0.5])
def test_labels_grow_as_those_of_scikit_image(distance, spacing):
    random = np.random.default_rng(5)
    labels = np.zeros((15, 24, 30), np.int16)
    for label in (9, 2, 31, 7):
        z, y, x = (random.integers(0, side - 5) for side in labels.shape)
        labels[z : z + 4, y : y + 5, x : x + 5] = label
    ours = masks.expand_labels(labels, distance, spacing=spacing)
    assert ours.dtype == labels.dtype
    assert np.array_equal(ours[labels > 0], labels[labels > 0])
    theirs = segmentation.expand_labels(labels, distance, spacing=1 if spacing is None else spacing)
    assert np.array_equal(ours != 0, theirs != 0)
    z, y, x = np.nonzero(labels)
    units = (1, 1, 1) if not isinstance(spacing, tuple) else spacing
    nearest, _ = brute(np.stack([z, y, x], axis=1), labels[z, y, x], labels.shape, units)
    assert np.array_equal(ours, np.where(ours != 0, nearest, 0))


@pytest.mark.parametrize("function", [masks.distance_transform, masks.expand_labels])
def test_what_is_no_volume_is_refused_by_masks(function):
    with pytest.raises(UsageError, match=r"or 3 of them, \(depth, height, width\)"):
        function(np.eye(3, dtype=int)[None] * 0, spacing=(1, 2))
    with pytest.raises(LimitError, match="2 x 3 x 4 = 24 voxels, more than max_pixels=23"):
        function(np.zeros((2, 3, 4), int), max_pixels=23)
    with pytest.raises(InputError, match="color image"):
        function(np.zeros((4, 5, 3), np.uint8))
    with pytest.raises(InputError, match="some are masked"):
        function(np.ma.array(np.zeros((1, 1, 2)), mask=[[[0, 1]]]))


def test_volumes_that_say_nothing():
    assert masks.distance_transform(np.zeros((0, 2, 3))).shape == (0, 2, 3)
    assert not masks.expand_labels(np.zeros((3, 4, 5), np.uint8)).any()
    with pytest.raises(InputError, match="expected at least one zero pixel"):
        masks.distance_transform(np.ones((3, 4, 5)))
    with pytest.raises(InputError, match="holds the value -2 in slice 0, row 0, column 1: labels must be integers"):
        masks.expand_labels(np.full((1, 1, 2), [0, -2]))
    with pytest.raises(InputError, match="round them first"):
        masks.expand_labels(np.ones((2, 2, 2)))
