"""Seeds of volumes, against those that SciPy's components and all voxels give."""

from fractions import Fraction

import numpy as np
import pytest
from scipy import ndimage
from skimage.filters import threshold_otsu

import vorotool
from support.few import few
from vorotool.engines.tessellation.tessellator import Tessellator, paint_inner
from vorotool.engines.tessellation.volume_seeding import (
    objects_of_volume,
    seeds_from_volume,
    seeds_from_xyz,
    seeds_of_slabs,
)
from vorotool.errors import InputError, LimitError, UsageError, VorotoolWarning
from vorotool.types.volumes.volume import LabelVolume, Volume, VolumeSeeds, VoxelFrame, VoxelGrid

FORMS = {26: np.ones((3, 3, 3)), 6: ndimage.generate_binary_structure(3, 1)}


def mask_of(random, shape, part):
    """Blobs, where the part is small, else noise."""
    mask = random.random(shape) < part
    return ndimage.binary_dilation(mask, FORMS[6], iterations=2) if part < 0.05 else mask


def all_voxels(labels):
    """Every voxel of each label as a seed."""
    z, y, x = np.nonzero(labels)
    return VolumeSeeds(np.stack([x, y, z], axis=1), labels[z, y, x].astype(np.uint32))


def components_of(mask, connectivity):
    """Components in raster order of their first voxel."""
    found, count = ndimage.label(mask, FORMS[connectivity])
    first = ndimage.minimum(np.arange(mask.size).reshape(mask.shape), found, np.arange(1, count + 1))
    order = np.zeros(count + 1, np.int64)
    order[1 + np.argsort(first)] = np.arange(1, count + 1)
    return order[found]


# ---- components ------------------------------------------------------------------------------------
@pytest.mark.parametrize("connectivity", [26, 6])
@pytest.mark.parametrize("part", few([0.3, 0.1, 0.01, 0.6, 0.97], 2))
@pytest.mark.parametrize("shape", [(9, 14, 17), (1, 9, 8), (12, 1, 7), (5, 8, 1), (30, 2, 2)])
def test_components_are_numbered_by_their_first_voxels(shape, part, connectivity):
    mask = mask_of(np.random.default_rng([*shape, connectivity]), shape, part)
    mask[-1, -1, -1] = True
    expected = components_of(mask, connectivity)
    seeds = seeds_from_volume(mask, connectivity=connectivity)
    whole = np.zeros(shape, np.uint32)
    whole[seeds.z, seeds.y, seeds.x] = seeds.labels
    paint_inner(whole, seeds, seeds.frame)
    assert np.array_equal(whole, expected)
    count = int(expected.max())
    assert seeds.site_labels.tolist() == list(range(1, count + 1))
    assert np.array_equal(seeds.object_volume, np.bincount(expected.ravel())[1:])
    centers = ndimage.center_of_mass(mask, expected, np.arange(1, count + 1))
    assert seeds.sites == pytest.approx(np.array(centers)[:, ::-1])


@pytest.mark.filterwarnings("ignore:.*seeds moved to the nearest")
@pytest.mark.parametrize("mode", ["components", "labels", "pixels", "centroids", None])
@pytest.mark.parametrize("connectivity", [26, 6])
def test_slabs_give_what_the_whole_gives(mode, connectivity):
    random = np.random.default_rng(5)
    values = np.where(mask_of(random, (13, 20, 16), 0.03), random.integers(1, 4, (13, 1, 16)), 0)
    grid = VoxelGrid(Fraction(1), Fraction(1), Fraction(2), "um")
    told = []
    source = Volume(values, grid)
    whole = seeds_of_slabs(source, mode=mode, connectivity=connectivity)
    for slices in (1, 2, 3, 5, 12, 13, 99):
        asked = {"mode": mode, "connectivity": connectivity, "slices": slices, "progress": told.append}
        assert seeds_of_slabs(source, **asked) == whole
        assert told[-1] == 1
    assert whole.grid is grid
    assert told == sorted(told[: told.index(1) + 1]) + told[told.index(1) + 1 :]


# ---- outer voxels are enough -----------------------------------------------------------------------
UNITS = [(1, 1, 1), (5, 2, 3), (1, 7, 1)]
LIMITS = [None, 0, 1, Fraction(7, 2)]
WINDOWS = [None, (-3, 2, -2, 12, 30, 9), (6, 6, 4, 5, 5, 5), (40, 1, 2, 6, 7, 4)]
PAIRS_FIRST = [
    (UNITS[(i + j + turn) % 3], limit, window)
    for turn in range(3)
    for i, limit in enumerate(LIMITS)
    for j, window in enumerate(WINDOWS)
]


@pytest.mark.parametrize(("units", "limit", "window"), few(PAIRS_FIRST, len(LIMITS) * len(WINDOWS)))
def test_outer_voxels_give_what_all_voxels_give(window, limit, units):
    random = np.random.default_rng(7)
    labels = np.zeros((13, 18, 22), np.uint16)
    for label in (5, 2, 9, 7, 2):
        z, y, x = (int(random.integers(0, side - 7)) for side in labels.shape)
        labels[z : z + 6, y : y + 7, x : x + 7] = label
    labels[labels == 9] *= random.random((labels == 9).sum()) < 0.9
    seeds = seeds_from_volume(labels)
    assert seeds.filled.any()
    assert len(seeds) < np.count_nonzero(labels)
    frame = seeds.frame if window is None else VoxelFrame(*window)
    sides = vorotool.types.pixels.PixelSides(units)
    ours = Tessellator(seeds, frame, sides=sides, max_distance=limit, threads=2)
    every = Tessellator(all_voxels(labels), frame, sides=sides, max_distance=limit)
    assert np.array_equal(ours.labels(), every.labels())
    assert np.array_equal(ours.squared_distances(), every.squared_distances())
    assert np.array_equal(ours.distances(), every.distances())
    for first in range(0, frame.depth, 3):
        count = min(3, frame.depth - first)
        assert np.array_equal(ours.labels(first, count), every.labels(first, count))
        assert np.array_equal(ours.distances(first, count), every.distances(first, count))


# ---- points ----------------------------------------------------------------------------------------
def test_points_lie_on_the_coarsest_lattice():
    seeds = seeds_from_xyz([[0.5, 2, 0], [7, 5, 3.25], [-1, 0, 0]])
    assert seeds.scale == 4
    assert seeds.places.tolist() == [[2, 8, 0], [28, 20, 13], [-4, 0, 0]]
    assert seeds.sites.tolist() == [[0.5, 2, 0], [7, 5, 3.25], [-1, 0, 0]]
    assert seeds.places.flags.f_contiguous


def test_points_that_move_are_told_of():
    with pytest.warns(VorotoolWarning, match=r"1 of 2 seeds moved to the nearest 1/256 voxel, by at most 0.00"):
        seeds = seeds_from_xyz([[0.1, 0, 0], [1, 1, 1]])
    assert seeds.snapped == 1
    assert seeds.largest_move == pytest.approx(abs(0.1 - round(25.6) / 256))
    with pytest.raises(InputError, match=r"point \[0\] is \(0.1, 0.0, 0.0\): seeds lie on multiples of 1/256 voxel"):
        seeds_from_xyz([[0.1, 0, 0], [1, 1, 1]], strict=True)


@pytest.mark.parametrize(
    ("points", "match"),
    [
        (
            [[2.0**45, 0, 0]],
            r"point \[0\] is \(35184372088832, 0, 0\): coordinates of seeds must be at most 2\^44 voxels",
        ),
        ([[0, 0, np.nan]], r"point \[0\] is .*: coordinates must be finite"),
        ([[0, 0]], r"invalid points: expected points in space: an \(n, 3\) array of numbers"),
        (np.zeros((4, 2)), r"but got an array of float64 and shape \(4, 2\)"),
        ({"x": [1], "y": [2]}, "expected columns x, y, z, but got a dict with x, y"),
        ({"x": [1], "y": [2, 3], "z": [1]}, "the columns x, y and z differ in length"),
        ("points.csv", "points.csv"),
    ],
)
def test_what_are_no_points_of_space_is_refused(points, match):
    with pytest.raises(InputError, match=match):
        seeds_from_xyz(points)


def test_points_of_shapely_need_a_z():
    shapely = pytest.importorskip("shapely")
    assert seeds_from_xyz([shapely.Point(1, 2, 3)]).places.tolist() == [[1, 2, 3]]
    with pytest.raises(InputError, match=r"point \[1\] is a Point without z"):
        seeds_from_xyz([shapely.Point(1, 2, 3), shapely.Point(1, 2)])


def test_thresholds():
    random = np.random.default_rng(3)
    grey = random.normal(size=(6, 20, 21)).astype(np.float32) + 4 * (random.random((6, 20, 21)) < 0.3)
    for values in (grey, (20 * grey + 100).astype(np.uint8), (20 * grey).astype(np.int16), (9 * grey).astype(np.int64)):
        level = threshold_otsu(values)
        for slices in (1, 4, 6):
            source = Volume(values)
            found = objects_of_volume(source, "otsu", slices=slices).threshold
            assert np.array_equal(values > found, values > level)
        above = seeds_from_volume(values, threshold="otsu", mode="pixels")
        assert len(above) == (values > level).sum()
        below = seeds_from_volume(values, threshold=float(level), invert=True, mode="pixels")
        assert len(below) == (values <= level).sum()
    flat = objects_of_volume(Volume(np.full((2, 2, 2), 5)), "otsu", invert=True)
    assert (flat.threshold, flat.invert) == (5, False)


# ---- refusals --------------------------------------------------------------------------------------
@pytest.mark.parametrize(
    ("asked", "error", "match"),
    [
        ({"connectivity": 8}, UsageError, "connectivity is 8: it must be 26 or 6 in a volume; 8 and 4 apply to images"),
        ({"connectivity": 5}, UsageError, "connectivity is 5: it must be 26 or 6 in a volume$"),
        ({"mode": "voxels"}, UsageError, "mode is 'voxels': it must be one of pixels, components, labels, centroids"),
        ({"threshold": float("nan")}, UsageError, "threshold"),
        ({"max_sites": 3}, LimitError, "8 outer voxels of objects, more than max_sites=3"),
        ({"max_sites": 3, "mode": "pixels"}, LimitError, "8 foreground voxels, more than max_sites=3"),
        ({"max_sites": 0, "mode": "centroids"}, LimitError, "the volume has 1 objects, more than max_sites=0"),
        ({"invert": True, "strict": True}, InputError, "the volume has no foreground: use invert=True or threshold"),
    ],
)
def test_what_does_not_go_is_refused(asked, error, match):
    with pytest.raises(error, match=match):
        seeds_from_volume(np.ones((2, 2, 2), bool), **asked)


@pytest.mark.parametrize(
    ("values", "match"),
    [
        (
            np.random.default_rng(0).integers(0, 200, (2, 40, 40)),
            "slice 0 of the volume holds 200 different values in .* pieces",
        ),
        (np.random.default_rng(0).random((2, 40, 40)), "different values in .* pieces"),
        (np.array([[[0, 1]], [[0, -3]]]), "the volume holds the value -3 in slice 1, row 0, column 1: labels must be"),
        (np.array([[[0, 1, np.inf]]]), "the volume holds NaN or infinite values"),
        (np.zeros((3, 4)), r"expected a volume: .*, but got an array of float64 and shape \(3, 4\)"),
        (np.zeros((3, 0, 4)), "the volume is empty"),
        (np.array([[["a"]]]), "expected a volume"),
        ("cells.tif", r"vorotool.read\('cells.tif'\)"),
        (np.ma.array(np.zeros((1, 1, 2)), mask=[[[0, 1]]]), "some are masked"),
    ],
)
def test_what_is_no_volume_of_objects_is_refused(values, match):
    with pytest.raises(InputError, match=match):
        seeds_from_volume(values)


def test_a_volume_without_foreground_has_no_seeds():
    for mode in ("components", "labels", "pixels", "centroids", None):
        with pytest.warns(VorotoolWarning, match="the volume has no foreground"):
            seeds = seeds_from_volume(np.zeros((2, 3, 4), np.uint8), mode=mode)
        assert not len(seeds)
        assert seeds.frame is not None
        assert (seeds.object_volume is None) == (mode == "pixels")
        sweep = Tessellator(seeds)
        assert not sweep.labels().any()
        with pytest.raises(InputError, match="the volume has no foreground"):
            sweep.squared_distances()
        with pytest.raises(InputError, match="no foreground"):
            sweep.distances()


def test_labels_of_a_volume_with_an_origin_lie_there():
    labels = np.zeros((3, 4, 5), np.uint16)
    labels[1, 2, 3], labels[0, 0, 0] = 9, 4
    made = vorotool.tessellate(LabelVolume(labels, VoxelFrame(100, 50, -7, 5, 4, 3)))
    assert made.frame.z == -7
    assert np.array_equal(made.labels, vorotool.tessellate(labels).labels)
    assert made.seeds.sites.tolist() == [[100, 50, -7], [103, 52, -6]]
