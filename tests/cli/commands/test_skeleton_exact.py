"""``vorotool skeleton-exact``: every result, every kind of input, and what is said when something is wrong."""

import json
from pathlib import Path

import pytest

from support.readers.written import rows_of

DATA = Path(__file__).parents[3] / "data"
SHAPES = DATA / "two-shapes.json"


def test_repairs_are_told(run, folder):
    (folder / "a.json").write_text("[[0, 0], [4, 4], [4, 0], [0, 4]]")
    done = run("skeleton-exact a.json --stats s.json -o b.csv")
    assert done.err.startswith("warning: repaired: 1 crossing")
    stats = json.loads((folder / "s.json").read_text())
    assert stats["repairs"]["crossings"] == 1
    assert len(stats["warnings"]) == 1
    run("skeleton-exact a.json --strict", code=3, says="polygon 1")


def test_the_polygons_of_a_skeleton_are_read_again(run):
    run(f"skeleton-exact {SHAPES} -o a.json")
    again = run("skeleton-exact a.json --what table", says="a.json")
    assert again.out == run(f"skeleton-exact {SHAPES} --what table").out


@pytest.mark.parametrize("command", [["skeleton-exact"], ["skeleton-approx", "--step", "1", "--compare"]])
def test_the_inside_of_lines_is_missed_once_and_where_it_is_asked_for(run, folder, command):
    (folder / "a.wkt").write_text("LINESTRING (0 0, 9 0, 9 9)")
    done = run(*command, "a.wkt", "-o", "a.json")
    [warning] = [line for line in done.err.splitlines() if line.startswith("warning")]
    assert "--side" in warning
    done = run(*command, "a.wkt", "--side", "both", "-o", "a.json")
    assert "warning" not in done.err


def test_features_are_separate_unless_they_are_together(run, folder):
    nested = {
        "polygons": [{"shell": square} for square in ([[0, 0], [9, 0], [9, 9], [0, 9]], [[3, 3], [6, 3], [6, 6]])]
    }
    (folder / "nested.json").write_text(json.dumps(nested))
    arguments = ("skeleton-exact", "nested.json", "--what", "table", "--strict", "--verify")
    rows = [run(*arguments, *more).rows for more in ((), ("--features", "together"))]
    assert [[row["ends"] for row in table] for table in rows] == [["4", "3"], ["7", "0"]]
    drawn = run("skeleton-exact nested.json -f svg --layers polygons").out
    assert drawn.count("<path") == 2
    drawings = {
        run("skeleton-exact nested.json --gap 0.1", *more, "-f", "csv", "--verify").out
        for more in ((), ("--features", "separate"), ("--features", "together"))
    }
    assert sorted({row["label"] for row in rows_of(drawing)} for drawing in drawings) == [{"1"}, {"1", "2"}]


def test_the_deviation_of_a_gap_is_the_largest_of_the_features(run, folder):
    shape = [[0, 0], [8, 0], [8, 3], [4, 1], [0, 3]]
    shapes = [shape, [[2 * x + 1, 2 * y + 1] for x, y in shape]]
    deviations = []
    for chosen in (shapes[:1], shapes[1:], shapes):
        (folder / "a.json").write_text(json.dumps({"polygons": [{"shell": shell} for shell in chosen]}))
        for side in ("interior", "both"):
            done = run(f"skeleton-exact a.json --gap 0.2 --side {side} -o a.csv --stats -")
            deviations.append(json.loads(done.out)["gap_deviation"])
    assert deviations[4] == pytest.approx(max(deviations[0], deviations[2]))
    assert deviations[5] >= deviations[4] > min(deviations[0], deviations[2]) > 0


def test_a_ring_in_the_first_one_of_a_list_is_noted(run, folder):
    (folder / "rings.json").write_text("[[[0, 0], [9, 0], [9, 9], [0, 9]], [[3, 3], [6, 3], [6, 6]]]")
    run("skeleton-exact rings.json --what table", says=["ring 2", '"holes"'])


CURVES = {
    "a.svg": '<svg xmlns="http://www.w3.org/2000/svg"><path d="M1 1H6A2 2 0 0 1 6 5H1Z"/></svg>',
    "a.wkt": "CURVEPOLYGON (COMPOUNDCURVE ((1 1, 6 1), CIRCULARSTRING (6 1, 8 3, 6 5), (6 5, 1 5, 1 1)))",
}


@pytest.mark.parametrize("name", CURVES)
def test_pruning_is_named_where_curves_are_flattened(run, folder, name):
    (folder / name).write_text(CURVES[name])
    done = run(f"skeleton-exact {name} --what branches", says=f"{name}: 1 curve")
    advice = "--prune angle=20"
    assert advice in done.err
    pruned = run(f"skeleton-exact {name} --what branches {advice}")
    assert len(pruned.rows) < 10 < len(done.rows)
    for more in (advice.split(), ("--what", "discs"), ("--prune", "none")):
        assert advice not in run(f"skeleton-exact {name}", *more).err
