"""What one command writes as a table or as features, others read: the same from each format, from files and pipes."""

import numpy as np
import pytest

import vorotool
from support.few import few
from vorotool.products.registry import PRODUCTS, formats_of

MADE_BY = {
    "tessellate": ["six-seeds.csv"],
    "delaunay": ["six-seeds.csv"],
    "alphashape": ["six-seeds.csv", "-r", "9"],
    "skeleton-exact": ["shape.json", "-d", "2", "--every", "9"],
    "skeleton-approx": ["shape.json", "--step", "5", "-d", "2", "--every", "9"],
}
NEEDS = {"-d": ("offset",), "--every": ("points", "transects")}
INPUTS = {"necks": "great-lakes.geojson", "parts": "great-lakes.geojson"}
MORE = {"discs": ["--count", "9"]}
"""Of what a plain shape has few rows."""
ROWS = ("csv", "tsv", "json", "jsonl", "npz")
COORDINATES = {
    **dict.fromkeys(("edges", "complex"), "x_a,y_a"),
    **dict.fromkeys(("hull", "elements", "skeleton", "diagram", "centerline", "offset"), "x0,y0"),
}
"""Columns that are chosen where the table has no x and y."""


def coordinates_of(command, what):
    """Elements of approximate skeletons are samples, which have x and y."""
    return "x,y" if (command, what) == ("skeleton-approx", "elements") else COORDINATES.get(what, "x,y")


NOT_OF_PLACES = {
    *("neighbors", "triangles", "compare", "family", "spectrum", "curves", "branches", "statistics", "persistence"),
    *("alphashape table", "skeleton-exact table", "skeleton-approx table", "delaunay tetrahedra", "delaunay hull"),
    *("alphashape surface", "alphashape tetrahedra"),
}
"""Tables of what has no place."""


def products():
    for command in MADE_BY:
        for what, formats in formats_of(command).items():
            if {what, f"{command} {what}"} & NOT_OF_PLACES:
                continue
            tables = [fmt for fmt in ROWS if fmt in formats and is_of_rows(command, what, fmt)]
            if tables:
                yield pytest.param(command, what, tables, id=f"{command} {what}")


def is_of_rows(command, what, fmt):
    """Whether a format has the rows of the table, and no features or arrays of several lengths."""
    if what in ("skeleton", "diagram", "offset", "cells", "polygons", "shape", "parts"):
        return fmt in ("csv", "tsv")
    data = PRODUCTS[command][what].data
    return not (fmt == "jsonl" and "geojson" in data)


@pytest.fixture
def made(run, tmp_path):
    """Write a result of a sample."""

    def make(command, what, fmt):
        source, *options = MADE_BY[command]
        for option, of in NEEDS.items():
            if option in options and what not in of:
                place = options.index(option)
                del options[place : place + 2]
        source = INPUTS.get(what, source)
        run(f"sample {source} -o {source}")
        run(command, source, *options, *MORE.get(what, []), "--what", what, "-o", f"{what}.{fmt}", "-q")
        return tmp_path / f"{what}.{fmt}"

    return make


@pytest.mark.parametrize(("command", "what", "formats"), few(products(), 12))
def test_points_of_tables_are_the_same_from_each_format(made, command, what, formats):
    read = [vorotool.read(made(command, what, fmt), columns=coordinates_of(command, what)) for fmt in formats]
    assert len(read[0]) > 2
    for each in read[1:]:
        assert np.array_equal(each.xy, read[0].xy)
        assert list(each.properties) == list(read[0].properties)


@pytest.mark.parametrize("what", ["table", "points"])
def test_what_follows_from_points_is_the_same_from_each_format_and_through_pipes(run, made, what):
    command = "tessellate" if what == "table" else "alphashape"
    written = {fmt: made(command, what, fmt) for fmt in ROWS}
    expected = run("delaunay", written["csv"], "--columns", "x,y,label", "--no-properties").out
    assert expected.count("\n") > 5
    for fmt, path in written.items():
        assert run(f"delaunay {path} --columns x,y,label --no-properties").out == expected
        words = ["delaunay", "-", "--columns", "x,y,label", "--no-properties"]
        assert run(*words, data=path.read_bytes()).out == expected, fmt


def features():
    for command in MADE_BY:
        for what, formats in formats_of(command).items():
            if {"geojson", "jsonl"} <= set(formats) and what not in ("hull", "compare"):
                yield command, what


@pytest.mark.parametrize(("command", "what"), few(features(), 8))
def test_features_a_line_are_those_of_the_collection(made, command, what):
    whole, lines = (vorotool.read(made(command, what, fmt)) for fmt in ("geojson", "jsonl"))
    assert type(lines) is type(whole)
    assert np.array_equal(lines.xy, whole.xy)
    assert lines.properties == whole.properties


def test_arrays_of_places_are_points_for_other_commands(run, tmp_path):
    run("sample shape.json -o shape.json")
    for size, more in ((1, []), (2, ["--pixel-size", "2um"])):
        run("skeleton-exact shape.json --what points --every 9 -o a.npy -q", *more)
        rows = run("skeleton-exact shape.json --what points --every 9 -q").rows
        assert np.load(tmp_path / "a.npy").tolist() == [
            [size * float(row["x"]), size * float(row["y"])] for row in rows
        ]
        run("delaunay a.npy -q")
    run("delaunay a.npy --what triangles -o b.npy --pixel-size 2um", code=2, says="--pixel-size")
