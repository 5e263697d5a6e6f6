"""``vorotool distance``: two inputs, every format, and what is said when it goes wrong."""

import json
from pathlib import Path

import ezdxf
import numpy as np
import pytest
import tifffile
from PIL import Image

import vorotool
from support.documents import DATA
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


@pytest.mark.parametrize(("what", "lines"), [("distances", 4), ("hausdorff", 3), ("smallest", 1)])
def test_drawings_have_the_same_lines(run, two, what, lines):
    run("distance", *two, "--what", what, "-o", "a.dxf")
    assert len(ezdxf.readfile("a.dxf").modelspace()) == lines


def test_standard_input_is_one_of_them(run, two):
    expected = run("distance", *two).out
    for names, text in ((["-", "b.wkt"], A), (["a.wkt", "-"], B)):
        assert run("distance", *names, data=text.encode()).out == expected


def test_two_systems(run, folder):
    for name, code in (("a", 2056), ("b", 3857)):
        point = {"type": "Point", "coordinates": [0, 0]}
        (folder / f"{name}.geojson").write_text(collection([point], crs=f"urn:ogc:def:crs:EPSG::{code}"))
    done = run("distance a.geojson b.geojson", code=3, says=["a.geojson", "--crs EPSG:2056"])
    assert done.err.count("a.geojson") == 1
    (folder / "c.csv").write_text("x,y\n3,4\n")
    run("distance a.geojson c.csv", says="c.csv")


# ---- thickness ----------------------------------------
BLOBS = DATA / "blobs.png"


@pytest.fixture(scope="module")
def expected():
    return vorotool.local_thickness(np.asarray(Image.open(BLOBS)))


def thickness(run, *arguments):
    assert run(f"skeleton-exact {BLOBS} --what thickness", *arguments).err == ""


def test_files_hold_floats(run, folder, expected):
    thickness(run, "-o", "a.tif", "--verify")
    made = tifffile.imread(folder / "a.tif")
    assert np.array_equal(made, expected.astype(np.float32))


def test_values_are_in_the_unit_and_summarized(run, folder, expected):
    thickness(run, "-o", "a.npy", "--pixel-size", "0.5um", "--stats", "s.json")
    np.testing.assert_allclose(np.load(folder / "a.npy"), expected / 2, rtol=1e-7)
    found, inner = json.loads((folder / "s.json").read_text()), expected[expected > 0] / 2
    summary = [found[f"thickness_{name}"] for name in ("mean", "sd", "largest")]
    np.testing.assert_allclose(summary, [inner.mean(), inner.std(), inner.max()], rtol=1e-12)
    assert (found["pixels"], found["unit"]) == (len(inner), "um")


def test_maps_keep_their_place(run, folder, expected):
    scale, tie = (33550, "d", 3, (2.0, 2.0, 0.0)), (33922, "d", 6, (0.0, 0.0, 0.0, 500.0, 900.0, 0.0))
    tifffile.imwrite(folder / "map.tif", np.asarray(Image.open(BLOBS)), extratags=[scale, tie], metadata=None)
    run("skeleton-exact map.tif --what thickness -o a.tif --verify")
    with tifffile.TiffFile(folder / "a.tif") as made:
        assert made.pages[0].tags[33550].value[:2] == (2.0, 2.0)
        np.testing.assert_allclose(made.asarray(), 2 * expected, rtol=1e-6)


def test_a_picture_has_a_color_for_each_thickness(run, folder, expected):
    thickness(run, "-o", "a.png")
    made = np.asarray(Image.open(folder / "a.png").convert("RGB")).astype(int)
    assert made.shape[:2] == expected.shape
    assert (made[expected == 0] == 255).all()
    assert made[expected == expected.max()][0].tolist() == [253, 231, 37]
    light = made[expected > 0].sum(axis=1)
    assert (np.diff(light[np.argsort(expected[expected > 0], kind="stable")]) >= -12).all()


def test_an_image_without_foreground(run, folder):
    Image.fromarray(np.zeros((4, 5), np.uint8)).save(folder / "none.png")
    for name in ("a.npy", "a.png"):
        run(f"skeleton-exact none.png --what thickness -o {name} --verify --stats s.json", says="warning")
    assert not np.load(folder / "a.npy").any()


def test_a_photograph_is_outlined_first(run, tmp_path):
    """Only what other commands have makes a mask of it, and what is advised is accepted."""
    gray = np.random.default_rng(1).integers(0, 99, (60, 50), dtype=np.uint8)
    gray[20:40, 10:30] += 150
    Image.fromarray(gray).save(tmp_path / "a.png")
    Image.fromarray((gray > 120).astype(np.uint8)).save(tmp_path / "mask.png")
    done = run(
        "distance a.png mask.png", code=3, says="like a photograph: write its outlines first, such as with vorotool"
    )
    assert "use --threshold" not in done.err
    advised = done.err.partition("vorotool ")[2].strip()
    run(f"{advised} -q")
    assert run("distance outlines.geojson mask.png -q").rows[0]["distance"] == "0"
