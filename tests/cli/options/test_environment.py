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
