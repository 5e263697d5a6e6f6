"""``vorotool alphashape --space``: every result, formats, checks, and what is refused."""

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


def test_the_surface_is_that_of_the_library(run, cloud):
    shape = vorotool.alpha_shape(POINTS, r=0.3)
    done = run("alphashape cloud.csv --space -r 0.3 --verify --stats stats.json")
    assert done.err == ""
    assert [[int(row[f"label_{corner}"]) - 1 for corner in "abc"] for row in done.rows] == shape.surface.tolist()
    stats = json.loads((cloud / "stats.json").read_text())
    expected = {"surface": len(shape.surface), "volume": shape.volume, "parts": shape.part_count}
    expected |= {"cavities": shape.cavity_count, "tunnels": shape.tunnel_count, "regions": shape.region_count}
    assert {name: stats[name] for name in expected} == expected


def test_rows_of_all_results(run, cloud):
    shape = vorotool.alpha_shape(POINTS, r=0.3)
    family = shape.family
    simplices = len(family.edges) + len(family.triangles) + len(family)
    counts = {
        "tetrahedra": len(shape.tetrahedra),
        "triangles": len(shape.triangles),
        "edges": len(shape.edges),
        "table": shape.region_count,
        "family": simplices,
        "spectrum": len(family.spectrum),
        "curves": len(family.spectrum),
    }
    for what, count in counts.items():
        assert len(run(f"alphashape cloud.csv --space -r 0.3 --what {what}").rows) == count, what
    alpha = run("alphashape cloud.csv --space --alpha=-4 --what edges")
    assert alpha.out == run("alphashape cloud.csv --columns x,y,z=z -r 0.25 --what edges").out


def test_formats_choose_their_result(run, cloud):
    shape = vorotool.alpha_shape(POINTS, r=0.3)
    for name in ("shape.vtu", "shape.ply", "shape.stl", "shape.obj", "shape.npz", "shape.json"):
        done = run(f"alphashape cloud.csv --space -r 0.3 -o {name}")
        assert done.err == ""
        vorotool.write(shape, cloud / f"own-{name}", what="tetrahedra" if name.endswith("vtu") else "surface")
        assert (cloud / name).read_bytes() == (cloud / f"own-{name}").read_bytes(), name


def test_a_page_opens_at_the_radius(run, cloud):
    for options, r, unit in (
        ("-r 0.3", 0.3, ""),
        ("-r 0.3 --what curves", 0.3, ""),
        ("-r 5um --pixel-size 10um", 5.0, "\\u00b5m"),
        ("", vorotool.alpha_shape(POINTS).r, ""),
    ):
        done = run("alphashape", "cloud.csv", "--space", *options.split(), "-q", "-o", "page.html")
        assert (done.code, done.err) == (0, ""), options
        page = (cloud / "page.html").read_text()
        assert f'const data = {{"r":{r!r},"unit":"{unit}",' in page
        assert page.count("</script>") == 1


def test_a_page_of_too_many_simplices_is_refused(run, cloud, monkeypatch):
    monkeypatch.setattr("vorotool.render.pages.html.MOST_SIMPLICES", 100)
    done = run("alphashape", "cloud.csv", "--space", "-r", "0.3", "-o", "page.html")
    assert done.code == 5
    assert "edges and triangles are too many for a page, at most 100: use -f ply or vtu, or -f svg or png" in done.err
    assert not (cloud / "page.html").exists()


def test_curves_are_in_the_unit(run, cloud):
    plain, scaled = (
        run("alphashape", "cloud.csv", "--space", "--what", "curves", *options).rows[-1]
        for options in ((), ("--pixel-size", "2um"))
    )
    factors = {"r": 2, "area": 4, "volume": 8, "parts": 1}
    for name, factor in factors.items():
        assert float(scaled[name]) == pytest.approx(factor * float(plain[name]))


def test_the_automatic_radius_is_told(run, cloud):
    r = vorotool.alpha_shape(POINTS).r
    done = run(
        "alphashape cloud.csv --space --what table",
        says=f"r = {r!r}, the smallest radius whose shape is one region covering every point",
    )
    assert len(done.rows) == 1


def test_an_empty_result_says_where_it_begins(run, cloud):
    first = vorotool.alpha_complex(POINTS).radii("tetrahedra").min()
    run("alphashape cloud.csv --space -r 0.001", says=f"has no surface: tetrahedra begin at r = {first:.12f}")
    (cloud / "flat.csv").write_text("x,y,z\n0,0,1\n2,0,1\n0,2,1\n")
    run("alphashape flat.csv --space -r 2 --verify", says="the result has no surface: the points span no tetrahedra")
    assert len(run("alphashape flat.csv --space -r 2 --what triangles").rows) == 1
    run("alphashape flat.csv --space", code=3, says="3 points in a plane span no tetrahedron")


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ("--space --rule printed -r 1", "--rule printed cannot be combined with --space"),
        ("--space --hole-threshold 2", "--hole-threshold cannot be combined with --space"),
        ("--space --what polygons", "--what polygons is of points in the plane"),
        ("--what surface", "--what surface needs --space"),
        ("--space -r 0", "a radius must be positive"),
    ],
)
def test_what_is_of_the_plane_is_refused(run, cloud, given, message):
    run(f"alphashape cloud.csv {given}", code=2, says=message)
