"""One table of many inputs: of any result with rows, with columns of file names, and a row an input."""

import json

import imageio.v3 as imageio
import numpy as np
import pandas
import pytest

FIELDS = r"(?P<plate>P\d)/(?P<well>[A-H]\d\d)_(?P<label>\d+)"
PLACES = {"P1/A01_1": [(2, 2), (20, 30)], "P1/A02_1": [], "P2/B01_07": [(5, 5)], "P2/odd": [(5, 5), (20, 20), (30, 40)]}


@pytest.fixture
def plates(tmp_path):
    for name, places in PLACES.items():
        image = np.zeros((40, 60), np.uint8)
        for y, x in places:
            image[y : y + 6, x : x + 6] = 255
        path = tmp_path / "plates" / f"{name}.png"
        path.parent.mkdir(parents=True, exist_ok=True)
        imageio.imwrite(path, image)
    return tmp_path / "plates"


def read(path):
    if path.suffix == ".json":
        return pandas.DataFrame(json.loads(path.read_text()))
    return pandas.read_csv(path, sep="\t" if path.suffix == ".tsv" else ",", dtype=str)


@pytest.mark.parametrize(
    ("command", "what", "rows", "ending"),
    [
        ("tessellate", "neighbors", [1, 0, 0, 2], "csv"),
        ("delaunay", "statistics", [7, 7, 7, 7], "tsv"),
        ("skeleton-exact", "branches", [2, 0, 1, 3], "json"),
    ],
)
def test_rows_of_any_result_are_collected(run, plates, tmp_path, command, what, rows, ending):
    table, inputs = tmp_path / f"all.{ending}", tmp_path / f"inputs.{ending}"
    options = ("--table", table, "--table-inputs", inputs, "--fields", FIELDS, "-q")
    run(command, plates, "--what", what, *options)
    joined, found = read(table), read(inputs)
    sources = [f"{plates}/{name}.png" for name in sorted(PLACES)]
    assert found["input"].tolist() == sources
    assert list(map(int, found["count"])) == rows
    assert set(found["status"]) == {"done"}
    assert found["well"].fillna("").tolist() == ["A01", "A02", "B01", ""]
    own = next(name for name in ("voro_label", "label") if name in joined)
    counts = joined["input"].value_counts()
    assert [int(counts.get(source, 0)) for source in sources] == rows
    known = joined[joined["plate"] == "P2"]
    assert set(known[own]) <= {"07"} or ending == "json"
    assert set(joined["input"][joined["plate"].isna()]) <= {sources[-1]}


def test_results_beside_the_table(run, plates, tmp_path):
    options = ("--out-dir", tmp_path / "out", "--table", tmp_path / "all.csv", "-q")
    run(f"tessellate {plates} --what labels", *options)
    assert "area" in read(tmp_path / "all.csv")
    run(f"tessellate {plates} --what labels,neighbors", *options)
    assert "border_length" in read(tmp_path / "all.csv")
    assert (tmp_path / "out/P1/A01_1.neighbors.csv").exists()
    run(f"tessellate {plates} --what labels,neighbors", *options, "--resume", "--table-inputs", tmp_path / "i.csv")
    assert set(read(tmp_path / "i.csv")["status"]) == {"kept"}
    assert read(tmp_path / "i.csv")["count"].tolist() == ["1", "0", "0", "2"]


def test_inputs_that_fail_have_a_row(run, plates, tmp_path):
    (plates / "P1/torn.png").write_bytes((plates / "P1/A01_1.png").read_bytes()[:60])
    run(f"tessellate {plates} --table-inputs {tmp_path}/i.csv --keep-going -q", code=6)
    found = read(tmp_path / "i.csv").set_index("input").loc[f"{plates}/P1/torn.png"]
    assert found["status"] == "failed"
    assert pandas.isna(found["count"])
    assert "torn.png" in found["error"]
