"""``--pixel-size auto``: sizes and units of pixels as files carry them, and as outputs carry them on."""

import json

import numpy as np
import pytest
import tifffile

MASK = np.zeros((24, 32), np.uint8)
MASK[3:9, 4:11] = MASK[12:20, 15:30] = 255


def write(path, kind, sides=(0.325, 0.325), unit="µm"):
    """A mask in the form of a microscope, of ImageJ, or of any other program."""
    x, y = sides
    if kind == "ome":
        sizes = {"PhysicalSizeX": x, "PhysicalSizeY": y, "PhysicalSizeXUnit": unit, "PhysicalSizeYUnit": unit}
        tifffile.imwrite(path, MASK, ome=True, metadata={"axes": "YX", **sizes})
    elif kind == "imagej":
        tifffile.imwrite(path, MASK, imagej=True, resolution=(1 / x, 1 / y), metadata={"unit": unit})
    else:
        tifffile.imwrite(path, MASK, resolution=(1 / x, 1 / y), resolutionunit=kind)
    return path


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
    write(tmp_path / "in.tif", kind, sides, unit)
    plain = run("tessellate in.tif --what table", says=f"{words}: --pixel-size")
    auto = run("tessellate in.tif --what table --pixel-size auto --stats s.json")
    typed = run("tessellate in.tif --what table --pixel-size", words)
    assert auto.out == typed.out != plain.out
    assert "note" not in auto.err
    stats = json.loads((tmp_path / "s.json").read_text())
    assert f"{stats['pixel_size']:g} {stats['unit']}" == words


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
    write(tmp_path / "in.tif", kind, sides, unit)
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
    write(tmp_path / "in.tif", kind, sides, unit)
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
