"""JSON lines say what GeoJSON and the JSON of tables say, an object a line."""

import json

import pytest

import vorotool
from support.families.point_families import draw
from support.few import few
from support.readers.written import written
from vorotool.products.registry import parts_of

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


@pytest.mark.parametrize("threads", few([3, 1], 1))
def test_many_slices(threads):
    mesh = vorotool.delaunay(draw("uniform", 12_000, 7))
    *lines, _ = lines_of(mesh, threads=threads)
    assert len(lines) == len(mesh.edges) == len(set(lines))
    assert json.loads(lines[-1]) == {"y_axis": "none", **vorotool.to_geojson(mesh)["features"][-1]}
