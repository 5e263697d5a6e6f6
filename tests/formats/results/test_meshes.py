"""Edges and triangles in every format, read back by other libraries and by small readers of our own."""

from __future__ import annotations

import json

import numpy as np
import orjson
import pytest
import shapely

import vorotool
from support.families.point_families import draw
from support.few import few
from support.readers.written import streamed
from support.readers.written import written as written_as
from vorotool import PointSet, delaunay
from vorotool.products.registry import PRODUCTS

pytestmark = pytest.mark.filterwarnings("ignore::vorotool.VorotoolWarning")
NAMES = ["uniform", "grid", "duplicates", "collinear", "small_lattice", "tiny_y"]


def written(mesh, fmt, what="edges", **options):
    return written_as(mesh, fmt, what, **options)


def numbers_of(data):
    """Numbers of each line."""
    return [[float(field) for field in line.split()] for line in data.decode().splitlines()]


def labelled(mesh, rows):
    return mesh.label_array[rows].tolist()


@pytest.fixture(params=NAMES)
def mesh(request):
    points = draw(request.param, 70, 6)
    labels = np.random.default_rng(1).permutation(len(points)) + 1000
    return delaunay(PointSet(points, labels=labels))


@pytest.mark.parametrize("what", ["edges", "triangles"])
def test_geojson_is_what_shapely_reads(mesh, what):
    document = orjson.loads(written(mesh, "geojson", what))
    features, rows = document["features"], mesh.edges if what == "edges" else mesh.triangles
    assert [feature["id"] for feature in features] == list(range(1, len(rows) + 1))
    shapes = [shapely.geometry.shape(feature["geometry"]) for feature in features]
    if what == "edges":
        assert [list(map(list, shape.coords)) for shape in shapes] == mesh.points[rows].tolist()
    else:
        assert all(shape.exterior.is_ccw or shape.area == 0 for shape in shapes)
        assert [list(map(list, shape.exterior.coords))[:3] for shape in shapes] == mesh.points[rows].tolist()
        assert all(ring[0] == ring[3] for feature in features for ring in feature["geometry"]["coordinates"])
    names = ["label_a", "label_b", "label_c"][: rows.shape[1]]
    assert [[feature["properties"][name] for name in names] for feature in features] == labelled(mesh, rows)
    assert "crs" not in document


def test_obj_holds_points_and_elements(mesh):
    for what, letter, rows in (("edges", "l", mesh.edges), ("triangles", "f", mesh.triangles)):
        lines = [line.split() for line in written(mesh, "obj", what).decode().splitlines()]
        vertices = [list(map(float, rest)) for kind, *rest in lines if kind == "v"]
        assert vertices == [[x, y, 0] for x, y in mesh.points.tolist()]
        assert [[int(k) - 1 for k in rest] for kind, *rest in lines if kind == letter] == rows.tolist()
        assert len(lines) == len(mesh.points) + len(rows)


@pytest.mark.parametrize("first", [0, 1])
def test_files_of_triangle(mesh, first, tmp_path):
    mesh = vorotool.delaunay(PointSet(mesh.points, first_number=first))
    (count, markers), *edges = numbers_of(written(mesh, "edge"))
    assert (count, markers) == (len(mesh.edges), 1)
    assert [row[0] for row in edges] == list(range(first, len(edges) + first))
    assert [row[1:3] for row in edges] == (mesh.edges + first).tolist()
    assert [row[3] for row in edges] == mesh.hull_edges.tolist()
    header, *triangles = numbers_of(written(mesh, "ele", "triangles"))
    assert header == [len(mesh.triangles), 3, 0]
    assert [row[1:] for row in triangles] == (mesh.triangles + first).tolist()
    (tmp_path / "a.node").write_bytes(written(mesh, "node", "table"))
    again = vorotool.read(tmp_path / "a.node")
    np.testing.assert_array_equal(again.xy, mesh.points)
    assert again.first_number == (first if len(again) else 1)


def test_nothing_and_little():
    for points, edges in ([[]] * 0, 0), ([[1, 2]], 0), ([[1, 2], [3, 4]], 1):
        mesh = delaunay(np.reshape(points, (-1, 2)))
        for what in ("edges", "triangles"):
            count = edges if what == "edges" else 0
            for fmt in streamed(PRODUCTS["delaunay"][what]):
                data = written(mesh, fmt, what)
                if fmt == "geojson":
                    assert len(json.loads(data)["features"]) == count
                elif fmt == "json":
                    assert len(json.loads(data)) == count
                elif fmt == "csv":
                    assert data.count(b"\n") == count + 1
                elif fmt in ("ele", "edge"):
                    assert data.split()[0] == b"%d" % count


@pytest.mark.parametrize("what", few(["edges", "triangles"], 1))
def test_the_same_bytes_for_any_threads(what):
    many, few = (delaunay(draw("uniform", count, 7)) for count in (12_000, 300))
    for fmt in streamed(PRODUCTS["delaunay"][what]):
        mesh = few if fmt in ("gpkg", "fgb", "parquet", "dxf") else many  # libraries write these, on one thread
        assert len({written(mesh, fmt, what, threads=threads) for threads in (1, 3)}) == 1
