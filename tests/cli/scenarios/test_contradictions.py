"""Sizes that contradict the file, sides in another order, and what OME-TIFFs state: said, and refused with --strict."""

import json

import numpy as np
import pytest
import tifffile

import vorotool
from support.families.rasters import MASK, write_sized


@pytest.mark.parametrize(
    ("sides", "options", "words"),
    [
        ((0.325, 0.325), "--pixel-size 0.325mm", "0.325mm contradicts in.tif, which has pixels of 0.325 µm"),
        ((0.325, 0.5), "--pixel-size 0.325um", "which has pixels of 0.325 x 0.5 µm"),
        ((0.25, 0.5), "--spacing 0.5,0.25um", "not in the order SX,SY"),
        ((0.25, 0.5), "--spacing 250,500nm", ""),
        ((0.325, 0.325), "--pixel-size 0.325um", ""),
        ((0.325, 0.325), "--pixel-size 325.1nm", ""),
    ],
)  # fmt: skip
@pytest.mark.parametrize("command", ["tessellate --what table", "skeleton-exact --what table"])
def test_images(run, tmp_path, sides, options, words, command):
    write_sized(tmp_path / "in.tif", sides=sides)
    call = [*command.split(), "in.tif", *options.split(), "-f", "csv"]
    done = run(*call, "--stats", "s.json")
    assert ("contradicts" in done.err) == bool(words)
    assert words in done.err
    assert len(json.loads((tmp_path / "s.json").read_text())["warnings"]) == bool(words)
    run(*call, "--strict", code=3 if words else 0, says=words)


def test_volumes(run, tmp_path):
    write_sized(tmp_path / "in.tif", sides=(0.5, 0.5, 2), values=np.stack([MASK] * 3))
    call = ["tessellate", "in.tif", "--volume", "--what", "table", "-f", "csv"]
    run(*call, "--spacing", "2,0.5,0.5um", says="the order SX,SY,SZ")
    run(*call, "--spacing", "2,0.5,0.5um", "--strict", code=3)
    assert "contradicts" not in run(*call, "--spacing", "0.5,0.5,2um").err
    assert "contradicts" not in run(*call, "--spacing", "auto").err


def test_vectors(run, tmp_path):
    page = '<svg xmlns="http://www.w3.org/2000/svg" width="9mm" height="9mm"><path d="M1 1h9v20z"/></svg>'
    (tmp_path / "in.svg").write_text(page)
    words = "--pixel-size 1cm contradicts in.svg, which has coordinates in mm"
    run("skeleton-exact in.svg --pixel-size 1cm --what table -f csv", says=words)
    run("skeleton-exact in.svg --pixel-size 1cm --what table --strict", code=3)
    assert "contradicts" not in run("skeleton-exact in.svg --pixel-size 0.1cm --what table").err


@pytest.mark.parametrize(
    ("size", "output", "is_said"),
    [("0.001km", "a.gpkg", True), ("2", "a.geojson", True), ("1m", "a.gpkg", False), ("0.001km", "a.csv", False)],
)
def test_a_size_that_moves_a_map(run, tmp_path, size, output, is_said):
    (tmp_path / "in.wkt").write_text("SRID=32632;POLYGON ((0 0, 9 0, 5 7, 0 0))")
    done = run(f"skeleton-exact in.wkt --pixel-size {size} -o {output}")
    assert (f"--pixel-size {size} scales the coordinates" in done.err) == is_said
    if not output.endswith("csv"):
        read = vorotool.read(tmp_path / output)
        assert (getattr(read, "polygons", read).crs is None) == is_said
    run(f"skeleton-exact in.wkt --pixel-size {size} -o {output} --strict", code=3 if is_said else 0)


@pytest.mark.parametrize("what", ["labels", "table"])
def test_pixels_that_are_no_squares_are_noted(run, tmp_path, what):
    write_sized(tmp_path / "in.tif", sides=(0.25, 0.5))
    done = run(f"tessellate in.tif --what {what} -o", "o.csv" if what == "table" else "o.tif")
    of = "results" if what == "table" else "distances"
    assert done.err.count(f"which are not squares: {of} are in pixels; --spacing auto measures with these sides") == 1
    done = run(f"tessellate in.tif --what {what} --spacing auto -o", "p.csv" if what == "table" else "p.tif")
    assert "not squares" not in done.err


# ---- OME ----------------------------------------------------------------------------------------
@pytest.mark.parametrize(
    ("stated", "sides", "unit"),
    [
        (((500, 0.5), ("nm", "µm")), (500, 500), "nm"),
        (((0.5, 750), ("µm", "nm")), (0.5, 0.75), "µm"),
        (((0.001, 0.001), "in"), (0.001, 0.001), "inch"),
        (((0.5,), "µm"), (0.5, 0.5), "µm"),
    ],
)
def test_ome(run, tmp_path, stated, sides, unit):
    """Mixed units, inches, the width alone; and what is written of it is what was read."""
    write_sized(tmp_path / "in.tif", "ome", *stated)
    told = json.loads(run("info --json in.tif").out)
    assert (told["pixel_size"], told["unit"]) == ([*map(float, sides)], unit)
    is_square = sides[0] == sides[1]
    size = "--pixel-size" if is_square else "--spacing"
    rows = run(f"tessellate in.tif --what table {size} auto -q").rows
    assert sum(float(row["area"]) for row in rows) == pytest.approx(MASK.size * sides[0] * sides[1])
    run("tessellate in.tif -o out.tif -q")
    again = json.loads(run("info --json out.tif").out)
    assert (again["pixel_size"], again["unit"]) == (told["pixel_size"], told["unit"])
    with tifffile.TiffFile(tmp_path / "out.tif") as file:
        described = file.pages[0].description
    assert f'PhysicalSizeXUnit="{"in" if unit == "inch" else unit}"' in described.replace("&#181;", "µ")
    alone = "states only PhysicalSizeX"
    assert (alone in run("tessellate in.tif -o out.tif").err) == (len(stated[0]) == 1)
