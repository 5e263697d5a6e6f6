"""Functions with the names of others, beside those others: they differ only where it is stated."""

import math
import warnings
from fractions import Fraction

import numpy as np
import pytest
import shapely
from scipy import ndimage
from skimage import morphology, segmentation

from support.few import few
from vorotool.engines import masks
from vorotool.engines.delaunay.cells import voronoi_polygons
from vorotool.errors import InputError, LimitError, UsageError, VorotoolWarning

SHAPES = [(1, 1), (1, 17), (19, 1), (13, 21), (64, 50)]
DENSITIES = [0.02, 0.3, 0.9]


def mask_of(shape, density, seed=0):
    """A random mask with a zero pixel."""
    mask = np.random.default_rng([*shape, seed]).random(shape) > density
    mask.flat[mask.size // 2] = False
    return mask


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
    distances, indices = masks.distance_transform(mask, return_indices=True)
    assert distances.dtype == np.float64
    assert indices.dtype == np.int32
    assert np.array_equal(distances, ndimage.distance_transform_edt(mask))
    assert np.array_equal(indices, brute_nearest(mask))
    assert np.array_equal(masks.distance_transform(mask), distances)
    assert np.array_equal(masks.distance_transform(mask, return_distances=False, return_indices=True), indices)


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
@pytest.mark.parametrize("function", [masks.distance_transform, masks.expand_labels])
def test_other_spacings_are_refused(function, spacing, words):
    with pytest.raises(UsageError, match=words):
        function(np.array([[0, 1]]), spacing=spacing)


def test_masks_that_say_nothing():
    assert masks.distance_transform(np.zeros((0, 4))).shape == (0, 4)
    _, indices = masks.distance_transform(np.zeros((3, 0)), return_indices=True)
    assert indices.shape == (2, 3, 0)
    assert masks.distance_transform(np.zeros((2, 2))).tolist() == [[0, 0], [0, 0]]
    with pytest.raises(InputError, match="expected at least one zero pixel"):
        masks.distance_transform(np.ones((2, 2)))
    with pytest.raises(InputError, match="some are masked"):
        masks.distance_transform(np.ma.array([[0, 1]], mask=[[0, 1]]))
    with pytest.raises(UsageError, match="both False"):
        masks.distance_transform([[0, 1]], return_distances=False)
    with pytest.raises(LimitError, match="max_pixels=3"):
        masks.distance_transform(np.zeros((2, 2)), max_pixels=3)


@pytest.mark.parametrize("wrong", [[0, 1], np.zeros((2, 2, 2, 2)), "mask", None, [["a"]], [[1j]], [[["a"]]]])
@pytest.mark.parametrize("function", [masks.distance_transform, masks.expand_labels, masks.medial_axis])
def test_what_is_no_image_is_refused(function, wrong):
    with pytest.raises(InputError, match=r"invalid (mask|labels): "):
        function(wrong)


def test_the_limit_is_exact_where_that_of_scikit_image_is_rounded():
    labels = np.zeros((4, 5), np.uint8)
    labels[0, 0] = 1
    root = math.sqrt(13)
    assert Fraction(root) ** 2 < 13
    assert segmentation.expand_labels(labels, root)[3, 2] == segmentation.expand_labels(labels, root)[2, 3] == 1
    ours = masks.expand_labels(labels, root)
    assert (ours[3, 2], ours[2, 3], ours[2, 2]) == (0, 0, 1)
    assert masks.expand_labels(labels, math.nextafter(root, 4))[2, 3] == 1


@pytest.mark.parametrize("kind", ["bool", "u1", ">u2", "i4", "i8", "u8"])
def test_labels_keep_their_type(kind):
    labels = np.array([[1, 0, 0, 0]]).astype(kind)
    grown = masks.expand_labels(labels)
    assert grown.dtype == labels.dtype
    assert grown.tolist() == [[1, 1, 0, 0]]


def test_labels_that_say_nothing():
    with warnings.catch_warnings(action="error"):
        for empty in (np.zeros((3, 3), int), np.zeros((0, 2), int), np.zeros((2, 2), bool)):
            assert np.array_equal(masks.expand_labels(empty, 5), empty)
    full = np.full((2, 3), 7)
    assert np.array_equal(masks.expand_labels(full), full)
    assert np.array_equal(masks.expand_labels(np.array([[0, 255]])), [[255, 255]])
    for wrong, words in (([[-1, 0]], "labels must be integers"), ([[0.0, 1.0]], "expected integers or booleans")):
        with pytest.raises(InputError, match=words):
            masks.expand_labels(wrong)


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
    axis = masks.medial_axis(mask)
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


@pytest.mark.parametrize("seed", few(range(4), 2))
def test_the_discs_of_an_axis_give_the_mask_as_those_of_scikit_image_do(seed):
    mask = blobs(seed)
    axis, distance = masks.medial_axis(mask, return_distance=True)
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


# ---- cells ---------------------------------------------------------------------------------------
@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("extend_to", [None, shapely.box(-5, -40, 30, 2), shapely.Point(0.5, 0.5), shapely.Point()])
def test_cells_are_those_of_shapely(seed, extend_to):
    points = np.random.default_rng(seed).random((40, 2)) * [10, 3]
    ours = voronoi_polygons(points, extend_to=extend_to)
    theirs = shapely.voronoi_polygons(shapely.MultiPoint(points), extend_to=extend_to, ordered=True)
    assert isinstance(ours, shapely.GeometryCollection)
    assert ours.bounds == pytest.approx(theirs.bounds)
    for a, b, point in zip(ours.geoms, theirs.geoms, points, strict=True):
        assert a.symmetric_difference(b).area < 1e-9
        assert a.covers(shapely.Point(point))


def test_cells_of_few_points():
    assert voronoi_polygons([[1, 2]]).wkt == "GEOMETRYCOLLECTION EMPTY"
    assert voronoi_polygons(np.empty((0, 2))).is_empty
    box = shapely.box(0, 0, 4, 4)
    assert voronoi_polygons([[1, 2]], extend_to=box).geoms[0].equals(box)
    with pytest.warns(VorotoolWarning, match="1 of 3 points"):
        cells = voronoi_polygons([[0, 0], [2, 0], [0, 0]])
    assert [cell.is_empty for cell in cells.geoms] == [False, False, True]
    with pytest.raises(InputError, match="invalid extend_to: expected a geometry of shapely"):
        voronoi_polygons([[0, 0], [1, 1]], extend_to=(0, 0, 4, 4))
