"""Fields with nothing or too little in them: what is written is empty, with a warning, and a batch goes on."""

import json

import numpy as np
import pytest

from support.readers.written import rows_of

ONE = "an alpha shape needs at least two distinct points, but got 1 point"
TWO = "two points span no triangle, so no radius gives a region that holds all points: give r itself (-r)"
LINE = "3 points on a line span no triangle, so no radius gives a region that holds all points: give r itself (-r)"
COLLECTION = {"type": "FeatureCollection", "y_axis": "down", "features": []}


@pytest.fixture
def fields(folder):
    """Masks of one object, of two, of three in a row, and of three that span a triangle; flat images."""
    mask = np.zeros((24, 30), np.uint8)
    for name, x, y in (("one", 4, 3), ("two", 12, 3), ("line", 20, 3)):
        mask[y : y + 3, x : x + 2] = 255
        np.save(folder / f"{name}.npy", mask)
    mask[15:18, 4:6] = 255
    np.save(folder / "many.npy", mask)
    for value in (0, 93, 255):
        np.save(folder / f"flat{value}.npy", np.full((8, 9), value, np.uint8))
    return folder


def test_a_batch_of_fields_with_few_objects_goes_on(run, fields):
    names = ["one.npy", "two.npy", "line.npy", "many.npy"]
    done = run("alphashape", *names, "--out-dir", "out", "-f", "geojson", "--table", "all.csv", "--verify")
    lines = done.err.splitlines()
    for name, reason in zip(names, (ONE, TWO, LINE), strict=False):
        assert any(line.startswith(f"warning: {name}: {reason}") for line in lines)
        assert json.loads((fields / "out" / name).with_suffix(".geojson").read_text()) == COLLECTION
    assert len(json.loads((fields / "out/many.geojson").read_text())["features"]) == 1
    assert [row["input"] for row in rows_of((fields / "all.csv").read_text())] == ["many.npy"]
    done = run("alphashape", *names, "--out-dir", "strict", "--strict", "--keep-going", code=6)
    for name, reason in zip(names, (ONE, TWO, LINE), strict=False):
        assert any(line.startswith(f"error: {name}: {reason}") for line in done.err.splitlines())


@pytest.mark.parametrize(
    ("options", "name", "reason"),
    [
        *(((), name, reason) for name, reason in (("one.npy", ONE), ("two.npy", TWO), ("line.npy", LINE))),
        *((("-f", fmt), "two.npy", TWO) for fmt in ("npz", "svg", "html")),
        (("--what", "hull"), "one.npy", ONE),
        (("--what", "polygons", "-f", "wkt"), "line.npy", LINE),
        (("--method", "digital-valid", "--seeds", "centroids"), "line.npy", LINE),
    ],
)
def test_every_output_of_an_empty_shape_is_written(run, fields, name, reason, options):
    fmt = () if "-f" in options else ("-f", "geojson" if "hull" in options else "csv")
    run(f"alphashape {name} --verify --stats stats.json -o shape", *options, *fmt, says=reason)
    stats = json.loads((fields / "stats.json").read_text())
    assert (stats["r"], stats["alpha"], stats["boundary_edges"], stats["singular_edges"]) == (None, None, 0, 0)
    assert (fields / "shape").stat().st_size > 0 or "wkt" in options  # which has nothing to say


@pytest.mark.parametrize(
    ("command", "value", "invert"),
    [
        *((("delaunay",), value, invert) for value, invert in ((0, ()), (93, ("--invert",)), (255, ()))),
        (("tessellate", "--what", "table"), 0, ()),
        (("tessellate", "-f", "text"), 93, ()),
        (("skeleton-exact", "--outline", "contour", "--what", "table"), 93, ("--invert",)),
        (("skeleton-approx", "--step", "1", "-f", "geojson"), 0, ()),
    ],
)
def test_a_flat_image_has_no_foreground_by_otsu(run, fields, command, value, invert):
    options = (f"flat{value}.npy", "--threshold", "otsu", *invert)
    done = run(*command, *options, "--verify", "--stats", "stats.json")
    note, warning = done.err.splitlines()
    assert (note.startswith("note: "), f"value {value}" in note) == (True, True)
    assert warning.startswith("warning: ")
    assert json.loads((fields / "stats.json").read_text())["threshold"] is None
    assert set(done.out.split()) == {"0"} or len(done.out.splitlines()) < 7
    done = run(*command, *options, "--strict", code=3)
    assert done.err.count("error: ") == 1
