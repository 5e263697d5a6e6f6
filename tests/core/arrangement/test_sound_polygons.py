"""Rings that are seen to be simple, beside shapely: of few directions, which are compared as chains, and of many."""

import numpy as np
import pytest
import shapely

from vorotool import _core


def steps(rng):
    return np.cumsum(rng.integers(-1, 2, (rng.integers(3, 30), 2)), axis=0)


def around(rng):
    turn = np.sort(rng.random(rng.integers(3, 40))) * 2 * np.pi
    return np.rint(np.stack([np.cos(turn), np.sin(turn)], axis=1) * rng.uniform(4, 10, (len(turn), 1)))


def waves(rng):
    """Mostly more than 64 chains; of half of the rings two vertices are exchanged."""
    turn = np.linspace(0, 2 * np.pi, int(rng.integers(100, 600)), endpoint=False)
    radius = 1 + 0.3 * np.sin(rng.integers(2, 60) * turn) + 0.002 * rng.random(len(turn))
    ring = np.stack([np.cos(turn), np.sin(turn)], axis=1) * radius[:, None]
    if rng.random() < 0.5:
        ring[[10, 14]] = ring[[14, 10]]
    return ring


@pytest.mark.parametrize("family", [steps, around, waves])
def test_a_ring_is_sound_if_it_is_simple_and_counter_clockwise(family):
    found = []
    for seed in range(200):
        ring = family(np.random.default_rng(seed)).astype(float)
        line = shapely.linearrings(ring)
        repeats = (ring == np.roll(ring, 1, axis=0)).all(axis=1).any()
        expected = not repeats and shapely.is_simple(line) and shapely.is_ccw(line)
        starts = np.array([0, len(ring)]), np.array([0, 1])
        assert (_core.arrangement.polygon_faults(ring, *starts, False, 1, None)[0] == 0) == expected
        found.append(expected)
    assert 0 < sum(found) < len(found)
