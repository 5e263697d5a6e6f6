"""``--spacing``: distances, lengths and results in the unit of rectangular pixels."""

import json

import numpy as np
import pytest
import rasterio
import shapely
import tifffile
from PIL import Image

import vorotool
from support.families.rasters import write_map, write_sized
from vorotool.engines.label_images.outlines import outlines
from vorotool.engines.tessellation.tessellator import Tessellator

X, Y = np.array([2, 9, 4, 15]), np.array([3, 4, 12, 9])
MASK = np.zeros((24, 32), np.uint8)
MASK[3:9, 4:11] = MASK[12:20, 15:30] = 255
MASK[14:17, 18:22] = 0
FRAME = ["--size", "20x15"]


@pytest.fixture
def dots(tmp_path):
    lines = ["x,y,name", *(f"{x},{y},p{x}" for x, y in zip(X, Y, strict=True))]
    (tmp_path / "dots.csv").write_text("\n".join(lines))
    return tmp_path


def tessellated(spacing, **options):
    return vorotool.tessellate(np.stack([X, Y], axis=1), shape=(15, 20), spacing=spacing, **options)


def test_labels_and_distances(run, dots):
    image = tessellated((0.5, 0.325))
    sweep = Tessellator(image.seeds, image.frame, sides=image.sides)
    for what, right in (
        ("labels", image.labels),
        ("distance", sweep.distances()),
        ("distance2", sweep.squared_distances()),
    ):
        done = run("tessellate dots.csv", *FRAME, "--spacing", "0.325,0.5", "--what", what, "-o", "a.npy", "--verify")
        assert np.array_equal(np.load(dots / "a.npy"), right)
    assert "note: squared distances are in squares of a step of 1/40" in done.err


@pytest.mark.parametrize("limit", ["1.5", "1500nm"])
def test_bare_lengths_are_in_the_unit_of_the_spacing(run, dots, limit):
    args = ["--spacing", "0.325,0.5um", "--max-distance", limit, "-o", "a.npy", "--verify"]
    run("tessellate dots.csv", *FRAME, *args)
    assert np.array_equal(np.load(dots / "a.npy"), tessellated((0.5, 0.325), max_distance=1.5).labels)


def test_tables_are_in_the_unit_which_they_name(run, dots):
    rows = run("tessellate dots.csv", *FRAME, "--spacing", "0.325,0.5um", "--what", "table").rows
    image = tessellated((0.5, 0.325))
    squares = Tessellator(image.seeds, image.frame, sides=image.sides).squared_distances()
    table = vorotool.region_table(image, distance2=squares)
    assert list(rows[0]) == [*table, "name", "unit"]
    for name in table:
        assert [float(row[name]) for row in rows] == table[name].tolist()
    assert {row["unit"] for row in rows} == {"um"}
    rows = run("tessellate dots.csv", *FRAME, "--spacing", "0.325,0.5um", "--what", "neighbors").rows
    borders = vorotool.neighbor_table(image)
    assert [float(row["border_length"]) for row in rows] == borders["border_length"].tolist()
    assert [float(row["centroid_distance"]) for row in rows] == borders["centroid_distance"].tolist()


def test_statistics_name_the_step_and_the_arithmetic(run, dots):
    run("tessellate dots.csv", *FRAME, "--spacing", "0.325,0.5um", "-o", "a.npy", "--stats", "s.json")
    stats = json.loads((dots / "s.json").read_text())
    assert (stats["spacing"], stats["unit"]) == ([0.325, 0.5], "um")
    assert (stats["distance2_step"], stats["arithmetic"]) == ("1/40", "float64")
    run("tessellate dots.csv", *FRAME, "--spacing", "1,2000001", "-o", "a.npy", "--stats", "s.json")
    assert json.loads((dots / "s.json").read_text())["arithmetic"] == "float64 with int128"


def test_too_large_a_range_is_refused_before_work(run, dots):
    window = "1000000,1000000,5,5"
    run(f"tessellate dots.csv --window {window} --spacing 1,1999999 -o a.npy", code=3, says="is too far from the frame")


# ---- images --------------------------------------------------------------------------------------
@pytest.mark.parametrize("kind", ["ome", "imagej"])
def test_auto_takes_what_the_file_says(run, tmp_path, kind):
    write_sized(tmp_path / "in.tif", kind, (0.325, 0.5), values=MASK)
    plain = run("tessellate in.tif --what table", says="--spacing")
    auto = run("tessellate in.tif --what table --spacing auto --stats s.json")
    typed = run("tessellate in.tif --what table --spacing 0.325,0.5µm")
    assert (auto.err, auto.out) == ("", typed.out) != ("", plain.out)
    assert json.loads((tmp_path / "s.json").read_text())["spacing"] == [0.325, 0.5]
    run("tessellate in.tif --what table --pixel-size auto", code=3, says="--spacing")
    run("tessellate in.tif -o a.npy --spacing auto --max-distance 2um")
    right = vorotool.tessellate(MASK, spacing=(0.5, 0.325), max_distance=2).labels
    assert np.array_equal(np.load(tmp_path / "a.npy"), right)


@pytest.mark.parametrize(("name", "large"), [("dots.csv", 2**24), ("in.tif", 100)])
def test_images_that_are_written_say_the_spacing(run, dots, monkeypatch, name, large):
    monkeypatch.setattr("vorotool.jobs.tessellation.LARGE", large)
    write_sized(dots / "in.tif", "ome", (2, 2), values=MASK)
    frame = FRAME if name == "dots.csv" else []
    for end in (".tif", ".ome.zarr"):
        run(f"tessellate {name}", *frame, "--spacing", "0.325,0.5um", "-q", "-o", f"out{end}")
        args = ["tessellate", f"out{end}", "--what", "table", "--stats", "s.json"]
        run(*args, "--spacing", "auto")
        stats = json.loads((dots / "s.json").read_text())
        assert (stats["spacing"], stats["unit"].replace("µ", "u")) == ([0.325, 0.5], "um")


def test_auto_needs_a_file_that_says_it(run, tmp_path):
    np.save(tmp_path / "in.npy", MASK)
    run("tessellate in.npy --spacing auto -o a.png", code=3, says="--spacing")
    write_sized(tmp_path / "in.tif", "ome", (0.32512345, 1.2345678))
    run("tessellate in.tif --spacing auto -o a.png", code=3, says="no common step that is coarse enough")


def test_a_map_with_pixels_that_are_no_squares(run, tmp_path):
    write_map(tmp_path / "in.tif", MASK, rasterio.Affine(30, 0, 2600000, 0, -25, 1200000))
    run("tessellate in.tif --what table --pixel-size auto", code=3, says="--pixel-size 1")
    rows = run("tessellate in.tif --what table --spacing auto").rows
    # 42 pixels in columns 4 to 10 and rows 3 to 8: center (7, 5.5)
    assert (float(rows[0]["x"]), float(rows[0]["y"])) == (2600000 + 7.5 * 30, 1200000 - 6 * 25)
    assert float(rows[0]["object_area"]) == 42 * 750
    for row, mask in zip(
        rows, vorotool.tessellate(MASK, spacing=(25, 30)).labels == np.array([1, 2])[:, None, None], strict=True
    ):
        y, x = np.nonzero(mask)
        assert float(row["bbox_x"]) == 2600000 + x.min() * 30
        assert float(row["bbox_y"]) == 1200000 - (y.max() + 1) * 25
    typed = run("tessellate in.tif --what table --spacing 30,25m").rows
    assert (float(typed[0]["x"]), float(typed[0]["y"])) == (7 * 30, 5.5 * 25)


@pytest.mark.parametrize(
    ("what", "options"),
    [
        *(("labels", ["--seeds", "labels"]), ("distance", []), ("distance2", ["--seeds", "pixels"])),
        *(("table", ["--seeds", "components"]), ("neighbors", [])),
    ],
)
def test_images_that_pass_by_have_the_same_bytes(run, tmp_path, monkeypatch, what, options):
    labels = np.kron(np.random.default_rng(2).random((40, 30)) < 0.05, np.ones((3, 2))).astype(np.uint8) * 7
    tifffile.imwrite(tmp_path / "in.tif", labels, rowsperstrip=8)
    args = ["tessellate", "in.tif", "--what", what, "--spacing", "0.325,0.5um", "-q", *options]
    limit = ["--max-distance", "2"] if not what.startswith("distance") else []
    is_table = what in ("table", "neighbors")
    end = "csv" if is_table else "npy"
    run(*args, *limit, "-o", f"held.{end}")
    monkeypatch.setattr("vorotool.jobs.tessellation.LARGE", 100)
    monkeypatch.setattr("vorotool.engines.tessellation.streamed_image.SWEEP_PIXELS", 60 * 7)
    monkeypatch.setattr("vorotool.engines.tessellation.frames.BAND_PIXELS", 60 * 11)
    run(*args, *limit, "-o", f"passed.{end}", "--stats", "s.json", "--chunk", "60x8", code=2)
    run(*args, *limit, "-o", f"passed.{end}", "--stats", "s.json")
    assert (tmp_path / f"passed.{end}").read_bytes() == (tmp_path / f"held.{end}").read_bytes()
    stats = json.loads((tmp_path / "s.json").read_text())
    assert stats["spacing"] == [0.325, 0.5]
    assert (stats["distance2_step"], stats["arithmetic"], "labels" in stats) == ("1/40", "float64", is_table)


# ---- triangulations, skeletons, Voronoi maps ----------------------------------------
STEPS = (20, 13)  # of 0.025, in 0.5 and 0.325


@pytest.fixture
def masks(tmp_path):
    Image.fromarray(MASK).save(tmp_path / "mask.png")
    (tmp_path / "dots.csv").write_text("x,y\n2,3\n9,4\n4,12\n15,9\n11,14\n")
    return tmp_path


def in_units(polygons):
    return polygons * (0.5, 0.325)


def shapes(path):
    features = json.loads(path.read_text())["features"]
    return shapely.from_geojson([json.dumps(each["geometry"]) for each in features])


@pytest.mark.parametrize("options", [["--prune", "length=0.3um"], ["--outline", "contour"]])
def test_exact_skeletons_are_those_of_outlines_in_the_unit(run, masks, options):
    args = ["--spacing", "0.5,0.325um", "--verify", *options]
    run("skeleton-exact mask.png -o a.geojson", *args)
    polygons = outlines(MASK, outline="contour" if "contour" in options else "crack")
    steps = shapely.transform(polygons.to_shapely(), lambda xy: xy * STEPS)
    skeleton = vorotool.skeleton_exact(steps)
    if "none" not in options:
        criterion = {"length": 0.3 / 0.025} if "length=0.3um" in options else {"scale": 1.5}
        skeleton = vorotool.prune(skeleton, **criterion)
    expected = shapely.transform(skeleton.to_shapely(), lambda xy: xy / 40)
    found = shapes(masks / "a.geojson")
    assert shapely.hausdorff_distance(shapely.union_all(found), shapely.union_all(expected)) < 0.01
    assert sum(shapely.length(found)) == pytest.approx(sum(shapely.length(expected)), rel=1e-3)


@pytest.mark.parametrize("distance", ["-0.3", "-300nm"])
def test_offsets_are_at_distances_in_the_unit(run, masks, distance):
    args = ["--what", "offset", "-d", distance, "--spacing", "0.5,0.325um"]
    run("skeleton-exact mask.png", *args, "-o", "a.geojson")
    first = shapes(masks / "a.geojson")[0]
    assert first.bounds == pytest.approx((3.5 * 0.5 + 0.3, 2.5 * 0.325 + 0.3, 10.5 * 0.5 - 0.3, 8.5 * 0.325 - 0.3))


def test_voronoi_maps(run, masks):
    args = ["--spacing", "0.5,0.325um", "--frame", "0,0,16,8", "--max-distance", "1.5", "--verify"]
    rows = run("voronoi mask.png --what table", *args).rows
    polygons = shapely.transform(outlines(MASK).to_shapely(), in_units)
    cells = vorotool.voronoi(polygons, frame=(0, 0, 16, 8), max_distance=1.5)
    assert [float(row["area"]) for row in rows] == pytest.approx(cells.areas.tolist(), rel=1e-5)


@pytest.mark.parametrize("method", ["exact", "digital-valid"])
def test_triangulations_are_of_places_in_the_unit(run, masks, method):
    args = ["--method", method, "--spacing", "0.5,0.325um", "--verify", "-q"]
    rows = run("delaunay dots.csv -f csv", *args).rows
    points = np.loadtxt(masks / "dots.csv", delimiter=",", skiprows=1)
    mesh = vorotool.delaunay(points * STEPS)
    assert [(int(row["label_a"]) - 1, int(row["label_b"]) - 1) for row in rows] == [
        tuple(e) for e in mesh.edges.tolist()
    ]
    assert [float(row["length"]) for row in rows] == pytest.approx((mesh.edge_lengths() / 40).tolist())
    assert {row["unit"] for row in rows} == {"um"}


def test_places_are_in_the_unit(run, masks):
    args = ["skeleton-exact", "mask.png", "--what", "centerline", "-f", "wkt", "--spacing", "0.5,0.325um", "--from"]
    assert (
        run(*args, "2,1.7875", "--to", "5,1.7875").out
        == "LINESTRING (2 1.7875, 2.725 1.7875, 4.275 1.7875, 5 1.7875)\n"
    )
    words = ["leads from (80, 80) to (560, 200)", "(coordinates in steps of 1/40 um)"]
    run(*args, "2,2", "--to", "14,5", code=3, says=words)
