"""Names and colors of regions, compared with a distance transform and with neighborhoods."""

import numpy as np
import pytest
from scipy import ndimage

import vorotool
from vorotool import tessellate
from vorotool.engines.label_images.names_and_colors import label_places, name_places, object_colors
from vorotool.engines.label_images.regions import measure_regions
from vorotool.engines.tessellation.seeding import seeds_from_raster
from vorotool.types.images import LabelImage
from vorotool.types.pixels import Frame
from vorotool.types.points.seed_set import SeedSet


def random_labels(seed):
    rng = np.random.default_rng(seed)
    return rng.integers(0, 5, (6, 8)).repeat(rng.integers(3, 9), axis=0).repeat(rng.integers(3, 9), axis=1)


@pytest.mark.parametrize("seed", range(8))
def test_no_pixel_is_deeper_inside(seed):
    image = random_labels(seed)
    labels, places, radius = label_places(LabelImage(image))
    assert labels.tolist() == np.unique(image[image > 0]).tolist()
    for label, (column, row), found in zip(labels.tolist(), places.tolist(), radius.tolist(), strict=True):
        region = np.pad(image == label, 1)
        inner = ndimage.binary_erosion(region)
        outermost = (region & ~inner)[1:-1, 1:-1]
        everywhere = ndimage.distance_transform_edt(~outermost) * (image == label)
        assert image[row, column] == label
        assert found == everywhere[row, column] == everywhere.max()


def test_the_middle_of_a_bar_and_the_larger_of_two_pieces():
    image = np.zeros((12, 30), np.uint16)
    image[1:6, 2:25] = 9
    image[8:11, 3:6] = 9
    labels, places, radius = label_places(LabelImage(image))
    assert (labels.tolist(), places.tolist(), radius.tolist()) == ([9], [[13, 3]], [2.0])


def test_thin_regions_and_none():
    assert label_places(LabelImage(np.array([[4, 4, 4, 0]])))[1].tolist() == [[1, 0]]
    assert len(label_places(LabelImage(np.zeros((3, 3), np.uint8)))[0]) == 0


def test_objects_are_named_where_they_are():
    """Pixels of objects, centroids that share a pixel, and an object that has no pixel of its own."""
    mask = np.zeros((30, 40), np.uint8)
    mask[2:7, 3:8] = 255
    mask[20:29, 30:33] = 255
    made = tessellate(seeds_from_raster(mask))
    assert name_places(made)[1].tolist() == [[5, 4], [31, 24]]
    assert label_places(made)[1].tolist() != [[5, 4], [31, 24]]
    near = SeedSet(np.array([9, 11, 60]), np.array([8, 8, 60]), np.array([4, 2, 9]), scale=2, frame=Frame(0, 0, 40, 40))
    labels, places = name_places(tessellate(near))
    assert labels.tolist() == [2, 4, 9]
    assert places[[0, 2]].tolist() == [[6, 4], [30, 30]]
    points = tessellate([[5, 5], [30, 20]], shape=(30, 40))
    assert name_places(points)[1].tolist() == label_places(points)[1].tolist()


def scattered(seed, largest=2**32 - 1):
    rng = np.random.default_rng(seed)
    image = np.zeros((60, 70), np.uint32)
    for label in rng.integers(1, largest, 25):
        x, y, w, h = rng.integers(0, 60), rng.integers(0, 50), rng.integers(1, 9), rng.integers(1, 9)
        image[y : y + h, x : x + w] = label
    return image


@pytest.mark.parametrize("seed", range(6))
def test_neighbors_differ_across_the_background(seed):
    image = scattered(seed)
    labels, colors = object_colors(LabelImage(image))
    assert labels.tolist() == np.unique(image)[1:].tolist()
    of = dict(zip(labels.tolist(), colors.tolist(), strict=True))
    influence = vorotool.tessellate(vorotool.seeds_from_raster(image, mode="labels"))
    measures = measure_regions(influence)
    pairs = measures.labels[measures.borders]
    assert len(pairs)
    assert all(of[a] != of[b] for a, b in pairs.tolist())
    assert len(set(colors.tolist())) > 1
