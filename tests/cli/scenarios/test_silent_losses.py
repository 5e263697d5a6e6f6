"""Sites that a result shows nothing of are named once, on standard error and in the statistics."""

import json
from pathlib import Path

import pytest

TWELVE = "x,y\n" + "".join(f"{k},1\n" for k in range(100, 112))


@pytest.fixture
def inputs(tmp_path):
    (tmp_path / "four.csv").write_text("x,y\n1,1\n5,5\n1,1\n200,3\n")
    (tmp_path / "many.csv").write_text(TWELVE + "1,1\n2,4\n")
    (tmp_path / "space.csv").write_text("x,y,z\n1,1,4\n5,5,2\n1,2,3\n")
    clip = {"type": "Polygon", "coordinates": [[[0, 0], [9, 0], [9, 9], [0, 0]]]}
    (tmp_path / "clip.geojson").write_text(json.dumps(clip))
    (tmp_path / "swallowed.wkt").write_text("POLYGON ((0 0, 9 0, 9 9, 0 0))\nPOINT (6 2)\nPOINT (20 1)\n")


def told(run, *arguments):
    """What is said, and the statistics."""
    done = run(*arguments, "--stats", "stats.json")
    return done.err.splitlines(), json.loads(Path("stats.json").read_text())


@pytest.mark.usefixtures("inputs")
def test_empty_cells_are_named(run):
    lines, stats = told(run, "delaunay", "four.csv", "--what", "cells,table", "--frame", "0,0,9,9", "--out-dir", "o")
    assert lines.count("note: 2 of 4 cells are empty: those of sites 3, 4") == 1
    assert (stats["empty_cells"], stats["empty_sites"]) == (2, [3, 4])
    lines, stats = told(run, "delaunay", "many.csv", "--what", "cells", "--clip", "clip.geojson", "-o", "a.geojson")
    assert lines == ["note: 12 of 14 cells are empty: those of sites 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, …"]
    lines, stats = told(run, "voronoi", "swallowed.wkt", "-o", "a.geojson")
    assert "note: 1 of 3 cells is empty: that of site 2" in lines
    assert (stats["empty_cells"], stats["empty_sites"]) == (1, [2])
    assert "empty" not in run("delaunay four.csv -o a.csv").err


@pytest.mark.usefixtures("inputs")
def test_seeds_outside_the_frame_are_named(run):
    lines, stats = told(run, "tessellate", "four.csv", "--size", "9x9", "-o", "a.png")
    assert "note: 1 of 4 seeds is outside the frame: site 4" in lines
    assert stats["outside"] == 1
    lines, _ = told(run, "tessellate", "many.csv", "--window", "90,0,30,9", "-o", "a.png")
    assert lines == ["note: 2 of 14 seeds are outside the frame: sites 13, 14"]
    assert "outside" not in run("tessellate many.csv -o a.png").err
    lines, _ = told(run, "tessellate", "many.csv", "--window", "5000,0,30,9", "-o", "a.png")
    assert any(line.startswith("warning: no seed is in the frame") and "--window" in line for line in lines)


@pytest.mark.usefixtures("inputs")
@pytest.mark.parametrize(("options", "is_told"), [((), True), (("--columns", "x,y"), False)])
def test_a_column_z_is_no_coordinate(run, options, is_told):
    said = run("delaunay space.csv", *options, "-o", "a.csv").err
    assert ("space.csv: the column z is ignored: only x and y are used" in said) == is_told
    if not options:  # of a volume it is one
        assert "column z" not in run("tessellate --volume space.csv --size 9x9x9 -o a.tif").err
