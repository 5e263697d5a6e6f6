"""What is said of polygons on the lattice: which features were repaired, and for which it is coarse."""

import re
import warnings

import numpy as np
import pytest

from vorotool import planar_graph, skeleton_approx, skeleton_exact, voronoi
from vorotool.errors import InputError, RepairWarning

SQUARE = np.array([[0, 0], [10, 0], [10, 10], [0, 10]])
SPIKE = np.array([[0, 0], [10, 0], [10, 10], [5, 10], [5, 30], [5, 10], [0, 10]])
ENGINES = [planar_graph, skeleton_exact, lambda given: skeleton_exact(given, features="together"), voronoi]


def moved(ring, x, y):
    return ring + np.array([x, y])


def said_by(call, *arguments, **options):
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        call(*arguments, **options)
    return [str(each.message) for each in said if issubclass(each.category, RepairWarning)]


def features_in(text):
    names = re.search(r"features? ([0-9, ]+)", text)
    assert names is not None, text
    return [int(each) for each in names[1].split(",") if each.strip()]


@pytest.mark.parametrize("engine", ENGINES)
def test_features_that_are_repaired_are_named(engine):
    twice = np.array([[0, 0], [0, 0], [10, 0], [10, 10], [0, 10]])
    hole = {"shell": moved(SQUARE, 160, 0), "holes": [moved(SQUARE, 200, 0).tolist()]}
    given = [
        SQUARE,
        moved(SPIKE, 40, 0),
        moved(SQUARE, 80, 0),
        moved(twice, 120, 0),
        hole,
        {"line": [[1000, 3], [1001, 3]]},
    ]
    (text,) = said_by(engine, given)
    assert features_in(text) == [2, 4, 5]


@pytest.mark.parametrize("engine", ENGINES)
def test_the_first_ten_features_are_named(engine):
    (text,) = said_by(engine, [moved(SPIKE, 100 * k, 0) for k in range(14)])
    assert features_in(text) == list(range(1, 11))
    assert "4 more" in text


def test_sites_that_meet_are_not_named():
    (text,) = said_by(voronoi, [SQUARE, moved(SQUARE, 5, 5), moved(SPIKE, 40, 0), moved(SQUARE, 45, 15)])
    assert features_in(text) == [3]


@pytest.mark.parametrize("engine", [*ENGINES, lambda given: skeleton_approx(given, step=1)])
@pytest.mark.parametrize("height", [1e-7, 1e-12])
def test_what_the_lattice_is_coarse_for_is_said(engine, height):
    turn = np.array([[0.8, 0.6], [-0.6, 0.8]])
    for sliver in (SQUARE * [1.2, height / 10], SQUARE * [1.2, height / 10] @ turn + 0.1):
        text = said_by(engine, [moved(SQUARE, 40, 0), sliver])[-1]
        assert features_in(text) == [2]
        assert f"{2.0**-25:.3g}" in text


@pytest.mark.parametrize("engine", ENGINES)
def test_small_houses_beside_something_far_are_said(engine):
    houses = [moved(SQUARE * 1e-4, k / 3, k / 7) for k in range(12)]
    far = moved(SQUARE, 1e4, 1e4)
    (text,) = said_by(engine, [*houses, far])
    assert features_in(text) == list(range(1, 11))
    assert "2 more" in text
    assert not said_by(engine, houses)


def test_what_the_lattice_has_as_it_is_given_is_not_coarse():
    pixels = [SQUARE / 10, SQUARE / 10 + [2.0**30, 0], SQUARE / 10 + [0, 2.0**30]]
    for engine in ENGINES:
        assert not said_by(engine, pixels)


def test_strict_refuses_what_the_lattice_is_coarse_for():
    given = [moved(SQUARE, 40, 0), SQUARE * [1.2, 1e-8]]
    for engine in (planar_graph, skeleton_exact):
        with pytest.raises(InputError) as caught:
            engine(given, strict=True)
        assert features_in(str(caught.value)) == [2]
