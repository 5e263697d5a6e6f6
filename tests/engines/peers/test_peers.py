"""Functions with the names of others, beside those others: they differ only where it is stated."""

import math
import warnings
from fractions import Fraction

import numpy as np
import pytest
import shapely
from scipy import ndimage
from skimage import morphology, segmentation

import vorotool
from vorotool.engines import peers
from vorotool.errors import InputError, LimitError, UsageError, VorotoolWarning
from vorotool.types.points.label_image import LabelImage

SHAPES = [(1, 1), (1, 17), (19, 1), (13, 21), (64, 50)]
DENSITIES = [0.02, 0.3, 0.9]


def mask_of(shape, density, seed=0):
    """A random mask with a zero pixel."""
    mask = np.random.default_rng([*shape, seed]).random(shape) > density
    mask.flat[mask.size // 2] = False
    return mask


def labels_of(shape, count, seed=0):
    """A label image of single pixels and a block."""
    random = np.random.default_rng([*shape, count, seed])
    labels = np.zeros(shape, np.uint16)
    places = random.choice(labels.size, min(count, labels.size), replace=False)
    labels.flat[places] = random.integers(1, 900, len(places))
    labels[: shape[0] // 4, : shape[1] // 4] = 5
    return labels


def brute_nearest(mask):
    """The first of the nearest zero pixels of each, by trying all."""
    rows, columns = np.nonzero(~mask)
    y, x = np.indices(mask.shape)
    squares = (y[..., None] - rows) ** 2 + (x[..., None] - columns) ** 2
    first = squares.argmin(axis=-1)
    return np.stack([rows[first], columns[first]])


# ---- distances -----------------------------------------------------------------------------------
@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("density", DENSITIES)
def test_distances_are_those_of_scipy(shape, density):
    mask = mask_of(shape, density)
    distances, indices = peers.distance_transform(mask, return_indices=True)
    assert distances.dtype == np.float64
    assert indices.dtype == np.int32
    assert np.array_equal(distances, ndimage.distance_transform_edt(mask))
    assert np.array_equal(indices, brute_nearest(mask))
    assert np.array_equal(peers.distance_transform(mask), distances)
    assert np.array_equal(peers.distance_transform(mask, return_distances=False, return_indices=True), indices)


def test_scipy_names_another_pixel_of_a_tie_than_the_first_one():
    mask = np.array([[0, 1, 0], [1, 1, 1], [0, 1, 0]], bool)
    _, theirs = ndimage.distance_transform_edt(mask, return_indices=True)
    _, ours = peers.distance_transform(mask, return_indices=True)
    assert ours[:, 1, 1].tolist() == [0, 0]
    y, x = np.indices(mask.shape)
    assert np.array_equal(np.hypot(*(theirs - [y, x])), np.hypot(*(ours - [y, x])))


@pytest.mark.parametrize("spacing", [1, 0.325, (2, 2), [0.5, 0.5], np.array([3.0, 3.0]), Fraction(1, 3)])
def test_spacing_scales_distances(spacing):
    mask = mask_of((20, 31), 0.1)
    side = float(spacing if np.ndim(spacing) == 0 else spacing[0])
    theirs = ndimage.distance_transform_edt(mask, sampling=side)
    np.testing.assert_allclose(peers.distance_transform(mask, spacing=spacing), theirs, rtol=1e-15, atol=1e-12)


@pytest.mark.parametrize(
    ("spacing", "words"),
    [
        ((1, 2**0.5), "round the sides"),
        (0, "expected a number above 0"),
        ((1, 1, 1), "or 2 of them"),
        (float("nan"), "spacing is nan"),
        (-1, "expected a number above 0"),
        ("1", "spacing"),
    ],
)
@pytest.mark.parametrize("function", [peers.distance_transform, peers.expand_labels])
def test_other_spacings_are_refused(function, spacing, words):
    with pytest.raises(UsageError, match=words):
        function(np.array([[0, 1]]), spacing=spacing)


def test_any_layout_and_type_is_taken():
    mask = mask_of((16, 12), 0.2)
    expected = peers.distance_transform(mask)
    frozen = mask.copy()
    frozen.flags.writeable = False
    forms = [mask[:, ::-1][:, ::-1], np.asfortranarray(mask), frozen, mask.tolist(), mask.astype(">i8"), mask * -2.5]
    for form in (*forms, np.ma.array(mask, mask=False), np.where(mask, np.nan, 0)):
        assert np.array_equal(peers.distance_transform(form), expected)
    for threads in (1, 2):
        assert np.array_equal(peers.distance_transform(mask, threads=threads), expected)


def test_masks_that_say_nothing():
    assert peers.distance_transform(np.zeros((0, 4))).shape == (0, 4)
    _, indices = peers.distance_transform(np.zeros((3, 0)), return_indices=True)
    assert indices.shape == (2, 3, 0)
    assert peers.distance_transform(np.zeros((2, 2))).tolist() == [[0, 0], [0, 0]]
    with pytest.raises(InputError, match="expected at least one zero pixel"):
        peers.distance_transform(np.ones((2, 2)))
    with pytest.raises(InputError, match="some are masked"):
        peers.distance_transform(np.ma.array([[0, 1]], mask=[[0, 1]]))
    with pytest.raises(UsageError, match="both False"):
        peers.distance_transform([[0, 1]], return_distances=False)
    with pytest.raises(LimitError, match="max_pixels=3"):
        peers.distance_transform(np.zeros((2, 2)), max_pixels=3)


@pytest.mark.parametrize("wrong", [[0, 1], np.zeros((2, 2, 2, 2)), "mask", None, [["a"]], [[1j]], [[["a"]]]])
@pytest.mark.parametrize("function", [peers.distance_transform, peers.expand_labels, peers.medial_axis])
def test_what_is_no_image_is_refused(function, wrong):
    with pytest.raises(InputError, match=r"invalid (mask|labels): "):
        function(wrong)


# ---- labels --------------------------------------------------------------------------------------
@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("distance", [0, 1, 1.5, 4, math.inf])
def test_labels_grow_as_those_of_scikit_image_but_for_ties(shape, distance):
    labels = labels_of(shape, 9)
    ours, theirs = peers.expand_labels(labels, distance), segmentation.expand_labels(labels, distance)
    assert ours.dtype == labels.dtype
    assert np.array_equal(ours != 0, theirs != 0)
    nearest = {label: ndimage.distance_transform_edt(labels != label) for label in np.unique(labels[labels > 0])}
    for y, x in np.argwhere(ours != theirs):
        assert nearest[ours[y, x]][y, x] == nearest[theirs[y, x]][y, x]
        assert ours[y, x] < theirs[y, x]


def test_the_smallest_label_has_a_tie():
    assert peers.expand_labels([[9, 0, 2]]).tolist() == [[9, 2, 2]]
    assert peers.expand_labels([[2, 0, 9]]).tolist() == [[2, 2, 9]]


def test_the_limit_is_exact_where_that_of_scikit_image_is_rounded():
    labels = np.zeros((4, 5), np.uint8)
    labels[0, 0] = 1
    root = math.sqrt(13)
    assert Fraction(root) ** 2 < 13
    assert segmentation.expand_labels(labels, root)[3, 2] == segmentation.expand_labels(labels, root)[2, 3] == 1
    ours = peers.expand_labels(labels, root)
    assert (ours[3, 2], ours[2, 3], ours[2, 2]) == (0, 0, 1)
    assert peers.expand_labels(labels, math.nextafter(root, 4))[2, 3] == 1


def test_the_limit_is_in_the_unit_of_the_spacing():
    labels = labels_of((30, 30), 6)
    assert np.array_equal(peers.expand_labels(labels, 1.5, spacing=0.5), peers.expand_labels(labels, 3))
    third = Fraction(1, 3)
    assert np.array_equal(peers.expand_labels(labels, 1, spacing=third), peers.expand_labels(labels, 3))
    theirs = segmentation.expand_labels(labels, 1.5, spacing=0.5)
    assert np.array_equal(peers.expand_labels(labels, 1.5, spacing=(0.5, 0.5)) != 0, theirs != 0)


@pytest.mark.parametrize("kind", ["bool", "u1", ">u2", "i4", "i8", "u8"])
def test_labels_keep_their_type(kind):
    labels = np.array([[1, 0, 0, 0]]).astype(kind)
    grown = peers.expand_labels(labels)
    assert grown.dtype == labels.dtype
    assert grown.tolist() == [[1, 1, 0, 0]]


def test_labels_that_say_nothing():
    with warnings.catch_warnings(action="error"):
        for empty in (np.zeros((3, 3), int), np.zeros((0, 2), int), np.zeros((2, 2), bool)):
            assert np.array_equal(peers.expand_labels(empty, 5), empty)
    full = np.full((2, 3), 7)
    assert np.array_equal(peers.expand_labels(full), full)
    assert np.array_equal(peers.expand_labels(np.array([[0, 255]])), [[255, 255]])
    for wrong, words in (([[-1, 0]], "labels must be integers"), ([[0.0, 1.0]], "expected integers or booleans")):
        with pytest.raises(InputError, match=words):
            peers.expand_labels(wrong)
    for distance in (-1, float("nan"), "far"):
        with pytest.raises(UsageError, match="distance"):
            peers.expand_labels(full, distance)


# ---- axes ----------------------------------------------------------------------------------------
def blobs(seed):
    """A mask of smooth objects, some with holes, off the border."""
    noise = np.random.default_rng(seed).normal(size=(80, 80))
    return np.pad(ndimage.gaussian_filter(noise, 4) > 0.02, 2)


EIGHT = np.ones((3, 3))


def rough_masks():
    """Masks in which branches run beside each other, up to the border."""
    yield np.array([[0, 1, 0, 0, 0], [1, 0, 1, 1, 0], [0, 1, 1, 1, 1], [0, 1, 1, 1, 1], [0, 0, 1, 1, 0]], bool)
    rng = np.random.default_rng(8)
    for share in (0.2, 0.5, 0.8):
        for width in (0, 0.6, 1, 2):
            noise = ndimage.gaussian_filter(rng.random(rng.integers(5, 90, 2)), width)
            yield noise > np.quantile(noise, share)


@pytest.mark.parametrize("mask", [*map(blobs, range(4)), *rough_masks()])
def test_an_axis_has_the_objects_and_holes_of_its_mask(mask):
    axis = peers.medial_axis(mask)
    assert axis.dtype == bool
    assert not (axis & ~mask).any()
    objects, count = ndimage.label(mask, EIGHT)
    pieces, found = ndimage.label(axis, EIGHT)
    assert found == count
    assert {int(objects[pieces == k].max()) for k in range(1, found + 1)} == set(range(1, count + 1))
    background, holes = ndimage.label(np.pad(~mask, 1, constant_values=True))
    left, found = ndimage.label(np.pad(~axis, 1, constant_values=True))
    apart = {int(left[background == k][0]) for k in range(1, holes + 1)}
    assert found == len(apart) == holes


@pytest.mark.parametrize("seed", range(4))
def test_the_discs_of_an_axis_give_the_mask_as_those_of_scikit_image_do(seed):
    mask = blobs(seed)
    axis, distance = peers.medial_axis(mask, return_distance=True)
    theirs, their_distance = morphology.medial_axis(mask, return_distance=True, rng=0)
    assert np.array_equal(distance, their_distance)
    y, x = np.indices(mask.shape)
    shares = []
    for each in (axis, theirs):
        covered = np.zeros(mask.shape, bool)
        for row, column in np.argwhere(each):
            covered |= np.hypot(y - row, x - column) < distance[row, column]
        assert not (covered & ~mask).any()
        shares.append(covered[mask].mean())
    assert shares[0] > max(0.95, shares[1] - 0.01)
    assert axis.sum() < 1.4 * theirs.sum()


def test_an_axis_is_on_the_middle_row_and_its_end_is_the_center_of_the_last_disc():
    axis = peers.medial_axis(np.ones((5, 21)))
    assert np.flatnonzero(axis.any(axis=1)).tolist() == [2]
    assert axis[2, 3:18].all()
    assert set(peers.medial_axis(np.ones((4, 20))).sum(axis=0)[5:15].tolist()) <= {1, 2}


def test_axes_of_small_masks():
    assert peers.medial_axis(np.zeros((3, 2))).tolist() == [[False, False]] * 3
    assert peers.medial_axis(np.zeros((0, 2))).shape == (0, 2)
    for place in ((0, 0), (1, 2), (2, 3)):
        one = np.zeros((3, 4), bool)
        one[place] = True
        assert np.array_equal(peers.medial_axis(one), one)


# ---- cells ---------------------------------------------------------------------------------------
@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("extend_to", [None, shapely.box(-5, -40, 30, 2), shapely.Point(0.5, 0.5), shapely.Point()])
def test_cells_are_those_of_shapely(seed, extend_to):
    points = np.random.default_rng(seed).random((40, 2)) * [10, 3]
    ours = peers.voronoi_polygons(points, extend_to=extend_to)
    theirs = shapely.voronoi_polygons(shapely.MultiPoint(points), extend_to=extend_to, ordered=True)
    assert isinstance(ours, shapely.GeometryCollection)
    assert ours.bounds == pytest.approx(theirs.bounds)
    for a, b, point in zip(ours.geoms, theirs.geoms, points, strict=True):
        assert a.symmetric_difference(b).area < 1e-9
        assert a.covers(shapely.Point(point))


def test_cells_of_few_points():
    assert peers.voronoi_polygons([[1, 2]]).wkt == "GEOMETRYCOLLECTION EMPTY"
    assert peers.voronoi_polygons(np.empty((0, 2))).is_empty
    box = shapely.box(0, 0, 4, 4)
    assert peers.voronoi_polygons([[1, 2]], extend_to=box).geoms[0].equals(box)
    with pytest.warns(VorotoolWarning, match="1 of 3 points"):
        cells = peers.voronoi_polygons([[0, 0], [2, 0], [0, 0]])
    assert [cell.is_empty for cell in cells.geoms] == [False, False, True]
    with pytest.raises(InputError, match="invalid extend_to: expected a geometry of shapely"):
        peers.voronoi_polygons([[0, 0], [1, 1]], extend_to=(0, 0, 4, 4))


def test_a_label_image_is_taken_by_its_pixels():
    labels = vorotool.tessellate([[1, 1], [5, 2]], shape=(4, 7), max_distance=1)
    assert isinstance(labels, LabelImage)
    assert peers.expand_labels(labels.labels, math.inf).all()
