"""JSON lines say what GeoJSON and the JSON of tables say, an object a line."""

import json
import random

import numpy as np
import pytest

import vorotool
from support.families.point_families import draw
from support.readers.written import written
from vorotool.formats.text.json_lines import JsonLines
from vorotool.products.registry import PRODUCTS, parts_of

CRS = {"type": "name", "properties": {"name": "EPSG:3857"}}
POINTS = vorotool.PointSet(draw("uniform", 300, 1), crs=CRS)
SHAPES = vorotool.PolygonSet(
    [[0, 0], [8, 0], [8, 3], [0, 3], [20, 0], [24, 0], [24, 9]],
    [0, 4, 7],
    [0, 0],
    [0, 1],
    ids=["a,\n", None],
    properties={"name": ['"features":[\n', "},\n{"]},
    crs=CRS,
)


def values():
    """Values of several types, all with a reference system."""
    mesh, shape = vorotool.delaunay(POINTS), vorotool.alpha_shape(POINTS)
    skeleton = vorotool.skeleton_exact(SHAPES)
    along = vorotool.points_along(skeleton, every=1)
    lines = (SHAPES, skeleton, vorotool.centerline(skeleton), vorotool.offset(SHAPES, [1, -1]), along)
    return [mesh, vorotool.voronoi_cells(POINTS), shape, vorotool.alpha_hull(shape), vorotool.edge_table(mesh), *lines]


PARTS = [pytest.param(v, each, id=f"{type(v).__name__}-{what}") for v in values() for what, each in parts_of(v).items()]


def lines_of(value, what=None, **options):
    return written(value, "jsonl", what, **options).decode().split("\n")


@pytest.mark.parametrize(("value", "product"), PARTS)
def test_an_object_a_line(value, product):
    *lines, end = lines_of(value, product.what, precision=5)
    assert end == ""
    found = [json.loads(line) for line in lines]
    if "geojson" in product.data:
        expected = json.loads(written(value, "geojson", product.what, precision=5))["features"]
        assert all(each.pop("crs") == CRS for each in found)
        assert {each.pop("y_axis", None) for each in found} <= {"none", None}
    else:
        expected = json.loads(written(value, "json", product.what, precision=5))
    assert found == expected != []


def test_nothing_is_nothing():
    nothing = vorotool.delaunay(np.empty((0, 2)))
    outside = vorotool.skeleton_exact([[0, 0], [1, 0], [0, 1]], side="exterior")
    for value in (nothing, outside, vorotool.edge_table(nothing), vorotool.voronoi_cells(np.empty((0, 2)))):
        assert lines_of(value) == [""]


@pytest.mark.parametrize("threads", [1, 3])
def test_many_slices(threads):
    mesh = vorotool.delaunay(draw("uniform", 12_000, 7))
    *lines, _ = lines_of(mesh, threads=threads)
    assert len(lines) == len(mesh.edges) == len(set(lines))
    assert json.loads(lines[-1]) == {"y_axis": "none", **vorotool.to_geojson(mesh)["features"][-1]}


def test_parts_of_any_length():
    text, out, chance = written(SHAPES, "geojson"), [], random.Random(1)
    lines = JsonLines(type("Out", (), {"write": staticmethod(out.append)}))
    begin = 0
    while begin < len(text):
        count = chance.randint(0, 40)
        assert lines.write(text[begin : begin + count]) == len(text[begin : begin + count])
        begin += count
    assert b"".join(out) == written(SHAPES, "jsonl")


def test_curves_become_lines(tmp_path):
    bent = vorotool.skeleton_exact([[0, 0], [9, 0], [9, 9], [5, 3], [0, 9]])
    fine, coarse = (written(bent, "jsonl", flatten=tolerance) for tolerance in (1e-3, 1))
    assert fine.count(b"[") > 2 * coarse.count(b"[")
    vorotool.write(bent, tmp_path / "a.ndjson", flatten=1)
    assert (tmp_path / "a.ndjson").read_bytes() == coarse


def test_all_but_images_are_written_so():
    for own in PRODUCTS.values():
        for product in own.values():
            assert ("jsonl" in product.formats) == ("json" in product.data or "geojson" in product.data)
