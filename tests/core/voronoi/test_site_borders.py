"""Borders of sites where many of them meet, owners at points, areas of rings, and arrays that do not go together."""

import numpy as np
import pytest

from vorotool import _core
from vorotool.engines.segment_voronoi.segment_voronoi import core_diagram, segment_voronoi

NO_SEGMENTS = np.empty((0, 2), dtype=np.int32)
RADIUS = 1105
"""Its circle passes 108 places with whole coordinates."""


def places_on_a_circle():
    x = np.arange(-RADIUS, RADIUS + 1)
    y = np.round(np.sqrt(RADIUS**2 - x * x)).astype(int)
    right = x * x + y * y == RADIUS**2
    return np.unique(np.concatenate([np.stack([x, s * y], axis=1)[right] for s in (1, -1)]), axis=0)


def test_ranks_where_many_sites_meet():
    places = places_on_a_circle().astype(np.int32)
    diagram = segment_voronoi(places, NO_SEGMENTS)
    core = core_diagram(diagram, NO_SEGMENTS)
    ring = diagram.sites_of(0).astype(np.int64)
    assert len(ring) == 108
    order = np.random.default_rng(1).permutation(len(ring))
    ranks = _core.voronoi.ranks_around(core, np.zeros(len(ring), dtype=np.int64), ring[order])
    assert ranks.tolist() == order.tolist()
    few = segment_voronoi(places[:3], NO_SEGMENTS)
    with pytest.raises(ValueError, match="range"):
        _core.voronoi.ranks_around(core_diagram(few), np.array([1]), np.array([0]))
    with pytest.raises(RuntimeError, match="does not touch"):
        _core.voronoi.ranks_around(core_diagram(few), np.array([0]), np.array([7]))
    with pytest.raises(RuntimeError, match="does not touch"):
        _core.voronoi.ranks_around(core, np.array([0]), np.array([200]))


@pytest.mark.parametrize("seed", range(10))
def test_owners_at_points(seed):
    random = np.random.default_rng(seed)
    segments = random.integers(0, 9, (12, 2)).astype(np.int32)
    owner = random.integers(0, 50, 12).astype(np.int32)
    least, most = _core.voronoi.owners_at_points(segments, owner, 10)
    for point in range(10):
        there = owner[(segments == point).any(axis=1)]
        assert least[point] == there.min(initial=2**31 - 1)
        assert most[point] == there.max(initial=-1)


def test_areas_of_rings_far_from_the_origin():
    places = np.array([[0, 0], [1, 0], [1, 1], [0, 1]]) + 2.0**40
    ends = np.array([[0, 1], [1, 2], [2, 3], [0, 3]], dtype=np.int32)
    start, half_edge = np.array([0, 4, 8]), np.array([0, 2, 4, 7, 1, 6, 5, 3])
    bulge = np.array([0.25, 0, 0, 0])
    assert _core.voronoi.ring_areas(start, half_edge, ends, places, bulge).tolist() == [1.25, -1.25]
    with pytest.raises(ValueError, match="half-edge"):
        _core.voronoi.ring_areas(start, half_edge - 1, ends, places, bulge)
    with pytest.raises(ValueError, match="area"):
        _core.voronoi.ring_areas(start, half_edge, ends, places, bulge[:3])
