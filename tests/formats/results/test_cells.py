"""Cells in every format, read back by other libraries."""

from __future__ import annotations

import io
import json

import numpy as np
import pytest
import shapely

from support.families.point_families import draw
from support.few import few
from support.readers.sources import read_as
from support.readers.written import streamed, written
from vorotool import PointSet, voronoi_cells
from vorotool.formats.io.sources import Source
from vorotool.products.registry import PRODUCTS

pytestmark = pytest.mark.filterwarnings("ignore::vorotool.VorotoolWarning")
RING = shapely.box(0, 0, 6, 6).difference(shapely.box(1, 2, 5, 4))


def cells_of(name):
    if name == "clipped":  # parts, a hole, and an empty cell
        return voronoi_cells([[3, 1], [3, 3], [3, 5], [100, 3], [3, 3]], clip=RING)
    if name == "holed":
        return voronoi_cells([[3, 3]], clip=RING)
    points = draw(name, 60, 2)
    labels = np.random.default_rng(1).permutation(len(points)) + 1000
    names = [f'cell "{i}", so' for i in range(len(points))]
    return voronoi_cells(PointSet(points, labels=labels, properties={"name": names}, crs={"type": "name"}))


@pytest.fixture(params=["uniform", "duplicates", "collinear", "small_lattice", "tiny_y", "clipped", "holed"])
def cells(request):
    return cells_of(request.param)


def same(found, cells):
    """Whether geometries are the cells, vertex for vertex."""
    right = cells.to_shapely()
    assert len(found) == len(right)
    for a, b in zip(found, right, strict=True):
        assert (a is None or a.is_empty) == b.is_empty
        assert b.is_empty or shapely.equals_exact(a, b)


def test_wkt(cells):
    lines = written(cells, "wkt").decode().splitlines()
    same(shapely.from_wkt(lines), cells)


def test_geojson(cells):
    document = json.loads(written(cells, "geojson"))
    features = document["features"]
    same([each["geometry"] and shapely.geometry.shape(each["geometry"]) for each in features], cells)
    assert [f["id"] for f in features] == cells.label_array.tolist()
    assert all(f["properties"]["label"] == f["id"] for f in features)
    assert document.get("crs") == cells.crs


def test_json_is_read_as_polygons(cells):
    document = json.loads(written(cells, "json"))
    parts = np.diff(cells.nesting.cells).clip(1)
    assert len(document["polygons"]) == parts.sum()
    assert sum(not item["shell"] for item in document["polygons"]) == cells.is_empty.sum()
    polygons = read_as(Source("cells.json", written(cells, "json")))
    rings, starts, _ = cells.nesting
    np.testing.assert_array_equal(polygons.xy, cells.coordinates)
    np.testing.assert_array_equal(polygons.ring_starts, rings)
    np.testing.assert_array_equal(polygons.polygon_starts, starts)
    assert list(dict.fromkeys(polygons.ids)) == cells.label_array[~cells.is_empty].tolist()


def test_npz(cells):
    with np.load(io.BytesIO(written(cells, "npz"))) as file:
        np.testing.assert_array_equal(np.stack([file["vertex_x"], file["vertex_y"]], axis=1), cells.coordinates)
        for name, right in zip(("ring_starts", "polygon_starts", "cell_starts"), cells.nesting, strict=True):
            np.testing.assert_array_equal(file[name], right)
        assert tuple(file["frame"]) == cells.frame.sides
        np.testing.assert_array_equal(file["label"], cells.label_array)


def test_further_columns_and_clashes():
    given = PointSet([[1, 1], [3, 1]], properties={"label": ["a", None], "id": ["p", None], "wkt": [1.5, 2]})
    cells = voronoi_cells(given, frame=(0, 0, 4, 2))
    header, first, _ = written(cells, "csv").decode().splitlines()
    assert header == "voro_label,id,x,y,area,perimeter,voro_wkt,label,wkt"
    assert first == '1,p,1,1,4,8,"POLYGON ((0 0, 2 0, 2 2, 0 2, 0 0))",a,1.5'
    a, b = json.loads(written(cells, "geojson"))["features"]
    assert a["id"] == "p"
    assert "id" not in b
    assert b["properties"] == {"voro_label": 2, "x": 3, "y": 1, "area": 4, "perimeter": 8, "label": None, "wkt": 2}
    items = json.loads(written(cells, "json"))["polygons"]
    assert [item["id"] for item in items] == ["p", None]
    assert items[0]["properties"]["label"] == "a"


def test_parts_share_their_properties():
    given = PointSet([[3, 1], [3, 3], [3, 5]], properties={"name": ["a", "b", "c"]})
    items = json.loads(written(voronoi_cells(given, clip=RING), "json"))["polygons"]
    found = [(item["id"], item["part"], item["properties"]["name"]) for item in items]
    assert found == [(1, 1, "a"), (2, 1, "b"), (2, 2, "b"), (3, 1, "c")]


@pytest.mark.parametrize("fmt", few(streamed(PRODUCTS["delaunay"]["cells"]), 3))
def test_threads_and_slices_change_nothing(fmt):
    by_library = fmt in ("gpkg", "fgb", "parquet", "dxf")  # on one thread
    cells = voronoi_cells(draw("uniform", 300 if by_library else 40_000, 1))
    assert written(cells, fmt, threads=1) == written(cells, fmt, threads=3)
