"""Every option of every command is given values that are no numbers, or no numbers that fit anything."""

import click
import pytest

from support.few import few
from vorotool.cli.main import COMMANDS
from vorotool.cli.main import vorotool as group
from vorotool.products.options import GROUPS

DIGITS = "9" * 5000
NUMBERS = (
    DIGITS, f"-{DIGITS}", f"0.{DIGITS}", "0" * 5000, "1" + "0" * 400, "1e400", "-1e400", "1e-400", "1e308", "-1e308",
    "5e-324", "1e999999999999", f"1e{DIGITS}", "nan", "-nan", "inf", "-inf", "infinity", "00", "01", "-0", "-1", "0",
    "1_000", "+1", "0x10", "1/3", "1/0", f"1/{DIGITS}", f"{DIGITS}/1", "9223372036854775808", "18446744073709551616",
    "-9223372036854775809", "4294967296", "2147483648", "٣", "²", "Ⅷ", "𝟗", "1é", "true",
)  # fmt: skip
TEXTS = ("", " ", ",", ",,", "\t", "é" * 3000, "\udcff", "-", "--", "=", "*", "..", "otsu", "none")
LISTS = (
    f"1,{DIGITS}", f"{DIGITS},1", "00,1", "1,01", "0,0", "1,1", "1,2,3", "²,1", "٣,1", "1,1e400", "nan,nan",
    f"{DIGITS},{DIGITS},{DIGITS},{DIGITS}", "0,0,1e308,1e308", "-1e308,-1e308,1e308,1e308", "0,0,5e-324,5e-324",
    "nan,0,1,1", "0,0,inf,1", "1e308,-1e308", "0,0,0,0", "9223372036854775807,0,1,1", "0,0,9223372036854775807,1",
    "-9223372036854775808,0,9223372036854775807,1", "0,0,18446744073709551616,18446744073709551616",
    f"1x{DIGITS}", f"{DIGITS}x1", "1x1", "01x01", "²x²", "0x0", "999999999999999999x999999999999999999",
    f"1/{DIGITS}", "angle=nan", f"angle={DIGITS}", "chord=1e400", "scale=inf", "length=-1", "ratio=", "angle=1e-400",
    f"1{DIGITS}um", "1e400um", "0um", "1e-400 m", "١um", "1,1,1,1,1", f"1,1,1,{DIGITS}", "1,nan", "inf,1",
    "1x1x1", "0x1x1", "999999999999999999x999999999999999999x999999999999999999", f"1x1x{DIGITS}", "1,2,z=3", "x,y,z=",
    "0,0,0,1,1,1", "0,0,0,1,1,0", f"0,0,{DIGITS},1,1,1", "9223372036854775807,0,0,1,1,9223372036854775807",
)  # fmt: skip
VALUES = tuple(dict.fromkeys((*NUMBERS, *TEXTS, *LISTS)))

FEW = 3
"""Commands whose copy of a shared option is tried."""

SHARED = {row.parameter for rows in GROUPS.values() for row in rows if len(row.commands.split()) > 3}

LEFT_OUT = {"cluster"}
"""Addresses are asked over the network."""

INPUTS = {
    "tessellate": ("dots.csv", "-o", "out.npy"),
    "delaunay": ("dots.csv", "-o", "out.csv"),
    "alphashape": ("dots.csv", "-o", "out.csv"),
    "skeleton-approx": ("shape.wkt", "-o", "out.json"),
    "skeleton-exact": ("shape.wkt", "-o", "out.json"),
    "voronoi": ("shape.wkt", "-o", "out.geojson"),
    "distance": ("shape.wkt", "dots.csv", "-o", "out.csv"),
    "draw": ("shape.wkt", "-o", "out.svg", "--width", "90"),
    "info": ("dots.csv",),
    "sample": ("dots.csv",),
    "completion": (),
}
NEEDED = {
    "delaunay frame": "--what cells",
    **dict.fromkeys(("skeleton-exact frame", "skeleton-approx frame"), "--side both"),
    "distance": "--what offset",
    "every": "--what points",
    "count": "--what discs",
    "neck": "--what parts",
    **dict.fromkeys(("start", "end"), "--what centerline"),
    "flatten": "-f geojson",
    "tessellate pixel_size": "--what table -f csv",
    "passes": "--method propagation",
    "chunk": "-f zarr",
    "slice": "space.csv --size 5x4x3 --what color -f svg",
    **dict.fromkeys(("threshold", "connectivity", "page", "simplify"), "mask.pgm"),
    "width": "-f svg",
    "precision": "-f csv",
}
"""What an option means something with."""


def cases():
    """Commands with options and the values of each: those of a shared option are dealt to a few of its commands."""
    takers = {}
    for name in COMMANDS:
        command = group.get_command(None, name)
        for option in command.params:
            if isinstance(option, click.Option) and not option.is_flag and option.name not in LEFT_OUT:
                takers.setdefault(option.name if option.name in SHARED else (name, option.name), []).append(
                    (name, option)
                )
    for each in takers.values():
        few = each[:FEW]
        for number, (name, option) in enumerate(few):
            yield pytest.param(name, option, VALUES[number :: len(few)], id=f"{name} {option.opts[-1]}")


CASES = sorted(enumerate(cases()), key=lambda numbered: (numbered[0] % 4, numbered[0]))
"""Every fourth comes first: it is run with the slow tests, the others are more of the same."""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "option", "values"),
    few([case for _, case in CASES], -(-len(CASES) // 4)),
)
def test_no_value_of_an_option_is_a_defect(run, folder, name, option, values):
    (folder / "shape.wkt").write_text("POLYGON ((0 0, 9 0, 9 4, 0 4, 0 0))\n")
    (folder / "space.csv").write_text("x,y,z\n1,2,0\n4,0,2\n")
    (folder / "mask.pgm").write_text("P2\n4 3\n255\n0 9 9 0\n0 9 9 0\n0 0 0 200\n")
    needed = NEEDED.get(f"{name} {option.name}", NEEDED.get(option.name, "")).split()
    given = [*INPUTS[name][{"mask.pgm", "space.csv"} & set(needed) != set() :], *needed]
    codes = {value[:60]: run(name, *given, f"{option.opts[-1]}={value}", code=None).code for value in values}
    assert {value: code for value, code in codes.items() if code not in (0, 2, 3, 4, 5)} == {}


POINTS = {
    "huge.json": "[[0,0],[1e300,0],[1e300,7e299],[4e299,3e299],[0,1e300]]",
    "tiny.json": "[[0,0],[1e-308,0],[1e-308,7e-309],[4e-309,3e-309],[0,1e-308]]",
    "flat.json": "[[18,5.3e-315],[30,5.2e-315],[1,5.4e-315],[32,5e-315],[0,5.5e-315],[5e-315,5.6e-315]]",
}
"""Coordinates whose squares, and radii whose values, are no floating-point numbers."""

WAYS = [
    f"{command} {options}"
    for command, ways in {
        "tessellate": ("-f text", "--size 20x20 -f text", "--size 20x20 --what table"),
        "delaunay": ("--what cells -f svg", "--what table", "-f png -o a.png --width 90",
                     "--method digital --size 9x9", "--verify"),
        "alphashape": ("-r 3", "-f html -o a.html", "-f png -o a.png --width 90",
                       "--what hull -r 1e300 -f geojson", "--what hull -r 1e-308 -f svg",
                       "--what curves -f svg", "--what general", "--what complex --pixel-size 1e90",
                       "--pixel-size 1e-90 --verify", "-r 1e400", "--region-threshold 1e-400", "--alpha=-1e-400"),
        "skeleton-exact": ("--input-format json", "--what table", "--what offset -d 1", "-f svg", "--verify"),
        "skeleton-approx": ("--input-format json", "--step 1", "--tolerance 1"),
        "voronoi": ("--what table", "--verify", "--max-distance 1e300 --what table", "--max-distance 1e-308 -f svg"),
        "draw": ("-f svg", "-o a.png --width 90"),
    }.items()
    for options in ways
]  # fmt: skip


@pytest.mark.parametrize("way", WAYS)
def test_no_coordinate_is_a_defect(run, folder, way):
    for name, text in POINTS.items():
        (folder / name).write_text(text)
        command, *options = way.split()
        assert run(command, name, *options, code=None).code in (0, 2, 3, 5), name


@pytest.mark.parametrize(
    ("columns", "code", "words"),
    [
        ("00,1", 2, "--columns"),
        ("01,02", 0, ""),
        (f"1,{DIGITS}", 3, "column 9999"),
        ("1,0004", 3, "column 0004"),
        ("²,1", 3, "'²'"),
        ("٣,1", 3, "'٣'"),
    ],
)
def test_columns_are_numbers_of_ascii_digits(run, folder, columns, code, words):
    assert len(run(f"delaunay dots.csv --columns {columns} -o a.csv", code=code, says=words).err) < 400
