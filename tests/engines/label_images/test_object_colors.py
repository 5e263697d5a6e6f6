"""Colors of objects with background between them."""

import numpy as np
import pytest

import vorotool
from vorotool.engines.label_images.object_colors import object_colors
from vorotool.engines.label_images.regions import measure_regions
from vorotool.types.points.label_image import LabelImage


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
