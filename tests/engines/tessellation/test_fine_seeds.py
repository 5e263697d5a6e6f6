"""Seeds between pixels: on the finest lattice of the whole frame, by exact brute force."""

from __future__ import annotations

import numpy as np
import pytest

import vorotool
from vorotool.engines.tessellation.tessellator import Tessellator

pytestmark = pytest.mark.filterwarnings("ignore:.*seeds (moved|lie)")


def test_seeds_get_the_lattice_of_the_frame_and_the_coarsest_that_holds_them():
    step = 2.0**-31
    points = np.array([[step, 1], [5, 6]])
    assert vorotool.tessellate(points, shape=(512, 512)).seeds.scale == 2**31
    assert vorotool.tessellate(points, shape=(1024, 1024)).seeds.scale == 1
    assert vorotool.tessellate(points + 0.25, shape=(1024, 1024)).seeds.scale == 4
    seeds = vorotool.seeds_from_points(vorotool.PointSet(points))
    assert seeds.scale == 2**31
    assert vorotool.tessellate(seeds, shape=(1024, 1024)).seeds.scale == 1


@pytest.mark.parametrize("origin", [0, 2**20, -(2**30)])
def test_distances_and_tables_of_fine_seeds(origin):
    rng = np.random.default_rng(1)
    points = rng.random((30, 2)) * 40 + origin
    image = vorotool.tessellate(points, window=(origin, origin, 40, 30))
    vorotool.verify_tessellation(image)
    sweep = Tessellator(image.seeds, image.frame)
    if origin >= 0:  # far from it doubles are coarser
        with pytest.raises(vorotool.LimitError, match="distance"):
            sweep.squared_distances()
    rows, columns = np.mgrid[origin : origin + 30, origin : origin + 40]
    nearest = image.seeds.sites[image.labels.astype(int) - 1]
    right = np.hypot(nearest[..., 0] - columns, nearest[..., 1] - rows)
    np.testing.assert_allclose(sweep.distances(), right, rtol=1e-6)
    table = vorotool.region_table(image, distance2=sweep.squared_distances(dtype=sweep.measured_dtype))
    farthest = [right[image.labels == label].max(initial=0) for label in table["label"]]
    np.testing.assert_allclose(np.ma.filled(table["max_distance"], 0), farthest, rtol=1e-9)
