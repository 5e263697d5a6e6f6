"""Centerlines on the command line: ends in the middle, in corners or at forks."""

import json

import pytest

RECTANGLE = "POLYGON((0 0,10 0,10 4,0 4,0 0))"


@pytest.fixture
def rectangle(folder):
    (folder / "rectangle.wkt").write_text(RECTANGLE)
    return "rectangle.wkt"


@pytest.mark.parametrize(
    ("options", "line"),
    [
        ([], "0 2, 10 2"),
        (["--prune", "none"], "0 2, 10 2"),
        (["--prune", "scale=1.3"], "0 2, 10 2"),
        (["--prune", "scale=1.42"], "0 2, 10 2"),
        (["--from", "0,2", "--to", "10,2"], "0 2, 10 2"),
        (["--to", "0,2", "--from", "10,2"], "10 2, 0 2"),
        (["--ends", "middle"], "0 2, 10 2"),
        (["--ends", "corner"], "0 0, 2 2, 8 2, 10 0"),
        (["--ends", "none"], "2 2, 8 2"),
    ],
)
def test_a_rectangle(run, rectangle, options, line):
    done = run(f"skeleton-exact {rectangle} --what centerline -f wkt", *options)
    assert (done.out, done.err) == (f"LINESTRING ({line})\n", "")


def test_lengths_and_widths_follow(run, rectangle):
    for options, expected in (([], ("10", "4")), (["--ends", "none"], ("6", "4"))):
        done = run(f"skeleton-exact {rectangle} --what table", *options)
        (row,) = done.rows
        assert (row["centerline_length"], row["centerline_width_mean"]) == expected
    done = run(f"skeleton-exact {rectangle} --what centerline -f geojson")
    properties = json.loads(done.out)["features"][0]["properties"]
    assert (properties["length"], properties["width_mean"], properties["width_min"]) == (10, 4, 4)
