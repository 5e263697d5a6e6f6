"""PNGs of results on a map have world files, which place them where rasterio and the vectors say."""

import json
import operator

import numpy as np
import pytest
import shapely
from PIL import Image

from support.families.geojson import collection
from support.families.rasters import MASK, about, pixels, write_map

SHAPES = [shapely.box(2600000, 1200000, 2600400, 1200100), shapely.box(2600100, 1200300, 2600300, 1200900)]


def write(path, shapes, crs="urn:ogc:def:crs:EPSG::2056"):
    path.write_text(collection(shapes, crs=crs))


def numbers(path):
    return [float(line) for line in path.read_text().splitlines()]


@pytest.fixture
def geotiff(tmp_path):
    return about(write_map(tmp_path / "in.tif"))[0]


@pytest.mark.parametrize("what", ["labels", "color"])
def test_images_keep_their_places(run, tmp_path, geotiff, what):
    run(f"tessellate in.tif --what {what} -o out.png -q")
    transform, _, shape, *_ = about(tmp_path / "out.png")
    assert (transform.almost_equals(geotiff), shape) == (True, MASK.shape)
    if what == "labels":
        tables = (run(f"tessellate {name} --what table -q").rows for name in ("out.png --seeds labels", "in.tif"))
        assert operator.eq(*([row["area"] for row in rows] for rows in tables))


BOUNDS = [2600000, 2600400, 1200000, 1200900]


@pytest.mark.parametrize(
    ("command", "bounds"),
    [
        ("voronoi in.geojson --layers objects", BOUNDS),
        ("skeleton-exact in.geojson --layers polygons", BOUNDS),
        ("draw in.geojson", BOUNDS),
        ("skeleton-exact in.tif --layers polygons", [2600125, 2601375, 1199100, 1199875]),
    ],
)
@pytest.mark.usefixtures("geotiff")
def test_pictures_of_vectors(run, tmp_path, command, bounds):
    """What is drawn lies in the bounds of the shapes, and reaches them."""
    write(tmp_path / "in.geojson", SHAPES)
    run(f"{command} -o out.png -q --width 600")
    rows, columns = np.nonzero((pixels("out.png") < 255).any(axis=0))
    transform = about("out.png")[0]
    x, y = transform @ (columns + 0.5, rows + 0.5)
    pixel = 2 * abs(transform.a)
    assert [x.min(), x.max(), y.min(), y.max()] == pytest.approx(bounds, abs=pixel)


def test_what_is_on_no_map_has_none(run, tmp_path):
    write(tmp_path / "in.geojson", SHAPES, crs=None)
    Image.fromarray(MASK).save(tmp_path / "in.png")
    run("voronoi in.geojson -o a.png -q --width 90")
    run("tessellate in.png -o b.png -q")
    assert not list(tmp_path.glob("*.pgw"))


def test_an_older_world_file(run, tmp_path):
    """Replaced as the picture is; refused with --no-clobber, and then neither is written."""
    write(tmp_path / "in.geojson", SHAPES)
    (tmp_path / "out.pgw").write_text("1\n0\n0\n-1\n0\n0\n")
    run("voronoi in.geojson -o out.png --no-clobber -q --width 90", code=4, says="out.pgw")
    assert not (tmp_path / "out.png").exists()
    run("voronoi in.geojson -o out.png -q --width 90")
    assert numbers(tmp_path / "out.pgw")[0] != 1


# ---- JSON lines ---------------------------------------------------------------------------------
def test_json_lines_on_a_map_are_noted(run, tmp_path):
    """GDAL reads them as EPSG:4326, whatever their features say."""
    import pyogrio

    write(tmp_path / "in.geojson", SHAPES)
    done = run("voronoi in.geojson -o out.jsonl")
    assert done.err.count("out.jsonl is in EPSG:2056, but GDAL reads") == 1
    assert "-a_srs EPSG:2056" in done.err
    (tmp_path / "out.jsonl").rename(tmp_path / "out.geojsonl")
    assert pyogrio.read_info(tmp_path / "out.geojsonl")["crs"] == "EPSG:4326"
    told = json.loads(run("info --json out.geojsonl").out)
    assert told["crs"] == "EPSG:2056"
    write(tmp_path / "plain.geojson", SHAPES, crs=None)
    assert "GDAL" not in run("voronoi plain.geojson -o out.jsonl").err
    assert "GDAL" not in run("voronoi in.geojson --crs EPSG:4326 -o out.jsonl").err
