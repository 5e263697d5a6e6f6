"""Every column of every table against its unit: as the table of an input that is twice as large."""

import csv
import re

import numpy as np
import pytest
import shapely
from PIL import Image

from support.families.geojson import collection
from vorotool.products.registry import PRODUCTS

POINTS = [(3, 4), (21, 9), (38, 2), (55, 30), (12, 33), (30, 20), (44, 41), (8, 18), (27, 37), (50, 12)]
SHAPES = [
    shapely.Polygon([(0, 0), (40, 0), (40, 12), (22, 14), (20, 30), (0, 30)]),
    shapely.Polygon([(50, 5), (80, 5), (80, 40), (66, 20), (50, 40)], [[(60, 8), (64, 8), (62, 12)]]),
    shapely.box(10, 40, 30, 50),
]
COMMANDS = ("delaunay", "alphashape", "voronoi", "skeleton-exact", "skeleton-approx")
OF_POINTS = ("delaunay", "alphashape")
LENGTHS = {
    "alphashape": dict.fromkeys(("edges", "polygons", "points", "table", "hull"), "-r {25}"),
    "skeleton-exact": {"points": "--every {2}", "transects": "--every {2}", "offset": "-d -{2}"},
    "skeleton-approx": {"points": "--every {2}", "transects": "--every {2}"},
}
"""Lengths that a table needs, for the smaller input."""
OF_SPACE = {("delaunay", "tetrahedra"), ("delaunay", "hull")}
OF_SPACE |= {("alphashape", "surface"), ("alphashape", "tetrahedra"), ("alphashape", "triangles")}
"""Of points with a z, in test_space.py."""
STEP = " --step {2}"


def tables():
    """Command and result of all that is written as CSV."""
    return [
        (command, what)
        for command in COMMANDS
        for what, each in PRODUCTS[command].items()
        if "csv" in each.formats and (command, what) not in OF_SPACE
    ]


def write(folder, factor):
    scaled = [shapely.transform(each, lambda xy: xy * factor) for each in SHAPES]
    names = [{"name": f"n{k}"} for k in range(len(SHAPES))]
    (folder / f"shapes{factor}.geojson").write_text(collection(scaled, names))
    rows = "".join(f"{x * factor},{y * factor},n{x}\n" for x, y in POINTS)
    (folder / f"points{factor}.csv").write_text("x,y,name\n" + rows)


def words(command, what, factor):
    """Options with the lengths that this table needs, for an input of that size."""
    source = f"points{factor}.csv" if command in OF_POINTS else f"shapes{factor}.geojson"
    text = LENGTHS.get(command, {}).get(what, "") + (STEP if command == "skeleton-approx" else "")
    lengths = re.sub(r"\{(\d+)\}", lambda found: str(int(found[1]) * factor), text)
    return [command, source, "--what", what, "-f", "csv", "-q", *lengths.split()]


def columns(text):
    rows = list(csv.DictReader(text.splitlines()))
    return {name: [row[name] for row in rows] for name in rows[0]} if rows else {}


def same(one, other):
    try:
        return [float(each) for each in one] == pytest.approx([float(each) for each in other], rel=1e-9, abs=1e-9)
    except ValueError:
        return all(
            a == b or (a and b and float(a) == pytest.approx(float(b), rel=1e-9, abs=1e-9))
            for a, b in zip(one, other, strict=True)
        )


@pytest.mark.parametrize(("command", "what"), [pytest.param(*each, id=" ".join(each)) for each in tables()])
def test_a_unit_scales_as_a_larger_input(run, tmp_path, command, what):
    """Lengths twice, areas four times as large, the rest as it was; and the unit says which."""
    write(tmp_path, 1)
    write(tmp_path, 2)
    plain, larger = run(*words(command, what, 1)), run(*words(command, what, 2))
    scaled = run(*words(command, what, 1), "--pixel-size", "2mm")
    before, expected, found = (columns(each.out) for each in (plain, larger, scaled))
    assert found, "the table has no rows: nothing is tested"
    units = found.pop("unit")
    assert list(found) == list(expected)
    for name, column in found.items():
        assert same(column, expected[name]), name
    if "measure" in found:
        check_units_of_measures(before, found, units)
    else:
        assert set(units) == {"mm"}


def check_units_of_measures(before, found, units):
    """Where a row is a measure: the unit by which its numbers grew."""
    for k, unit in enumerate(units):
        one, two = (
            np.array([float(each[name][k] or "nan") for name in ("mean", "max") if name in each])
            for each in (before, found)
        )
        if not one.size or not (one[np.isfinite(one)] != 0).any():
            continue
        growth = round(float(np.nanmax(two / one)))
        assert unit == {1: "", 2: "mm", 4: "mm2"}[growth], found["measure"][k]


@pytest.mark.parametrize("what", [what for what, each in PRODUCTS["tessellate"].items() if "csv" in each.formats])
@pytest.mark.parametrize("source", ["in.csv", "in.png"])
def test_pixels_with_a_size_are_pixels_with_sides(run, tmp_path, source, what):
    """Tables that are scaled are those that are measured in the sides of pixels."""
    (tmp_path / "in.csv").write_text("x,y\n" + "".join(f"{x},{y}\n" for x, y in POINTS))
    mask = np.zeros((40, 60), np.uint8)
    mask[5:20, 5:25] = mask[25:36, 20:55] = 255
    Image.fromarray(mask).save(tmp_path / "in.png")
    call = ["tessellate", source, "--what", what, "-f", "csv", "-q"]
    scaled, measured = run(*call, "--pixel-size", "2mm"), run(*call, "--spacing", "2,2mm")
    one, two = columns(scaled.out), columns(measured.out)
    assert list(one) == list(two)
    assert all(same(one[name], two[name]) for name in one)
    assert set(one["unit"]) == {"mm"}
