"""``--pixel-size``: what is written is what a larger input gives, byte by byte where the factor is a power of two."""

import json
import re

import numpy as np
import pytest

from support.few import few
from vorotool.products.formats import FORMATS
from vorotool.products.registry import formats_of

XY = np.array([[0, 0], [9, 1], [4, 7], [12, 8], [2, 3], [7, 4], [11, 2], [1, 9], [5, 2], [8, 9]])
SHAPES = [
    [[0, 0], [9, 0], [9, 9], [5, 3], [0, 9]],
    [[20, 0], [33, 1], [30, 8], [21, 7]],
]

OPTIONS = {
    "delaunay": [[], ["--method", "digital-valid", "--what", "edges"]],
    "alphashape": [["-r", "{}"], ["--auto"], ["--auto", "--what", "table,curves"]],
    "skeleton-exact": [["--side", "both"], ["--gap", "{}", "--what", "skeleton,elements"]],
}


def write_inputs(folder, command, factor):
    """The same input, larger; a column or property with the name of a length stays as it is."""
    folder.mkdir()
    if command.startswith("skeleton"):
        features = [
            {
                "type": "Feature",
                "properties": {"length": 3},
                "geometry": {
                    "type": "Polygon",
                    "coordinates": [[[factor * x, factor * y] for x, y in [*ring, ring[0]]]],
                },
            }
            for ring in SHAPES
        ]
        (folder / "in.geojson").write_text(json.dumps({"type": "FeatureCollection", "features": features}))
        return folder / "in.geojson"
    rows = [f"{factor * x},{factor * y},{x}" for x, y in XY]
    (folder / "in.csv").write_text("\n".join(["x,y,length", *rows]) + "\n")
    return folder / "in.csv"


def outputs(run, command, folder, options, *, r, more=(), of=None):
    """Bytes of all results in all formats with units, or in some, by their names."""
    formats = formats_of(command)
    wanted = [(what, fmt) for what in formats for fmt in formats[what] if not FORMATS[fmt].is_image]
    wanted = [(what, fmt) for what, fmt in wanted if of is None or fmt in of]
    wanted = [(what, fmt) for what, fmt in wanted if what != "compare"]  # goes with nothing else
    if "--side" in options:  # necks are inside
        wanted = [(what, fmt) for what, fmt in wanted if what not in ("necks", "parts")]
    if command == "alphashape":  # of which points, lines and polygons are, and a Shapefile holds one of them
        wanted = [(what, fmt) for what, fmt in wanted if fmt != "shp" or what not in ("general", "hull")]
    if "--what" in options:
        place = options.index("--what")
        wanted = [(what, fmt) for what, fmt in wanted if what in options[place + 1].split(",")]
        options = options[:place] + options[place + 2 :]
    made = {}
    for fmt in sorted({fmt for _, fmt in wanted}):
        names = ",".join(what for what, each in wanted if each == fmt)
        place = folder.parent / f"{folder.name}-{fmt}"
        arguments = [option.format(r) for option in options]
        if "offset" in names.split(","):
            arguments += ["-d", f"{-r / 8},{r}"]
        if command.startswith("skeleton") and {"points", "transects"} & set(names.split(",")):
            arguments += ["--every", f"{r / 4}"]
        source = next(folder.iterdir())
        done = run(command, source, "--what", names, "-f", fmt, "--out-dir", place, "-q", *arguments, *more)
        assert done.code == 0, done.err
        made |= {f"{fmt} {path.name}": without_unit(path.read_bytes()) for path in place.iterdir()}
    assert made
    return made


def without_unit(data):
    """Leave out the number of the unit in the header of a DXF."""
    return re.sub(rb"(\$INSUNITS\n 70\n)\d+", rb"\1", data)


FIRST = [(command, tuple(each[0]), None) for command, each in OPTIONS.items()]
TEXTS = ("csv", "json", "geojson")
OTHERS = [(command, tuple(options), TEXTS) for command, each in OPTIONS.items() for options in each[1:]]
"""Each option is tried with texts, and one of each command with all formats; `make test-all` tries all with all."""


@pytest.mark.parametrize(
    ("command", "options", "of"),
    few([*FIRST, *OTHERS, *((command, options, None) for command, options, _ in OTHERS)], 1),
)
def test_results_are_those_of_a_larger_input(run, tmp_path, command, options, of):
    small, large = tmp_path / "small", tmp_path / "large"
    write_inputs(small, command, 1)
    write_inputs(large, command, 2)
    scaled = outputs(run, command, small, list(options), r=1.5, more=["--pixel-size", "2"], of=of)
    doubled = outputs(run, command, large, list(options), r=3, of=of)
    assert scaled.keys() == doubled.keys()
    assert [name for name in scaled if scaled[name] != doubled[name]] == []
    plain = outputs(run, command, small, list(options), r=1.5, of=("csv",))
    assert plain.items() - scaled.items()


@pytest.mark.parametrize("what", ["labels", "distance"])
def test_the_resolution_of_an_image_is_kept(run, tmp_path, what):
    import tifffile

    image = np.zeros((6, 8), np.uint8)
    image[1, 2] = image[4, 5] = 255
    tifffile.imwrite(tmp_path / "in.tif", image, resolution=(300, 150), resolutionunit=2)
    assert run("tessellate", "in.tif", "-o", "out.tif", "--what", what, "-q").code == 0
    with tifffile.TiffFile(tmp_path / "out.tif") as file:
        tags = {name: file.pages[0].tags.valueof(name) for name in ("XResolution", "YResolution", "ResolutionUnit")}
    assert tags == {"XResolution": (300, 1), "YResolution": (150, 1), "ResolutionUnit": 2}


# ---- the column --------------------------------------------------------------------------------


def test_a_column_of_the_input_keeps_its_name(run, tmp_path):
    (tmp_path / "a.csv").write_text("x,y,unit\n1,2,px\n4,3,px\n2,6,px\n")
    row = run("delaunay", "a.csv", "--what", "table", "--pixel-size", "2nm", "-q").rows[0]
    assert (row["unit"], row["voro_unit"], list(row)[-1]) == ("px", "nm", "voro_unit")
