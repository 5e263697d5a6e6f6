"""Tetrahedra, triangles and edges in space, read back by readers of the tests' own."""

from base64 import b64decode
from xml.etree import ElementTree

import numpy as np
import pytest

import vorotool
from support.readers.written import bytes_of
from support.refusals import refused
from vorotool.formats.results.meshes import write_solid

POINTS = np.random.default_rng(1).random((60, 3))
MESH = vorotool.delaunay(POINTS)


def written(mesh, fmt, what):
    return bytes_of(write_solid, mesh, fmt, what=what)


def read_vtu(data):
    kinds = {"Int64": "<i8", "Float64": "<f8", "Int32": "<i4", "UInt8": "u1"}
    arrays = {}
    root = ElementTree.fromstring(data)
    for item in root.iter("DataArray"):
        raw = b64decode(item.text.strip())
        assert int.from_bytes(raw[:8], "little") == len(raw) - 8
        arrays[item.get("Name")] = np.frombuffer(raw[8:], kinds[item.get("type")])
    piece = root.find("UnstructuredGrid/Piece")
    assert int(piece.get("NumberOfPoints")) * 3 == len(arrays["Points"])
    assert int(piece.get("NumberOfCells")) == len(arrays["types"])
    return arrays


def read_ply(data):
    head, body = data.split(b"end_header\n", 1)
    counts = [int(line.split()[2]) for line in head.decode().splitlines() if line.startswith("element")]
    vertices = np.frombuffer(body, [("xyz", "<f8", 3), ("label", "<i4")], counts[0])
    faces = np.frombuffer(body[vertices.nbytes :], [("n", "u1"), ("corners", "<i4", 3)])
    assert len(faces) == counts[1]
    return vertices, faces


@pytest.mark.parametrize(("what", "kind"), [("tetrahedra", 10), ("triangles", 5), ("hull", 5), ("edges", 3)])
def test_vtu_holds_all_parts(what, kind):
    corners = getattr(MESH, what)
    arrays = read_vtu(written(MESH, "vtu", what))
    assert arrays["Points"].reshape(-1, 3).tolist() == POINTS.tolist()
    assert arrays["connectivity"].reshape(corners.shape).tolist() == corners.tolist()
    assert arrays["offsets"].tolist() == list(range(corners.shape[1], corners.size + 1, corners.shape[1]))
    assert set(arrays["types"]) == {kind}
    assert arrays["label"].tolist() == list(range(1, 61))


def test_text_of_large_arrays_is_in_one_piece():
    many = np.random.default_rng(2).random((40_000, 3))  # blocks of text have to fit together
    mesh = vorotool.Tetrahedralization(
        many, np.arange(40_000).reshape(-1, 4), np.full((10_000, 4), -1), np.zeros((0, 3)), np.arange(40_000)
    )
    arrays = read_vtu(written(mesh, "vtu", "tetrahedra"))
    assert np.array_equal(arrays["Points"].reshape(-1, 3), many)
    assert np.array_equal(arrays["connectivity"], np.arange(40_000))


def test_ply_holds_vertices_with_labels_and_faces():
    vertices, faces = read_ply(written(MESH, "ply", "hull"))
    assert vertices["xyz"].tolist() == POINTS.tolist()
    assert vertices["label"].tolist() == list(range(1, 61))
    assert faces["corners"].tolist() == MESH.hull.tolist()
    assert set(faces["n"]) == {3}


def test_stl_is_closed_and_its_normals_go_outwards():
    data = written(MESH, "stl", "hull")
    assert int.from_bytes(data[80:84], "little") == len(MESH.hull)
    rows = np.frombuffer(data[84:], [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    assert np.array_equal(rows["corners"], POINTS.astype("f4")[MESH.hull])
    middle = POINTS.mean(axis=0)
    assert (np.einsum("ij,ij->i", rows["normal"], rows["corners"][:, 0] - middle) > 0).all()
    assert np.allclose(np.linalg.norm(rows["normal"], axis=1), 1)


def test_stl_says_what_single_precision_loses():
    close = np.vstack([POINTS, POINTS[:1] + 1e-12])
    with pytest.warns(vorotool.VorotoolWarning, match="corners coincide"):
        written(vorotool.delaunay(close), "stl", "triangles")
    refused(vorotool.InputError, r"up to 3\.4e38", written, vorotool.delaunay(POINTS * 1e39), "stl", "hull")


def test_ply_refuses_labels_that_it_cannot_hold():
    mesh = vorotool.delaunay(vorotool.VolumePoints(POINTS, np.arange(60) + 2**31))
    refused(vorotool.InputError, "PLY holds labels up to 2147483647", written, mesh, "ply", "hull")


@pytest.mark.parametrize(("what", "kind"), [("hull", "f"), ("triangles", "f"), ("edges", "l")])
def test_obj_numbers_vertices_from_1(what, kind):
    lines = [line.split() for line in written(MESH, "obj", what).decode().splitlines()]
    vertices = [list(map(float, line[1:])) for line in lines if line[0] == "v"]
    assert vertices == POINTS.tolist()
    rows = [[int(word) - 1 for word in line[1:]] for line in lines if line[0] == kind]
    assert rows == getattr(MESH, what).tolist()
    assert len(vertices) + len(rows) == len(lines)


def test_write_chooses_what_a_format_is_for(tmp_path):
    for fmt, what in (("vtu", "tetrahedra"), ("ply", "hull"), ("stl", "hull"), ("obj", "hull")):
        vorotool.write(MESH, tmp_path / f"mesh.{fmt}")
        assert (tmp_path / f"mesh.{fmt}").read_bytes() == written(MESH, fmt, what)
    vorotool.write(MESH, tmp_path / "rows.npy", what="tetrahedra")
    assert np.load(tmp_path / "rows.npy").tolist() == MESH.tetrahedra.tolist()
