"""``tessellate --like RASTER``: the frame and the pixels of a raster, checked with rasterio."""

import numpy as np
import pytest
import rasterio
import shapely
import tifffile
from PIL import Image

from support.families.geojson import collection
from support.families.rasters import about, pixels, write_map

NORTH = rasterio.Affine(12.5, 0, 2600512.5, 0, -12.5, 1200012.5)
SAME_BY_HAND = ("--cell-size", "12.5", "--window", "2600512.5,1199512.5,625,500")
XY = np.random.default_rng(5).integers((2600400, 1199400), (2601200, 1200100), (30, 2)) + 0.25


def raster(path, transform=NORTH, crs="EPSG:2056", count=1, height=40, width=50, **kind):
    write_map(path, np.zeros((count, height, width), np.uint8), transform, crs, **kind)


def points(path, xy=XY, crs="EPSG:2056"):
    path.write_text(collection(shapely.points(xy), [{"name": f"n{k}"} for k in range(len(xy))], crs=crs))


@pytest.mark.parametrize("what", ["labels", "color", "table"])
def test_it_is_the_frame_by_hand(run, tmp_path, what):
    raster(tmp_path / "r.tif")
    points(tmp_path / "in.geojson")
    ending = {"color": "png", "table": "csv"}.get(what, "tif")
    words = ["tessellate", "in.geojson", "--max-distance", "200", "--what", what, "-q", "-o"]
    words = words if what in ("labels", "table") else words[:2] + words[4:]
    run(*words, f"a.{ending}", "--like", "r.tif")
    run(*words, f"b.{ending}", *SAME_BY_HAND)
    if ending == "csv":
        assert (tmp_path / "a.csv").read_bytes() == (tmp_path / "b.csv").read_bytes()
    else:
        assert (pixels(f"a.{ending}") == pixels(f"b.{ending}")).all()
        assert about(f"a.{ending}")[:3:2] == about("r.tif")[:3:2]


@pytest.mark.parametrize(
    "kind",
    [
        {"transform": rasterio.Affine(12.5, 0, 2600512.5, 0, 12.5, 1199512.5)},
        {"AREA_OR_POINT": "Point"},
        {"crs": "+proj=somerc +lat_0=46.95 +lon_0=7.44 +x_0=2600000 +y_0=1200000 +ellps=bessel"},
        {"count": 3, "height": 512, "width": 512, "compress": "jpeg", "tiled": True},
        {
            "driver": "COG",
            "height": 1500,
            "width": 1200,
            "transform": rasterio.Affine(1 / 3, 0, 2600500, 0, -1 / 3, 1200000),
        },
    ],
)
def test_a_result_overlays_its_raster(run, tmp_path, kind):
    raster(tmp_path / "r.tif", **kind)
    np.savetxt(tmp_path / "in.csv", XY, delimiter=",", header="x,y", comments="", fmt="%.2f")
    run("tessellate in.csv --like r.tif -o out.tif -q")
    assert about(tmp_path / "out.tif") == about(tmp_path / "r.tif")
    labels, (transform, *_) = pixels(tmp_path / "out.tif")[0], about(tmp_path / "r.tif")
    x, y = transform @ (np.arange(labels.shape[1]) + 0.5, np.zeros(labels.shape[1]) + 0.5)
    distances = np.hypot(x[:, None] - XY[:, 0], y[:, None] - XY[:, 1])
    chosen = np.take_along_axis(distances, labels[0][:, None].astype(int) - 1, axis=1)[:, 0]
    assert (chosen <= distances.min(axis=1) + 0.001).all()


@pytest.mark.parametrize("name", ["r.tif", "r.pgm"])
def test_a_raster_without_a_map_counts_in_pixels(run, tmp_path, name):
    values = np.zeros((60, 80), np.uint8)
    writers = {".tif": tifffile.imwrite, ".npy": np.save}
    writers.get(name[1:], lambda path, array: Image.fromarray(array).save(path))(tmp_path / name, values)
    points(tmp_path / "in.geojson", np.array([[3, 4], [70.5, 50]]), crs=None)
    for options in (("--like", name, "-o", "a.png"), ("--size", "80x60", "-o", "b.png")):
        run("tessellate in.geojson", *options, "--y-down", "-q")
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()
    (tmp_path / "in.wkt").write_text("POLYGON ((5 5, 30 5, 30 30, 5 30, 5 5))\nLINESTRING (40 40, 70 50)\n")
    run(f"tessellate in.wkt --like {name} --max-distance 0 -o c.png -q")
    with Image.open(tmp_path / "c.png") as image:
        labels = np.array(image)
    assert (labels[10, 10], labels[40, 40], labels[45, 10]) == (1, 2, 0)


def test_only_the_header_is_read(run, tmp_path):
    """A raster of 20 GB whose pixels are not in the file."""
    kind = {"height": 60_000, "width": 90_000, "count": 1, "dtype": "float32", "BIGTIFF": "YES", "SPARSE_OK": "TRUE"}
    with rasterio.open(tmp_path / "r.tif", "w", driver="GTiff", transform=NORTH, crs="EPSG:2056", tiled=True, **kind):
        pass
    points(tmp_path / "in.geojson")
    run("tessellate in.geojson --like r.tif -f svg", code=5, says="90000 x 60000 pixels")


def test_pictures_on_a_map_have_north_on_top(run, tmp_path):
    points(tmp_path / "in.geojson", np.array([[2600600, 1199600], [2601100, 1199990]]))
    raster(tmp_path / "r.tif")
    for frame in (("--like", "r.tif"), SAME_BY_HAND):
        run("tessellate in.geojson", *frame, "--what", "color", "--layers", "seeds", "-o", "a.png", "-q")
        rows, columns = np.nonzero((pixels("a.png") != pixels("a.png")[:, :1, :1]).any(axis=0))
        assert np.corrcoef(rows, columns)[0, 1] < 0  # from the south-west to the north-east


@pytest.mark.parametrize(
    ("options", "code", "words"),
    [
        ("in.geojson --like -", 2, "is a stream"),
        ("in.geojson --like none.tif", 3, "none.tif"),
        ("in.geojson --like in.geojson", 3, "in.geojson is not a TIFF, PNG"),
        ("in.geojson --like turned.tif", 3, "gdalwarp turned.tif"),
        ("in.geojson --like flat.tif", 3, "12.5 x 25 m"),
        ("in.geojson --like far.tif", 3, "in EPSG:2056, but far.tif in EPSG:4326"),
        ("in.geojson --like far.tif", 3, "--crs EPSG:4326, or ogr2ogr -t_srs EPSG:4326"),
        ("in.geojson --like plain.png", 3, "in.geojson is in EPSG:2056, but plain.png"),
        ("um.csv --like r.tif", 3, "um.csv is in µm, but r.tif in m"),
        ("um.csv --like plain.png", 3, "um.csv is in µm, but plain.png"),
        ("degrees.csv --like r.tif", 3, "degrees.csv states no coordinate reference system, r.tif is in EPSG:2056"),
        ("degrees.csv --y-down --like r.tif", 3, "--y-up uses the numbers as they are"),
    ],
)
def test_what_is_refused(run, tmp_path, options, code, words):
    raster(tmp_path / "r.tif")
    raster(tmp_path / "turned.tif", rasterio.Affine(12.5, 1, 2600512.5, 1, -12.5, 1200012.5))
    raster(tmp_path / "flat.tif", rasterio.Affine(12.5, 0, 2600512.5, 0, -25, 1200012.5))
    raster(tmp_path / "far.tif", rasterio.Affine(0.1, 0, 7, 0, -0.1, 48), "EPSG:4326")
    Image.new("L", (9, 9)).save(tmp_path / "plain.png")
    (tmp_path / "um.csv").write_text("x,y,unit\n2600600,1199600,um\n")
    (tmp_path / "degrees.csv").write_text("x,y\n7.4,46.9\n")
    points(tmp_path / "in.geojson")
    run(f"tessellate {options} -o out.tif", code=code, says=words)
    assert not (tmp_path / "out.tif").exists()


def test_batches_look_at_the_header_alone(run, tmp_path):
    (tmp_path / "in").mkdir()
    points(tmp_path / "in/a.geojson")
    raster(tmp_path / "r.tif")
    words = ["tessellate", "in", "--like", "r.tif", "--out-dir", "out", "-f", "tiff", "--resume"]
    run(*words)
    assert about(tmp_path / "out/a.tif") == about(tmp_path / "r.tif")
    assert "kept" in run(*words).err
    raster(tmp_path / "r.tif", width=60)
    assert "kept" not in run(*words).err
    assert about(tmp_path / "out/a.tif") == about(tmp_path / "r.tif")
