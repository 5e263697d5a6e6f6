"""Edges and triangles in every format, read back by other libraries and by small readers of our own."""

from __future__ import annotations

import io
import json

import numpy as np
import orjson
import pytest
import shapely

import vorotool
from support.families.point_families import draw
from support.readers.written import rows_of, streamed
from support.readers.written import written as written_as
from vorotool import PointSet, UsageError, delaunay
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


def test_edges_as_csv_and_json(mesh):
    rows = rows_of(written(mesh, "csv"))
    assert [[int(row["label_a"]), int(row["label_b"])] for row in rows] == labelled(mesh, mesh.edges)
    found = [[[float(row["x_a"]), float(row["y_a"])], [float(row["x_b"]), float(row["y_b"])]] for row in rows]
    assert found == mesh.points[mesh.edges].tolist()
    assert [float(row["length"]) for row in rows] == mesh.edge_lengths().tolist()
    same = orjson.loads(written(mesh, "json"))
    assert [{name: float(value) for name, value in row.items()} for row in rows] == same


def test_triangles_as_csv_and_json(mesh):
    rows = rows_of(written(mesh, "csv", "triangles"))
    assert [[int(value) for value in row.values()] for row in rows] == labelled(mesh, mesh.triangles)
    assert [list(row.values()) for row in orjson.loads(written(mesh, "json", "triangles"))] == labelled(
        mesh, mesh.triangles
    )


def test_arrays_by_column(mesh):
    arrays = np.load(io.BytesIO(written(mesh, "npz")), allow_pickle=False)
    found = np.stack([arrays["label_a"], arrays["label_b"]], axis=1)
    np.testing.assert_array_equal(found, mesh.label_array[mesh.edges])
    np.testing.assert_array_equal(np.stack([arrays["x_b"], arrays["y_b"]], axis=1), mesh.points[mesh.edges[:, 1]])
    np.testing.assert_array_equal(arrays["length"], mesh.edge_lengths())
    arrays = np.load(io.BytesIO(written(mesh, "npz", "triangles")), allow_pickle=False)
    found = np.stack([arrays[f"label_{corner}"] for corner in "abc"], axis=1)
    np.testing.assert_array_equal(found, mesh.label_array[mesh.triangles])


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


def test_geojson_keeps_the_crs():
    crs = {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::2056"}}
    mesh = delaunay(PointSet([[0, 0], [1, 0], [0, 1]], crs=crs))
    for what in ("edges", "triangles"):
        assert json.loads(written(mesh, "geojson", what))["crs"] == crs


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


def test_decimals_and_lengths_that_no_double_holds():
    mesh = delaunay([[-1.7e308, 0], [1.7e308, 1 / 3]])
    assert written(mesh, "csv").endswith(b",\n")
    assert json.loads(written(mesh, "json"))[0]["length"] is None
    assert json.loads(written(mesh, "geojson"))["features"][0]["properties"]["length"] is None
    for fmt in ("csv", "geojson", "obj"):
        assert b"0.333 " in written(mesh, fmt, decimals=3).replace(b"]", b" ").replace(b",", b" ")


@pytest.mark.parametrize("what", ["edges", "triangles"])
def test_the_same_bytes_for_any_threads(what):
    many, few = (delaunay(draw("uniform", count, 7)) for count in (12_000, 300))
    for fmt in streamed(PRODUCTS["delaunay"][what]):
        mesh = few if fmt in ("gpkg", "fgb", "parquet", "dxf") else many  # libraries write these, on one thread
        assert len({written(mesh, fmt, what, threads=threads) for threads in (1, 3)}) == 1


def test_formats_that_there_are_not():
    mesh = delaunay([[0, 0], [1, 1]])
    with pytest.raises(UsageError, match="'ele'"):
        written(mesh, "ele")
    with pytest.raises(UsageError, match="what='faces' is not"):
        written(mesh, "csv", "faces")
    with pytest.raises(UsageError, match=r"'html'"):
        written(mesh, "html")


def test_library_writes_meshes(tmp_path):
    mesh = delaunay([[0, 0], [4, 0], [0, 3]])
    vorotool.write(mesh, tmp_path / "a.csv")
    assert (tmp_path / "a.csv").read_text().startswith("label_a,label_b,x_a,y_a,x_b,y_b,length\n1,3,0,0,0,3,3\n")
    vorotool.write(mesh, tmp_path / "a.ele")
    assert (tmp_path / "a.ele").read_text() == "1 3 0\n1 1 2 3\n"
    vorotool.write(mesh, tmp_path / "a", fmt="obj", what="triangles")
    assert (tmp_path / "a").read_text().endswith("f 1 2 3\n")
    with pytest.raises(UsageError, match="what='edges' is not a result of a Table"):
        vorotool.write(vorotool.edge_table(mesh), tmp_path / "b.csv", what="edges")
    with pytest.raises(UsageError, match="cannot be written"):
        vorotool.write(mesh, tmp_path / "b.xyz")
    assert not (tmp_path / "b.xyz").exists()
