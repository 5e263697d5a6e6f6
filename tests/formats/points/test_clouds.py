"""Points from PLY, OBJ, XYZ, LAS and LAZ, against files that were packed by hand or by laspy."""

import io
import struct

import laspy
import numpy as np
import pyproj
import pytest

import vorotool
from support.readers.written import bytes_of
from support.refusals import refused
from vorotool.errors import InputError, LimitError
from vorotool.numeric.crs import crs_member, same_crs

RNG = np.random.default_rng(25)
PLACES = np.concatenate([RNG.normal(0, 1e3, (40, 3)), RNG.integers(-9, 9, (10, 3)).astype(float)])
REDS = np.arange(50) % 7


def read(tmp_path, name, data, **options):
    """Points in space, and those in the plane with the notes on them."""
    path = tmp_path / name
    path.write_bytes(data)
    notes = []
    plane = vorotool.read(path, note=notes.append, **options)
    space = vorotool.read(path, geometry="space", **options)
    assert np.array_equal(plane.xy, space.xyz[:, :2])
    assert [note for note in notes if "z is ignored" in note] == [note for note in notes if name in note] != []
    return plane, space


def ply(order, *, doubles=True, before=b""):
    """A PLY file with a color in front of the coordinates, a list behind them, and other rows before them."""
    kind = "double" if doubles else "float32"
    lines = ["ply", f"format {order} 1.0", "comment element vertex 99", "obj_info none"]
    lines += ["element range 2", "property short low", "property double high"] if before else []
    lines += [f"element vertex {len(PLACES)}", "property uchar red", *(f"property {kind} {axis}" for axis in "xyz")]
    lines += ["element face 1", "property list uchar int vertex_indices", "end_header", ""]
    head = "\n".join(lines).encode()
    if order == "ascii":
        rows = [f"{red} {' '.join(map(repr, place))}\n" for red, place in zip(REDS, PLACES.tolist(), strict=True)]
        return head + (b"1 2.5\n3 4.5\n" if before else b"") + "".join(rows).encode() + b"3 0 1 2\n"
    mark = "<" if "little" in order else ">"
    rows = [
        struct.pack(f"{mark}B3{'d' if doubles else 'f'}", red, *place) for red, place in zip(REDS, PLACES, strict=True)
    ]
    extra = struct.pack(f"{mark}hdhd", 1, 2.5, 3, 4.5) if before else b""
    return head + extra + b"".join(rows) + struct.pack(f"{mark}B3i", 3, 0, 1, 2)


@pytest.mark.parametrize("before", [b"", b"range"])
@pytest.mark.parametrize("order", ["ascii", "binary_little_endian", "binary_big_endian"])
def test_vertices_of_ply_have_their_columns(tmp_path, order, before):
    plane, space = read(tmp_path, "a.ply", ply(order, before=before))
    assert np.array_equal(space.xyz, PLACES)
    assert plane.properties["red"] == REDS.tolist()
    assert plane.properties["z"] == PLACES[:, 2].tolist()


def test_single_precision_of_ply_is_kept(tmp_path):
    _, space = read(tmp_path, "a.ply", ply("binary_big_endian", doubles=False))
    assert np.array_equal(space.xyz, PLACES.astype(np.float32).astype(float))


def test_lines_of_ply_may_end_otherwise(tmp_path):
    for end in (b"\r\n", b"\r"):
        _, space = read(tmp_path, "a.ply", ply("ascii").replace(b"\n", end))
        assert np.array_equal(space.xyz, PLACES)


@pytest.mark.parametrize("fmt", ["ply", "obj"])
def test_what_is_written_is_read(tmp_path, fmt):
    mesh = vorotool.delaunay(PLACES)
    vorotool.write(mesh, tmp_path / f"a.{fmt}", what="hull")
    assert np.array_equal(vorotool.read(tmp_path / f"a.{fmt}", geometry="space").xyz, PLACES)


def test_labels_of_ply_come_back(tmp_path):
    labels = RNG.permutation(50) + 7
    mesh = vorotool.delaunay(PLACES)
    vorotool.write(mesh, tmp_path / "a.ply", what="hull")
    data = (tmp_path / "a.ply").read_bytes()
    begin = data.index(b"end_header\n") + len(b"end_header\n")
    rows = np.frombuffer(data, [("xyz", "<f8", 3), ("label", "<i4")], 50, begin).copy()
    rows["label"] = labels
    plane, _ = read(tmp_path, "b.ply", data[:begin] + rows.tobytes() + data[begin + rows.nbytes :])
    assert plane.labels.tolist() == labels.tolist()


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (ply("binary_little_endian")[:-200], "holds 4"),
        (ply("ascii")[:-300], "follow"),
        (ply("ascii").replace(b"end_header", b"end_here"), "end_header"),
        (ply("ascii").replace(b"element vertex 50", b"element vertices 50"), "no element vertex"),
        (ply("ascii").replace(b"property uchar red", b"property list uchar int red"), "lists"),
        (ply("ascii").replace(b"property uchar red", b"property color red"), "line 6: 'property color red'"),
        (ply("ascii").replace(b"property double z", b"property double w"), "z"),
        (ply("ascii").replace(b"element vertex 50", b"element vertex 5000000000"), "5000000000"),
    ],
)
def test_damaged_ply_is_refused(tmp_path, data, said):
    (tmp_path / "a.ply").write_bytes(data)
    refused((InputError, LimitError), [said, "a.ply"], vorotool.read, tmp_path / "a.ply", geometry="space")


def test_bad_numbers_of_text_are_named_with_their_line(tmp_path):
    data = ply("ascii")
    line = data[: data.index(b"end_header")].count(b"\n") + 1 + 3
    rows = data.split(b"\n")
    rows[line - 1] = b"1 2 three 4"
    (tmp_path / "a.ply").write_bytes(b"\n".join(rows))
    refused(InputError, f"line {line}: 'three' in y is not a number", vorotool.read, tmp_path / "a.ply")
    (tmp_path / "a.obj").write_bytes(b"# made\nv 1 2 3\nvn 0 0 1\nv 1 zwei 3\n")
    refused(InputError, "line 4: 'zwei' in y is not a number", vorotool.read, tmp_path / "a.obj")


def test_vertices_of_obj(tmp_path):
    lines = ["mtllib a.mtl", "o thing", *(f"v {x!r} {y!r}\t{z!r}" for x, y, z in PLACES.tolist())]
    lines += ["vt 0 0", "vn 0 0 1", "f 1/1/1 2/1/1 3/1/1", "l 1 2", ""]
    for end in ("\n", "\r\n"):
        _, space = read(tmp_path, "a.obj", end.join(lines).encode())
        assert np.array_equal(space.xyz, PLACES)
    assert len(vorotool.read(tmp_path / "a.obj", geometry="space").xyz) == 50


@pytest.mark.parametrize("head", ["", "50\n", "x y z kind\n"])
@pytest.mark.parametrize("mark", [" ", ",", "\t"])
def test_rows_of_xyz(tmp_path, head, mark):
    rows = [mark.join([*map(repr, place), "tree"]) for place in PLACES.tolist()]
    plane, space = read(tmp_path, "a.xyz", (head.replace(" ", mark) + "\n".join(rows)).encode())
    assert np.array_equal(space.xyz, PLACES)
    assert set(plane.properties) == {"z", "kind" if "kind" in head else "column_4"}


@pytest.mark.parametrize("comment", ["water", "", "1 2 3"])
def test_atoms_of_xyz(tmp_path, comment):
    data = f"3\n{comment}\nO 0 0 0.119\nH 0 0.763 -0.477\nH 0 -0.763 -0.477\n".encode()
    plane, space = read(tmp_path, "a.xyz", data)
    assert space.xyz.tolist() == [[0, 0, 0.119], [0, 0.763, -0.477], [0, -0.763, -0.477]]
    assert plane.properties["column_1"] == ["O", "H", "H"]


def cloud(version, point_format, *, system=True):
    """Points of Switzerland, as laspy keeps them."""
    header = laspy.LasHeader(version=version, point_format=point_format)
    header.scales, header.offsets = [0.01, 0.01, 0.001], [2600000, 1200000, 400]
    if system:
        header.add_crs(pyproj.CRS.from_epsg(2056))
    data = laspy.LasData(header)
    data.x, data.y, data.z = (PLACES + header.offsets).T
    data.classification = REDS
    return data


@pytest.mark.parametrize("name", ["a.las", "a.laz"])
@pytest.mark.parametrize(("version", "point_format"), [("1.2", 1), ("1.4", 6)])
def test_points_of_las(tmp_path, name, version, point_format):
    data = cloud(version, point_format)
    plane, space = read(tmp_path, name, bytes_of(data.write, do_compress=name.endswith("z")))
    assert np.array_equal(space.xyz, np.asarray(data.xyz))
    assert plane.properties["classification"] == REDS.tolist()
    assert plane.y_axis == "up"
    assert same_crs(plane.crs, crs_member("EPSG:2056"))


def test_las_without_a_system_has_none_and_damaged_ones_are_refused(tmp_path):
    out = io.BytesIO()
    cloud("1.2", 1, system=False).write(out)
    assert read(tmp_path, "a.las", out.getvalue())[0].crs is None
    (tmp_path / "b.las").write_bytes(out.getvalue()[:-100])
    refused(InputError, r"b\.las", vorotool.read, tmp_path / "b.las")


def test_points_are_counted_before_they_are_read(tmp_path):
    for name, data in (("a.las", bytes_of(cloud("1.2", 1).write)), ("a.ply", ply("ascii"))):
        (tmp_path / name).write_bytes(data)
        refused(LimitError, "50 points", vorotool.read, tmp_path / name, max_sites=49)
