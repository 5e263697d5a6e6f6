"""Points in space: `--space` of `delaunay` and `alphashape`; test_same_as_library.py compares what is written."""

import json

import numpy as np
import pytest

import vorotool

POINTS = np.random.default_rng(3).random((60, 3)).round(3)


@pytest.fixture
def cloud(folder):
    rows = [f"{x},{y},{z},p{number}" for number, (x, y, z) in enumerate(POINTS.tolist())]
    (folder / "cloud.csv").write_text("\n".join(["x,y,z,name", *rows]) + "\n")
    return folder


def test_statistics(run, cloud):
    mesh, shape = vorotool.delaunay(POINTS), vorotool.alpha_shape(POINTS, r=0.3)
    expected = {"dimension": 3, "tetrahedra": len(mesh), "triangles": len(mesh.triangles), "hull": len(mesh.hull)}
    stats = json.loads(run("delaunay cloud.csv --space -o a.csv --stats -").out)
    assert {name: stats[name] for name in expected} == expected
    expected = {"surface": len(shape.surface), "volume": shape.volume, "parts": shape.part_count}
    expected |= {"cavities": shape.cavity_count, "tunnels": shape.tunnel_count, "regions": shape.region_count}
    stats = json.loads(run("alphashape cloud.csv --space -r 0.3 -o a.csv --stats -").out)
    assert {name: stats[name] for name in expected} == expected


def test_columns_name_the_z(run, cloud):
    (cloud / "other.csv").write_text((cloud / "cloud.csv").read_text().replace("x,y,z", "east,north,height"))
    named = run("delaunay other.csv --columns east,north,z=height")
    assert named.out == run("delaunay cloud.csv --space").out
    np.save(cloud / "cloud.npy", POINTS)
    assert run("delaunay cloud.npy --columns 1,2,z=3").out == named.out
    alpha = run("alphashape cloud.csv --space --alpha=-4 --what edges")
    assert alpha.out == run("alphashape cloud.csv --columns x,y,z=z -r 0.25 --what edges").out
    table = run("delaunay cloud.csv --space --what table").rows
    assert [row["name"] for row in table] == [f"p{number}" for number in range(60)]


def test_the_automatic_radius_is_told(run, cloud):
    words = (
        f"r = {vorotool.alpha_shape(POINTS).r!r}, the smallest radius whose shape is one region covering every point"
    )
    assert len(run("alphashape cloud.csv --space --what table", says=words).rows) == 1


def test_lengths_are_in_the_unit_of_a_pixel(run, cloud):
    plain, scaled = (run(f"delaunay cloud.csv --space {more}").rows for more in ("", "--pixel-size 2um"))
    assert [float(row["length"]) for row in scaled] == [2 * float(row["length"]) for row in plain]


def test_an_empty_result_says_why(run, cloud):
    first = vorotool.alpha_complex(POINTS).radii("tetrahedra").min()
    run("alphashape cloud.csv --space -r 0.001", says=f"has no surface: tetrahedra begin at r = {first:.12f}")
    (cloud / "flat.csv").write_text("x,y,z\n0,0,1\n2,0,1\n0,2,1\n")
    run("alphashape flat.csv --space -r 2 --verify", says="the result has no surface: the points span no tetrahedra")
    assert len(run("alphashape flat.csv --space -r 2 --what triangles").rows) == 1
    run("alphashape flat.csv --space", code=3, says="3 points in a plane span no tetrahedron")
    run("delaunay flat.csv --space --what tetrahedra", says="the result has no tetrahedra: all lie in a plane")
    (cloud / "line.csv").write_text("x,y,z\n0,0,0\n2,2,2\n1,1,1\n")
    run("delaunay line.csv --space --what hull", says="the result has no hull: all points lie on a line")


def test_pictures_have_layers_and_names(run, folder):
    (folder / "a.csv").write_text("x,y,z,name\n0,0,0,a\n4,0,0,b\n0,3,0,c\n1,1,5,<d>\n")
    text = run("delaunay a.csv --space -f svg --label-by name").out
    shown = [name for name in ("hull", "edges", "points", "labels") if f'id="{name}"' in text]
    assert (shown, "&lt;d&gt;" in text) == (["edges", "points", "labels"], True)
    for wrong in ("--label-by height", "--scale-bar"):
        run(f"delaunay a.csv --space -o b.svg {wrong}", code=2)


def test_a_page_opens_at_the_radius(run, cloud):
    for options, r, unit in (
        *(("-r 0.3", 0.3, ""), ("-r 0.3 --what curves", 0.3, "")),
        *(("-r 5um --pixel-size 10um", 5.0, "\\u00b5m"), ("", vorotool.alpha_shape(POINTS).r, "")),
    ):
        assert run(f"alphashape cloud.csv --space {options} -q -o page.html").err == ""
        page = (cloud / "page.html").read_text()
        assert f'"r":{r!r},"unit":"{unit}",' in page
        assert page.count("</script>") == 1


def test_a_page_shows_the_hull_whatever_is_asked_for(run, cloud):
    pages = set()
    for options in ("", "--what hull", "--what tetrahedra"):
        assert run(f"delaunay cloud.csv --space {options} -o page.html").err == ""
        pages.add((cloud / "page.html").read_bytes())
    assert len(pages) == 1


@pytest.mark.parametrize("command", ["alphashape cloud.csv --space -r 0.3", "delaunay cloud.csv --space"])
def test_a_page_of_too_many_simplices_is_refused(run, cloud, monkeypatch, command):
    monkeypatch.setattr("vorotool.render.pages.html.MOST_SIMPLICES", 10)
    words = "edges and triangles are too many for a page, at most 10: use -f ply or vtu, or -f svg or png"
    run(f"{command} -o page.html", code=5, says=words)
    assert not (cloud / "page.html").exists()


def test_curves_are_in_the_unit(run, cloud):
    line = "alphashape cloud.csv --space --what curves"
    plain, scaled = (run(f"{line} {options}").rows[-1] for options in ("", "--pixel-size 2um"))
    for name, factor in {"r": 2, "area": 4, "volume": 8, "parts": 1}.items():
        assert float(scaled[name]) == pytest.approx(factor * float(plain[name]))
