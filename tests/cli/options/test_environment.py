"""Options that the environment sets: none changes a result, and a bad value names its variable."""

import json

import pytest

POINTS = "x,y\n2,1\n7,5\n1,6\n4,3\n"


@pytest.fixture
def points(tmp_path):
    (tmp_path / "p.csv").write_text(POINTS)
    (tmp_path / "q.csv").write_text(POINTS)


@pytest.mark.parametrize(
    ("name", "value"),
    [("THREADS", "-1"), ("JOBS", "many"), ("MAX_PIXELS", "1e9999"), ("QUIET", "x")],
)
def test_a_bad_value_names_the_variable(run, points, monkeypatch, name, value):
    monkeypatch.setenv(f"VOROTOOL_{name}", value)
    run("delaunay p.csv", code=2, says=[f"VOROTOOL_{name}", value])


def test_values_are_taken_and_what_is_typed_holds(run, points, monkeypatch):
    monkeypatch.setenv("VOROTOOL_MAX_SITES", "3")
    run("delaunay p.csv", code=5)
    run("delaunay p.csv --max-sites 4")
    monkeypatch.setenv("VOROTOOL_MAX_SITES", "")
    run("delaunay p.csv")
    monkeypatch.setenv("VOROTOOL_THREADS", "1")
    run("tessellate p.csv -o l.tif --stats s.json")


def test_quiet(run, points, tmp_path, monkeypatch):
    (tmp_path / "none.csv").write_text("x,y\n")
    assert run("delaunay none.csv").err
    monkeypatch.setenv("VOROTOOL_QUIET", "1")
    assert run("delaunay none.csv").err == ""
    monkeypatch.setenv("VOROTOOL_QUIET", "no")
    assert run("delaunay none.csv").err


def test_jobs_of_many_and_a_cluster_that_is_not_asked_where_jobs_are_typed(run, points, tmp_path, monkeypatch):
    monkeypatch.setenv("VOROTOOL_JOBS", "2")
    run("delaunay p.csv q.csv --out-dir out -q")
    monkeypatch.setenv("VOROTOOL_CLUSTER", "tcp://127.0.0.1:1")
    run("delaunay p.csv q.csv --out-dir two -q -j 1 --stats s.json")
    assert json.loads((tmp_path / "s.json").read_text())["done"] == 2


# ---- options that are given again ----------------------------------------
SQUARE = "[[[0, 0], [9, 0], [9, 9], [0, 9]]]"


def test_results_and_layers_accumulate(run, tmp_path):
    (tmp_path / "p.csv").write_text("x,y\n2,1\n7,5\n1,6\n")
    run("delaunay p.csv --what edges,triangles --what table --what edges -o o")
    assert sorted(path.name for path in tmp_path.glob("o.*")) == ["o.edges.csv", "o.table.csv", "o.triangles.csv"]
    once = run("delaunay p.csv -f svg --layers points,edges,labels").out
    assert run("delaunay p.csv -f svg", *("--layers", "points", "--layers", "edges,labels")).out == once
    run("alphashape p.csv --what hull --what polygons -f geojson -o a")
    assert sorted(path.name for path in tmp_path.glob("a.*")) == ["a.hull.geojson", "a.polygons.geojson"]


def test_distances_accumulate(run, tmp_path):
    (tmp_path / "s.json").write_text(SQUARE)
    several = run("skeleton-exact s.json --what offset -d -1,2,-3")
    assert run("skeleton-exact s.json --what offset -d -1 -d 2,-3 -d -1").out == several.out
    assert json.loads(several.out) != json.loads(run("skeleton-exact s.json --what offset -d -1").out)


def test_the_last_of_others_holds(run, tmp_path):
    (tmp_path / "p.csv").write_text("x,y\n2,1\n7,5\n1,6\n")
    last = run("alphashape p.csv -r 9 --precision 4").out
    assert run("alphashape p.csv -r 1 -r 9 --precision 2 --precision 4").out == last


@pytest.mark.parametrize(
    ("arguments", "shown", "not_shown"),
    [
        ("skeleton-exact s.json --offset 1", "-d", "--aspect"),
        ("skeleton-exact s.json -d -1 -2", "-1,-2", "No such"),
        ("skeleton-exact s.json -d 1 -.5", "-.5", "No such"),
        ("skeleton-exact s.json --flaten 1", "--flatten", "--gap"),
        ("draw s.json -f dxf", "dxf", "--what"),
    ],
)
def test_advice_fits_what_was_typed(run, tmp_path, arguments, shown, not_shown):
    (tmp_path / "s.json").write_text(SQUARE)
    done = run(arguments, code=2, says=shown)
    assert not_shown not in done.err
