"""``vorotool distance``: two inputs, every format, and what is said when it goes wrong."""

from pathlib import Path

import pytest

import vorotool
from support.families.geojson import collection

A = "LINESTRING (26 8, 13 -2, 13 19, 10 19, 10 23, 1 17)"
B = "LINESTRING (15 1, 28 11, 13 26, 1 18)"
HEADER = ["what", "distance", "x_a", "y_a", "x_b", "y_b"]


@pytest.fixture
def two(folder):
    (folder / "a.wkt").write_text(A)
    (folder / "b.wkt").write_text(B)
    return "a.wkt", "b.wkt"


def test_the_table_is_that_of_the_library(run, two):
    done = run("distance", *two, "--verify")
    assert done.err == ""
    far, near = vorotool.hausdorff([A], [B]), vorotool.distance([A], [B])
    assert [float(row["distance"]) for row in done.rows] == [
        *(each.distance for each in far.rows.values()),
        near.distance,
    ]
    assert [row["what"] for row in done.rows] == ["hausdorff", "a to b", "b to a", "smallest"]
    assert list(done.rows[0]) == HEADER
    assert (float(done.rows[1]["x_a"]), float(done.rows[1]["y_b"])) == (far.from_a.on_a[0], far.from_a.on_b[1])


def test_what_is_chosen(run, two):
    assert [row["what"] for row in run("distance", *two, "--what", "smallest").rows] == ["smallest"]
    assert len(run("distance", *two, "--what", "hausdorff").rows) == 3
    run("distance", *two, "--what", "hausdorff,smallest", "-o", "both.csv")
    assert len(Path("both.hausdorff.csv").read_text().splitlines()) == 4


def test_standard_input_is_one_of_them(run, two):
    expected = run("distance", *two).out
    for names, text in ((["-", "b.wkt"], A), (["a.wkt", "-"], B)):
        done = run("distance", *names, data=text.encode())
        assert done.out == expected


def test_two_systems(run, folder):
    for name, code in (("a", 2056), ("b", 3857)):
        point = {"type": "Point", "coordinates": [0, 0]}
        (folder / f"{name}.geojson").write_text(collection([point], crs=f"urn:ogc:def:crs:EPSG::{code}"))
    run("distance a.geojson b.geojson", code=3, says=["a.geojson", "--crs EPSG:2056"])
    (folder / "c.csv").write_text("x,y\n3,4\n")
    run("distance a.geojson c.csv", says="c.csv")
