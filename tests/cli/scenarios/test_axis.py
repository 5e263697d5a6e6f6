"""The y axis: each kind of input in each format of outputs, against the table of what goes up, down, or is unstated.

The shape is a triangle with two vertices at y = 0 and one at y = 5: where y goes down, its centroid is in the upper
half of a picture.
"""

import io
import json
import re

import ezdxf
import geopandas
import numpy as np
import pytest
import shapely
from ezdxf import disassemble
from PIL import Image

import vorotool
from support.families.geojson import collection
from support.refusals import refused

pytestmark = pytest.mark.filterwarnings("ignore:'crs' was not provided:UserWarning")

PLACES = [(0, 0), (10, 0), (0, 5)]
TRIANGLE = shapely.Polygon(PLACES)
CRS = "EPSG:2056"


def pixels(folder, name):
    """An image of three pixels, or of a triangle: rows go down."""
    labels = np.zeros((6, 11), np.uint8)
    for label, (x, y) in enumerate(PLACES, 1):
        labels[y, x] = label
    if name == "mask.png":
        y, x = np.indices(labels.shape)
        labels = np.where(x <= 10 - 2 * y, 255, 0).astype(np.uint8)
    Image.fromarray(labels).save(folder / name)


def text(content):
    return lambda folder, name: (folder / name).write_text(content)


def table(*columns):
    return text("\n".join([",".join(columns), *(f"{x},{y}" for x, y in PLACES), ""]))


def features(*shapes, **members):
    return text(collection(shapes, **members))


def layer(*shapes, crs=None):
    return lambda folder, name: geopandas.GeoDataFrame(
        {"a": range(len(shapes))}, geometry=list(shapes), crs=crs
    ).to_file(folder / name)


def drawing(folder, name):
    document = ezdxf.new()
    document.modelspace().add_lwpolyline(PLACES, close=True)
    document.saveas(folder / name)


POINTS = [shapely.Point(place) for place in PLACES]
OF_POINTS = {
    "a.csv": (table("x", "y"), "none"),
    "map.csv": (table("easting", "northing"), "up"),
    "degrees.csv": (table("lon", "lat"), "up"),
    "a.npy": (lambda folder, name: np.save(folder / name, np.array(PLACES, float)), "none"),
    "a.json": (text(json.dumps(PLACES)), "none"),
    "a.node": (text("3 2 0 0\n1 0 0\n2 10 0\n3 0 5\n"), "none"),
    "a.wkt": (text("\n".join(point.wkt for point in POINTS)), "up"),
    "a.geojson": (features(*POINTS), "up"),
    "down.geojson": (features(*POINTS, y_axis="down"), "down"),
    "none.geojson": (features(*POINTS, y_axis="none"), "none"),
    "a.gpkg": (layer(*POINTS, crs=CRS), "up"),
    "labels.png": (pixels, "down"),
}
SVG = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 20 20"><path d="M0 0H10L0 5Z"/></svg>'
OF_POLYGONS = {
    "a.json": (text(json.dumps(PLACES)), "none"),
    "down.json": (text(json.dumps({"y_axis": "down", "polygons": [{"shell": PLACES}]})), "down"),
    "a.poly": (text("3 2 0 0\n1 0 0\n2 10 0\n3 0 5\n3 0\n1 1 2\n2 2 3\n3 3 1\n0\n"), "none"),
    "a.wkt": (text(TRIANGLE.wkt), "up"),
    "a.geojson": (features(TRIANGLE), "up"),
    "down.geojson": (features(TRIANGLE, y_axis="down"), "down"),
    "a.gpkg": (layer(TRIANGLE, crs=CRS), "up"),
    "a.shp": (layer(TRIANGLE), "up"),
    "a.svg": (text(SVG), "down"),
    "a.dxf": (drawing, "up"),
    "mask.png": (pixels, "down"),
}
CASES = [("delaunay", name) for name in OF_POINTS] + [("skeleton-exact", name) for name in OF_POLYGONS]


def made(folder, command, name):
    make, axis = (OF_POINTS if command == "delaunay" else OF_POLYGONS)[name]
    make(folder, name)
    return axis


def centroid(rings):
    return shapely.MultiPolygon([shapely.Polygon(ring) for ring in rings]).centroid.y


def is_drawn_down(svg):
    """Whether the polygons of an SVG lie in the upper half of the box that they need."""
    paths = [re.findall(r"[-0-9.]+", d) for d in re.findall(r' d="(M[^"]*Z)"', svg)]
    rings = [np.array(path, float).reshape(-1, 2) for path in paths]
    low, high = (bound(np.concatenate(rings)[:, 1]) for bound in (np.min, np.max))
    return centroid(rings) < (low + high) / 2


def extent(geometry):
    """Signs of y of geometry: that of the triangle, or of its mirror image."""
    low, high = (shapely.total_bounds(np.asarray(geometry, dtype=object))[k] for k in (1, 3))
    return "mirrored" if low < -2 else "as given" if high > 2 else "flat"


STATED = {None: (), "up": ("--y-up",), "down": ("--y-down",)}


STATING = {"a.csv": "up", "degrees.csv": "down", "labels.png": "up", "a.json": "down", "mask.png": "up"}


@pytest.mark.parametrize(
    ("command", "name", "stated"),
    [*((*case, None) for case in CASES), *((*case, STATING[case[1]]) for case in CASES if case[1] in STATING)],
    ids=str,
)
def test_outputs_say_which_way_y_goes(run, tmp_path, command, name, stated):
    axis = made(tmp_path, command, name)
    if stated == "down" and name in ("a.gpkg", "degrees.csv"):
        run(command, name, *STATED[stated], code=2, says="where y goes up: leave out --y-down")
        return
    axis = stated or axis
    given = (command, name, *STATED[stated])
    polygons = "triangles" if command == "delaunay" else "polygons"

    drawn = run(*given, "--layers", polygons, "-f", "svg").out
    assert is_drawn_down(drawn) == (axis != "up")
    run(*given, "--layers", polygons, "-o", "out.png", "--width", "300")
    with Image.open(tmp_path / "out.png") as image:
        rows = np.nonzero(np.array(image.convert("L")) < 255)[0]
    assert (rows.mean() < (rows.min() + rows.max()) / 2) == (axis != "up")

    what = ("--what", "cells") if command == "delaunay" else ("--what", "offset", "-d", "-0.1")
    done = run(*given, *what, "-f", "geojson")
    document = json.loads(done.out)
    assert document.get("y_axis") == (None if axis == "up" else axis)
    shapes = [shapely.geometry.shape(each["geometry"]) for each in document["features"]]
    assert extent(shapes) == "as given"
    assert "--y-down" not in done.err

    done = run(*given, *what, "-f", "wkt")
    assert extent(shapely.from_wkt(done.out.splitlines())) == "as given"
    assert ("note: y goes down in standard output, as in the input: read it with --y-down" in done.err) == (
        axis == "down"
    )
    run(*given, *what, "-o", "out.gpkg", "--overwrite")
    assert extent(geopandas.read_file(tmp_path / "out.gpkg").geometry) == "as given"

    done = run(*given, *what, "-o", "out.dxf")
    corners = [
        shapely.Point(x, y)
        for entity in ezdxf.readfile(tmp_path / "out.dxf").modelspace()
        for x, y, *_ in next(disassemble.to_primitives([entity])).vertices()
    ]
    assert extent(corners) == ("mirrored" if axis == "down" else "as given")
    assert ("y is negated" in done.err) == (axis == "down" and name.endswith(".png"))


@pytest.mark.parametrize(
    ("command", "what", "name", "fmt"),
    [
        *(("skeleton-exact", "skeleton", "a.json", "json"), ("skeleton-exact", "skeleton", "a.svg", "npz")),
        *(("skeleton-exact", "skeleton", "a.wkt", "geojson"), ("skeleton-exact", "offset", "mask.png", "json")),
        *(("skeleton-exact", "offset", "a.json", "jsonl"), ("voronoi", "cells", "a.svg", "json")),
        *(("voronoi", "cells", "mask.png", "npz"), ("voronoi", "cells", "a.json", "geojson")),
    ],
)
def test_results_that_are_read_back_have_their_axis(run, tmp_path, command, what, name, fmt):
    axis = made(tmp_path, "skeleton-exact", name)
    more = ("-d", "-0.5") if what == "offset" else ()
    done = run(command, name, "--what", what, *more, "-f", fmt, "-o", f"out.{fmt}", code=None)
    if done.code:
        assert "cannot be written as" in done.err
        return
    kind = "json" if fmt in ("geojson", "jsonl") else None
    back = vorotool.read(tmp_path / f"out.{fmt}", geometry="polygons" if kind and what != "skeleton" else None)
    assert back.y_axis == axis
    assert vorotool.read(tmp_path / f"out.{fmt}", y_up=False).y_axis == "down"


VALUES = {
    "shapely": (TRIANGLE, "up"),
    "list of shapely": ([TRIANGLE], "up"),
    "text": (TRIANGLE.wkt, "up"),
    "mapping": (shapely.geometry.mapping(TRIANGLE), "up"),
    "stated mapping": ({**shapely.geometry.mapping(TRIANGLE), "y_axis": "down"}, "down"),
    "series": (geopandas.GeoSeries([TRIANGLE]), "up"),
    "pairs": (PLACES, "none"),
    "array": (np.array(PLACES, float), "none"),
    "shell": ({"shell": PLACES}, "none"),
    "mask": (np.indices((6, 11))[1] <= 10 - 2 * np.indices((6, 11))[0], "down"),
}


@pytest.mark.parametrize("name", VALUES)
def test_values_of_the_library_have_an_axis(name, tmp_path):
    given, axis = VALUES[name]
    skeleton = vorotool.skeleton_exact(vorotool.outlines(given) if name == "mask" else given)
    assert skeleton.y_axis == axis
    vorotool.write(skeleton, tmp_path / "out.svg", layers=["polygons"])
    assert is_drawn_down((tmp_path / "out.svg").read_text()) == (axis != "up")
    vorotool.write(skeleton, tmp_path / "out.svg", layers=["polygons"], y_up=axis != "up")
    assert is_drawn_down((tmp_path / "out.svg").read_text()) == (axis == "up")
    assert skeleton.__geo_interface__.get("y_axis", "up") == axis
    assert vorotool.to_geojson(skeleton).get("y_axis", "up") == axis


@pytest.mark.parametrize("axis", ["sideways", None])
def test_another_axis_is_refused(run, tmp_path, axis):
    features(TRIANGLE, y_axis=axis)(tmp_path, "a.geojson")
    run("skeleton-exact a.geojson", code=3, says=repr(axis))
    refused(vorotool.InputError, "y_axis", vorotool.PolygonSet, PLACES, [0, 3], [0], [0], y_axis=axis)


def test_parts_of_a_mask_lie_on_it_again(run, tmp_path):
    """A label image that is made of polygons of a mask, through GeoJSON, covers the mask and not its mirror image."""
    pixels(tmp_path, "mask.png")
    run("skeleton-exact mask.png --what parts -o parts.geojson")
    window = ("--window=-0.5,-0.5,11,6", "--max-distance", "0")
    run("tessellate parts.geojson --cell-size 1", *window, "-o", "parts.tif")
    with Image.open(tmp_path / "parts.tif") as made, Image.open(tmp_path / "mask.png") as mask:
        assert ((np.array(made) > 0) == (np.array(mask) > 0)).all()


def test_lines_that_differ_in_their_axis_are_refused(run):
    lines = io.StringIO()
    for axis in ("up", "down"):
        feature = {"type": "Feature", "y_axis": axis, "properties": {}, "geometry": shapely.geometry.mapping(TRIANGLE)}
        lines.write(json.dumps(feature) + "\n")
    data = lines.getvalue().encode()
    run("skeleton-exact - --input-format jsonl", data=data, code=3, says="line 2: y_axis is not 'up'")
