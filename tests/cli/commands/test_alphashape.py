"""``vorotool alphashape``: every result, every kind of input, and what is said when something is wrong."""

from __future__ import annotations

import json
import re
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import vorotool
from support.documents import DATA

DOTS = DATA / "dots.csv"
FAMILY = vorotool.alpha_complex(vorotool.read(DOTS))


def test_auto_is_the_default_and_tells_r(run, folder):
    done = run(f"alphashape {DOTS} -o a.csv --stats s.json --verify")
    told = re.search(r"^note: r = (\S+), the smallest radius .* one region", done.err, re.MULTILINE)
    stats = json.loads((folder / "s.json").read_text())
    assert stats["r"] == float(told[1])
    assert (stats["regions"], stats["isolated_points"], stats["automatic"]) == (1, 0, True)
    run(f"alphashape {DOTS} --auto -o b.csv -q")
    run(f"alphashape {DOTS} -r", told[1], "-o", "c.csv")
    assert (folder / "a.csv").read_text() == (folder / "b.csv").read_text() == (folder / "c.csv").read_text()
    less = np.nextafter(stats["r"], 0)
    assert vorotool.alpha_shape(FAMILY, r=less).family.reached(less) == FAMILY.reached(stats["r"]) - 1
    run(f"alphashape {DOTS} --regions", 3, "-o", "d.csv", "--stats", "s.json", says="at most 3 regions")
    fewer = json.loads((folder / "s.json").read_text())
    assert fewer["r"] <= stats["r"]
    assert fewer["regions"] <= 3


def test_r_and_alpha_are_read_exactly(run, folder):
    """Half of 0.2 as a double is more than 1/10, which a decimal says exactly."""
    (folder / "pair.csv").write_text("x,y\n0,0\n0.2,0\n")
    assert len(run("alphashape pair.csv -r 0.1").out.splitlines()) == 1
    assert len(run("alphashape pair.csv --alpha -10").out.splitlines()) == 1
    exact = repr(0.1) + "000000000000000056"
    assert Fraction(exact) > Fraction(0.1)
    assert len(run(f"alphashape pair.csv -r {exact}").out.splitlines()) == 2


def test_images_by_both_pipelines(run, folder):
    """A dot pattern as a picture: exact and digital triangulations agree but for what the errata say."""
    points = np.loadtxt(DATA / "dot-pattern.csv", delimiter=",", skiprows=1, dtype=int)
    mask = np.zeros((128, 128), np.uint8)
    mask[points[:, 1], points[:, 0]] = 255
    Image.fromarray(mask).save(folder / "dots.png")

    def edges(*options):
        rows = run("alphashape", *options, "-r", 10, "-q").rows
        return {frozenset([(row["x_a"], row["y_a"]), (row["x_b"], row["y_b"])]) for row in rows}

    exact = edges(DATA / "dot-pattern.csv")
    assert edges("dots.png", "--seeds", "pixels") == exact
    assert edges("dots.png", "--seeds", "pixels", "--method", "digital-valid") == exact
    assert edges(DATA / "dot-pattern.csv", "--method", "digital-valid", "--size", "128x128") == exact
    digital = edges("dots.png", "--seeds", "pixels", "--method", "digital")
    assert len(digital & exact) > 0.9 * len(exact)
    assert len(digital - exact) < 0.1 * len(exact)


@pytest.mark.parametrize(("what", "rule"), [("polygons", "corrected"), ("table", "printed")])
def test_the_radius_that_is_named_has_a_region(run, what, rule):
    options = [DOTS, "--what", what, "--rule", rule, "-f", "wkt" if what == "polygons" else "csv"]
    done = run("alphashape", *options, "-r", FAMILY.spectrum[0] * 1.001)
    assert done.err.startswith("warning: ")
    named = done.err.split()[-1]
    done = run("alphashape", *options, "-r", named)
    assert (done.err, len(done.out.splitlines()) > (what == "table")) == ("", True)


def test_an_infinite_radius_is_in_the_statistics(run, folder):
    assert json.loads(run("alphashape dots.csv -r inf -o shape.csv --stats -").out)["r"] == "inf"


def test_holes_mean_one_thing_and_cavities_another(run, folder):
    """Six triangles in a ring, joined at their corners, enclose a cavity that is a hole of none; a plate has a hole."""
    turn = np.pi / 6 * np.arange(12)
    ring = np.stack([np.cos(turn), np.sin(turn)], axis=1) * np.where(np.arange(12) % 2, 150, 100)[:, None]
    plate = [(x, y) for x in range(900, 1051, 50) for y in range(0, 151, 50) if not (900 < x < 1050 and 0 < y < 150)]
    (folder / "p.csv").write_text("".join(f"{x},{y}\n" for x, y in [*ring.tolist(), *plate]))
    for r, counts in ((60, (0, 1)), (45, None), (80, None), (110, None)):
        run(f"alphashape p.csv -r {r} --what table,polygons -f json -o a --stats s.json")
        stats = json.loads((folder / "s.json").read_text())
        tables = json.loads((folder / "a.table.json").read_text())
        polygons = json.loads((folder / "a.polygons.json").read_text())["polygons"]
        reached = [row for row in run("alphashape p.csv --what curves").rows if float(row["r"]) <= r][-1]
        assert stats["holes"] == sum(row["holes"] for row in tables)
        assert stats["holes"] == sum(len(polygon["holes"]) for polygon in polygons)
        assert stats["cavities"] == int(reached["cavities"])
        assert counts in (None, (stats["holes"], stats["cavities"]))


@pytest.mark.parametrize("ending", ["gpkg", "shp", "wkt"])
def test_files_of_maps_have_polygons(run, tmp_path, ending):
    """As GeoJSON has: GIS users would look for areas."""
    (tmp_path / "p.csv").write_text("x,y\n0,0\n4,0\n4,3\n0,3\n")
    run(f"alphashape p.csv -r 3 -o a.{ending} -q")
    read = vorotool.read(tmp_path / f"a.{ending}")
    assert len(read) == 1
    assert not read.is_line.any()
    vorotool.write(vorotool.alpha_shape([[0, 0], [4, 0], [4, 3], [0, 3]], r=3), tmp_path / f"b.{ending}")
    assert not vorotool.read(tmp_path / f"b.{ending}").is_line.any()


# ---- dot patterns ----------------------------------------
def test_persistence_is_that_of_the_library(run, folder):
    found = vorotool.persistence(vorotool.read(DOTS))
    done = run(f"alphashape {DOTS} --what persistence --verify")
    assert done.err == "note: 3 regions stand out, apart below r = 64.49413399086379\n"
    assert [float(row["birth"]) for row in done.rows] == found.birth.tolist()
    assert [row["into"] for row in done.rows] == [str(k + 1) if k >= 0 else "" for k in found.into.tolist()]
    assert run(f"alphashape {DOTS} --what persistence -o p.svg -q").err == ""
    assert (folder / "p.svg").read_text().count("<rect") == min(len(found), 40) + 1
    words = f"apart below r = {2 * found.apart_until!r}"
    scaled = run(f"alphashape {DOTS} --what persistence --pixel-size 2mm", says=words)
    assert [float(row["birth"]) for row in scaled.rows] == (2 * found.birth).tolist()


def test_one_cluster_and_none(run, folder):
    np.savetxt("dots.csv", np.random.default_rng(1).random((300, 2)), delimiter=",")
    assert run("alphashape dots.csv --what persistence").err == "note: 1 region stands out\n"
    Path("line.csv").write_text("0,0\n1,1\n2,2\n")
    done = run("alphashape line.csv --what persistence -f svg")
    assert done.err == "note: the shapes have no regions\n"
    assert "there are no regions" in done.out
