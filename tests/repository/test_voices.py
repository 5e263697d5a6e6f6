"""Messages of the library name parameters and functions; the command line reads them as options and commands.

`errors.option` has both readings. A flag in any other text of the rooms that Python calls would reach its users.
"""

import ast
import re
import warnings
from pathlib import Path

import numpy as np
import pytest

import vorotool
from vorotool.errors import VorotoolError, VorotoolWarning

PACKAGE = Path(vorotool.__file__).parent
ROOMS = ("engines", "geometry", "formats", "products", "render")
MODULES = [
    *(path for room in ROOMS for path in sorted((PACKAGE / room).rglob("*.py"))),
    *(PACKAGE / "jobs" / f"{name}.py" for name in ("writing", "pictures")),
]
"""What public functions call: `batch`, and the rest of `jobs`, speak to the command line alone."""

FLAG = re.compile(r"(?<![\w\0-])(?:--[a-z\0][\w-]*|-[a-z]\b(?!-))")
COMMAND = re.compile(r"\bskeleton-(?:exact|approx)\b|--what")
OF_OTHERS = re.compile(r"\b(?:ogr2ogr|inkscape|gs|pdftoppm|iconv|dwg2dxf)\b[^;)]*")
"""Command lines of other programs, which have flags of their own."""


def _texts(tree):
    """Texts that are neither docstrings nor in a call of ``option``; what an f-string holds is a null there."""
    if isinstance(tree, ast.Call) and isinstance(tree.func, ast.Name) and tree.func.id == "option":
        return
    if isinstance(tree, ast.Expr) and isinstance(tree.value, ast.Constant):
        return
    if isinstance(tree, ast.JoinedStr):
        yield tree.lineno, "".join(part.value if isinstance(part, ast.Constant) else "\0" for part in tree.values)
        for part in tree.values:
            if isinstance(part, ast.FormattedValue):
                yield from _texts(part.value)
        return
    if isinstance(tree, ast.Constant) and isinstance(tree.value, str):
        yield tree.lineno, tree.value
    for child in ast.iter_child_nodes(tree):
        yield from _texts(child)


def _flags(source):
    for line, text in _texts(ast.parse(source)):
        rest = OF_OTHERS.sub("", text)
        commands = COMMAND.findall(rest) if " " in rest else []  # tables have names of commands
        for found in (*FLAG.findall(rest), *commands):
            yield line, found


@pytest.mark.parametrize("path", MODULES, ids=lambda path: str(path.relative_to(PACKAGE)))
def test_no_text_has_a_flag_outside_of_option(path):
    assert list(_flags(path.read_text(encoding="utf-8"))) == []


@pytest.mark.parametrize(
    ("source", "expected"),
    [
        ('raise InputError(f"{n} points: use --window X")', ["--window"]),
        ('raise InputError("use " + ("--strict" if x else f"{y} or -f svg"))', ["--strict", "-f"]),
        ('note("skeleton-exact reads it")', ["skeleton-exact"]),
        ("def f(option='-o'): pass", ["-o"]),
        ("raise InputError(f\"use {option('--window X', 'window=x')}, {n}-bit, -1, 3-D, run-time\")", []),
        ('"""Like ``--strict``."""', []),
        ('raise InputError(f"ogr2ogr -f GeoJSON {a} {b}")', []),
    ],
)
def test_flags_are_found(source, expected):
    assert [found for _, found in _flags(source)] == expected


def test_no_public_name_is_at_home_where_messages_have_flags():
    homes = {home for name, home in vorotool._HOME.items()}
    spoken = {f"vorotool.{'.'.join(path.relative_to(PACKAGE).with_suffix('').parts)}" for path in MODULES}
    spoken |= {name.removesuffix(".__init__") for name in spoken} | {"vorotool.errors"}
    assert homes <= spoken


PHOTO = np.random.default_rng(1).integers(0, 256, (40, 40)).astype(np.uint8)
COLOUR = np.random.default_rng(2).integers(0, 256, (9, 9, 3)).astype(np.uint8)
SQUARE = [[0, 0], [4, 0], [4, 4], [0, 4]]
EMPTY = np.zeros((4, 4), np.uint8)


def _written(name, text):
    path = Path("build") / name
    path.parent.mkdir(exist_ok=True)
    path.write_text(text, encoding="utf-8")
    return path


MISUSES = [
    (lambda: vorotool.tessellate([[-1, 2], [3, 4]]), "use window=(x, y, w, h), or voronoi_cells"),
    (lambda: vorotool.tessellate([[1, 2]], shape=(0, 4)), "use shape=(H, W)"),
    (lambda: vorotool.tessellate([[1, 2]], window=(2**60, 0, 3, 3)), "use a nearer window"),
    (lambda: vorotool.tessellate([[1, 2]], shape=(9, 9), max_pixels=5), "more than max_pixels=5"),
    (
        lambda: vorotool.tessellate(vorotool.PointSet([[1, 2]], [300]), shape=(9, 9), dtype="uint8"),
        'use dtype="uint32"',
    ),
    (lambda: vorotool.tessellate([[1.5, 2]], shape=(9, 9), method="propagation"), 'use method="exact"'),
    (lambda: vorotool.tessellate([[20, 2]], shape=(9, 9), method="propagation"), "use a larger shape or window"),
    (
        lambda: vorotool.seeds_from_raster(COLOUR),
        "use threshold=T (of seeds_from_raster, seeds_from_volume and outlines)",
    ),
    (lambda: vorotool.seeds_from_raster(PHOTO), 'or mode="labels" if these are labels'),
    (lambda: vorotool.seeds_from_raster(PHOTO / 7.0), 'use threshold="otsu"'),
    (lambda: vorotool.seeds_from_raster(np.array([[0.0, np.nan]])), "use threshold=T"),
    (lambda: vorotool.seeds_from_raster(np.array([[0, 2**40, 7]])), "use threshold=T"),
    (lambda: vorotool.seeds_from_raster(EMPTY), "use invert=True or threshold=T"),
    (lambda: vorotool.seeds_from_raster(EMPTY, strict=True), "leave out strict=True"),
    (lambda: vorotool.seeds_from_raster(EMPTY + 1, mode="pixels", max_sites=3), 'use mode="centroids", or a larger'),
    (lambda: vorotool.seeds_from_raster(np.diag([1, 2, 3]), mode="centroids", max_sites=2), "more than max_sites=2"),
    (lambda: vorotool.seeds_from_points(vorotool.PointSet([[1 / 3, 0]]), strict=True), "leave out strict=True"),
    (
        lambda: vorotool.seeds_from_points(vorotool.PointSet([[1, 0], [2, 0]], [1, 1], {"a": [1, 2]})),
        "use properties=False",
    ),
    (lambda: vorotool.delaunay([[1, 1], [1, 1]], strict=True), "leave out strict=True"),
    (lambda: vorotool.outlines(EMPTY + 1, max_sites=2), "more than max_sites=2"),
    (lambda: vorotool.outlines(np.full((3, 3), np.inf), outline="contour", threshold=1), 'use outline="crack"'),
    (lambda: vorotool.compare_digital(vorotool.seeds_from_raster(EMPTY + 1)), "seeds_from_raster, or digital_"),
    (lambda: vorotool.planar_graph([[0, 0], [4, 4], [4, 0], [0, 4]], strict=True), "leave out strict=True"),
    (lambda: vorotool.alpha_shape(SQUARE, alpha=0.1), "use r=10"),
    (lambda: vorotool.alpha_shape(SQUARE, alpha=0), "for the convex hull use r=inf"),
    (lambda: vorotool.alpha_hull(vorotool.alpha_shape(SQUARE, r=np.inf)), "use delaunay(points).hull"),
    (lambda: vorotool.alpha_shape([[1, 1], [2, 1]]), "give r itself"),
    (lambda: vorotool.skeleton_exact(vorotool.read(_written("v.wkt", "LINESTRING (0 0, 1 1)"))), 'side="exterior"'),
    (lambda: vorotool.read(_written("v.csv", "1,2,3\n4,5,6\n")), 'for example columns="'),
    (lambda: vorotool.read(_written("w.csv", "x,y\n1,2\n"), columns="x,x"), "columns is 'x,x'"),
    (lambda: vorotool.read(_written("w.csv", "x,y\n1,2\n"), columns="x,z"), "correct columns"),
    (lambda: vorotool.read(_written("w.csv", "x,y\n1,2\n"), max_sites=0), "raise max_sites"),
    (lambda: vorotool.read(_written("w.csv", "x,y\n1,2\n"), to_crs="EPSG:3857"), "say which it is in with crs"),
    (lambda: vorotool.read(_written("w.csv", "x,y\n1,2\n"), layer="a"), "layer is for files of several layers"),
    (lambda: vorotool.read("data/blobs.png", page=3), "there is no page=3"),
    (lambda: vorotool.read("data/dots.csv", input_format="doc"), "invalid input_format 'doc'"),
    (lambda: vorotool.write(vorotool.delaunay(SQUARE), "build/v.csv", precision=99), "precision is 99"),
    (lambda: vorotool.write(vorotool.tessellate([[1, 1]], shape=(99, 99)), "build/none/v.tif"), "create the directory"),
    (lambda: vorotool.write(vorotool.tessellate([[1, 1]], shape=(2, 20001)), "build/v.txt"), "the path labels.png"),
    (lambda: vorotool.write(vorotool.tessellate([[1, 1]], shape=(1999, 999)), "build/v.svg"), 'use fmt="png"'),
]
"""Misuses of public functions, and words of what they say."""


@pytest.mark.parametrize(("misuse", "words"), MISUSES, ids=[words for _, words in MISUSES])
def test_misuses_are_told_in_parameters(misuse, words):
    with warnings.catch_warnings():
        warnings.simplefilter("error", VorotoolWarning)
        with pytest.raises((VorotoolError, VorotoolWarning)) as caught:
            misuse()
    said = str(caught.value)
    assert words in said
    assert not FLAG.search(said)
    assert "\ufdd0" not in said


def test_notes_are_told_in_parameters():
    said = []
    vorotool.seeds_from_raster(np.array([[0, 7]]), note=said.append)
    vorotool.outlines(np.array([[0, 255]], np.uint16), note=said.append)
    vorotool.read(_written("v.geojson", '{"type": "Point", "coordinates": [1.5, 2]}'), note=said.append)
    assert [any(word in line for line in said) for word in ('mode="components"', 'mode="labels"', "crs=")] == [True] * 3
    assert not any(FLAG.search(line) or "\ufdd0" in line for line in said)
