"""Rotating a shape moves its skeleton by no more than the placement lets it: see `support.oracles.rotation_oracle`."""

from dataclasses import replace

import numpy as np
import pytest

from support.oracles.rotation_oracle import Pair, Rotation, fault
from vorotool.convert.polygons import as_polygons

SHAPE = as_polygons(
    [[0, 0], [30, 0], [30, 6], [26, 6], [26, 12], [24, 12], [24, 6], [6, 6], [6, 9], [4, 9], [4, 6], [0, 6]]
)


def test_larger_moves_and_other_radii_are_found():
    pair = Pair(SHAPE, Rotation(10))
    assert fault(pair, {}) is None
    right = pair.second
    away = np.array([100 * pair.move, 0])
    for changed in ({"vertices": right.vertices + away}, {"radius": right.radius * (1 + 1e-6)}):
        pair.second = replace(right, **changed)
        assert fault(pair, {}) is not None


@pytest.mark.filterwarnings("ignore:1 polygon has its vertices at one or two")
def test_features_that_overlap_are_compared_one_by_one():
    """What is nearest to a place inside a feature is its own border, though another one runs between."""
    pair = Pair(as_polygons([SHAPE.xy, [[3, -2], [9, -2], [9, 20]], [[7, 1], [8, 2]]]), Rotation(10))
    assert fault(pair, {}) is None
    right = pair.second
    for feature in (0, 1):
        radius = right.radius.copy()
        radius[np.unique(right.arcs[right.polygon == feature])] *= 1 + 1e-6
        pair.second = replace(right, radius=radius)
        assert fault(pair, {}) is not None


def test_a_quarter_turn_moves_nothing():
    """Whole numbers stay whole."""
    pair = Pair(SHAPE, Rotation(90), step=1.0)
    assert np.array_equal(np.sort(pair.first.radius), np.sort(pair.second.radius))
    assert np.sort(pair.first.length).tolist() == np.sort(pair.second.length).tolist()
