"""``--pixel-size``: what is written is what a larger input gives, byte by byte where the factor is a power of two."""

import json
from fractions import Fraction

import numpy as np
import pytest
import tifffile
from PIL import Image

from support.families.rasters import MASK, write_sized


@pytest.mark.parametrize("what", ["labels", "distance"])
def test_the_resolution_of_an_image_is_kept(run, tmp_path, what):
    image = np.zeros((6, 8), np.uint8)
    image[1, 2] = image[4, 5] = 255
    tifffile.imwrite(tmp_path / "in.tif", image, resolution=(300, 150), resolutionunit=2)
    run(f"tessellate in.tif -o out.tif --what {what} -q")
    with tifffile.TiffFile(tmp_path / "out.tif") as file:
        tags = {name: file.pages[0].tags.valueof(name) for name in ("XResolution", "YResolution", "ResolutionUnit")}
    assert tags == {"XResolution": (300, 1), "YResolution": (150, 1), "ResolutionUnit": 2}


def test_pixels_are_scaled_with_one_rounding(run, tmp_path):
    """Areas, boxes and perimeters are integers in pixels: in units they are the nearest doubles."""
    Image.fromarray(np.repeat(np.arange(1, 62, dtype=np.uint8), 41).reshape(61, 41)).save(tmp_path / "a.png")
    side = Fraction("0.325")
    plain = run("tessellate a.png --what table -q").rows
    for before, after in zip(plain, run("tessellate a.png --what table --pixel-size 0.325um -q").rows, strict=True):
        for name in ("area", "perimeter", "bbox_x", "bbox_y", "bbox_w", "bbox_h", "object_area"):
            expected = int(before[name]) * side ** (2 if "area" in name else 1)
            assert float(after[name]) == float(expected)


# ---- the column --------------------------------------------------------------------------------


def test_a_column_of_the_input_keeps_its_name(run, tmp_path):
    (tmp_path / "a.csv").write_text("x,y,unit\n1,2,px\n4,3,px\n2,6,px\n")
    row = run("delaunay a.csv --what table --pixel-size 2nm -q").rows[0]
    assert (row["unit"], row["voro_unit"], list(row)[-1]) == ("px", "nm", "voro_unit")


# ---- --pixel-size auto ----------------------------------------
FILES = [
    ("ome", (0.325, 0.325), "µm", "0.325 µm"),
    ("ome", (2.5, 2.5), "nm", "2.5 nm"),
    ("imagej", (0.325, 0.325), "um", "0.325 µm"),
    ("imagej", (0.25, 0.25), "micron", "0.25 µm"),
    ("imagej", (0.25, 0.25), "\\u00B5m", "0.25 µm"),
    (3, (0.02, 0.02), None, "0.02 cm"),
]


@pytest.mark.parametrize(("kind", "sides", "unit", "words"), FILES)
def test_what_a_file_carries_is_what_a_user_would_type(run, tmp_path, kind, sides, unit, words):
    write_sized(tmp_path / "in.tif", kind, sides, unit)
    plain = run("tessellate in.tif --what table", says=f"{words}: --pixel-size")
    auto = run("tessellate in.tif --what table --pixel-size auto --stats s.json")
    typed = run("tessellate in.tif --what table --pixel-size", words)
    assert auto.out == typed.out != plain.out
    assert "note" not in auto.err
    stats = json.loads((tmp_path / "s.json").read_text())
    assert f"{stats['pixel_size']:g} {stats['unit']}" == words.replace("µ", "u")


@pytest.mark.parametrize(
    ("kind", "sides", "unit", "words"),
    [
        (2, (1 / 300, 1 / 300), None, "300 dots"),
        ("imagej", (0.25, 0.5), "um", "0.25 x 0.5 µm"),
        ("ome", (0.25, 0.5), "µm", "0.25 x 0.5 µm"),
        (1, (0.25, 0.25), None, "--pixel-size"),
        ("imagej", (0.25, 0.25), "pixel", "--pixel-size"),
        ("ome", (0.25, 0.25), "reference frame", "--pixel-size"),
    ],
)
def test_files_without_a_size(run, tmp_path, kind, sides, unit, words):
    write_sized(tmp_path / "in.tif", kind, sides, unit)
    done = run("tessellate in.tif --what table --pixel-size auto", code=3)
    assert done.err.startswith("error: in.tif: ")
    assert words in done.err
    assert "--pixel-size 0.325um" in done.err
    plain = run("tessellate in.tif --what table")
    assert ("--spacing" in plain.err) == (sides[0] != sides[1])


@pytest.mark.parametrize(
    ("kind", "sides", "unit", "words", "what"),
    [(*each, what) for each, what in zip(FILES, 2 * ("labels", "diagram", "distance"), strict=True)],
)
def test_outputs_carry_sizes_on(run, tmp_path, kind, sides, unit, words, what):
    write_sized(tmp_path / "in.tif", kind, sides, unit)
    run(f"tessellate in.tif -o out.tif --what {what} -q")
    run("tessellate out.tif --what table", *(["--threshold", "1"] if what == "distance" else []), says="out.tif")
    with tifffile.TiffFile(tmp_path / "out.tif") as file:
        assert (file.is_ome, file.is_imagej) == (kind == "ome", kind == "imagej")
        assert file.asarray().shape == MASK.shape
        assert file.series[0].axes == "YX"


def test_ome_xml_that_is_hostile(run, tmp_path):
    """Entities are not expanded, sizes are numbers, and two images of different sizes have none in common."""
    bodies = [
        '<!DOCTYPE OME [<!ENTITY a "0.5"><!ENTITY b "&a;&a;">]><OME><Pixels PhysicalSizeX="&b;"/></OME>',
        '<OME><Pixels PhysicalSizeX="1e99999999" PhysicalSizeY="1"/></OME>',
        '<OME><Pixels PhysicalSizeX="0" PhysicalSizeY="-1"/></OME>',
        '<OME><Pixels PhysicalSizeX="1" PhysicalSizeY="1"/><Pixels PhysicalSizeX="2" PhysicalSizeY="2"/></OME>',
        '<OME><Pixels PhysicalSizeX="1" PhysicalSizeY="1"></OME>',
    ]
    for body in bodies:
        tifffile.imwrite(tmp_path / "in.tif", MASK, description=body, metadata=None)
        run("tessellate in.tif --what table --pixel-size auto", code=3, says="states no pixel size")
        run("tessellate in.tif -o out.png")


# ---- statistics --------------------------------------------------------------------------------
SHAPE = "0 0,60 0,60 20,30 30,20 60,0 60"
STATED = (
    "alphashape p.csv",
    "alphashape p.csv -r RR",
    "delaunay p.csv --what cells",
    "voronoi s.wkt --what discs",
    "skeleton-exact s.wkt --what points,skeleton --every RR --prune length=RR -o o --gap RR",
    "skeleton-exact s.wkt --what offset --distance RR",
    "skeleton-exact s.wkt --smooth RR",
    "skeleton-approx s.wkt --step RR --compare",
    "alphashape q.csv --space",
    "delaunay q.csv --space --what cells",
)


@pytest.mark.parametrize("line", STATED)
def test_statistics_are_in_the_unit_that_they_name(run, tmp_path, line):
    """Those of an input that is twice as large, where a pixel has two units: lengths of options are in the input's."""
    scattered = np.random.default_rng(5).integers(0, 64, (12, 3)).tolist()
    found = {}
    for times, more in ((2, ""), (1, "--pixel-size 2um")):
        rows = [[times * x for x in row] for row in scattered]
        (tmp_path / "p.csv").write_text("\n".join(["x,y", *(f"{x},{y}" for x, y, _ in rows)]))
        (tmp_path / "q.csv").write_text("\n".join(["x,y,z", *(f"{x},{y},{z}" for x, y, z in rows)]))
        ring = ",".join(" ".join(str(times * int(x)) for x in place.split()) for place in f"{SHAPE},0 0".split(","))
        (tmp_path / "s.wkt").write_text(f"POLYGON (({ring}))\n")
        given = line.replace("RR", str(8 * times))
        out = "" if " -o " in given else f"-o o.{'npz' if 'space' in given else 'geojson'}"
        run(f"{given} {more} {out} --overwrite --stats s{times}.json -q")
        found[times] = json.loads((tmp_path / f"s{times}.json").read_text())
    stated = {name: found[1].pop(name) for name in ("pixel_size", "unit")}
    assert stated == {"pixel_size": 2, "unit": "um"}
    for each in found.values():
        del each["seconds"]
    assert found[1] == found[2]
