"""PNGs of results on a map have world files, which place them where rasterio and the vectors say."""

import json

import numpy as np
import pytest
import rasterio
import rasterio.features
import shapely
from PIL import Image

from support.families.geojson import collection

MASK = np.zeros((40, 60), np.uint8)
MASK[5:20, 5:25] = MASK[25:36, 20:55] = 1
SHAPES = [shapely.box(2600000, 1200000, 2600400, 1200100), shapely.box(2600100, 1200300, 2600300, 1200900)]


def write(path, shapes, crs="urn:ogc:def:crs:EPSG::2056"):
    path.write_text(collection(shapes, crs=crs))


def numbers(path):
    return [float(line) for line in path.read_text().splitlines()]


@pytest.fixture
def geotiff(tmp_path):
    transform = rasterio.Affine(25, 0, 2600000, 0, -25, 1200000)
    kind = {"driver": "GTiff", "height": 40, "width": 60, "count": 1, "dtype": "uint8", "crs": "EPSG:2056"}
    with rasterio.open(tmp_path / "in.tif", "w", transform=transform, **kind) as file:
        file.write(MASK, 1)
    return transform


@pytest.mark.parametrize("what", ["labels", "color"])
def test_images_keep_their_places(run, tmp_path, geotiff, what):
    run(f"tessellate in.tif --what {what} -o out.png -q")
    with rasterio.open(tmp_path / "out.png") as file:
        assert file.transform.almost_equals(geotiff)
        assert (file.height, file.width) == MASK.shape
    again = run("tessellate out.png --seeds labels --what table -q") if what == "labels" else None
    assert again is None or [row["area"] for row in again.rows] == [
        row["area"] for row in run("tessellate in.tif --what table -q").rows
    ]


def black(path):
    """Where a picture is not white, on the map."""
    with rasterio.open(path) as file:
        rows, columns = np.nonzero((file.read() < 255).any(axis=0))
        x, y = file.transform @ (columns + 0.5, rows + 0.5)
    return np.asarray(x), np.asarray(y), file.transform


@pytest.mark.parametrize("command", ["voronoi --layers polygons", "skeleton-exact --layers polygons", "draw"])
def test_pictures_of_vectors(run, tmp_path, command):
    """What is drawn lies in the bounds of the shapes, and reaches them."""
    write(tmp_path / "in.geojson", SHAPES)
    words = command.split()
    if words[0] == "voronoi":
        words = ["voronoi", "--layers", "objects"]
    run(words[0], "in.geojson", *words[1:], "-o", "out.png", "-q", "--width", "200")
    x, y, transform = black(tmp_path / "out.png")
    pixel = 2 * abs(transform.a)
    assert [x.min(), x.max(), y.min(), y.max()] == pytest.approx([2600000, 2600400, 1200000, 1200900], abs=pixel)


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
    done = run("voronoi in.geojson -o out.png --no-clobber -q --width 90", code=4)
    assert "out.pgw" in done.err
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
    done = run("voronoi in.geojson --crs EPSG:4326 -o out.jsonl")
    assert "GDAL" not in done.err
