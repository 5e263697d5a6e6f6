"""The peers' functions with their own signatures: called as theirs are, results are theirs but for ties."""

import inspect
import subprocess
import sys

import geopandas
import numpy as np
import pytest
import shapely
from scipy import ndimage
from skimage import measure, morphology, segmentation
from skimage.data import binary_blobs

import vorotool
from support.few import few
from vorotool import compat
from vorotool.engines import masks

SHAPES = [(40,), (12, 15), (6, 7, 8)]


@pytest.mark.parametrize(
    ("ours", "theirs"),
    [
        (compat.distance_transform_edt, ndimage.distance_transform_edt),
        (compat.expand_labels, segmentation.expand_labels),
        (compat.medial_axis, morphology.medial_axis),
    ],
    ids=lambda function: function.__module__.split(".")[0],
)
def test_parameters_have_their_names_order_and_defaults(ours, theirs):
    own, other = (inspect.signature(function).parameters.values() for function in (ours, theirs))
    assert [(each.name, each.default, each.kind) for each in own] == [
        (each.name, each.default, each.kind) for each in other
    ]


@pytest.mark.parametrize("shape", SHAPES, ids=len)
@pytest.mark.parametrize("sampling", [None, 2.5, "each"])
def test_distances_are_those_of_scipy(shape, sampling):
    mask = np.random.default_rng(len(shape)).random(shape) < 0.8
    mask.reshape(-1)[0] = False
    sides = np.arange(1, 1 + len(shape)) / 2 if sampling == "each" else sampling
    expected, nearest = ndimage.distance_transform_edt(mask, sides, return_indices=True)
    found, indices = compat.distance_transform_edt(mask, sides, True, True)
    assert np.allclose(found, expected, rtol=1e-15)
    assert (indices.dtype, indices.shape) == (nearest.dtype, nearest.shape)
    assert not mask[tuple(indices)].any()
    steps = (indices - np.indices(shape)) * np.reshape(1.0 if sides is None else sides, (-1,) + (1,) * len(shape))
    assert np.allclose(np.sqrt((steps * steps).sum(axis=0)), expected)


@pytest.mark.parametrize("shape", SHAPES, ids=len)
def test_results_are_written_into_arrays(shape):
    mask = np.ones(shape, bool)
    mask.reshape(-1)[3] = False
    distances, indices = np.empty(shape), np.empty((len(shape), *shape), np.int32)
    assert compat.distance_transform_edt(mask, None, True, True, distances, indices) is None
    assert np.array_equal(distances, compat.distance_transform_edt(mask))
    alone = compat.distance_transform_edt(mask, return_distances=False, return_indices=True)
    assert np.array_equal(indices, alone)
    kept = compat.distance_transform_edt(mask, return_indices=True, distances=distances)
    assert np.array_equal(kept, indices)
    for given in ({"distances": np.empty(3)}, {"indices": indices.astype(np.int64), "return_indices": True}):
        with pytest.raises(vorotool.InputError):
            compat.distance_transform_edt(mask, **given)
    wrong = [{"return_distances": False}, {"indices": indices}]
    wrong.append({"distances": distances, "return_distances": False, "return_indices": True})
    for given in wrong:
        with pytest.raises(vorotool.UsageError):
            compat.distance_transform_edt(mask, **given)


@pytest.mark.parametrize("ndim", [1, 2, 3])
@pytest.mark.parametrize("distance", few([1.5, 3, 0, 1, 2, 5], 2))
@pytest.mark.parametrize("spacing", few([1, 2, "each"], 2))
def test_labels_grow_as_those_of_scikit_image(ndim, distance, spacing):
    blobs = binary_blobs(length=32, blob_size_fraction=0.1, n_dim=max(ndim, 2), rng=7)
    labels = measure.label(blobs)[5] if ndim == 1 else measure.label(blobs)
    sides = tuple(range(1, ndim + 1)) if spacing == "each" else spacing
    found = compat.expand_labels(labels, distance, sides)
    expected = segmentation.expand_labels(labels, distance, sides)
    assert (found.dtype, found.shape) == (labels.dtype, labels.shape)
    assert np.array_equal(found != 0, expected != 0)
    assert np.array_equal(found[labels != 0], labels[labels != 0])
    # where they differ, both labels are as near, and ours is the smaller
    for place in np.argwhere(found != expected):
        near = [
            min(((np.multiply(place - each, sides)) ** 2).sum() for each in np.argwhere(labels == label))
            for label in (found[tuple(place)], expected[tuple(place)])
        ]
        assert near[0] == near[1]
        assert found[tuple(place)] < expected[tuple(place)]


def test_medial_axis_of_a_part():
    image = np.zeros((20, 30), np.uint8)
    image[5:15, 5:25] = 1
    mask = np.zeros(image.shape, bool)
    mask[:, :15] = True
    axis, distance = compat.medial_axis(image, mask, True)
    assert np.array_equal(axis[:, 15:], image[:, 15:] != 0)
    assert np.array_equal(distance, ndimage.distance_transform_edt(image.astype(bool) & mask))
    assert axis[:, :15].any()
    assert np.array_equal(compat.medial_axis(image), masks.medial_axis(image))
    with pytest.raises(vorotool.InputError, match="mask"):
        compat.medial_axis(image, mask[1:])


def test_cells_of_buildings():
    houses = geopandas.GeoDataFrame(
        {"name": list("abc")},
        geometry=[shapely.box(0, 0, 2, 2), shapely.box(6, 0, 8, 2), shapely.box(0, 8, 2, 10)],
        crs=3857,
        index=[7, 5, 3],
    )
    cells = compat.morphological_tessellation(houses)
    assert cells.index.tolist() == [7, 5, 3]
    assert cells.crs == houses.crs
    assert cells.area.sum() == pytest.approx(80)
    assert all(cell.covers(house) for cell, house in zip(cells.geometry, houses.geometry, strict=True))
    hull = compat.morphological_tessellation(houses, "convex_hull")
    assert hull.area.sum() == pytest.approx(houses.union_all().convex_hull.area)
    inside = compat.morphological_tessellation(houses, clip=shapely.box(0, 0, 8, 4))
    assert inside.area.sum() == pytest.approx(32)
    assert compat.morphological_tessellation(houses.geometry, clip=None).area.sum() > 80
    with pytest.raises(vorotool.UsageError, match="'box'"):
        compat.morphological_tessellation(houses, clip="box")


def test_the_module_needs_no_import_of_its_own():
    text = "import vorotool; print(vorotool.compat.expand_labels([0, 0, 7], distance=1).tolist())"
    assert subprocess.run([sys.executable, "-c", text], capture_output=True, check=True).stdout == b"[0, 7, 7]\n"
