"""``vorotool tessellate``: every result in every format, on one input."""

import io
import json

import numpy as np

from support.oracles.oracles import nearest_labels, nearest_squares

X, Y = [2, 7, 1], [1, 5, 6]
LABELS = nearest_labels(X, Y, [1, 2, 3], (0, 0, 8, 7))


def test_table_has_the_columns_of_the_input(run, folder):
    done = run("tessellate dots.csv --columns x,y --what table")
    header, *rows = (line.split(",") for line in done.out.splitlines())
    assert header == [
        *["label", "x", "y", "area", "perimeter", "neighbors", "nearest_label", "nearest_distance", "touches_frame"],
        *["max_distance", "components", "bbox_x", "bbox_y", "bbox_w", "bbox_h", "name"],
    ]
    assert [row[-1] for row in rows] == ["a", "b", "c"]
    assert [int(row[3]) for row in rows] == [int((k == LABELS).sum()) for k in (1, 2, 3)]
    squares = nearest_squares(X, Y, (0, 0, 8, 7))
    for k, row in enumerate(rows, start=1):
        assert float(row[9]) == np.sqrt(squares[k == LABELS].max())
    assert "name" not in run("tessellate dots.csv --columns x,y --what table --no-properties").out


def test_components_of_a_mask(run, folder):
    rows = json.loads(run("tessellate mask.pbm --what table -f json").out)
    assert [row["object_area"] for row in rows] == [2, 2]
    assert [(row["x"], row["y"]) for row in rows] == [(0.5, 0), (5.5, 1.5)]
    assert len(json.loads(run("tessellate mask.pbm --what table -f json --connectivity 4").out)) == 3
    done = run("tessellate mask.pbm --seeds pixels -f text")
    assert int(np.loadtxt(io.StringIO(done.out), dtype=int).max()) == 4
    done = run("tessellate mask.pbm --seeds centroids --what table -f json")
    assert [row["object_area"] for row in json.loads(done.out)] == [2, 2]
    done = run("tessellate mask.pbm --invert --what table -f json")
    assert [row["object_area"] for row in json.loads(done.out)] == [28]


def test_several_results_are_named(run, folder):
    run("tessellate dots.csv --what labels,table,color -o result")
    assert {p.name for p in folder.glob("result*")} == {"result.labels.png", "result.table.csv", "result.color.png"}
    run("tessellate dots.csv --what labels,table -o other.tif")
    assert {p.name for p in folder.glob("other*")} == {"other.labels.tif", "other.table.csv"}
    (folder / "out").mkdir()
    run("tessellate dots.csv --out-dir out")
    assert (folder / "out" / "dots.png").exists()


def test_stats(run, folder):
    (folder / "twice.csv").write_text("x,y\n1,1\n1,1\n4.1,2\n")
    done = run("tessellate twice.csv -o a.png --stats -")
    stats = json.loads(done.out)
    assert (stats["seeds"], stats["duplicates"], stats["snapped"], stats["frame"]) == (3, 1, 1, [0, 0, 5, 3])
    assert stats["arithmetic"] == "filtered float64 with int128"
    assert {"read", "tessellate", "write labels"} <= set(stats["seconds"])
    assert len(stats["warnings"]) == 1  # of the seed at the same place; a move this small is none
    assert all(line.startswith("warning: ") for line in done.err.splitlines() if not line.startswith("note"))
    assert run("tessellate twice.csv -o a.png -q").err == ""


def test_stats_of_the_propagation_name_the_first_wrong_pixel(run, folder):
    (folder / "three.csv").write_text("x,y\n2,0\n1,2\n0,6\n")
    options = ("--size", "14x8", "--method", "propagation", "-o", "a.npy", "--stats", "s.json")
    run("tessellate three.csv", *options)
    stats = json.loads((folder / "s.json").read_text())
    assert stats["wrong_pixels"] == 1
    assert stats["first_wrong"] == {"x": 13, "y": 7, "label": 1, "exact_label": 2}
    run("tessellate three.csv", *options, "--verify", code=1)


def test_window_and_distance(run, folder):
    done = run("tessellate dots.csv --window -2,-1,9,5 --max-distance 2.5 -f text")
    right = nearest_labels(X, Y, [1, 2, 3], (-2, -1, 9, 5), most_squared=6.25)
    np.testing.assert_array_equal(np.loadtxt(io.StringIO(done.out), dtype=int), right)
