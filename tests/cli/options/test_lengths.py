"""Lengths with units on the command line: the bytes are those of the same number of pixels, which is exact."""

import json
import shutil
from fractions import Fraction

import numpy as np
import pytest

from vorotool.cli.values import UnexpectedError
from vorotool.cli.values.lengths import distances, exact_length, length, measured, place, radius, rectangle
from vorotool.jobs.options import Options, changed
from vorotool.jobs.units import Measured, PixelSize, lengths_in_pixels
from vorotool.numeric.length_units import METERS, is_known, ratio

XY = np.array([[0, 0], [9, 1], [4, 7], [12, 8], [2, 3], [7, 4], [11, 2], [1, 9], [5, 2], [8, 9]])


@pytest.fixture
def inputs(tmp_path):
    (tmp_path / "in.csv").write_text("x,y\n" + "".join(f"{x},{y}\n" for x, y in XY))
    (tmp_path / "in.json").write_text(
        "[[[0, 0], [9, 0], [9, 9], [5, 3], [0, 9]], [[20, 0], [33, 1], [30, 8], [21, 7]]]"
    )
    return tmp_path


# A pixel is 0.325 um: each length is given with a unit, and as what it is in pixels.
CASES = [
    ("tessellate in.csv -o {}.npy --max-distance", "1.3um", "4"),
    ("tessellate in.csv -o {}.npy --max-distance", "1625nm", "5"),
    ("tessellate in.csv -o {}.csv --what table --max-distance", "0.00000065 m", "2"),
    ("alphashape in.csv -o {}.csv -r", "0.00195mm", "6"),
    ("alphashape in.csv -o {}.svg -r", "0.000195 cm", "6"),
    ("alphashape in.csv -o {}.csv -r", "inf", "inf"),
    ("skeleton-exact in.json -o {}.csv --what offset -d", "-0.325um,0.65µm,7", "-1,2,7"),
    ("skeleton-exact in.json -o {}.geojson --what points --every", "325nm", "1"),
    ("skeleton-exact in.json -o {}.wkt --flatten", "0.0325um", "0.1"),
    ("skeleton-exact in.json -o {}.json --simplify", "0.325\u03bcm", "1"),
    ("skeleton-exact in.json -o {}.json --prune", "length=0.65um", "length=2"),
    ("skeleton-exact in.json -o {}.json --prune", "chord=0.65um", "chord=2"),
    ("skeleton-exact in.json -o {}.json --gap", "0.0325um", "0.1"),
    ("skeleton-approx in.json -o {}.json --step", "0.325um", "1"),
    ("skeleton-approx in.json -o {}.json --tolerance", "0.0325um", "0.1"),
]


@pytest.mark.parametrize(("command", "length", "pixels"), CASES, ids=lambda text: text.split()[0])
def test_a_length_is_its_number_of_pixels(run, inputs, command, length, pixels):
    written = []
    for name, given in (("unit", length), ("plain", pixels)):
        words = command.format(name).split()
        # without a length in a unit a size of pixels is refused where there is nothing that it scales
        is_needed = name == "unit" or not words[3].endswith(("npy", "svg"))
        done = run(*words, given, *(["--pixel-size", "0.325um"] if is_needed else []), "-q")
        assert done.code == 0, done.err
        written.append((inputs / words[3]).read_bytes())
    assert written[0] == written[1]


def test_what_is_exact_stays_so(run, inputs):
    """A third of an inch is no decimal number: of pixels at distance 1 none is lost or won by rounding."""
    (inputs / "two.csv").write_text("x,y\n3,3\n")
    size = ["--pixel-size", "0.1in", "--size", "7x7", "-q", "-o"]
    assert run("tessellate", "two.csv", "--max-distance", "2.54mm", *size, "one.npy").code == 0
    assert run("tessellate", "two.csv", "--max-distance", "2.5399999999999999999999mm", *size, "less.npy").code == 0
    assert np.count_nonzero(np.load(inputs / "one.npy")) == 5
    assert np.count_nonzero(np.load(inputs / "less.npy")) == 1


def test_a_batch_and_its_statistics(run, inputs):
    (inputs / "many").mkdir()
    for name in "ab":
        shutil.copy(inputs / "in.csv", inputs / "many" / f"{name}.csv")
    options = ["--pixel-size", "0.5mm", "-r", "3mm", "-q"]
    assert run("alphashape", "many", "--out-dir", "out", "-f", "csv", *options, "--stats", "s.json").code == 0
    assert run("alphashape", "in.csv", "-o", "one.csv", *options).code == 0
    assert {path.read_bytes() for path in (inputs / "out").glob("*.csv")} == {(inputs / "one.csv").read_bytes()}
    assert json.loads((inputs / "s.json").read_text())["unit"] == "mm"
    again = run("alphashape", "many", "--out-dir", "out", "-f", "csv", *options, "--resume", "--dry-run")
    assert again.out.count('"kept"') == 2
    other = run("alphashape", "many", "--out-dir", "out", "-f", "csv", *options[:3], "2mm", "--resume", "--dry-run")
    assert other.out.count('"planned"') == 2


KNOWN = "nm, um, µm, mm, cm, dm, m, km, in, ft, ftUS, yd, mi"


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ("tessellate in.csv --max-distance 5um", "5um"),
        ("tessellate in.csv --max-distance 5parsec", "--max-distance '5parsec'"),
        ("tessellate in.csv --max-distance 5um --pixel-size 2", "--pixel-size"),
        ("tessellate in.csv --max-distance 5um --pixel-size 2voxel", "is in voxel, an unknown unit"),
        ("tessellate in.csv --max-distance 5voxel --pixel-size 2um", "invalid --max-distance '5voxel'"),
        ("skeleton-exact in.json --prune chord=2m", "--prune chord=2m"),
        ("skeleton-exact in.json --what points --every 1ell", "invalid --every '1ell'"),
        ("skeleton-exact in.json --gap -1um", "'-1um'"),
        ("skeleton-exact in.json --what offset -d 0um,2", "a distance is 0"),
        ("skeleton-exact in.json --what offset -d 1mm,1000um --pixel-size 1mm", "the distance 1 is repeated"),
        ("skeleton-exact in.json --prune angle=2um", "'2um'"),
        ("skeleton-exact in.json --prune length=-2um", "expected a length from 0"),
        ("skeleton-exact in.json --what points --every 1e300km --pixel-size 1e-20nm", "invalid --every '1e300km'"),
        ("tessellate in.csv --max-distance 1e999um --pixel-size 1um", "expected a decimal"),
    ],
)
def test_lengths_that_mean_nothing(run, inputs, options, words):
    done = run(*options.split(), "-o", "out.npy" if options.startswith("tess") else "out.csv")
    assert done.code == 2
    assert words in done.err
    assert not list(inputs.glob("out*"))


def test_a_unit_of_its_own_is_as_good_as_any(run, inputs):
    assert run("tessellate", "in.csv", "--max-distance", "6voxel", "--pixel-size", "2voxel", "-o", "a.npy").code == 0
    assert run("tessellate", "in.csv", "--max-distance", "3", "-o", "b.npy").code == 0
    assert (inputs / "a.npy").read_bytes() == (inputs / "b.npy").read_bytes()


# ---- units and parsing ---------------------------------------------------------------------------
def test_ratios_are_those_of_the_units():
    assert ratio("in", "mm") == Fraction("25.4")
    assert ratio("ft", "in") == 12
    assert ratio("km", "nm") == 10**12
    assert ratio("µm", "\u03bcm") == ratio("um", "µm") == 1
    assert ratio("mm", "parsec") is None
    for one in METERS:
        for two in METERS:
            assert ratio(one, two) * ratio(two, one) == 1
    assert is_known("\u03bcm")
    assert not is_known("Mm")


@pytest.mark.parametrize(
    "text", ["1e5", "inf", "nan", "5", "-2.5", "", "um", "5 5um", "5um2", "1_000um", "5um,", ".um"]
)
def test_what_has_no_unit(text):
    assert measured(text) is None


@pytest.mark.parametrize(
    ("text", "number", "unit"),
    [("5um", "5", "um"), (".5 mm", "0.5", "mm"), ("5.m", "5", "m"), ("1e-3km", "0.001", "km"), ("+2in", "2", "in")],
)
def test_what_has_one(text, number, unit):
    assert measured(text) == Measured(text, Fraction(number), unit, False)
    assert length(text) == Measured(text, Fraction(number), unit, False)
    assert exact_length(text) == Measured(text, Fraction(number), unit, True)


def test_plain_numbers_are_what_they_were():
    assert length("0.5") == 0.5
    assert exact_length("0.1") == Fraction(1, 10)
    assert radius("inf") == float("inf")
    assert distances("-2,5") == (-2.0, 5.0)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("1:3:1", [1, 2, 3]),
        ("1:3.9:1", [1, 2, 3]),
        ("-3:-1:0.5", [-3, -2.5, -2, -1.5, -1]),
        ("3:1:-1", [3, 2, 1]),
        ("0.1:0.5:0.1", [0.1, 0.2, 0.3, 0.4, 0.5]),  # each is the decimal number that it looks like
        ("2:2:1", [2]),
        ("-1, 2:4:2 ,9", [-1, 2, 4, 9]),
    ],
)
def test_ranges_of_distances(text, expected):
    assert list(distances(text)) == expected


@pytest.mark.parametrize("text", ["1mm:3mm:1mm", "1:3:1mm", "1 : 3 : 1 mm"])
def test_ranges_have_units(text):
    found = distances(text)
    assert [(each.number, each.unit) for each in found] == [(1, "mm"), (2, "mm"), (3, "mm")]


@pytest.mark.parametrize(
    "text", ["1:2", "1:2:3:4", "1:3:0", "1:3:-1", "a:b:c", "1:3:", "1um:3mm:1mm", "-1:1:1", "1:1e9:1", "1:inf:1"]
)
def test_ranges_that_are_none(text):
    with pytest.raises(UnexpectedError):
        distances(text)


def test_options_without_units_are_the_same_value():
    options = Options("tessellate")
    assert lengths_in_pixels(options, None) is options
    size = PixelSize(Fraction("0.325"), "um")
    given = changed(options, max_distance=exact_length("1.3um"))
    assert lengths_in_pixels(given, size).max_distance == 4


# ---- places and frames
@pytest.mark.parametrize(
    ("text", "numbers"),
    [("1,2.5um", (1, 2.5)), ("0.001mm,2.5um", (1, 2.5)), ("0, 7 um", (0, 7)), ("-3um,0um", (-3, 0)), ("1,0um", (1, 0))],
)
def test_places_have_one_unit(text, numbers):
    found = place(text)
    assert [(each.number, each.unit, each.text) for each in found] == [(Fraction(x), "um", text) for x in numbers]


def test_places_without_unit_are_numbers():
    assert place("1,-2e3") == (1.0, -2000.0)
    assert rectangle("0,0,12.5,8") == (0.0, 0.0, 12.5, 8.0)


@pytest.mark.parametrize(
    "text", ["1um,2", "1um,2s2", "1um", "1,2,3um", "1kg,2um", "1um,2um,3", ",um", "um,um", "nan,1um"]
)
def test_places_that_are_none(text):
    with pytest.raises(UnexpectedError):
        place(text)


@pytest.mark.parametrize("text", ["0,0,0,5mm", "0,0,-1mm,5mm", "0,0,1mm,0mm", "0,0,1,0", "0,0,inf,1", "0,0,1mm,5"])
def test_frames_that_are_none(text):
    with pytest.raises(UnexpectedError):
        rectangle(text)


FRAMED = [
    "voronoi in.json -o {}.csv --frame",
    "delaunay in.csv --what cells -o {}.csv --frame",
    "skeleton-exact in.json --side both -o {}.json --frame",
    "skeleton-approx in.json --step 1 --what diagram -o {}.json --frame",
]


@pytest.mark.parametrize("command", FRAMED, ids=lambda text: text.split()[0])
def test_a_frame_is_its_numbers(run, inputs, command):
    """A pixel is 0.5 um."""
    for name, frame in (("unit", "-1um,-1um,10um,0.009mm"), ("plain", "-2,-2,20,18")):
        words = command.format(name).split()
        assert run(*words, frame, "--pixel-size", "0.5um", "-q").code == 0
    kind = words[words.index("-o") + 1].rpartition(".")[2]
    assert (inputs / f"unit.{kind}").read_bytes() == (inputs / f"plain.{kind}").read_bytes()


def test_ends_of_a_centerline_are_their_numbers(run, inputs):
    command = ["skeleton-exact", "in.json", "--what", "centerline", "--pixel-size", "0.5um", "-f", "csv", "-q"]
    done = [run(*command, "--from", begin, "--to", end) for begin, end in (("1,1um", "4um,0um"), ("2,2", "8,0"))]
    assert done[0].code == 0, done[0].err
    assert done[0].out == done[1].out


def test_places_on_a_map_are_in_pixels(run, tmp_path):
    import rasterio

    place = {"crs": "EPSG:2056", "transform": rasterio.Affine(2, 0, 2600000, 0, -2, 1200000)}
    mask = np.zeros((20, 30), np.uint8)
    mask[5:15, 5:25] = 255
    with rasterio.open(tmp_path / "m.tif", "w", "GTiff", 30, 20, 1, dtype="uint8", **place) as out:
        out.write(mask, 1)
    done = run("voronoi", "m.tif", "--frame", "0,0,20,20m", "-f", "csv")
    assert (done.code, "--frame" in done.err, "pixels" in done.err) == (2, True, True)
