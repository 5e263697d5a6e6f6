"""The site of one place against shapely, and where places tie exactly."""

import numpy as np
import pytest
import shapely
from tests.support.families.site_families import mixed_sites, squares
from tests.support.oracles.voronoi_oracle import EQUAL, NEARLY, distances_of

from vorotool.convert.sites import as_sites
from vorotool.engines.voronoi.regions import site_at
from vorotool.engines.voronoi.site_graph import owned_graph


def owned_of(geometry):
    sites = as_sites(geometry)
    return owned_graph(sites.polygons, sites.site)


@pytest.mark.filterwarnings("ignore::vorotool.errors.RepairWarning")
@pytest.mark.parametrize("seed", range(12))
def test_random_places(seed):
    random = np.random.default_rng(seed)
    geometry = mixed_sites(random, int(random.integers(1, 9)), [None, 10][seed % 2])
    owned = owned_of(geometry)
    places = random.random((60, 2)) * 140 - 20
    distance = distances_of(geometry, places)
    least = distance.min(axis=0)
    ties = distance <= least + EQUAL * 100
    for k in np.flatnonzero((ties == (distance <= least + NEARLY * 100)).all(axis=0)).tolist():
        assert site_at(owned, tuple(places[k].tolist())) == ties[:, k].argmax()


def test_ties_are_of_the_first():
    owned = owned_of(squares(3))
    assert [site_at(owned, (x, 1.5)) for x in (1.5, 3.5)] == [0, 1]
    for places in ([[0, 0], [6, 0]], [[6, 0], [0, 0]]):
        assert site_at(owned_of(places), (3.0, 7.0)) == 0
        near = np.nextafter(3.0, 4.0)  # nearer to (6, 0), by less than distances in doubles tell
        assert site_at(owned_of(places), (near, 7.0)) == places.index([6, 0])
    assert site_at(owned_of([shapely.box(2, 2, 4, 4), shapely.box(0, 0, 6, 6)]), (3.0, 3.0)) == 0
    assert site_at(owned_of([shapely.box(2, 2, 4, 4), shapely.box(0, 0, 6, 6)]), (1.0, 3.0)) == 1
