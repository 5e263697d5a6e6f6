"""Polygons and lines in Triangle's .poly files."""

import pytest

from support.readers.polygon_reading import error_of, notes_of, read, rings, written
from vorotool.convert.polygons import as_polygons

SHELL = [[0, 0], [9, 0], [9, 9], [0, 9]]
HOLE = [[1, 1], [7, 1], [1, 7]]
ISLAND = [[2, 2], [3, 2], [2, 3]]


@pytest.mark.parametrize("base", [0, 1])
def test_poly(base):
    vertices = [*SHELL, *HOLE, [20, 0], [21, 1], [20, 2]]
    lines = [f"{i} {x} {y} 1 # vertex" for i, (x, y) in enumerate(vertices, base)]
    ends = [(0, 1), (2, 1), (2, 3), (3, 0), (4, 5), (6, 5), (4, 6), (8, 9), (8, 7)]
    segments = [f"{i} {a + base} {b + base} 0" for i, (a, b) in enumerate(ends, base)]
    text = "\n".join(["# box", f"{len(vertices)} 2 0 1", *lines, "", f"{len(ends)} 1", *segments, "1", "1 1.5 1.5"])
    shapes = read(text, "a.poly")
    assert rings(shapes) == [
        (0, 0, SHELL),
        (1, 0, HOLE),
        (2, 1, [[20, 0], [21, 1], [20, 2]]),
    ]
    assert notes_of(text, "a.poly") == ["a.poly: attributes and boundary markers are ignored"]


def test_round_trip():
    line = {"line": [[20, 0], [21, 1.5], [20, 0]]}
    shapes = as_polygons([line, {"shell": SHELL, "holes": [HOLE]}, ISLAND, {"line": [[30, 1e-7], [31, 1]]}])
    text = written(shapes, "poly")
    assert rings(read(text, "a.poly")) == rings(shapes)
    assert text.splitlines()[:2] == ["15 2 0 0", "1 20 0"]
    assert len(read("1 2\n1 0 0\n0\n0\n", "a.poly")) == 0


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", ": the file ends before a header; write <vertices> 2 <attributes> <0 or 1 boundary markers>"),
        ("x 2\n", "line 1: 'x 2'"),
        ("0 2 0 0\n", ": the vertices are in a separate .node file; copy its lines in place of the first line"),
        ("1 3\n1 0 0 0\n", "line 1"),
        ("2 2\n1 0 0\n", "line 1"),
        ("1 2\n1 0\n", "line 2"),
        ("1 2\n1 0 a\n", "line 2: '1 0 a'"),
        ("1 2\n1 0 inf\n", "line 2: '1 0 inf'"),
        ("2 2\n1 0 0\n3 0 0\n", "line 3: vertex 3"),
        ("1 2\n1 0 0\n", ": the file ends before a header; write <segments> <0 or 1 boundary markers>"),
        ("1 2\n1 0 0\n1\n1 1 2\n", "vertex 2"),
        ("1 2\n1 0 0\n1\n1 1 0.5\n", "line 4"),
        ("3 2\n1 0 0\n2 1 0\n3 0 1\n3\n1 1 2\n2 2 3\n3 3 1\n1\n1 5 5\n", "hole 1, (5, 5)"),
        ("3 2\n1 0 0\n2 4 0\n3 0 4\n3\n1 1 2\n2 2 3\n3 3 1\n1\n1 1 1\n", "hole 1, (1, 1)"),
    ],
)
def test_bad_poly(text, message):
    error = error_of(text, "a.poly")
    assert error.startswith("a.poly")
    assert message in error
