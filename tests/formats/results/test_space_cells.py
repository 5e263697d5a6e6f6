"""Cells in space in files, read back by parsers of their own."""

import base64
import io
from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryDirectory
from xml.etree import ElementTree

import numpy as np
import pytest

import vorotool
from support.refusals import refused
from vorotool import InputError

CELLS = vorotool.voronoi_cells(
    vorotool.VolumePoints(np.random.default_rng(3).random((30, 3)), labels=np.arange(101, 131)),
    frame=(0, 0, 0, 0.9, 1, 1),
)
KINDS = {"Int64": "<i8", "Float64": "<f8", "Int32": "<i4", "UInt8": "u1"}


def written(fmt, cells=CELLS, **options):
    with TemporaryDirectory() as folder:
        path = Path(folder, f"cells.{fmt}")
        vorotool.write(cells, path, **options)
        return path.read_bytes()


def volume(places, faces):
    """That of a polyhedron whose faces are counter-clockwise from outside."""
    o = places[faces[0][0]]
    total = 0.0
    for corners in faces:
        a = places[corners[0]] - o
        for j, k in pairwise(corners[1:]):
            total += np.dot(a, np.cross(places[j] - o, places[k] - o)) / 6
    return total


def test_polyhedra_of_vtu():
    root = ElementTree.fromstring(written("vtu"))
    arrays = {}
    for each in root.iter("DataArray"):
        raw = base64.b64decode(each.text)
        assert int.from_bytes(raw[:8], "little") == len(raw) - 8
        arrays[each.get("Name")] = np.frombuffer(raw[8:], KINDS[each.get("type")])
    places = arrays["Points"].reshape(-1, 3)
    piece = next(root.iter("Piece"))
    assert int(piece.get("NumberOfPoints")) == len(places) == len(CELLS.vertices)
    assert int(piece.get("NumberOfCells")) == 30 == len(arrays["types"])
    assert set(arrays["types"].tolist()) == {42}
    assert arrays["label"].tolist() == list(range(101, 131))
    begin = corner = 0
    for cell in range(30):
        end = arrays["faceoffsets"][cell]
        count, *rest = arrays["faces"][begin:end].tolist()
        faces = []
        for _ in range(count):
            size, rest = rest[0], rest[1:]
            faces.append(rest[:size])
            rest = rest[size:]
        assert rest == []
        corners = arrays["connectivity"][corner : arrays["offsets"][cell]].tolist()
        assert sorted({v for face in faces for v in face}) == sorted(corners)
        assert len(set(corners)) == len(corners)
        assert volume(places, faces) == pytest.approx(CELLS.volumes[cell], rel=1e-12)
        assert arrays["volume"][cell] == CELLS.volumes[cell]
        begin, corner = end, arrays["offsets"][cell]
    assert begin == len(arrays["faces"])


def test_faces_of_obj():
    lines = written("obj").decode().splitlines()
    places = np.array([line.split()[1:] for line in lines if line.startswith("v ")], dtype=float)
    np.testing.assert_array_equal(places, CELLS.vertices)
    faces = [[int(v) - 1 for v in line.split()[1:]] for line in lines if line.startswith("f ")]
    assert faces == [CELLS.face(face).tolist() for face in range(len(CELLS.face_cells))]
    groups = [line for line in lines if line.startswith("g ")]
    a, b = CELLS.face_cells[0]
    assert groups[0] == f"g cell_{a + 101} cell_{b + 101}"
    assert any(group.endswith(" side_6") for group in groups)


def test_faces_of_ply():
    head, _, body = written("ply").partition(b"end_header\n")
    assert f"element vertex {len(CELLS.vertices)}" in head.decode()
    assert f"element face {len(CELLS.face_cells)}" in head.decode()
    size = 24 * len(CELLS.vertices)
    np.testing.assert_array_equal(np.frombuffer(body[:size], "<f8").reshape(-1, 3), CELLS.vertices)
    at = size
    for face, (a, b) in enumerate(CELLS.face_cells.tolist()):
        count = body[at]
        values = np.frombuffer(body[at + 1 : at + 9 + 4 * count], "<i4").tolist()
        assert values[:-2] == CELLS.face(face).tolist()
        assert values[-2:] == [a + 101, b + 101 if b >= 0 else b]
        at += 9 + 4 * count
    assert at == len(body)


def test_arrays_of_npz_and_rows_of_csv():
    arrays = np.load(io.BytesIO(written("npz")))
    np.testing.assert_array_equal(np.stack([arrays[f"vertex_{axis}"] for axis in "xyz"], axis=1), CELLS.vertices)
    for name in ("face_starts", "corners", "cell_starts", "cell_faces"):
        np.testing.assert_array_equal(arrays[name], getattr(CELLS, name))
    assert arrays["box"].tolist() == [0, 0, 0, 0.9, 1, 1]
    np.testing.assert_array_equal(arrays["volume"], CELLS.volumes)
    head, first, *_ = written("csv").decode().splitlines()
    assert head == "label,x,y,z,volume,area,faces,neighbors"
    assert first.split(",")[4] == repr(float(CELLS.volumes[0]))


def test_what_ply_cannot_hold_is_refused():
    cells = vorotool.voronoi_cells(vorotool.VolumePoints([[0.5, 0.5, 0.5]], labels=[2**31]), frame=(0, 0, 0, 1, 1, 1))
    refused(InputError, "PLY holds labels up to 2147483647", written, "ply", cells)
