"""Approximate skeletons: their checker on broken shapes, and their bounds beside the exact skeleton."""

import json

import numpy as np
import pytest

import vorotool
from fuzz.skeleton_bounds import TOLERANCES, Shape, check_steps, check_tolerances, random_shapes
from support.approximations import verify_approximate
from support.families.skeleton_shapes import regular
from support.few import few
from support.readers.written import assert_same
from vorotool.engines.arrangement.planar_graph import planar_graph
from vorotool.engines.arrangement.repaired_polygons import placed_shapes
from vorotool.engines.sampled_skeleton.approximate import SamplingOptions, approximate_skeleton, sampled_graph
from vorotool.engines.skeleton.verify_bounds import distances_to, places_on_arcs
from vorotool.errors import LimitError, UsageError

SHAPES = random_shapes(np.random.default_rng(1))


@pytest.mark.parametrize("name", few(["random 0", "random 1", "holes 0"], 1))
def test_bounds_hold_and_tolerances_are_met(name):
    shape = Shape(name, SHAPES[name])
    violations, ratio, orders = check_steps(shape, 8)
    assert violations == 0
    assert np.median(ratio) <= 3
    assert 1.5 <= np.median(orders) <= 2.5
    assert check_tolerances(shape, TOLERANCES[:3]) == 0


def test_bounds_hold_and_are_small_where_shapes_are_round():
    shape = Shape("round", regular(150))
    skeleton = shape.sampled(10.0).skeleton
    spots = places_on_arcs(skeleton, np.linspace(0, 1, 5)).reshape(-1, 2)
    true = distances_to(shape.exact, spots).reshape(len(skeleton), 5)
    assert (true <= skeleton.error_bound[:, None]).all()
    assert skeleton.error_bound.max() < 1


# three edges from one corner, at angles of 1e-8
FAN = [
    {"line": [[0, 0], [311204261, 487696144]]},
    {"shell": [[0, 0], [311204254, 487696143], [-12, 14]]},
    {"shell": [[0, 0], [20, 0], [311204261, 487696142]]},
]


@pytest.fixture
def fan(tmp_path):
    path = tmp_path / "fan.json"
    path.write_text(json.dumps({"polygons": FAN}))
    return vorotool.read(path)


def test_tolerances_where_edges_are_too_near_to_each_other_end_with_a_limit(fan):
    with pytest.raises(LimitError, match=r"could not be bounded.*use a step"):
        vorotool.skeleton_approx(fan, tolerance=3830685.32494347, features="together")


@pytest.mark.parametrize("sampling", ["paper", "symmetric"])
def test_steps_are_kept_where_edges_are_too_near_to_each_other(fan, sampling):
    graph = planar_graph(fan)
    shapes = sampled_graph(graph, placed_shapes(graph), SamplingOptions(1e6, None, sampling))
    verify_approximate(approximate_skeleton(shapes), step=1e6)


FAR_APART = [[[x, 0], [x + 0.5, 0], [x, 0.5]] for x in (0, 2**29)]  # on a lattice of steps of 1/2
FINEST = 2**-17


@pytest.mark.parametrize("sampling", ["paper", "symmetric"])
@pytest.mark.parametrize("features", ["separate", "together"])
def test_steps_below_the_spacing_of_samples_are_refused(sampling, features):
    with pytest.raises(LimitError, match=f"use at least {FINEST!r}"):
        vorotool.skeleton_approx(FAR_APART, step=FINEST * 0.99, sampling=sampling, features=features)


def test_results_do_not_depend_on_threads():
    one, two = (vorotool.skeleton_approx(SHAPES["holes 1"], step=7.0, threads=threads) for threads in (1, 2))
    assert_same(("vertices", "radius", "arcs", "sites", "error_bound"), one, two)


@pytest.mark.parametrize("options", [{}, {"step": 0}, {"step": -1.0}, {"tolerance": 0.0}, {"step": 1, "tolerance": 1}])
def test_wrong_options_are_refused(options):
    with pytest.raises(UsageError):
        vorotool.skeleton_approx(SHAPES["random 0"], **options)
