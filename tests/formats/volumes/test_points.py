"""Points with a z, of all formats that have one."""

import json

import numpy as np
import pytest
import shapely

import vorotool
from support.families.geojson import collection
from support.refusals import refused
from vorotool.errors import InputError, LimitError, UsageError
from vorotool.formats.volumes.opening import read_xyz

XYZ = [[1.5, 2, 3], [4, 5, 6.25], [0, 0, 9]]
LABELS = [7, 9, 7]


def points_of(places):
    return collection(
        [{"type": "Point", "coordinates": place} for place in places], [{"n": k} for k, _ in enumerate(places)]
    )


def rows(*names):
    columns = {"x": 0, "y": 1, "z": 2}
    return [[LABELS[k] if name not in columns else XYZ[k][columns[name]] for name in names] for k in range(3)]


def text(*names, by=",", header=True):
    lines = [by.join(map(str, row)) for row in rows(*names)]
    return "\n".join([by.join(names), *lines] if header else lines) + "\n"


@pytest.mark.parametrize(
    ("name", "data", "columns", "has_labels"),
    [
        ("a.csv", text("x", "y", "z"), None, False),
        ("a.csv", text("label", "z", "y", "x"), None, True),
        ("a.csv", text("x", "y", "z", "kind"), None, False),
        ("a.tsv", text("x", "kind", "y", "z", by="\t"), "x,y,kind", True),
        ("a.csv", text("x", "y", "z", "kind", by=";"), "x,y,z=z,kind", True),
        ("a.txt", text("x", "y", "z", by=" ", header=False), "1,2,z=3", False),
        ("a.txt", text("z", "x", "y", "k", by=" ", header=False), "2,3,Z=1,4", True),
        ("a.csv", text("x", "y", "z").replace("x,y,z", "centroid-2,centroid-1,centroid-0"), None, False),
        ("a.json", json.dumps(XYZ), None, False),
        ("a.json", json.dumps([dict(zip("xyz", row, strict=True)) for row in XYZ]), None, False),
        ("a.jsonl", "\n".join(json.dumps(dict(zip("xyz", row, strict=True))) for row in XYZ), "x,y,z=z", False),
        ("a.geojson", points_of(XYZ), None, False),
        ("a.wkt", "\n".join(f"POINT Z ({x} {y} {z})" for x, y, z in XYZ), None, False),
        ("a.csv", "wkt\n" + "\n".join(f'"POINT Z ({x} {y} {z})"' for x, y, z in XYZ), None, False),
        ("a.wkb", shapely.to_wkb(shapely.multipoints(shapely.points(XYZ))), None, False),
    ],
)
def test_formats(tmp_path, name, data, columns, has_labels):
    path = tmp_path / name
    path.write_bytes(data if isinstance(data, bytes) else data.encode())
    points = read_xyz(path, columns=columns)
    assert points.xyz.tolist() == XYZ
    assert (points.labels is not None) == has_labels
    assert not has_labels or points.labels.tolist() == LABELS
    assert read_xyz(path, columns=columns, properties=False).properties == {}
    refused(LimitError, "3 points", read_xyz, path, columns=columns, max_sites=2)


@pytest.mark.parametrize("base", [0, 1])
def test_nodes_of_tetgen(tmp_path, base):
    lines = [f"{base + k} {x} {y} {z} {k / 2} {k}" for k, (x, y, z) in enumerate(XYZ)]
    path = tmp_path / "a.node"
    path.write_text("\n".join(["# of TetGen", "3 3 1 1", *lines, "# end"]))
    points = read_xyz(path)
    assert (points.xyz.tolist(), points.label_array.tolist()) == (XYZ, [1, 2, 3])
    assert points.properties == {"attribute_1": ["0.0", "0.5", "1.0"], "boundary_marker": ["0", "1", "2"]}
    path.write_text("1\n1 2 3 4\n")
    assert vorotool.read(path, geometry="space").xyz.tolist() == [[2, 3, 4]]
    refused(LimitError, "1 points", read_xyz, path, max_sites=0)
    path.write_text("1 2 0 0\n1 2 3\n")
    refused(InputError, "line 1", read_xyz, path)
    path.write_text("1 3 0 2\n1 2 3 4 5 6\n")
    refused(InputError, "write <vertices> 3 <attributes>", read_xyz, path)


def test_npz_and_npy(tmp_path):
    table = np.array(XYZ)
    np.savez(tmp_path / "a.npz", x=table[:, 0], y=table[:, 1], z=table[:, 2], n=np.arange(3))
    points = read_xyz(tmp_path / "a.npz")
    assert (points.xyz.tolist(), points.properties) == (XYZ, {"n": [0, 1, 2]})
    np.save(tmp_path / "a.npy", table)
    assert read_xyz(tmp_path / "a.npy", columns="1,2,z=3").xyz.tolist() == XYZ
    assert vorotool.read(tmp_path / "a.npy", geometry="space", columns="1,2,z=3").xyz.tolist() == XYZ
    for columns, error, words in (
        ("1,2", UsageError, "names no z"),
        ("1,2,z=4", InputError, "has 3 columns without names: there is no column '4'"),
        ("x,y,z=z", InputError, "there is no column 'x'"),
        ("1,2,z=2", UsageError, "name X,Y,z=Z"),
        ("01,2,z=1", InputError, "names one column twice"),
    ):
        refused(error, words, read_xyz, tmp_path / "a.npy", columns=columns)
    np.save(tmp_path / "b.npy", np.column_stack([LABELS, table]))
    points = read_xyz(tmp_path / "b.npy", columns="2,3,1,z=4")
    assert (points.xyz.tolist(), points.labels.tolist()) == (XYZ, LABELS)
    table[1, 2] = np.nan
    np.save(tmp_path / "a.npy", table)
    refused(InputError, r"a.npy, row 2", read_xyz, tmp_path / "a.npy", columns="1,2,z=3")
    np.save(tmp_path / "a.npy", table[:, :2])
    with pytest.raises(InputError, match=r"holds float64 of shape \(3, 2\): points with a z are an \(n, 3\) array"):
        read_xyz(tmp_path / "a.npy", columns="1,2,z=3")


@pytest.mark.parametrize(
    ("name", "data", "columns", "words"),
    [
        ("a.csv", "x,y\n1,2\n", None, r"no columns recognized as x, y and z; name them with columns=\"X,Y,z=Z\""),
        ("a.csv", "1,2,3,4\n", None, "no columns recognized as x, y and z"),
        ("a.csv", "a,b,c\n1,2,3\n", "a,b", "no columns recognized as x, y and z"),
        ("a.csv", "a,b,c\n1,2,3\n", "a,b,z=d", "'d'"),
        ("a.csv", "a,b,c\n1,2,3\n", "1,2,z=a", "names one column twice"),
        ("a.csv", "x,y,z\n1,2,nan\n", None, r"a.csv, line 2: 'nan' in column 3 \(z\)"),
        ("a.csv", "x,y,z\n1,2,\n", None, "is empty; fill in a number"),
        ("a.json", "[[1, 2]]", None, r"point 1: \[1"),
        ("a.json", "[[1, 2, 3, 4]]", None, r"has 4 numbers; write \[x, y, z\]"),
        ("a.geojson", points_of([[1, 2]]), None, "is not three finite numbers"),
        ("a.wkt", "POINT Z (1 2 3)\nPOINT (4 5)", None, r"a.wkt, line 2: 'POINT \(4 5\)' has no finite z"),
        ("a.wkb", shapely.to_wkb(shapely.Point(1, 2)), None, "feature 1"),
        ("a.node", "1 2 0 0\n1 5 6\n", None, "a.node, line 1"),
    ],
)
def test_what_has_no_z(tmp_path, name, data, columns, words):
    path = tmp_path / name
    path.write_bytes(data if isinstance(data, bytes) else data.encode())
    refused(InputError, [words, name], read_xyz, path, columns=columns)


@pytest.mark.parametrize("columns", ["x", "x,y,z=", "x,y,z=z,z=w", "x,y,z=x", "0,1,z=2", "a,b,c,d,z=e"])
def test_columns_that_are_malformed(tmp_path, columns):
    (tmp_path / "a.csv").write_text(text("x", "y", "z"))
    refused(UsageError, "name X,Y,z=Z or X,Y,z=Z,LABEL", read_xyz, tmp_path / "a.csv", columns=columns)


def test_three_columns_without_names_are_x_y_z(tmp_path):
    np.save(tmp_path / "a.npy", XYZ)
    (tmp_path / "a.csv").write_text("\n".join(",".join(map(str, row)) for row in XYZ))
    for name in ("a.npy", "a.csv"):
        assert read_xyz(tmp_path / name).xyz.tolist() == XYZ
    np.save(tmp_path / "b.npy", np.ones((2, 4)))
    refused(InputError, ["b.npy", "4 columns", 'columns="1,2,z=3"'], read_xyz, tmp_path / "b.npy")


def test_an_image(tmp_path):
    vorotool.write(vorotool.LabelImage(np.ones((3, 4), np.uint8)), tmp_path / "a.png")
    refused(InputError, r"a.png", read_xyz, tmp_path / "a.png")


def test_a_z_stays_a_property_of_points_in_the_plane(tmp_path):
    (tmp_path / "a.csv").write_text(text("x", "y", "z"))
    points = vorotool.read(tmp_path / "a.csv")
    assert points.xy.tolist() == [row[:2] for row in XYZ]
    assert list(points.properties) == ["z"]
    with pytest.raises(UsageError, match="crs does not apply to points in space"):
        vorotool.read(tmp_path / "a.csv", geometry="space", crs="EPSG:2056")
