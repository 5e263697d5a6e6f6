"""Values of options: what each text means, exactly, and texts that mean nothing."""

from fractions import Fraction
from importlib import import_module

import pytest

from support.refusals import refused
from vorotool.cli.values import UnexpectedError
from vorotool.cli.values.lengths import (
    distances,
    exact_length,
    length,
    measured,
    place,
    radius,
    rectangle,
    with_hole_areas,
)
from vorotool.jobs.options import Measured, Options, changed
from vorotool.jobs.units import PixelSize, lengths_in_pixels
from vorotool.numeric.length_units import METERS, is_known, ratio

MEANINGLESS = {
    "numbers.decimal": "x 1e999999999 1/0 nan",
    "numbers.threshold": "nan x inf",
    "numbers.aspect": "nan 0 1e9 x",
    "numbers.size": "0x5 5 5x 1x2x3 " + "9" * 5000 + "x1",
    "numbers.size_or_volume": "1x2x3x4 0x1x1",
    "numbers.window": "1,2,3 1,2,3,0 0,0,nan,20 x,0,1,1",
    "numbers.window_or_volume": "1,2,3,4,5,0 1,2,3,4,5,x 1,2,3",
    "numbers.shard": "3/2 0/2 1 x/2",
    "numbers.page": "-1 x 1.5",
    "numbers.levels": "31 x -1",
    "names.columns": "a,,b type,",
    "names.crs": "Lambert 3857 EPSG:",
    "names.image": "-o --width",
    "names.scale": "2:1 0 1:0 x",
    "names.color": "nocolor #12",
    "names.color_of_layer": "red skeleton=nocolor =red",
    "names.width_of_layer": "skeleton=-1 skeleton=1cm 2",
    "lengths.length": "0 -1 nan x",
    "lengths.length_or_zero": "-1um x",
    "lengths.exact_length": "1e999um x",
    "lengths.radius": "x 5um2 auto 5furlong",
    "lengths.tolerance_or_auto": "0 x",
    "lengths.distances": "1,,2 1:2 1:2:3:4 1:3:0 1:3:-1 a:b:c 1:3: 1um:3mm:1mm -1:1:1 1:1e9:1 1:inf:1 1x 1:2:1x",
    "lengths.rectangle": "0,0,1 0,0,0,1 nan,0,1,1 0,0,0,5mm 0,0,-1mm,5mm 0,0,inf,1 0,0,1mm,5 0,0,1,0",
    "lengths.place": "1um,2 1um,2s2 1um 1,2,3um 1kg,2um 1um,2um,3 ,um um,um nan,1um",
    "lengths.area": "0 5um ten -5",
    "lengths.holes": "-5 5um ten 5furlong2",
    "lengths.pixel_size": "0.5x um 0um 1e300 -1um 1..5um",
    "lengths.spacing": "0,1 1 -1,1 1e-9,1 1um,1 1furlong,1um 1,1furlong",
    "lengths.pruning": "angle=2um length=-2um length chord=x angle=nan",
}


@pytest.mark.parametrize("kind", MEANINGLESS)
def test_texts_that_mean_nothing(kind):
    module, name = kind.split(".")
    parse = getattr(import_module(f"vorotool.cli.values.{module}"), name)
    for text in MEANINGLESS[kind].split(" "):
        refused(UnexpectedError, "", parse, text)


def test_ratios_are_those_of_the_units():
    assert (ratio("in", "mm"), ratio("ft", "in"), ratio("km", "nm")) == (Fraction("25.4"), 12, 10**12)
    assert ratio("µm", "\u03bcm") == ratio("um", "µm") == 1
    assert ratio("mm", "parsec") is None
    assert all(ratio(one, two) * ratio(two, one) == 1 for one in METERS for two in METERS)
    assert (is_known("\u03bcm"), is_known("Mm")) == (True, False)


def test_lengths_with_a_unit_and_without():
    for text in ("1e5", "inf", "nan", "5", "-2.5", "", "um", "5 5um", "5um2", "1_000um", "5um,", ".um"):
        assert measured(text) is None
    for text, number, unit in (
        *(("5um", "5", "um"), (".5 mm", "0.5", "mm"), ("5.m", "5", "m"), ("1e-3km", "0.001", "km")),
        ("+2in", "2", "in"),
    ):
        assert measured(text) == length(text) == Measured(text, Fraction(number), unit, False)
        assert exact_length(text) == Measured(text, Fraction(number), unit, True)
    assert (length("0.5"), exact_length("0.1"), radius("inf")) == (0.5, Fraction(1, 10), float("inf"))
    assert (place("1,-2e3"), rectangle("0,0,12.5,8")) == ((1.0, -2000.0), (0.0, 0.0, 12.5, 8.0))


def test_places_have_one_unit():
    for text, numbers_of in (
        *(("1,2.5um", (1, 2.5)), ("0.001mm,2.5um", (1, 2.5)), ("0, 7 um", (0, 7)), ("-3um,0um", (-3, 0))),
        ("1,0um", (1, 0)),
    ):
        assert [(each.number, each.unit, each.text) for each in place(text)] == [
            (Fraction(x), "um", text) for x in numbers_of
        ]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("-2,5", [-2, 5]),
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


def test_ranges_have_units():
    for text in ("1mm:3mm:1mm", "1:3:1mm", "1 : 3 : 1 mm"):
        assert [(each.number, each.unit) for each in distances(text)] == [(1, "mm"), (2, "mm"), (3, "mm")]


def test_options_without_units_are_the_same_value():
    options = Options("tessellate")
    assert lengths_in_pixels(options, None) is options
    given = changed(options, max_distance=exact_length("1.3um"), sources={"max_distance": "typed"})
    assert lengths_in_pixels(given, PixelSize(Fraction("0.325"), "um")).max_distance == 4


FILL = "--fill-holes"


@pytest.mark.parametrize(
    ("typed", "expected"),
    [
        ([FILL], ["--fill-holes=all"]),
        ([FILL, "a.png"], ["--fill-holes=all", "a.png"]),
        ([FILL, "12.tif", "-o", "b.png"], ["--fill-holes=all", "12.tif", "-o", "b.png"]),
        ([FILL, "3.m"], ["--fill-holes=all", "3.m"]),
        (["a.png", FILL, "-"], ["a.png", "--fill-holes=all", "-"]),
        ([FILL, "-5", "a.png"], ["--fill-holes=-5", "a.png"]),
        ([FILL, "2.5", FILL, ".5e1", "a.png"], ["--fill-holes=2.5", "--fill-holes=.5e1", "a.png"]),
        ([FILL, FILL, "5µm²"], ["--fill-holes=all", "--fill-holes=5µm²"]),
        ([FILL, "1e-3", "a.png"], ["--fill-holes=1e-3", "a.png"]),
        ([FILL, "5parsec2"], ["--fill-holes=5parsec2"]),
        ([FILL, "5 um^2"], ["--fill-holes=5 um^2"]),
        (["--fill-holes=7", "8"], ["--fill-holes=7", "8"]),
        ([FILL, "--", FILL, "3"], ["--fill-holes=all", "--", FILL, "3"]),
    ],
)
def test_which_argument_is_the_area(typed, expected):
    assert with_hole_areas(typed) == expected
