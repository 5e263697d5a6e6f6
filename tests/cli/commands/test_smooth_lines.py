"""`--ends middle` of skeletons, and `--smooth`: every format, units, and what does not go together."""

import json
import re

import ezdxf
import numpy as np
import pytest

ELL = "[[[0,0],[60,0],[60,40],[50,40],[50,10],[0,10]]]"


@pytest.fixture
def ell(tmp_path):
    path = tmp_path / "ell.json"
    path.write_text(ELL)
    return str(path)


def test_skeletons_are_led_on_to_ends(run, ell):
    pruned = ("skeleton-exact", ell, "--prune", "scale=1.5", "-f")
    led_on = run(*pruned, "wkt", "--ends", "middle", "--flatten", "9", "--verify").out
    assert led_on.startswith("LINESTRING (55 40, 55 10,")
    assert led_on.endswith(" 50 5, 0 5)\n")
    as_is = run(*pruned, "wkt", "--flatten", "9").out
    for ends in ("corner", "none"):
        assert run(*pruned, "wkt", "--ends", ends, "--flatten", "9").out == as_is
    assert [row["kind"] for row in run(*pruned, "csv", "--ends", "middle").rows][:2] == ["extension", "line"]
    (feature,) = json.loads(run(*pruned, "geojson", "--ends", "middle").out)["features"]
    assert feature["properties"]["width_max"] > feature["properties"]["width_min"] == 10


@pytest.mark.parametrize("what", [("--what", "centerline"), ("--prune", "scale=1.5", "--ends", "middle")])
def test_smooth_lines_in_every_format(run, ell, tmp_path, what):
    command = ("skeleton-exact", ell, *what, "--smooth", "0.5", "--verify")
    rows = run(*command, "-f", "csv").rows
    assert all(float(row["error"]) <= 0.5 for row in rows)
    assert list(rows[0])[:4] == ["label", "id", "branch", "curve"]
    assert len(json.loads(run(*command, "-f", "json").out)) == len(rows)
    features = json.loads(run(*command, "-f", "geojson").out)["features"]
    assert sum(feature["properties"]["curves"] for feature in features) == len(rows)
    assert len(run(*command, "-f", "wkt").out.splitlines()) == len(features)
    picture = run(*command, "-f", "svg").out
    assert picture.count("C") >= len(features)
    assert "Q" not in picture
    for fmt in ("png", "npz", "dxf"):
        width = ("--width", 90) if fmt == "png" else ()
        run(*command, "-o", str(tmp_path / f"lines.{fmt}"), *width)
    splines = ezdxf.readfile(tmp_path / "lines.dxf").modelspace().query("SPLINE")
    assert len(splines) == len(features)
    assert {spline.dxf.degree for spline in splines} == {3}


def test_svg_has_the_curves_of_the_table(run, ell):
    command = ("skeleton-exact", ell, "--what", "centerline", "--smooth", "0.5")
    rows, picture = run(*command, "-f", "csv").rows, run(*command, "-f", "svg").out
    path = re.search(r'id="centerline".*? d="([^"]*)"', picture, re.DOTALL)[1]
    numbers = np.array(re.findall(r"[-0-9.]+", path), dtype=float).reshape(-1, 2)
    names = [(f"x{k}", f"y{k}") for k in range(4)]
    table = np.array([[[float(row[x]), float(row[y])] for x, y in names] for row in rows])
    table = np.concatenate([table[0, :1], *table[:, 1:]])
    scale = np.ptp(numbers, axis=0) / np.ptp(table, axis=0)
    np.testing.assert_allclose((numbers - numbers[0]) / scale, table - table[0], atol=0.01)
