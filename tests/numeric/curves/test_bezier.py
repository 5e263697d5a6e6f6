"""Areas beside quadratic Bezier curves and their lengths, against sums over many chords."""

import numpy as np
import pytest

from support.few import few
from vorotool.numeric.curves.mixed_arcs import areas_beside, lengths_of

CHORDS = 4000


def places_along(source, control, target):
    t = np.linspace(0, 1, CHORDS + 1)[:, None]
    return (1 - t) ** 2 * source + 2 * t * (1 - t) * control + t * t * target


@pytest.mark.parametrize("seed", few(range(20)))
def test_against_chords(seed):
    a, b, c = np.random.default_rng(seed).normal(size=(3, 2)) * [10, 1]
    way = places_along(a, b, c)
    length = np.sqrt((np.diff(way, axis=0) ** 2).sum(axis=1)).sum()
    assert lengths_of(a[None], b[None], c[None])[0] == pytest.approx(length, rel=1e-6)
    center = np.array([0.3, -2])
    x, y = (way - center).T
    area = (x[:-1] * y[1:] - x[1:] * y[:-1]).sum() / 2
    assert areas_beside(a[None], b[None], c[None], center)[0] == pytest.approx(area, rel=1e-6, abs=1e-6)


@pytest.mark.parametrize("bend", [0, 1e-300, 1e-16, 1e-12, 1e-9, 1e-6, 1e-3])
def test_nearly_straight(bend):
    source, target = np.array([[0.0, 0.0]]), np.array([[3.0, 4.0]])
    for control in ([[1.5 - 4 * bend, 2 + 3 * bend]], [[0.3, 0.4 + bend]]):
        length = lengths_of(source, np.array(control), target)[0]
        assert 5 - 1e-14 <= length <= 5 + 30 * bend * bend + 1e-14 + 5 * bend * (control[0][0] == 0.3)


def test_folded_and_straight():
    source, target = np.zeros((3, 2)), np.array([[1.0, 0.0], [0.0, 0.0], [2.0, 0.0]])
    control = np.array([[np.nan, np.nan], [0.0, 0.0], [1.0, 0.0]])
    assert lengths_of(source, control, target).tolist() == [1, 0, 2]
    assert areas_beside(source, control, target, np.zeros(2)).tolist() == [0, 0, 0]


def test_nothing():
    none = np.empty((0, 2))
    assert not len(lengths_of(none, none, none))
    assert not len(areas_beside(none, none, none, np.zeros(2)))
