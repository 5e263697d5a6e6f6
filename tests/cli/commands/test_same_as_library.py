"""A command computes what the library computes, by the same engine: there is one policy for both."""

import json
import warnings
from functools import partial
from pathlib import Path

import numpy as np
import pytest

import vorotool
from vorotool.engines.sampled_skeleton import per_feature
from vorotool.engines.skeleton import diagrams

DATA = Path(__file__).parents[3] / "data"
SHAPES = {
    "type": "GeometryCollection",
    "geometries": [
        {
            "type": "Polygon",
            "coordinates": [[[0, 0], [40, 0], [40, 30], [0, 30]], [[8, 8], [8, 20], [22, 20], [22, 8]]],
        },
        {"type": "Polygon", "coordinates": [[[30, 10], [60, 10], [60, 25], [30, 25]]]},
        {"type": "Polygon", "coordinates": [[[10, 10], [20, 10], [20, 18], [10, 18]]]},
        {"type": "LineString", "coordinates": [[45, -5], [55, 32]]},
    ],
}
"""One lies over another, one in a hole, and a line goes through one."""


@pytest.fixture
def shapes(folder):
    (folder / "shapes.geojson").write_text(json.dumps(SHAPES))
    with warnings.catch_warnings(action="ignore"):  # of overlaps, once they are taken together
        yield vorotool.read(folder / "shapes.geojson")


def written(value, folder, **options):
    vorotool.write(value, folder / "library.json", **options)
    return (folder / "library.json").read_bytes()


SIDES = ["interior", "exterior", "both"]


EXACT = (
    *("feature_skeleton", "feature_elements", "graph_for_skeletons", "together", "diagram_of_graph"),
    *("elements_of_graph", "skeleton_of", "sides_of"),
)
APPROXIMATE = (
    *("feature_approximation", "approximation_of_sides", "graph_for_skeletons", "together", "skeleton_within"),
    *("sampled_graph", "approximate_skeleton"),
)


def calls_of(monkeypatch, module, names):
    """What is called of the engines, and whether vertices outside are left out."""
    made = []

    def spied(name, own, *arguments, **options):
        made.append((name, options.get("interior_only"), options.get("look") is None))
        return own(*arguments, **options)

    for name in names:
        monkeypatch.setattr(module, name, partial(spied, name, getattr(module, name)))
    return made


@pytest.mark.parametrize("features", ["separate", "together"])
@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("gap", [0.0, 1.0])
@pytest.mark.parametrize("more", [(), ("--verify",), ("--stats", "s.json")])
def test_exact_skeletons_are_the_same_by_the_same_engines(run, folder, shapes, monkeypatch, side, features, gap, more):
    calls = calls_of(monkeypatch, diagrams, EXACT)
    chosen = ("--side", side, "--features", features, "--gap", gap, *more)
    done = run("skeleton-exact", "shapes.geojson", *chosen, "-o", "command.json")
    assert done.code == 0, done.err
    of_command = calls[:]
    calls.clear()
    made = vorotool.skeleton_exact(shapes, side=side, features=features, gap=gap)
    assert (folder / "command.json").read_bytes() == written(made, folder)
    assert more or calls == of_command != []


@pytest.mark.parametrize("features", ["separate", "together"])
@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("fineness", [{"step": 3}, {"tolerance": 1}])
def test_approximate_skeletons_are_the_same_by_the_same_engines(
    run, folder, shapes, monkeypatch, side, features, fineness
):
    calls = calls_of(monkeypatch, per_feature, APPROXIMATE)
    ((name, value),) = fineness.items()
    chosen = ("--side", side, "--features", features, f"--{name}", value)
    assert run("skeleton-approx", "shapes.geojson", *chosen, "-o", "command.json").code == 0
    of_command = calls[:]
    calls.clear()
    made = vorotool.skeleton_approx(shapes, side=side, features=features, **fineness)
    assert (folder / "command.json").read_bytes() == written(made, folder)
    assert calls == of_command != []


@pytest.mark.parametrize("method", ["exact", "propagation"])
def test_tessellations(run, folder, method):
    (folder / "twice.csv").write_text("2,1\n7,5\n2,1\n1,6\n")
    done = run("tessellate", "twice.csv", "--size", "12x9", "--method", method, "-o", "command.npy")
    assert (done.code, done.err.count("warning")) == (0, 1)
    with pytest.warns(vorotool.VorotoolWarning) as told:
        made = vorotool.tessellate(vorotool.read(folder / "twice.csv"), shape=(9, 12), method=method)
    assert f"warning: {told[0].message}" in done.err
    np.testing.assert_array_equal(np.load(folder / "command.npy"), made.labels)
    assert run("tessellate", "twice.csv", "--method", method, "--strict", "-o", "strict.npy").code == 3


@pytest.mark.parametrize("features", ["separate", "together"])
def test_offsets(run, folder, shapes, features):
    chosen = ("--what", "offset", "-d", "3,-1", "--features", features)
    assert run("skeleton-exact", "shapes.geojson", *chosen, "-o", "command.json").code == 0
    made = vorotool.offset(shapes, [3, -1], features=features)
    assert (folder / "command.json").read_bytes() == written(made, folder)


@pytest.mark.parametrize("method", ["exact", "digital", "digital-valid"])
def test_triangulations_and_alpha_shapes(run, folder, method):
    points = vorotool.read(DATA / "dots.csv")
    mesh = {
        "exact": vorotool.delaunay,
        "digital": vorotool.digital_triangulation,
        "digital-valid": lambda points: vorotool.repair_digital(points)[0],
    }[method](points)
    assert run("delaunay", DATA / "dots.csv", "--method", method, "-o", "command.json").code == 0
    assert (folder / "command.json").read_bytes() == written(mesh, folder)
    if method != "digital":
        assert run("alphashape", DATA / "dots.csv", "--method", method, "-r", 60, "-o", "command.json").code == 0
        made = vorotool.alpha_shape(vorotool.alpha_complex(mesh), r=60)
        assert (folder / "command.json").read_bytes() == written(made, folder)
