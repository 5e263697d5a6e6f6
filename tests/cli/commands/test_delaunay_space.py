"""``vorotool delaunay --space``: points with a z, every result, and what is refused."""

import json

import numpy as np
import pytest

import vorotool
from support.readers.written import rows_of

POINTS = np.random.default_rng(3).random((30, 3)).round(3)


@pytest.fixture
def cloud(folder):
    rows = [f"{x},{y},{z},p{number}" for number, (x, y, z) in enumerate(POINTS.tolist())]
    (folder / "cloud.csv").write_text("\n".join(["x,y,z,name", *rows]) + "\n")
    return folder


def test_points_with_a_z_are_triangulated_in_space(run, cloud):
    mesh = vorotool.delaunay(POINTS)
    done = run("delaunay cloud.csv --space --what tetrahedra --verify --stats stats.json")
    found = [[int(row[f"label_{corner}"]) - 1 for corner in "abcd"] for row in done.rows]
    assert found == mesh.tetrahedra.tolist()
    stats = json.loads((cloud / "stats.json").read_text())
    counts = {"dimension": 3, "tetrahedra": len(mesh), "triangles": len(mesh.triangles), "hull": len(mesh.hull)}
    assert {name: stats[name] for name in counts} == counts


def test_columns_name_the_z(run, cloud):
    (cloud / "other.csv").write_text((cloud / "cloud.csv").read_text().replace("x,y,z", "east,north,height"))
    named = run("delaunay other.csv --columns east,north,z=height")
    assert named.out == run("delaunay cloud.csv --space").out
    np.save(cloud / "cloud.npy", POINTS)
    assert run("delaunay cloud.npy --columns 1,2,z=3").out == named.out


def test_without_it_the_plane_is_meant(run, cloud):
    done = run("delaunay cloud.csv", says="z is ignored")
    assert len(done.rows) == len(vorotool.delaunay(POINTS[:, :2]).edges)


def test_the_table_has_the_columns_of_the_input(run, cloud):
    rows = rows_of(run("delaunay cloud.csv --space --what table").out)
    assert [row["name"] for row in rows] == [f"p{number}" for number in range(30)]
    assert [[float(row[axis]) for axis in "xyz"] for row in rows] == POINTS.tolist()


def test_formats_choose_their_result(run, cloud):
    for name in ("mesh.vtu", "mesh.ply", "mesh.stl", "mesh.obj"):
        done = run(f"delaunay cloud.csv --space -o {name}")
        assert done.err == ""
        vorotool.write(vorotool.delaunay(POINTS), cloud / f"own-{name}")
        assert (cloud / name).read_bytes() == (cloud / f"own-{name}").read_bytes()


def test_a_page_shows_the_hull_whatever_is_asked_for(run, cloud, monkeypatch):
    pages = set()
    for options in ("", "--what hull", "--what tetrahedra"):
        done = run(f"delaunay cloud.csv --space {options} -o page.html")
        assert (done.code, done.err) == (0, ""), options
        pages.add((cloud / "page.html").read_bytes())
    assert len(pages) == 1
    monkeypatch.setattr("vorotool.render.pages.html.MOST_SIMPLICES", 10)
    assert "edges and triangles are too many" in run("delaunay cloud.csv --space -o page.html", code=5).err


def test_lengths_are_in_the_unit_of_a_pixel(run, cloud):
    plain, scaled = (rows_of(run("delaunay cloud.csv --space", *more).out) for more in ([], ["--pixel-size", "2um"]))
    assert [float(row["length"]) for row in scaled] == [2 * float(row["length"]) for row in plain]


def test_a_plane_and_a_line_are_said(run, folder):
    (folder / "flat.csv").write_text("x,y,z\n0,0,1\n4,0,1\n0,3,1\n4,3,1\n")
    run(
        "delaunay flat.csv --space --what tetrahedra,triangles -o flat.csv.out -f csv",
        says="the result has no tetrahedra: all lie in a plane",
    )
    (folder / "line.csv").write_text("x,y,z\n0,0,0\n2,2,2\n1,1,1\n")
    run("delaunay line.csv --space --what hull", says="the result has no hull: all points lie on a line")


def test_pictures_have_layers_and_names(run, tmp_path):
    (tmp_path / "a.csv").write_text("x,y,z,name\n0,0,0,a\n4,0,0,b\n0,3,0,c\n1,1,5,<d>\n")
    run(f"delaunay {tmp_path}/a.csv --space -o {tmp_path}/a.svg --label-by name")
    text = (tmp_path / "a.svg").read_text()
    assert [name for name in ("hull", "edges", "points", "labels") if f'id="{name}"' in text] == [
        "edges",
        "points",
        "labels",
    ]
    assert "&lt;d&gt;" in text
    run(f"delaunay {tmp_path}/a.csv --space -o {tmp_path}/b.svg --label-by height", code=2)
    run(f"delaunay {tmp_path}/a.csv --space -o {tmp_path}/b.svg --scale-bar", code=2)
