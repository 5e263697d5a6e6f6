"""Approximate skeletons: their checker on broken shapes, and their bounds beside the exact skeleton."""

import json
import warnings

import numpy as np
import pytest

import vorotool
from fuzz.features import FAMILIES, as_set, chosen, differing, inside_of
from fuzz.skeleton_bounds import TOLERANCES, Shape, check_steps, check_tolerances, random_shapes
from support.approximations import verify_approximate
from support.families.skeleton_shapes import regular
from support.few import few
from vorotool import _core
from vorotool.convert.polygons import as_polygons
from vorotool.engines.arrangement.planar_graph import planar_graph
from vorotool.engines.arrangement.repaired_polygons import placed_shapes
from vorotool.engines.features import batches as feature_sheets
from vorotool.engines.sampled_skeleton.approximate import SamplingOptions, Wanted, approximate_skeleton, sampled_graph
from vorotool.engines.sampled_skeleton.per_feature import approximation_of_sides, feature_approximation
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


@pytest.mark.parametrize("options", [{}, {"step": 1, "tolerance": 1}])
def test_wrong_options_are_refused(options):
    with pytest.raises(UsageError):
        vorotool.skeleton_approx(SHAPES["random 0"], **options)


# ---- Approximate skeletons inside features: each is what it would be if there were no others ----
ARRAYS = ("vertices", "radius", "arcs", "sites", "polygon", "side", "branch", "length", "error_bound")
OUTER = [[0, 0], [10, 0], [10, 10], [0, 10]]
INNER = [[3, 3], [7, 3], [7, 7], [3, 7]]
SETS = {
    "nested": [OUTER, INNER],
    "overlapping": [OUTER, [[5, 3], [15, 3], [15, 13], [5, 13]]],
    "touching": [OUTER, [[10, 2], [14, 2], [14, 8], [10, 8]]],
    "identical": [OUTER, OUTER],
    "nearer than samples": [OUTER, [[10.01, 0], [20, 0], [20, 10], [10.01, 10]]],
}
OPTIONS = (
    {"step": 0.8},
    {"step": 0.8, "sampling": "symmetric", "complete": True},
    {"tolerance": 0.05},
)


@pytest.mark.parametrize("options", OPTIONS, ids=str)
@pytest.mark.parametrize("name", SETS)
def test_features_are_what_they_are_alone(name, options):
    shapes = as_set([[[np.array(ring, dtype=float)]] for ring in SETS[name]])
    made = [vorotool.skeleton_approx(shapes, threads=threads, **options) for threads in (1, 2)]
    assert all(getattr(made[0], array).tobytes() == getattr(made[1], array).tobytes() for array in ARRAYS)
    for feature in range(2):
        given = chosen(shapes, [feature, 2])
        alone = vorotool.skeleton_approx(given, **options)
        assert differing(inside_of(made[0], feature, shapes), inside_of(alone, 0, given)) is None
        assert np.isin(made[0].polygon, np.flatnonzero(made[0].polygons.feature == feature)).any()


@pytest.mark.parametrize("family", few(FAMILIES, 5), ids=lambda family: family.__name__)
def test_features_of_any_family_are_what_they_are_alone_in_any_order(family, monkeypatch):
    rng = np.random.default_rng(3)
    monkeypatch.setattr(feature_sheets, "BATCH", 40)
    shapes = as_set(family(rng))
    count = int(shapes.feature.max())
    step = 0.02 * float(np.ptp(shapes.xy, axis=0).max())
    order = [*rng.permutation(count).tolist(), count]
    with warnings.catch_warnings(action="ignore"):
        made = vorotool.skeleton_approx(shapes, step=step)
        permuted = vorotool.skeleton_approx(chosen(shapes, order), step=step)
        for place, feature in enumerate(order[:-1][:8]):
            given = chosen(shapes, [feature, count])
            own = inside_of(made, feature, shapes)
            assert differing(own, inside_of(vorotool.skeleton_approx(given, step=step), 0, given)) is None
            assert differing(own, inside_of(permuted, place, chosen(shapes, order))) is None


@pytest.mark.parametrize("side", ["interior", "exterior", "both"])
@pytest.mark.parametrize("name", SETS)
def test_all_parts_pass_the_checker(name, side):
    shapes, options = as_polygons(SETS[name]), SamplingOptions(step=0.8)
    if side == "interior":
        found = feature_approximation(shapes, options, Wanted())
    else:
        found = approximation_of_sides(shapes, options, Wanted(side))
    for part in found.parts:
        verify_approximate(part, step=0.8)
    assert sorted(np.concatenate(found.arcs).tolist()) == list(range(len(found.skeleton)))
    assert found.skeleton.features == "separate"


def test_groups_that_do_not_go_with_the_points_are_refused():
    points = np.array([[0, 0], [4, 0], [0, 4]], dtype=np.int32)
    segments = np.array([[0, 1], [1, 2], [2, 0]], dtype=np.int32)
    faces = np.tile(np.array([1, 0], dtype=np.int32), (3, 1))
    graph = _core.kernel.PlanarGraph(points, segments, faces)
    made = _core.sampled_skeleton.sample_by_step(graph, 1.0, 100, 1, None)
    for group in ([0, 0], [0, 1, 0], [-1, -1, -1], [7, 7, 7]):
        with pytest.raises(ValueError, match="groups"):
            _core.sampled_skeleton.SampledDiagram(graph, *made, np.array(group, dtype=np.int32), None, 1, None)


def test_seeds_of_all_features_are_counted():
    shapes = as_polygons(SETS["nested"])
    count = feature_approximation(shapes, SamplingOptions(step=0.5), Wanted()).counts()["samples"]
    assert count == 80 + 32
    feature_approximation(shapes, SamplingOptions(step=0.5), Wanted(most=count))
    for options in (SamplingOptions(step=0.5), SamplingOptions(tolerance=0.001)):
        with pytest.raises(LimitError, match="more than 111"):
            feature_approximation(shapes, options, Wanted(most=count - 1))
