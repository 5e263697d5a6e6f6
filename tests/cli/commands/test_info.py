"""``vorotool info``: what is told is what other libraries find, and the commands that are named take the file."""

import json
import os
import threading

import imageio.v3 as iio
import numpy as np
import pytest
import shapely
import tifffile
from scipy import ndimage

from vorotool.jobs import description
from vorotool.products.registry import PRODUCTS
from vorotool.products.samples import SAMPLES


@pytest.fixture
def info(run):
    """What is told of inputs, as parsed JSON."""

    def call(*arguments):
        done = run("info --json", *arguments)
        return [json.loads(line) for line in done.out.splitlines()]

    return call


def test_each_page_is_told(run, info, tmp_path):
    tifffile.imwrite(tmp_path / "stack.tif", np.eye(9, dtype=np.uint8) * np.array([[[1]], [[7]]], np.uint8))
    tifffile.imwrite(tmp_path / "one.tif", np.eye(9, dtype=np.uint8))
    told = info("stack.tif", "one.tif", "--page", "all")
    assert [each["input"] for each in told] == ["stack.tif, page 0", "stack.tif, page 1", "one.tif, page 0"]
    assert [each["kind"] for each in told] == ["mask", "label image", "mask"]
    assert run("info stack.tif --page all").out.startswith("stack.tif, page 0\n")


def test_an_archive_with_an_image_is_not_a_table(run, tmp_path):
    np.savez(tmp_path / "a.npz", np.eye(9))
    run("info a.npz", code=3, says="arr_0.npy has the shape (9, 9); save an image or points as NPY")


def test_features_without_geometry_are_named_alike_by_all(run, tmp_path):
    geometries = ({"type": "Point", "coordinates": [1, 2]}, None)
    features = [{"type": "Feature", "properties": {}, "geometry": each} for each in geometries]
    (tmp_path / "a.geojson").write_text(json.dumps({"type": "FeatureCollection", "features": features}))
    for command in ("voronoi a.geojson", "distance a.geojson a.geojson"):
        assert "1 feature without geometry kept, and empty" in run(command).err


# ---- against other libraries ---------------------------------------------------------------------
def test_points(info, tmp_path):
    (tmp_path / "a.csv").write_text("lon,name,lat,n\n7.5,Ulm,48.25,1\n-3,,40,2\n")
    (told,) = info("a.csv")
    assert (told["format"], told["kind"], told["points"], told["bounds"]) == ("csv", "points", 2, [-3, 40, 7.5, 48.25])
    assert (told["crs"], told["y"]) == ("OGC:CRS84", "up")
    assert told["columns"] == {"name": "text", "n": "integer"}
    assert told["notes"] == [
        "a.csv: columns lon, lat are read as x, y",
        "a.csv: longitude and latitude are treated as planar, lengths are in degrees; --crs EPSG:32631 works in "
        "meters (UTM)",
    ]


@pytest.mark.parametrize("name", [name for name in SAMPLES if name.endswith("json")] + ["segments.wkt"])
def test_polygons_are_as_many_and_where_shapely_finds_them(run, info, tmp_path, name):
    run(f"sample {name} -o {name}")
    text = (tmp_path / name).read_text(encoding="utf-8")
    (told,) = info(name)
    if name.endswith(".wkt"):
        shapes = [shapely.from_wkt(text)]
    elif name.endswith(".geojson"):
        shapes = [shapely.geometry.shape(each["geometry"]) for each in json.loads(text)["features"]]
    else:
        document = json.loads(text)
        rings = document["polygons"] if isinstance(document, dict) else document
        rings = [ring if isinstance(ring, dict) else {"shell": ring} for ring in rings]
        shapes = [shapely.Polygon(ring["shell"], ring.get("holes", ())) for ring in rings]
    parts = shapely.get_parts(shapes)
    lines = parts[shapely.get_type_id(parts) == shapely.GeometryType.LINESTRING]
    polygons = parts[shapely.get_type_id(parts) == shapely.GeometryType.POLYGON]
    assert told["bounds"] == shapely.total_bounds(shapes).tolist()
    assert (told["features"], told["polygons"], told["lines"]) == (len(shapes), len(polygons), len(lines))
    assert told["holes"] == int(shapely.get_num_interior_rings(polygons).sum())
    rings = int((shapely.get_num_interior_rings(polygons) + 1).sum())
    if name != "great-lakes.geojson":  # whose rings repeat vertices, which are left out
        assert told["vertices"] == int(shapely.get_num_coordinates(parts).sum()) - rings


def test_masks_and_label_images(info, tmp_path):
    chance = np.random.default_rng(5)
    mask = chance.random((40, 60)) < 0.2
    labels = chance.integers(1, 9, (5, 7)).repeat(8, 0).repeat(8, 1).astype(np.uint16)
    iio.imwrite(tmp_path / "mask.png", mask.astype(np.uint8) * 255)
    tifffile.imwrite(tmp_path / "labels.tif", labels, resolution=(20, 40), resolutionunit=3)
    np.save(tmp_path / "mask.npy", mask)
    told, same, regions = info("mask.png", "mask.npy", "labels.tif")
    count = ndimage.label(mask, np.ones((3, 3)))[1]
    assert (told["kind"], told["objects"], told["foreground_pixels"]) == ("mask", count, int(mask.sum()))
    assert (told["width"], told["height"], told["type"], told["pixel_size"]) == (60, 40, "uint8", None)
    assert [same[name] for name in ("kind", "objects", "foreground_pixels")] == ["mask", count, int(mask.sum())]
    assert (regions["kind"], regions["objects"]) == ("label image", len(np.unique(labels)))
    assert (regions["pixel_size"], regions["unit"]) == ([0.05, 0.025], "cm")


def test_pictures_say_what_to_do(run, info, tmp_path):
    chance = np.random.default_rng(6)
    iio.imwrite(tmp_path / "grey.png", chance.integers(0, 255, (64, 64), dtype=np.uint8))
    iio.imwrite(tmp_path / "color.png", chance.integers(0, 255, (8, 9, 3), dtype=np.uint8))
    iio.imwrite(tmp_path / "photo.jpg", chance.integers(0, 255, (8, 9), dtype=np.uint8))
    pictures = info("grey.png", "color.png", "photo.jpg")
    for told, words in zip(pictures, ("a photograph", "a color image", "lossy"), strict=True):
        assert told["kind"] == "picture"
        assert "draw" not in told["commands"]
        assert any(words in note and "--threshold otsu" in note for note in told["notes"])


def test_what_vorotool_wrote(run, info):
    run("sample shape.json -o shape.json")
    run("skeleton-exact shape.json -o skeleton.json")
    run("skeleton-exact shape.json --what offset -d -3,2 -o offset.json")
    run("sample blobs.png -o blobs.png")
    run("tessellate blobs.png -o labels.zarr")
    skeleton, offset, zarr = info("skeleton.json", "offset.json", "labels.zarr")
    assert (skeleton["kind"], skeleton["arcs"], skeleton["polygons"]) == ("skeleton", 9, 1)
    assert (offset["kind"], offset["shapes"], offset["distances"]) == ("offset curves", 2, [-3, 2])
    assert (zarr["format"], zarr["kind"], zarr["objects"]) == ("zarr", "label image", 24)


def test_points_lines_and_polygons_and_their_map(run, info, tmp_path):
    (tmp_path / "a.wkt").write_text("POINT (0 0)\nLINESTRING (5 5, 9 6)\nPOLYGON ((4 9, 9 9, 9 12, 4 9))")
    run("voronoi a.wkt -o map.json -q")
    mixed, cells = info("a.wkt", "map.json")
    assert (mixed["kind"], mixed["commands"]) == ("points, lines and polygons", ["voronoi", "distance"])
    assert [mixed[name] for name in ("features", "points", "lines", "polygons")] == [3, 1, 1, 1]
    assert (cells["kind"], cells["cells"]) == ("Voronoi map", 3)
    assert cells["commands"] == ["voronoi", "skeleton-approx", "skeleton-exact", "distance", "draw"]


def test_a_plain_list_may_be_a_ring(run, info, tmp_path):
    (tmp_path / "a.json").write_text("[[0, 0], [4, 0], [0, 3]]")
    (told,) = info("a.json")
    assert told["kind"] == "points"
    assert "skeleton-exact" in told["notes"][0]
    run("skeleton-exact a.json -o out.json")


def test_large_images_are_told_by_their_headers(info, tmp_path, monkeypatch):
    monkeypatch.setattr(description, "MOST_PIXELS_READ", 11)
    tifffile.imwrite(tmp_path / "a.tif", np.ones((3, 4), np.uint16))
    (told,) = info("a.tif")
    assert (told["kind"], told["width"], told["height"], told["type"]) == ("image", 4, 3, "uint16")
    assert "objects" not in told


# ---- which commands ------------------------------------------------------------------------------
OPTIONS = {"tessellate": ["--size", "600x600"], "skeleton-approx": ["--step", "9"], "draw": ["-f", "svg"]}
OF_IMAGES = {"png": [], "tif": ["--volume", "--what", "color"]}
"""Options of `tessellate` for them."""


@pytest.mark.parametrize(
    "name", [name for name in SAMPLES if name != "great-lakes.geojson"] + ["skeleton.json", "offset.json"]
)
def test_the_commands_that_are_named_take_it_and_no_others(run, info, name):
    if name.removesuffix(".json") in ("skeleton", "offset"):
        run("sample shape.json -o shape.json")
        options = ["-d", "2"] if name == "offset.json" else []
        run("skeleton-exact shape.json --what", name.removesuffix(".json"), *options, "-o", name)
    else:
        run(f"sample {name} -o {name}")
    (told,) = info(name)
    taken = []
    for command in PRODUCTS:
        options = OPTIONS.get(command, [])
        if command == "tessellate":
            options = OF_IMAGES.get(name.rpartition(".")[2], options)
        inputs = [name, name] if command == "distance" else [name]
        ending = "png" if command == "tessellate" else "svg"
        code = run(command, *inputs, *options, "-q", "-o", f"{command}-out.{ending}", code=None).code
        assert code in (0, 3)
        taken += [command] if code == 0 else []
    assert sorted(told["commands"]) == sorted(taken)


# ---- text, streams, several ----------------------------------------------------------------------
def test_text_is_for_people(run, tmp_path):
    (tmp_path / "a.csv").write_text("x,y,label\n0.5,1,3\n2,7,4\n")
    tifffile.imwrite(tmp_path / "a.tif", np.eye(4, dtype=np.uint8), resolution=(20, 20), resolutionunit=3)
    lines = run("info a.csv a.tif").out.splitlines()
    assert lines[:5] == [
        "a.csv",
        "  format     csv",
        "  kind       points",
        "  points     2",
        "  bounds     x 0.5 to 2, y 1 to 7",
    ]
    assert lines[8:11] == ["a.tif", "  format     tiff", "  kind       mask"]
    assert {"  pixel size 0.05 cm", "  foreground 4 pixels", "  objects    1"} < set(lines)


def test_a_pipe_with_a_name(run, tmp_path):
    os.mkfifo(tmp_path / "pipe")
    writer = threading.Thread(target=(tmp_path / "pipe").write_bytes, args=(b"P1 3 2 1 0 0 0 0 1",))
    writer.start()
    done = run("info pipe")
    writer.join()
    assert "kind       mask\n" in done.out


def test_folders_and_patterns(info, folder):
    assert [told["input"] for told in info(folder)] == [f"{folder}/dots.csv", f"{folder}/mask.pbm"]
    assert [told["input"] for told in info("*.pbm", "dots.csv")] == ["mask.pbm", "dots.csv"]


def test_one_that_cannot_be_read_ends_nothing(run, folder):
    (folder / "bad.png").write_bytes(b"\x89PNG and no more")
    done = run("info dots.csv bad.png none.csv mask.pbm --json", code=6)
    assert [json.loads(line)["input"] for line in done.out.splitlines()] == ["dots.csv", "mask.pbm"]
    assert [line.partition(":")[0] for line in done.err.splitlines()] == ["error"] * 3
    assert done.err.splitlines()[-1] == "error: 2 of 4 inputs cannot be read"


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        ("", 2, "no input given: name a file, a folder, or - for standard input"),
        ("empty.png", 3, "empty.png"),
        ("text.png", 3, "text.png"),
        ("edges.csv --columns a,b", 3, "'a'"),
        ("edges.csv", 3, "--columns x_a,y_a"),
        ("mask.pbm --input-crs EPSG:3857", 2, "--input-crs"),
        ("mask.pbm --max-pixels 3", 5, "pixels"),
    ],
)
def test_what_is_wrong(run, folder, arguments, code, words):
    (folder / "empty.png").write_bytes(b"")
    (folder / "text.png").write_bytes(b"x,y\n1,2\n")
    run("delaunay dots.csv -o edges.csv")
    run(f"info {arguments}", code=code, says=words)


def test_types_are_those_of_values_in_json():
    """Whatever readers keep columns as: numbers of numpy, text of a type of its own, arrays."""

    class Code(str):
        __slots__ = ()

    columns = {
        "whole": [np.int32(3), None],
        "broken": [np.float64(0.5), 2],
        "text": [Code("007"), "8"],
        "array": np.array([1.5, 2]),
        "lists": [[1], {"a": 1}],
    }
    found = {name: description._type_of(values) for name, values in columns.items()}
    assert found == {"whole": "integer", "broken": "number", "text": "text", "array": "number", "lists": "other"}
