"""Images that lie on a map: GeoTIFF and world files, checked with rasterio and with shapely."""

import json

import numpy as np
import pytest
import rasterio
import shapely
import tifffile
from PIL import Image
from rasterio.transform import Affine
from shapely.affinity import affine_transform

import vorotool
from support.families.geojson import collection
from support.families.rasters import about, write_map
from support.few import few
from support.refusals import refused
from vorotool import UsageError
from vorotool.engines.tessellation.raster_objects import numbered_components

rng = np.random.default_rng(5)
MASK = np.zeros((40, 50), np.uint8)
MASK[4:15, 6:20] = MASK[20:37, 25:45] = MASK[30:34, 3:9] = 255
MASK[25:30, 30:38] = 0
DOTS = (rng.random((40, 50)) < 0.02).astype(np.uint8)


def from_origin(west, north, x, y):
    return Affine(x, 0, west, 0, -y, north)


NORTH_UP = from_origin(2600000, 1200000, 25, 25)
SOUTH_UP = Affine(0.5, 0, 10, 0, 0.5, -7)


CASES = [
    (NORTH_UP, "EPSG:2056", {}),
    (SOUTH_UP, "EPSG:32632", {}),
    (from_origin(7.4, 47.1, 0.01, 0.01), "EPSG:4326", {}),
    (from_origin(7.4, 47.1, 0.01, 0.02), "EPSG:4258", {}),
    (Affine(3, 1, 50, -1, 3, 60), "EPSG:3857", {}),
    (Affine(-3, 0, 50, 0, -2, 60), "EPSG:3857", {}),
    (NORTH_UP, "+proj=laea +lat_0=10 +lon_0=20 +datum=WGS84", {}),
    (NORTH_UP, None, {}),
    (NORTH_UP, "EPSG:2056", {"nodata": 3, "tiled": True, "blockxsize": 16, "blockysize": 16, "compress": "lzw"}),
]


@pytest.mark.parametrize(
    ("transform", "crs", "options", "what"),
    [(*case, what) for case, what in zip(CASES, 3 * ("labels", "distance", "diagram"), strict=True)],
)
def test_images_line_up_with_their_input(run, tmp_path, transform, crs, options, what):
    write_map(tmp_path / "in.tif", MASK, transform=transform, crs=crs, **options)
    assert "results are in its coordinates" not in run(f"tessellate in.tif -o out.tif --what {what}").err
    before, after = about(tmp_path / "in.tif"), about(tmp_path / "out.tif")
    assert after[0].almost_equals(before[0], 1e-12)
    assert after[1:3] == before[1:3]
    assert after[3] is None


def test_pixels_that_are_points(run, tmp_path):
    path = write_map(tmp_path / "in.tif", MASK)
    with rasterio.open(path, "r+") as file:
        file.update_tags(AREA_OR_POINT="Point")
    run("tessellate in.tif -o out.tif")
    assert about(tmp_path / "out.tif") == about(path)
    assert about(path)[4] == "Point"


def placed(transform, column, row):
    """A place on the map."""
    a, b, c, d, e, f = tuple(transform)[:6]
    return a * column + b * row + c, d * column + e * row + f


def component(number):
    """The pixels of an object of the mask."""
    return numbered_components(MASK) == number + 1


def geometry(features):
    """All features in one, so that neither their order nor their direction counts."""
    return shapely.union_all([shapely.geometry.shape(each["geometry"]) for each in features if each["geometry"]])


VECTORS = [
    "skeleton-exact --what skeleton",
    "skeleton-exact --what skeleton --side both --prune none",
    "skeleton-exact --what offset -d -1,2",
    "skeleton-exact --what shape",
    "skeleton-exact --what diagram --frame -5,-6,70,60",
    "skeleton-approx --what skeleton --step 1",
    "delaunay --seeds pixels --what triangles",
    "delaunay --seeds pixels --what cells --frame 3,5,30,20",
    "delaunay --seeds pixels --what edges --method digital",
    "alphashape --seeds pixels --what general -r 4",
]


def vectors():
    """Commands with the two ways that rows go, in turn, and then with the other one and finer."""
    ways = [(command, (NORTH_UP, SOUTH_UP)[number % 2]) for number, command in enumerate(VECTORS)]
    others = [(command, (SOUTH_UP, NORTH_UP)[number % 2]) for number, command in enumerate(VECTORS)]
    return few([(*way, is_fine) for is_fine in (False, True) for way in (*ways, *others)], len(ways))


@pytest.mark.parametrize(("command", "transform", "is_fine"), vectors())
def test_vectors_are_those_of_pixels_on_the_map(run, tmp_path, command, transform, is_fine):
    values = DOTS if "pixels" in command else MASK
    write_map(tmp_path / "in.tif", values, transform)
    has_many_arcs = "offset" in command or "shape" in command.split()
    closeness = 1e-4 if has_many_arcs and not is_fine else 1e-6
    flatten = ["--flatten", closeness] if command.startswith("skeleton") else []
    on_map = run(command, "in.tif", "-f", "geojson", *flatten, says="in.tif")
    pixels = run(command, "in.tif", "-f", "geojson", "--pixel-size", "1", *flatten)
    assert pixels.err.startswith("note: 26 of 56 cells are empty") or not pixels.err
    on_map, pixels = json.loads(on_map.out), json.loads(pixels.out)
    assert on_map["crs"]["properties"]["name"] == "urn:ogc:def:crs:EPSG::2056"
    assert "crs" not in pixels
    assert len(on_map["features"]) == len(pixels["features"]) > 0
    a, b, c, d, e, f = tuple(transform)[:6]
    placed = affine_transform(geometry(pixels["features"]), [a, b, d, e, c + a / 2, f + e / 2])
    assert placed.hausdorff_distance(geometry(on_map["features"])) < 10 * closeness * a
    shapes = [shapely.geometry.shape(each["geometry"]) for each in on_map["features"] if each["geometry"]]
    assert all(shape.exterior.is_ccw for shape in shapes if shape.geom_type == "Polygon")


@pytest.mark.parametrize("transform", [NORTH_UP, SOUTH_UP])
def test_the_table_of_regions(run, tmp_path, transform):
    write_map(tmp_path / "in.tif", MASK, transform=transform)
    rows = run("tessellate in.tif --what table -q").rows
    run("tessellate in.tif -o labels.tif -q")
    with rasterio.open(tmp_path / "labels.tif") as file:
        labels, side = file.read(1), transform.a
        for row in rows:
            y, x = np.nonzero(labels == int(row["label"]))
            corners = [placed(transform, x[k] + dx, y[k] + dy) for k in range(len(x)) for dx in (0, 1) for dy in (0, 1)]
            (left, low), (right, high) = np.min(corners, axis=0), np.max(corners, axis=0)
            box = [float(row[f"bbox_{name}"]) for name in "xywh"]
            assert box == pytest.approx([left, low, right - left, high - low])
            assert float(row["area"]) == pytest.approx(len(x) * side**2)
        masses = [shapely.centroid(shapely.MultiPoint(np.argwhere(component(k))[:, ::-1])) for k in range(3)]
        centers = [placed(transform, mass.x + 0.5, mass.y + 0.5) for mass in masses]
        assert np.allclose([(float(row["x"]), float(row["y"])) for row in rows], centers, rtol=1e-12)
    neighbors = run("tessellate in.tif --what neighbors -q").rows
    meters = run("tessellate in.tif --what neighbors -q --pixel-size", str(side)).rows
    assert neighbors == meters


def test_paths_between_places_of_the_image(run, tmp_path):
    """Places among the options are in pixels, as without a map."""
    write_map(tmp_path / "in.tif", MASK)
    options = ["--what", "centerline", "--from", "7,5", "--to", "18,13", "-f", "geojson"]
    on_map = json.loads(run("skeleton-exact in.tif", *options).out)
    pixels = json.loads(run("skeleton-exact in.tif", *options, "--pixel-size", "1").out)
    placed = affine_transform(geometry(pixels["features"]), [25, 0, 0, -25, 2600012.5, 1199987.5])
    assert placed.hausdorff_distance(geometry(on_map["features"])) < 1e-6


def test_clip_is_on_the_map(run, tmp_path):
    write_map(tmp_path / "in.tif", DOTS)
    area = shapely.box(2600100, 1199300, 2600900, 1199900)
    command = "delaunay in.tif --seeds pixels --what cells -f geojson --clip clip.geojson"
    (tmp_path / "clip.geojson").write_text(collection([area], crs="EPSG:2056"))
    cells = json.loads(run(command).out)["features"]
    assert geometry(cells).symmetric_difference(area).area < 1e-3
    (tmp_path / "clip.geojson").write_text(collection([area], crs="EPSG:3857"))
    run(command, code=3, says="in.tif in EPSG:2056")


@pytest.mark.parametrize(
    ("transform", "code", "words"),
    [
        (Affine(3, 1, 50, -1, 3, 60), 3, "the image is rotated, mirrored or sheared on the map"),
        (Affine(-3, 0, 50, 0, -3, 60), 3, "the image is rotated, mirrored or sheared on the map"),
        (from_origin(0, 100, 2, 3), 0, "in.tif"),
    ],
)
def test_maps_that_results_cannot_follow(run, tmp_path, transform, code, words):
    write_map(tmp_path / "in.tif", MASK, transform=transform)
    run("skeleton-exact in.tif -o a.geojson", code=code, says=words)
    run("skeleton-exact in.tif -o a.geojson --pixel-size auto", code=3, says="--pixel-size 1")
    assert run("skeleton-exact in.tif -o a.geojson --pixel-size 1").err == ""


TURNED = Affine.translation(500, 400) @ Affine.rotation(30) @ Affine.scale(2, -3)
SHEARED = Affine(2, 1, 500, 0.5, -3, 400)


@pytest.mark.parametrize("what", ["labels", "distance"])
def test_a_turned_map_is_measured_along_its_rows(run, tmp_path, what):
    """Images follow any map; what a note advises is accepted, and gives what the typed sides give."""
    write_map(tmp_path / "in.tif", MASK, transform=TURNED)
    run(f"tessellate in.tif -o a.tif --what {what}", says="distances are in pixels; --spacing auto")
    for sides, name in (("auto", "b"), ("2,3m", "c")):
        run(f"tessellate in.tif -o {name}.tif --what {what} --spacing {sides} --max-distance 7m --verify -q")
    assert (tmp_path / "b.tif").read_bytes() == (tmp_path / "c.tif").read_bytes()
    with rasterio.open(tmp_path / "b.tif") as file:
        assert file.transform.almost_equals(TURNED)
    run("tessellate in.tif --what table --spacing auto", code=3, says="--spacing 2,3m gives results along its rows")
    assert run("tessellate in.tif --what table --spacing 2,3m").rows[0]["unit"] == "m"


def test_a_sheared_map_has_no_sides_to_measure_with(run, tmp_path):
    write_map(tmp_path / "in.tif", MASK, transform=SHEARED)
    done = run("tessellate in.tif -o a.tif", says="its pixels are no rectangles: distances are in pixels")
    assert "--spacing" not in done.err
    run("tessellate in.tif -o a.tif --spacing auto", code=3, says="gdalwarp")
    run("tessellate in.tif -o a.tif --max-distance 7m", code=2, says="give numbers of pixels")
    image = vorotool.read(tmp_path / "in.tif")
    refused(UsageError, "sheared", vorotool.tessellate, image, spacing="auto")
    vorotool.tessellate(image)  # without a warning that advises it


def test_a_system_without_a_code(run, tmp_path):
    write_map(tmp_path / "in.tif", MASK, crs="+proj=laea +lat_0=10 +lon_0=20 +datum=WGS84")
    done = run("skeleton-exact in.tif -f geojson", says="without an EPSG code")
    assert "crs" not in json.loads(done.out)


@pytest.mark.parametrize(
    ("what", "size"), [("labels", "1300x700"), ("distance", "512x512"), ("diagram", "513x1"), ("labels", "3x1025")]
)
@pytest.mark.filterwarnings("ignore::rasterio.errors.NotGeoreferencedWarning")
def test_tiles(run, tmp_path, size, what):
    (tmp_path / "in.csv").write_text("x,y\n2,0\n700,500\n1,600\n1200,90\n")
    options = ["tessellate", "in.csv", "--size", size, "--what", what, "-q", "-o"]
    run(*options, "strips.tif")
    run(*options, "tiles.tif", "--tiled")
    with rasterio.open(tmp_path / "strips.tif") as strips, rasterio.open(tmp_path / "tiles.tif") as tiles:
        assert tiles.block_shapes == [(512, 512)]
        assert (strips.read(1) == tiles.read(1)).all()
    image = tifffile.imread(tmp_path / "tiles.tif")
    assert (image == tifffile.imread(tmp_path / "strips.tif")).all()
    if what == "labels":
        strips, tiles = (
            run(f"tessellate {name}.tif --what table -q --seeds labels").out for name in ("strips", "tiles")
        )
        assert strips == tiles
    run(f"tessellate in.csv --size {size} -o a.png --tiled", code=2, says="--tiled")


# ---- nodata --------------------------------------------------------------------------------------
KNOWN = np.arange(50) < 40


@pytest.mark.parametrize(
    ("values", "nodata", "options", "plain"),
    [
        (np.where(KNOWN, MASK, 7), 7, "", MASK * KNOWN),
        (np.where(KNOWN, MASK, 7), 7, "--threshold 100 --invert", (255 - MASK) * KNOWN),
        (np.where(MASK == 255, 1, np.where(KNOWN, np.nan, 0)).astype(np.float32), np.nan, "", MASK),
    ],
)
def test_nodata_is_background(run, tmp_path, monkeypatch, values, nodata, options, plain):
    """Of images that are held, and of those that are not."""
    write_map(tmp_path / "in.tif", values, nodata=nodata)
    tifffile.imwrite(tmp_path / "plain.tif", plain)
    run("tessellate plain.tif -o plain.npy")
    for pixels in (2**24, 100):
        monkeypatch.setattr("vorotool.jobs.tessellation.LARGE", pixels)
        run(f"tessellate in.tif -o out.npy {options}")
        assert (np.load(tmp_path / "out.npy") == np.load(tmp_path / "plain.npy")).all()


# ---- world files ---------------------------------------------------------------------------------
@pytest.mark.parametrize(
    ("image", "world"),
    [("a.tif", "a.TFW"), ("a.tif", "a.tifw"), ("a.gif", "a.gfw"), ("a.png", "a.wld"), ("a.jpg", "a.jgw")],
)
def test_world_files(run, tmp_path, image, world):
    Image.fromarray(MASK).save(tmp_path / image)
    (tmp_path / world).write_text("25\n0\n0\n-25\n2600012.5\n1199987.5\n")
    write_map(tmp_path / "map.tif", MASK)
    options = ["--what", "table", *(["--threshold", "100"] if image.endswith("jpg") else [])]
    assert run(f"tessellate {image}", *options, says=image).out == run("tessellate map.tif --what table").out
    run(f"tessellate {image} -o out.tif", *options[2:])
    transform, crs, *_ = about(tmp_path / "out.tif")
    assert (transform, crs) == (NORTH_UP, None)


@pytest.mark.parametrize("text", ["1\n2\n3\n4\n5\n", "1 0 0 -1 0 nan", "1 1 1 1 0 0", "9" * 5000])
def test_world_files_that_are_none(run, tmp_path, text):
    tifffile.imwrite(tmp_path / "a.tif", MASK)
    (tmp_path / "a.tfw").write_text(text)
    run("tessellate a.tif -o out.png", code=3, says=["a.tfw", "correct or remove it"])


def test_control_points_are_not_used(run, tmp_path):
    points = tuple(float(k) for k in range(24))
    tifffile.imwrite(tmp_path / "a.tif", MASK, extratags=[(33922, 12, 24, points, True)])
    run("tessellate a.tif --what table", says="placed by control points, which are not used")


def test_many_images_of_maps(run, tmp_path):
    (tmp_path / "in").mkdir()
    write_map(tmp_path / "in" / "a.tif", MASK)
    write_map(tmp_path / "in" / "b.tif", MASK, transform=from_origin(0, 0, 50, 50))
    run("tessellate in --table all.csv --out-dir out -f tiff -q")
    assert about(tmp_path / "out" / "b.tif")[:2] == about(tmp_path / "in" / "b.tif")[:2]
    write_map(tmp_path / "in" / "c.tif", MASK, crs="EPSG:3857")
    run("tessellate in --table all.csv -q", code=3, says=["EPSG:2056", "in/a.tif", "EPSG:3857", "in/c.tif"])


def test_distances_in_pixels_are_said_to_be(run, tmp_path):
    write_map(tmp_path / "map.tif", MASK, NORTH_UP, "EPSG:2056")
    made = run(f"tessellate {tmp_path}/map.tif --what distance -o {tmp_path}/a.tif")
    assert "25 m: distances are in pixels; --spacing auto" in made.err
    run(
        f"tessellate {tmp_path}/map.tif --what distance --pixel-size auto -o {tmp_path}/a.tif",
        code=2,
        says="--spacing,",
    )
    assert not run(f"tessellate {tmp_path}/map.tif --what distance --spacing auto -o {tmp_path}/b.tif").err
    pixels, meters = (tifffile.imread(tmp_path / name) for name in ("a.tif", "b.tif"))
    np.testing.assert_allclose(meters, 25 * pixels, rtol=1e-6)
