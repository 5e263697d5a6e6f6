"""Every option that is a length or an area, with every way in which an input says what its unit is."""

import json
import struct
from decimal import Decimal as Number
from fractions import Fraction
from pathlib import Path

import click
import ezdxf
import numpy as np
import pytest
import rasterio
from PIL import Image

import vorotool
from support.families.geojson import collection
from support.families.rasters import MASK, write_map, write_sized
from vorotool.cli.command import Value
from vorotool.cli.main import vorotool as main
from vorotool.numeric.length_units import unit_name

RINGS = [[(5, 5), (25, 5), (25, 20), (5, 20)], [(20, 25), (55, 25), (55, 36), (20, 36)]]
POINTS = [(3, 4), (21, 9), (38, 2), (55, 30), (12, 33), (30, 20)]


# ---- what says a unit -------------------------------------------------------------------------


def geojson(folder, name, **members):
    shapes = [{"type": "Polygon", "coordinates": [[*ring, ring[0]]]} for ring in RINGS]
    (folder / f"{name}-shapes.geojson").write_text(collection(shapes, **members))
    points = [{"type": "Point", "coordinates": each} for each in POINTS]
    (folder / f"{name}-points.geojson").write_text(collection(points, **members))
    return f"{name}-shapes.geojson", f"{name}-points.geojson"


def system(folder, code):
    return geojson(folder, f"e{code}", crs=f"urn:ogc:def:crs:EPSG::{code}")


def svg(folder):
    paths = "".join(f'<path d="M{" L".join(f"{x} {y}" for x, y in ring)}z"/>' for ring in RINGS)
    page = f'<svg xmlns="http://www.w3.org/2000/svg" width="60mm" height="40mm" viewBox="0 0 60 40">{paths}</svg>'
    (folder / "in.svg").write_text(page)
    return ("in.svg", None)


def dxf(folder):
    drawing = ezdxf.new(units=1)
    for ring in RINGS:
        drawing.modelspace().add_lwpolyline(ring, close=True)
    drawing.saveas(folder / "in.dxf")
    return ("in.dxf", None)


def table(folder):
    """Tables whose column says it; as results of vorotool have it."""
    rows = "".join(f"{x},{y},um\n" for x, y in POINTS)
    (folder / "in.csv").write_text("x,y,unit\n" + rows)
    wkt = "".join(f'"POLYGON(({", ".join(f"{x} {y}" for x, y in [*ring, ring[0]])}))",um\n' for ring in RINGS)
    (folder / "shapes.csv").write_text("geometry,unit\n" + wkt)
    return "shapes.csv", "in.csv"


def typed(folder):
    shapes, points = geojson(folder, "plain")
    return f"{shapes} --pixel-size 0.5um", f"{points} --pixel-size 0.5um"


def ome(folder):
    write_sized(folder / "in.ome.tif")
    return ("in.ome.tif",) * 2


def ome_auto(folder):
    ome(folder)
    return ("in.ome.tif --pixel-size auto",) * 2


def imagej(folder):
    write_sized(folder / "ij.tif", "imagej", unit="um")
    return ("ij.tif",) * 2


def centimeters(folder):
    write_sized(folder / "cm.tif", 3, (0.00005, 0.00005))
    return ("cm.tif",) * 2


def geotiff(folder):
    write_map(folder / "map.tif", transform=rasterio.Affine(30, 0, 2600000, 0, -30, 1200000))
    return ("map.tif",) * 2


def png(folder):
    Image.fromarray(MASK).save(folder / "in.png")
    return ("in.png --pixel-size 0.5um",) * 2


SOURCES = {
    "svg": (svg, "0.2cm", "2"),
    "dxf": (dxf, "50.8mm", "2"),
    "meters": (lambda folder: system(folder, 2056), "0.002km", "2"),
    "feet": (lambda folder: system(folder, 2229), "0.6m", "1.9685"),
    "member": (lambda folder: geojson(folder, "um", unit="um"), "2000nm", "2"),
    "column": (table, "0.002mm", "2"),
    "typed": (typed, "1um", "2"),
    "ome": (ome, "1um", "2"),
    "ome auto": (ome_auto, "1um", "2"),
    "imagej": (imagej, "1000nm", "2"),
    "centimeters": (centimeters, "0.0001cm", "2"),
    "geotiff": (geotiff, "0.06km", "2"),
    "png": (png, "0.001mm", "2"),
}
"""What makes inputs, shapes and points, and a length with a unit, and in coordinates: exactly, by hand."""
FEW = ("svg", "feet", "column", "ome")

# ---- options -----------------------------------------------------------------------------------
WITH = {
    "tessellate --max-distance": ["-o o.npy", "-o o.csv --what table"],
    "tessellate --cell-size": ["-o o.tif"],
    "tessellate --min-area": ["-o o.npy"],
    "tessellate --fill-holes": ["-o o.npy"],
    "alphashape -r": ["-o o.csv", "-o o.csv --what table"],
    "alphashape --hole-threshold": ["-o o.csv --what table -r 30"],
    "alphashape --region-threshold": ["-o o.csv --what table -r 30"],
    "voronoi --max-distance": ["-o o.csv", "-o o.wkt --flatten 5um"],
    "voronoi --flatten": ["-o o.wkt"],
    "skeleton-exact -d": ["-o o.csv --what offset"],
    "skeleton-exact --every": ["-o o.csv --what points", "-o o.csv --what transects"],
    "skeleton-exact --gap": ["-o o.csv", "-o o.csv --complete"],
    "skeleton-exact --flatten": ["-o o.wkt", "-o o.wkt --what shape"],
    "skeleton-approx --every": ["-o o.csv --what points --step 1"],
    "skeleton-approx --flatten": ["-o o.wkt --what shape --step 1"],
    "skeleton-approx --step": ["-o o.csv"],
    "skeleton-approx --tolerance": ["-o o.csv"],
}
"""Further options with which a length is used, where a plain output would not show it."""

NO_LENGTHS = {"alpha", "neck", "fps"}
"""Numbers with decimals that are none: one over a length, a ratio, frames a second."""


def options():
    context = click.Context(main)
    for command in main.list_commands(context):
        for option in main.get_command(context, command).params:
            yield command, option


LENGTHS = {
    f"lengths.{name}"
    for name in ("length", "length_or_zero", "exact_length", "radius", "tolerance_or_auto", "distances", "pruning")
}
AREAS = {"lengths.area", "lengths.area_or_zero", "lengths.holes"}


def kind_of(option):
    return option.type.kind if isinstance(option.type, Value) else ""


def lengths():
    """Command, option and further options of all that are lengths or areas."""
    for command, option in options():
        if kind_of(option) in LENGTHS | AREAS:
            plain = "-o o.csv --step 1" if command == "skeleton-approx" else "-o o.csv"
            name = f"{command} {option.opts[0]}"
            yield from ((name, option, more) for more in WITH.get(name, [plain]))


def test_no_number_is_forgotten():
    """A new option of numbers with decimals is a length or an area, or named above."""
    plain = {
        option.name
        for _, option in options()
        if kind_of(option) == "numbers.decimal"
        or isinstance(option.type, click.types.FloatParamType | click.FloatRange)
    }
    assert plain == NO_LENGTHS
    lengths_of = {option.name for _, option, _ in lengths()}
    assert {"r", "distance", "max_distance", "every", "gap", "flatten", "step", "prune", "cell_size"} <= lengths_of


def texts(option, length, number):
    """A length as this option takes it, with its unit and as a number."""
    if option.name == "prune":
        return f"length={length}", f"length={number}"
    if kind_of(option) not in AREAS:
        return length, number
    digits = length.rstrip("cdkmnu")
    return f"{Number(digits) ** 2:f}{length[len(digits) :]}2", str(Number(number) ** 2)


CASES = [
    pytest.param(
        *each, source, id=f"{each[0]} {each[2]} {source}", marks=[] if FEW[number % 4] == source else pytest.mark.more
    )
    for number, each in enumerate(lengths())
    for source in SOURCES
]


@pytest.mark.parametrize(("name", "option", "more", "source"), CASES)
def test_a_length_is_its_number(run, tmp_path, name, option, more, source):
    """The bytes of the same number in coordinates; where that is refused, the length is too."""
    make, length, number = SOURCES[source]
    shapes, points = make(tmp_path)
    command = name.split()[0]
    wanted = points if command in ("tessellate", "alphashape", "delaunay") else shapes
    if wanted is None:
        return
    found = []
    for text in texts(option, length, number):
        more_now = more.replace("5um", number) if source not in ("ome", "typed", "png") else more
        if text != texts(option, length, number)[0] and more.startswith(("-o o.npy", "-o o.tif")):
            wanted = wanted.partition(" --pixel-size")[0]  # which is refused where there is nothing that it scales
        done = run(command, *wanted.split(), option.opts[0], text, *more_now.split(), "-q", code=None)
        assert "Measured(" not in done.err + done.out
        result = Path(more.split()[1])
        found.append((done.code, result.read_bytes() if done.code == 0 else done.err.replace(text, "")))
        result.unlink(missing_ok=True)
    assert found[0] == found[1]
    assert found[0][0] == 0 or is_refused(option.name, source, found[0][1])


def is_refused(option, source, message):
    """Whether an option is refused there whatever its value."""
    is_image = source in ("ome", "ome auto", "imagej", "centimeters", "geotiff", "png")
    if option in ("min_area", "fill_holes", "simplify"):
        return not is_image
    if option in ("cell_size", "join_tolerance"):
        return is_image or source != "dxf"
    return "--pixel-size auto" in message or "no frame" in message


# ---- numbers, by fractions ----------------------------------------------------------------------
METERS = {"m": Fraction(1), "ft": Fraction(3048, 10**4), "in": Fraction(254, 10**4), "ftUS": Fraction(1200, 3937)}


@pytest.mark.parametrize(("code", "axis", "unit"), [(2056, "m", "ftUS"), (2229, "ftUS", "in"), (2229, "ftUS", "m")])
def test_correctly_rounded(run, tmp_path, code, axis, unit):
    shapes, _ = system(tmp_path, code)
    for digits in ("1", "0.1", "3.3", "0.7"):
        run(f"skeleton-exact {shapes} --what offset -d", digits + unit, "-o", "o.json")
        exact = Fraction(digits) * METERS[unit] / METERS[axis]
        (written,) = {each["distance"] for each in json.loads((tmp_path / "o.json").read_text())["shapes"]}
        assert struct.pack("<d", written) == struct.pack("<d", exact.numerator / exact.denominator)


def test_lengths_in_degrees_are_refused(run, tmp_path):
    (tmp_path / "in.geojson").write_text(
        collection([{"type": "Polygon", "coordinates": [[[7, 47], [7.1, 47], [7, 47.1], [7, 47]]]}],
                   crs="urn:ogc:def:crs:OGC:1.3:CRS84")
    )  # fmt: skip
    line = "skeleton-exact in.geojson --what points --every 200m -f csv"
    run(line, code=2, says=["--every 200m", "in degrees (OGC:CRS84)", "--crs EPSG:32632"])
    assert run(f"{line} --crs EPSG:32632").rows


# ---- what is told of units -----------------------------------------------------------------------
@pytest.mark.parametrize(("source", "unit"), [("dxf", "in"), ("feet", "ftUS"), ("member", "µm")])
def test_units_are_told_and_kept(run, tmp_path, source, unit):
    shapes, _ = SOURCES[source][0](tmp_path)
    told = json.loads(run(f"info --json {shapes}").out)
    assert told["unit"] == unit_name(unit)
    assert f"unit       {told['unit']}" in run(f"info {shapes}").out
    for command in ("skeleton-exact", "voronoi", "skeleton-exact --what offset -d 1"):
        run(command, shapes, "-o", "o.json", "-q")
        value = vorotool.read("o.json")
        kept = value.polygons.unit
        assert (kept is None) == (source in ("meters", "feet"))
        assert kept is None or unit_name(kept) == told["unit"]
        again = json.loads(run("info --json o.json").out)
        assert again["unit"] == told["unit"]
    run(f"voronoi {shapes} -o o.geojson -q")
    assert json.loads(run("info --json o.geojson").out)["unit"] == told["unit"]


def test_the_library_keeps_units(tmp_path):
    shapes, _ = svg(tmp_path)
    drawing = vorotool.read(tmp_path / shapes)
    skeleton = vorotool.skeleton_exact(drawing)
    values = [drawing, vorotool.voronoi(drawing), skeleton, vorotool.offset(drawing, [1])]
    values.append(vorotool.points_along(skeleton, every=2))
    for value in values:
        assert vorotool.to_geojson(value)["unit"] == "mm"
        vorotool.write(value, tmp_path / "o.geojson")
        assert json.loads((tmp_path / "o.geojson").read_text())["unit"] == "mm"
    assert vorotool.read(tmp_path / "o.geojson").unit == "mm"
    plain = vorotool.read(tmp_path / geojson(tmp_path, "plain")[0])
    assert "unit" not in vorotool.to_geojson(plain)


# ---- exact lengths, places and frames ----------------------------------------
XY = np.array([[0, 0], [9, 1], [4, 7], [12, 8], [2, 3], [7, 4], [11, 2], [1, 9], [5, 2], [8, 9]])


@pytest.fixture
def inputs(tmp_path):
    (tmp_path / "in.csv").write_text("x,y\n" + "".join(f"{x},{y}\n" for x, y in XY))
    (tmp_path / "in.json").write_text(
        "[[[0, 0], [9, 0], [9, 9], [5, 3], [0, 9]], [[20, 0], [33, 1], [30, 8], [21, 7]]]"
    )
    return tmp_path


def test_what_is_exact_stays_so(run, inputs):
    """A third of an inch is no decimal number: of pixels at distance 1 none is lost or won by rounding."""
    (inputs / "two.csv").write_text("x,y\n3,3\n")
    size = ["--pixel-size", "0.1in", "--size", "7x7", "-q", "-o"]
    run("tessellate two.csv --max-distance 2.54mm", *size, "one.npy")
    run("tessellate two.csv --max-distance 2.5399999999999999999999mm", *size, "less.npy")
    assert np.count_nonzero(np.load(inputs / "one.npy")) == 5
    assert np.count_nonzero(np.load(inputs / "less.npy")) == 1


@pytest.mark.parametrize("command", ["voronoi in.json", "delaunay in.csv --what cells"])
@pytest.mark.usefixtures("inputs")
def test_a_frame_is_its_numbers(run, command):
    """A pixel is 0.5 um."""
    frames = ("-1um,-1um,10um,0.009mm", "-2,-2,20,18")
    unit, plain = (run(f"{command} -f csv --frame {frame} --pixel-size 0.5um").out for frame in frames)
    assert unit == plain


def test_places_on_a_map_are_in_pixels(run, tmp_path):
    write_map(tmp_path / "m.tif")
    run("voronoi m.tif --frame 0,0,20,20m -f csv", code=2, says=["--frame", "pixels"])
