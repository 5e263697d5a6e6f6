"""Objects of an image are numbered by raster order of their first pixel."""

import numpy as np
import pytest

import vorotool


def flood(mask, connectivity):
    """Components by flooding from pixel after pixel, in raster order."""
    steps = [(0, 1), (1, 0), (0, -1), (-1, 0)] + ([(1, 1), (1, -1), (-1, 1), (-1, -1)] if connectivity == 8 else [])
    labels, count = np.zeros(mask.shape, int), 0
    for start in zip(*np.nonzero(mask), strict=True):
        if labels[start]:
            continue
        count += 1
        labels[start] = count
        front = [start]
        while front:
            r, c = front.pop()
            for dr, dc in steps:
                p = (r + dr, c + dc)
                if 0 <= p[0] < mask.shape[0] and 0 <= p[1] < mask.shape[1] and mask[p] and not labels[p]:
                    labels[p] = count
                    front.append(p)
    return labels


@pytest.mark.parametrize("connectivity", [4, 8])
@pytest.mark.parametrize("seed", range(6))
def test_components(seed, connectivity):
    rng = np.random.default_rng(seed)
    mask = rng.random((int(rng.integers(1, 40)), int(rng.integers(1, 40)))) < rng.uniform(0.1, 0.9)
    mask[0, 0] = True
    right = flood(mask, connectivity)
    seeds = vorotool.seeds_from_raster(vorotool.Raster(mask), mode="components", connectivity=connectivity)
    found = vorotool.tessellate(seeds).labels
    np.testing.assert_array_equal(found[mask], right[mask])
    assert seeds.object_area.tolist() == np.bincount(right.ravel())[1:].tolist()


def test_pixels():
    mask = np.array([[0, 1, 1], [1, 0, 1]])
    found = vorotool.tessellate(vorotool.seeds_from_raster(vorotool.Raster(mask), mode="pixels")).labels
    assert found[mask == 1].tolist() == [1, 2, 3, 4]
