"""Lengths, areas and polylines of lines, parabolas and circular arcs together, against sums over fine polylines."""

import numpy as np
import pytest

from vorotool.numeric.curves.mixed_arcs import MixedArcs


def circles(random, count):
    """Arcs of at most half a circle, either way round."""
    center, radius = random.normal(size=(count, 2)) * 10, 10.0 ** random.uniform(-2, 2, (count, 1))
    first, turn = (
        random.uniform(-np.pi, np.pi, count),
        random.uniform(0, np.pi, count) * random.choice([1e-3, 1], count),
    )
    is_left = random.random(count) < 0.5
    last = first + np.where(is_left, turn, -turn)
    source, target = (center + radius * np.stack([np.cos(at), np.sin(at)], axis=1) for at in (first, last))
    return MixedArcs(source, target, np.full((count, 2), np.nan), center, is_left), radius[:, 0], turn


def test_circular_arcs():
    arcs, radius, turn = circles(np.random.default_rng(1), 200)
    np.testing.assert_allclose(arcs.lengths, radius * turn, rtol=1e-7)
    chord = np.sqrt(np.square(arcs.target - arcs.source).sum(axis=1))
    np.testing.assert_allclose(chord, 2 * radius * np.sin(turn / 2), rtol=1e-7)
    np.testing.assert_allclose(arcs.sagittas, radius * 2 * np.sin(turn / 4) ** 2, rtol=1e-6)
    around = arcs.areas_beside(arcs.center[0])[0]
    assert abs(around) == pytest.approx(radius[0] ** 2 * turn[0] / 2)


@pytest.mark.parametrize("angle", [1e-6, 1e-3, 0.1, 0.5, 0.51, 1, 3, np.pi])
def test_slices_of_circles(angle):
    """Beside its source the area of an arc is that between it and its chord, however thin."""
    ends = np.array([[1.0, 0.0]]), np.array([[np.cos(angle), np.sin(angle)]])
    arc = MixedArcs(*ends, np.full((1, 2), np.nan), np.zeros((1, 2)), np.array([True]))
    series = angle**3 / 12 * (1 - angle**2 / 20) if angle < 0.01 else (angle - np.sin(angle)) / 2
    assert arc.areas_beside(ends[0][0])[0] == pytest.approx(series, rel=1e-9)


def test_more_than_half_a_circle():
    ends = np.array([[1.0, 0.0]]), np.array([[0.0, -1.0]])
    arc = MixedArcs(*ends, np.full((1, 2), np.nan), np.zeros((1, 2)), np.array([True]))
    assert arc.lengths[0] == pytest.approx(1.5 * np.pi)
    assert arc.areas_beside(np.zeros(2))[0] == pytest.approx(0.75 * np.pi)


@pytest.mark.parametrize("move", [-1e-6, -1e-9, 0, 1e-9, 1e-6])
@pytest.mark.parametrize("off", [-1e-9, 0, 1e-9])
def test_half_circles_whose_ends_are_off_by_a_lattice(move, off):
    """What moves an end by little changes lengths, areas and sagittas by little."""
    ends = np.array([[1.0, move]]), np.array([[-1.0 - off, move]])
    arc = MixedArcs(*ends, np.full((1, 2), np.nan), np.zeros((1, 2)), np.array([True]))
    assert arc.lengths[0] == pytest.approx(np.pi - 2 * move, abs=3e-9)
    assert arc.areas_beside(np.zeros(2))[0] == pytest.approx(np.pi / 2 - move, abs=3e-9)
    assert arc.sagittas[0] == pytest.approx(1 - move, abs=3e-9)


def test_the_other_way_round():
    arcs, _, _ = circles(np.random.default_rng(2), 50)
    back = arcs.reversed(np.ones(50, dtype=bool))
    assert back.lengths.tolist() == pytest.approx(arcs.lengths.tolist())
    assert back.areas_beside(np.ones(2)).tolist() == pytest.approx((-arcs.areas_beside(np.ones(2))).tolist())


@pytest.mark.parametrize("tolerance", [1e-3, 0.2])
def test_polylines_of_all_kinds(tolerance):
    random = np.random.default_rng(3)
    arcs, radius, _ = circles(random, 60)
    kind = np.arange(60) % 3
    center = np.where((kind == 0)[:, None], arcs.center, np.nan)
    control = np.where((kind == 1)[:, None], random.normal(size=(60, 2)) * 5, np.nan)
    mixed = MixedArcs(arcs.source, arcs.target, control, center, arcs.is_left)
    points, start = mixed.polylines(tolerance)
    fine, fine_start = mixed.polylines(1e-7)
    np.testing.assert_array_equal(points[start[:-1]], mixed.source)
    np.testing.assert_array_equal(points[start[1:] - 1], mixed.target)
    for k in range(60):
        along = points[start[k] : start[k + 1]]
        assert kind[k] != 2 or len(along) == 2
        if kind[k] == 0:
            middle = (along[1:] + along[:-1]) / 2 - center[k]
            assert (radius[k] - np.sqrt(np.square(middle).sum(axis=1)) <= tolerance * (1 + 1e-9)).all()
        steps = np.diff(fine[fine_start[k] : fine_start[k + 1]], axis=0)
        assert np.sqrt(np.square(steps).sum(axis=1)).sum() == pytest.approx(mixed.lengths[k], rel=1e-5)
