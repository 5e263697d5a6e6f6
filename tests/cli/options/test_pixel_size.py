"""``--pixel-size``: what is written is what a larger input gives, byte by byte where the factor is a power of two."""

import json
import re

import numpy as np
import pytest

from support.few import few
from support.readers.written import rows_of
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
    few([*FIRST, *OTHERS, *((command, options, None) for command, options, _ in OTHERS)], len(FIRST) + len(OTHERS)),
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


KEPT = {
    *("label", "neighbors", "nearest_label", "touches_frame", "components", "label_a", "label_b", "label_c"),
    *("kind", "difference", "cause", "regions", "holes", "cavities", "edges", "on_hull", "duplicate_of_label"),
}
"""Columns of tables that are scaled by the names of their columns, and are no lengths."""


@pytest.mark.parametrize(
    "options",
    ["tessellate --what table", "tessellate --what neighbors", "delaunay --what table", "alphashape --what curves",
     "delaunay --what compare"],
)  # fmt: skip
def test_columns_are_scaled_by_what_they_are(run, tmp_path, options):
    source = write_inputs(tmp_path / "in", "delaunay", 1)
    plain, scaled = (run(*options.split(), source, "-q", *more).rows for more in ([], ["--pixel-size", "0.325 µm"]))
    assert len(plain) == len(scaled) > 0
    for name in plain[0]:
        before, after = ([row[name] for row in rows] for rows in (plain, scaled))
        assert {row["unit"] for row in scaled} == {"um"}
        own = name if name == "length" else name.removeprefix("voro_")
        if own in KEPT or own == "length":
            assert after == before, name
            continue
        power = 2 if own in ("area", "object_area") else 1
        assert [bool(text) for text in after] == [bool(text) for text in before]
        values = np.array([[float(a), float(b)] for a, b in zip(before, after, strict=True) if a])
        assert np.allclose(values[:, 1], values[:, 0] * 0.325**power, rtol=1e-15, atol=0), name
        assert (values[:, 0] != 0).any(), name


def test_objects_of_an_image(run, tmp_path):
    (tmp_path / "mask.pbm").write_text("P1\n5 4\n1 1 0 0 0\n0 0 0 0 0\n0 0 0 0 1\n0 0 0 1 1\n")
    done = run("tessellate", "mask.pbm", "--what", "table", "--pixel-size", "0.5mm", "-q", "--stats", "s.json")
    assert [row["object_area"] for row in done.rows] == ["0.5", "0.75"]
    stats = json.loads((tmp_path / "s.json").read_text())
    assert (stats["pixel_size"], stats["unit"]) == (0.5, "mm")


def test_many_inputs(run, tmp_path):
    write_inputs(tmp_path / "in", "delaunay", 1)
    done = run("delaunay", "in", "--table", "-", "--pixel-size", "3", "-q", "--stats", "s.json")
    alone = run("delaunay", "in/in.csv", "--what", "table", "--pixel-size", "3", "-q")
    assert [line.partition(",")[2] for line in done.out.splitlines()] == alone.out.splitlines()
    stats = json.loads((tmp_path / "s.json").read_text())
    assert (stats["pixel_size"], stats["unit"]) == (3, None)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ("--pixel-size um", "'um'"),
        ("--pixel-size 0um", "expected more than 0"),
        ("--pixel-size 1e300", "at most 1e100"),
        ("--pixel-size -1um", "'-1um'"),
        ("--pixel-size 1..5um", "expected a decimal"),
        ("--pixel-size 0.5um -f svg -o a.svg", "--pixel-size"),
        ("--pixel-size 0.5um -f png -o a.png", "--pixel-size"),
    ],
)
def test_sizes_that_mean_nothing(run, tmp_path, options, words):
    source = write_inputs(tmp_path / "in", "delaunay", 1)
    done = run("delaunay", source, *options.split())
    assert done.code == 2
    assert words in done.err


@pytest.mark.parametrize("what", ["labels", "diagram", "distance"])
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
def values_of(path, name):
    """A column of a table in any format, as text."""
    fmt = path.suffix[1:]
    if fmt == "npz":
        with np.load(path) as arrays:
            return [str(value) for value in arrays[name]] if name in arrays else None
    if fmt in ("csv", "tsv"):
        rows = rows_of(path.read_bytes(), "\t" if fmt == "tsv" else ",")
    else:
        text = path.read_text(encoding="utf-8")
        rows = json.loads(text) if fmt == "json" else [json.loads(line) for line in text.splitlines()]
    return [row[name] for row in rows] if name in rows[0] else None


@pytest.mark.parametrize(
    ("options", "fmt"),
    [
        *(("tessellate --what table", fmt) for fmt in ("csv", "tsv", "json", "jsonl", "npz")),
        *(("skeleton-exact --what branches", fmt) for fmt in ("csv", "jsonl", "npz")),
        *(("tessellate --what neighbors", "csv"), ("delaunay --what table", "csv")),
        *(("alphashape --what points -r 9", "csv"), ("skeleton-exact --what table", "json")),
        ("skeleton-approx --step 2 --what elements", "csv"),
    ],
)
def test_each_table_tells_its_unit_at_its_end(run, tmp_path, options, fmt):
    command, *more = options.split()
    source = write_inputs(tmp_path / "in", command, 1)
    for size, unit in (("0.5um", "um"), ("0.5 µm", "um"), ("0.5", None)):
        assert run(command, source, *more, "-q", "-o", f"a.{fmt}", "--pixel-size", size).code == 0
        units = values_of(tmp_path / f"a.{fmt}", "unit")
        assert units is None if unit is None else set(units) == {unit}
    assert run(command, source, *more, "-q", "-o", f"b.{fmt}").code == 0
    assert values_of(tmp_path / f"b.{fmt}", "unit") is None
    if fmt == "csv":
        plain, scaled = ((tmp_path / f"{name}.csv").read_text().splitlines()[0] for name in "ba")
        assert plain == scaled, "no unit, no column"
        run(command, source, *more, "-q", "-o", "c.csv", "--pixel-size", "3mm")
        assert (tmp_path / "c.csv").read_text().splitlines()[0] == f"{plain},unit"


@pytest.mark.parametrize("fmt", ["csv", "json", "npz"])
def test_rows_of_measures_have_units_of_their_own(run, tmp_path, fmt):
    source = write_inputs(tmp_path / "in", "delaunay", 1)
    wanted = f"{tmp_path}/a.{fmt}"
    assert run("delaunay", source, "--what", "statistics", "-q", "-o", wanted, "--pixel-size", "0.5um").code == 0
    names, units = (values_of(tmp_path / f"a.{fmt}", name) for name in ("measure", "unit"))
    found = {name: unit or None for name, unit in zip(names, units, strict=True)}
    assert found == {
        **{"area": "um2", "perimeter": "um", "nearest_distance": "um", "tree_length": "um"},
        **dict.fromkeys(["roundness", "neighbors", "tree_normalized"]),
    }


def test_rows_of_arcs_and_cells_have_the_column_and_features_have_not(run, tmp_path):
    source = write_inputs(tmp_path / "in", "skeleton-exact", 1)
    assert run("skeleton-exact", source, "-f", "csv", "-q", "--pixel-size", "2mm").rows[0]["unit"] == "mm"
    made = run("skeleton-exact", source, "-f", "geojson", "-q", "--pixel-size", "2mm").out
    assert "unit" not in json.loads(made)["features"][0]["properties"]
    points = write_inputs(tmp_path / "points", "delaunay", 1)
    assert (
        run("delaunay", points, "--what", "cells", "-f", "tsv", "-q", "--pixel-size", "2mm").out.count("\tmm\n") == 10
    )


def test_a_column_of_the_input_keeps_its_name(run, tmp_path):
    (tmp_path / "a.csv").write_text("x,y,unit\n1,2,px\n4,3,px\n2,6,px\n")
    row = run("delaunay", "a.csv", "--what", "table", "--pixel-size", "2nm", "-q").rows[0]
    assert (row["unit"], row["voro_unit"], list(row)[-1]) == ("px", "nm", "voro_unit")


def test_a_table_of_all_inputs_has_one_unit(run, tmp_path):
    folder = write_inputs(tmp_path / "in", "delaunay", 1).parent
    for name in ("all.csv", "all.tsv", "all.json"):
        assert run("delaunay", folder, "--table", name, "--pixel-size", "3mm", "-q").code == 0
        assert set(values_of(tmp_path / name, "unit")) == {"mm"}
