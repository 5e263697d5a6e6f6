"""``vorotool delaunay --what cells`` and ``table``: frames, clipping, pictures, and what is said when it goes wrong."""

import json
from pathlib import Path

import numpy as np
import pytest
import shapely
from PIL import Image

import vorotool
from support.readers.written import rows_of

DOTS = Path(__file__).parents[3] / "data" / "dots.csv"
POINTS = vorotool.read(DOTS)
TRIANGLE = '{"type":"Polygon","coordinates":[[[20,20],[200,40],[120,220],[20,20]]]}'


@pytest.fixture
def clip(folder):
    (folder / "clip.geojson").write_text(TRIANGLE)
    return folder / "clip.geojson"


def shapes_of(text):
    features = json.loads(text)["features"]
    return [f["geometry"] and shapely.from_geojson(json.dumps(f["geometry"])) for f in features]


def test_cells_go_to_standard_output(run):
    done = run("delaunay", DOTS, "--what", "cells", "--verify")
    assert (done.code, done.err) == (0, "")
    right = vorotool.voronoi_cells(POINTS).to_shapely()
    assert all(shapely.equals_exact(a, b) for a, b in zip(shapes_of(done.out), right, strict=True))


def test_frame(run, folder):
    done = run("delaunay", DOTS, "--what", "cells", "--frame", "0.5,10,300,200.25", "--stats", "s.json", "-o", "a.csv")
    assert done.code == 0
    rows = rows_of((folder / "a.csv").read_text())
    cells = [shapely.from_wkt(row["wkt"]) for row in rows if row["wkt"]]
    assert shapely.union_all(cells).bounds == (0.5, 10, 300.5, 210.25)
    stats = json.loads((folder / "s.json").read_text())
    assert stats["frame"] == [0.5, 10, 300, 200.25]
    assert stats["empty_cells"] == len(rows) - len(cells) > 0


def test_clip(run, clip):
    done = run("delaunay", DOTS, "--what", "cells", "--clip", clip, "--verify")
    assert (done.code, "cells are empty" in done.err) == (0, True)
    shapes = [shape for shape in shapes_of(done.out) if shape is not None]
    area = shapely.from_geojson(TRIANGLE)
    assert sum(shape.area for shape in shapes) == pytest.approx(area.area)
    assert shapely.union_all(shapes).symmetric_difference(area).area < 1e-6


def test_table(run):
    done = run("delaunay", DOTS, "--what", "table", "--frame", "0,0,512,512")
    rows = done.rows
    assert [int(row["label"]) for row in rows] == list(range(1, 54))
    assert sum(float(row["area"]) for row in rows) == pytest.approx(512**2)
    shapes = vorotool.voronoi_cells(POINTS, frame=(0, 0, 512, 512)).to_shapely()
    np.testing.assert_allclose([float(row["perimeter"]) for row in rows], shapely.length(shapes))


def test_several_results_share_the_cells(run, folder, clip):
    assert run("delaunay", DOTS, "--what", "cells,table,edges", "--clip", clip, "-o", "a").code == 0
    assert {p.name for p in folder.glob("a.*")} == {"a.cells.geojson", "a.table.csv", "a.edges.csv"}
    rows = rows_of((folder / "a.table.csv").read_text())
    shapes = shapes_of((folder / "a.cells.geojson").read_text())
    assert [float(row["area"]) for row in rows] == pytest.approx([0 if s is None else s.area for s in shapes])


def test_pictures(run, folder):
    for fmt in ("svg", "png"):
        assert run("delaunay", DOTS, "--what", "cells", "-o", f"a.{fmt}", "--width", "300").code == 0
    text = (folder / "a.svg").read_text()
    assert all(f'id="cell-{label}"' in text for label in range(1, 54))
    assert text.count("<circle") == 53
    with Image.open(folder / "a.png") as picture:
        assert picture.width == 300
        assert len(np.unique(np.asarray(picture.convert("RGB")).reshape(-1, 3), axis=0)) > 5
    assert run("delaunay", DOTS, "-o", "b.svg", "--layers", "cells,edges,diagram,points").code == 0
    text = (folder / "b.svg").read_text()
    places = [text.index(f'<g id="{name}"') for name in ("cells", "diagram", "edges", "points")]
    assert places == sorted(places)


def test_properties_are_copied_unless_refused(run, folder):
    (folder / "p.csv").write_text("x,y,name\n0,0,a\n4,0,b\n")
    done = run("delaunay", "p.csv", "--what", "cells")
    assert [f["properties"]["name"] for f in json.loads(done.out)["features"]] == ["a", "b"]
    done = run("delaunay", "p.csv", "--what", "cells", "--no-properties")
    assert all("name" not in f["properties"] for f in json.loads(done.out)["features"])


@pytest.mark.parametrize(
    ("options", "code", "words"),
    [
        (("--frame", "0,0,1"), 2, "'0,0,1'"),
        (("--frame", "0,0,0,1"), 2, "W and H above 0"),
        (("--frame", "nan,0,1,1"), 2, "expected finite numbers"),
        (("--frame", "1e17,0,1,1"), 3, "width and height must be positive"),
        (("--clip", "none.geojson"), 3, "none.geojson"),
        (("--clip", "line.wkt"), 3, "line.wkt"),
        (("--clip", "point.wkt"), 3, "point.wkt"),
        (("--clip", "flat.wkt"), 3, "have no area"),
        (("-o", "a.obj"), 2, "cells cannot be written as obj"),
    ],
)
def test_bad_options(run, folder, options, code, words):
    (folder / "line.wkt").write_text("LINESTRING (0 0, 1 1)")
    (folder / "point.wkt").write_text("POINT (0 0)")
    (folder / "flat.wkt").write_text("POLYGON ((0 0, 1 1, 2 2, 0 0))")
    done = run("delaunay", DOTS, "--what", "cells", *options)
    assert done.code == code
    assert words in done.err
    assert "Traceback" not in done.err


@pytest.mark.parametrize("option", [("--frame", "0,0,1,1"), ("--clip", "clip.geojson")])
def test_frames_and_polygons_are_for_cells(run, clip, option):
    done = run("delaunay", DOTS, *option)
    assert done.code == 2
    assert option[0] in done.err
    assert run("delaunay", DOTS, "-f", "svg", "--layers", "diagram", *option).code == 0
