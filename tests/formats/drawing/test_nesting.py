"""Rings in one another: a sweep over many, beside a look at every pair of few."""

import numpy as np
import pytest
import shapely

from support.few import few
from support.refusals import refused
from vorotool.errors import LimitError
from vorotool.formats.drawing import fill_rules
from vorotool.formats.drawing.fill_rules import filled_polygons, nested_polygons

RULES = ("nonzero", "evenodd")


def square(low, high):
    return np.array([[low, low], [high, low], [high, high], [low, high]], dtype=float)


def random_ring(random):
    """A ring on a small grid, so that many touch one another, run along one another, or cross."""
    kind = random.integers(3)
    if kind == 0:
        (x, y), (w, h) = random.integers(0, 8, 2), random.integers(1, 6, 2)
        ring = np.array([[x, y], [x + w, y], [x + w, y + h], [x, y + h]], dtype=float)
    elif kind == 1:
        ring = random.integers(0, 9, (3, 2)).astype(float)
    else:
        k = random.integers(0, 5)
        ring = square(k, 9 - k)
    return np.roll(ring[:: random.choice([-1, 1])], random.integers(len(ring)), axis=0)


def random_rings(random):
    """Simple rings, most often such that do not cross."""
    rings, shapes = [], []
    may_cross = random.random() < 0.3
    for _ in range(random.integers(2, 9)):
        ring = random_ring(random)
        shape = shapely.Polygon(ring)
        if shape.is_valid and (may_cross or not any(shape.overlaps(other) or shape.equals(other) for other in shapes)):
            rings.append(ring)
            shapes.append(shape)
    return rings


def lists(polygons):
    return [[ring.tolist() for ring in polygon] for polygon in polygons]


@pytest.mark.parametrize("seed", few(range(30), 8))
def test_a_sweep_finds_what_pairs_show(seed, monkeypatch):
    random = np.random.default_rng(seed)
    rings = random_rings(random)
    by_pairs = [lists(filled_polygons(rings, rule)) for rule in RULES] + [lists(nested_polygons(rings))]
    monkeypatch.setattr(fill_rules, "_MOST_PAIRS", 0)
    assert [lists(filled_polygons(rings, rule)) for rule in RULES] + [lists(nested_polygons(rings))] == by_pairs


def test_the_sign_of_a_side_is_exact():
    a, b = (0.1, 0.1), (0.7, 0.7)
    assert fill_rules._side(a, b, (0.3, 0.3)) == 0
    assert fill_rules._side(a, b, (0.3, np.nextafter(0.3, 1))) > 0 > fill_rules._side(a, b, (0.3, np.nextafter(0.3, 0)))
    assert fill_rules._side((0.0, 0.0), (1e-200, 1e-200), (1e-200, 2e-200)) > 0
    assert fill_rules._side((0.0, 0.0), (1e200, 1e200), (1e200, 2e200)) > 0


def test_rings_that_touch_without_end_are_refused(monkeypatch):
    monkeypatch.setattr(fill_rules, "MOST_MEETINGS", 1000)
    rings = [square(0, 1 + k) for k in range(400)]  # all along the same two lines
    refused(LimitError, "1000", filled_polygons, rings, "evenodd")
