"""Distances between sites, where shapes are small and where they are long."""

import numpy as np
import pytest
import shapely
from tests.support.families.site_families import mixed_sites

from vorotool import voronoi
from vorotool.types.voronoi import tables
from vorotool.types.voronoi.tables import site_distances


@pytest.mark.parametrize("most", [1, 1 << 20])
def test_distances_are_those_of_shapely(most, monkeypatch):
    monkeypatch.setattr(tables, "_MANY", most)
    for seed in range(12):
        random = np.random.default_rng(seed)
        sites = mixed_sites(random, 8)
        by = random.integers(4, size=8)
        by[:4] = range(4)
        joined = [shapely.union_all([sites[k] for k in np.flatnonzero(by == each)]) for each in range(4)]
        pairs = np.stack(np.triu_indices(4, 1), axis=1)
        expected = shapely.distance(*np.array(joined)[pairs].T)
        np.testing.assert_allclose(site_distances(voronoi(sites, by=by), pairs), expected, atol=1e-12)


def test_neighbors_have_the_distance_between_them():
    sites = [shapely.box(0, 0, 2, 2), shapely.box(2, 0, 4, 2), shapely.box(7, 0, 9, 2), shapely.Point(8, 1)]
    rows = voronoi(sites).neighbors
    assert rows["label_a"].tolist() == [1, 2]
    assert rows["distance"].tolist() == [0, 3]
    assert voronoi([shapely.Point(0, 0)]).neighbors["distance"].tolist() == []
