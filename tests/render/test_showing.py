"""Notebooks and plots: the pictures that are written to files, small ones of what is large, and axes of the data."""

import io
import json
import re
from base64 import b64decode
from dataclasses import replace
from html.parser import HTMLParser
from math import cos, radians
from xml.etree import ElementTree

import imageio.v3 as iio
import numpy as np
import pytest
import shapely
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

import vorotool
from support.families.values import empty_values, example_values, label_image
from support.few import few
from vorotool.numeric.crs import crs_member
from vorotool.types.pixels import map_grid

VALUES = example_values()
PICTURED = [name for name, value in VALUES.items() if hasattr(value, "plot")]
DRAWN = [name for name in PICTURED if name not in {"LabelImage", "Raster"}]
WRITTEN = [name for name in DRAWN if name not in {"PointSet", "SeedSet", "PlanarGraph", "AlphaComplex"}]


def picture_of(html):
    """The pixels of a picture in HTML."""
    return iio.imread(io.BytesIO(b64decode(re.search(r'base64,([^"]+)"', html)[1])))


def axes_of(value, **style):
    return value.plot(Figure().add_subplot(), **style)


@pytest.mark.parametrize("name", DRAWN)
def test_svg_is_a_picture(name):
    text = VALUES[name]._repr_svg_()
    root = ElementTree.fromstring(text)
    assert root.tag.endswith("svg")
    assert root.get("width") == "480"
    assert len(list(root.iter())) > 2
    assert VALUES[name]._repr_html_() is None


@pytest.mark.parametrize("name", WRITTEN)
def test_svg_is_that_of_files(name, tmp_path):
    vorotool.write(VALUES[name], tmp_path / "a.svg", width=480)
    assert (tmp_path / "a.svg").read_text() == VALUES[name]._repr_svg_()


def test_many_elements_are_pixels():
    mesh = vorotool.delaunay(np.random.default_rng(0).random((2000, 2)))
    assert mesh._repr_svg_() is None
    picture = picture_of(mesh._repr_html_())
    assert picture.shape[1] == 480
    assert picture.std() > 10
    assert f"<br>{mesh!r}</figure>" in mesh._repr_html_()


def test_label_images_are_small_pictures_of_their_colors(tmp_path):
    image = label_image()
    assert image._repr_svg_() is None
    vorotool.write(image, tmp_path / "a.png", what="color", layers=["cells"])
    np.testing.assert_array_equal(picture_of(image._repr_html_()), iio.imread(tmp_path / "a.png"))
    large = vorotool.LabelImage(np.kron(image.labels, np.ones((30, 30), np.uint16)))
    assert max(picture_of(large._repr_html_()).shape) <= 320
    assert "LabelImage: 1200 x 900, 9 labels, uint16" in large._repr_html_()


@pytest.mark.parametrize(
    ("values", "expected"),
    [
        (np.array([[0, 1], [1, 0]], bool), [[0, 255], [255, 0]]),
        (np.array([[0.0, 1.0], [2.0, np.nan]]), [[0, 128], [255, 0]]),
        (np.array([[7, 7]], np.uint8), [[255, 255]]),
        (np.array([[0, 0]], np.uint8), [[0, 0]]),
        (np.array([[-1e308, 1e308]]), [[0, 255]]),
        (np.array([[0, 65535]], ">u2"), [[0, 255]]),
        (np.array([[[0, 9], [4, 9]]], np.uint8), [[0, 255]]),
        (np.full((1, 2), np.nan), [[0, 0]]),
    ],
)
def test_rasters_are_grey(values, expected):
    html = vorotool.Raster(values)._repr_html_()
    np.testing.assert_array_equal(picture_of(html), np.repeat(np.array(expected)[..., None], 3, axis=2))


class Cells(HTMLParser):
    """The texts of a table."""

    def __init__(self, text):
        super().__init__()
        self.rows, self.open = [], False
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        if tag == "tr":
            self.rows.append([])
        self.open = tag in {"td", "th"}
        if self.open:
            self.rows[-1].append("")

    def handle_endtag(self, tag):
        self.open = False

    def handle_data(self, data):
        if self.open:
            self.rows[-1][-1] += data


def test_tables_show_their_first_rows():
    table = vorotool.region_table(label_image())
    many = vorotool.Table({"label": np.arange(25), "size": np.ma.array(np.arange(25), mask=np.arange(25) == 1)})
    rows = Cells(many._repr_html_()).rows
    assert rows[:3] == [["label", "size"], ["0", "0"], ["1", ""]]
    assert len(rows) == 11
    assert "25 rows x 2 columns" in many._repr_html_()
    rows = Cells(table._repr_html_()).rows
    assert rows[0] == list(table)
    assert [row[0] for row in rows[1:]] == [str(label) for label in table["label"].tolist()]
    assert Cells(vorotool.Table({"<a>": ["&b", None]})._repr_html_()).rows == [["<a>"], ["&b"], [""]]


@pytest.mark.parametrize("name", few(PICTURED, 8))
def test_plots_cover_the_data(name):
    value = VALUES[name]
    ax = axes_of(value)
    assert len(ax.collections) + len(ax.patches) + len(ax.images) > 0
    assert ax.get_aspect() == 1
    is_up = name not in {"SeedSet", "LabelImage", "Raster", "DigitalTriangulation"}
    assert (ax.get_ylim()[0] < ax.get_ylim()[1]) == is_up
    if hasattr(value, "to_shapely"):
        left, bottom, right, top = shapely.total_bounds(value.to_shapely())
        for limits, low, high in ((ax.get_xlim(), left, right), (ax.get_ylim(), bottom, top)):
            assert min(limits) <= low + 1e-6
            assert max(limits) >= high - 1e-6
    ax.figure.savefig(io.BytesIO(), format="png", dpi=30)


def test_holes_are_holes():
    ring = vorotool.PolygonSet(
        [[0, 0], [9, 0], [9, 9], [0, 9], [3, 3], [3, 6], [6, 6], [6, 3]], [0, 4, 8], [0, 1], [0, 0]
    )
    ax = axes_of(ring, linewidth=0, facecolor="black")
    ax.set_axis_off()
    canvas = FigureCanvasAgg(ax.figure)
    canvas.draw()
    pixels = np.asarray(canvas.buffer_rgba())[..., 0]
    for place, is_ink in (((1.5, 1.5), True), ((4.5, 4.5), False), ((8, 8), True)):
        column, row = ax.transData.transform(place).round().astype(int)
        assert (pixels[pixels.shape[0] - 1 - row, column] < 50) == is_ink, place


def test_images_lie_in_their_frame_and_on_their_map():
    image = vorotool.tessellate([[12, 21], [15, 23]], window=(10, 20, 8, 6))
    shown = axes_of(image).images[0]
    assert shown.get_extent() == [9.5, 17.5, 25.5, 19.5]
    colors = shown.get_array()
    assert len({tuple(c) for c in colors.reshape(-1, 3).tolist()}) == 2
    assert ((colors == colors[0, 0]).all(axis=2) == (image.labels == image.labels[0, 0])).all()
    grid = map_grid((2.0, 0.0, 100.0, 0.0, -2.0, 60.0))
    ax = axes_of(vorotool.LabelImage(image.labels, grid=grid))
    assert ax.images[0].get_extent() == [100, 116, 48, 60]
    assert ax.get_ylim() == (48, 60)
    raster = vorotool.Raster(np.arange(6).reshape(2, 3))
    assert axes_of(raster, cmap="viridis").images[0].get_cmap().name == "viridis"


def test_degrees_are_as_long_as_they_are_in_the_middle():
    points = vorotool.PointSet([[-24, 63], [-13, 67]], y_axis="up", crs=crs_member("EPSG:4326"))
    for value in (points, vorotool.delaunay(points)):
        ax = axes_of(value)
        assert ax.get_aspect() == pytest.approx(1 / cos(radians(sum(ax.get_ylim()) / 2)))
    pole = replace(points, xy=np.array([[0.0, 90.0], [10.0, 90.0]]))
    assert axes_of(pole).get_aspect() == 1


@pytest.mark.parametrize("name", few((name for name, value in empty_values().items() if hasattr(value, "plot")), 4))
def test_what_is_empty_is_drawn(name):
    ax = axes_of(empty_values()[name])
    ax.figure.savefig(io.BytesIO(), format="png", dpi=30)


@pytest.mark.parametrize("name", [name for name, value in VALUES.items() if hasattr(type(value), "__geo_interface__")])
def test_features_are_json(name):
    features = VALUES[name].__geo_interface__
    assert json.loads(json.dumps(features, allow_nan=False)) == features


MESH = vorotool.delaunay([[0, 0], [4, 0], [0, 3], [5, 5]])
WITHOUT = (vorotool.PointSet([[0, 0], [4, 1]]), MESH.table(), vorotool.cell_statistics(MESH))


@pytest.mark.parametrize("value", WITHOUT, ids=lambda value: type(value).__name__)
@pytest.mark.parametrize("options", [{}, {"label_by": "name"}, {"scale_bar": True}], ids=str)
def test_what_has_no_picture_is_refused(tmp_path, value, options):
    said = "cannot be written" if isinstance(value, vorotool.PointSet) else "has no picture: write it as a table"
    with pytest.raises(vorotool.UsageError, match=f"a {type(value).__name__} {said}"):
        vorotool.write(value, tmp_path / "a.svg", **options)
    assert not (tmp_path / "a.svg").exists()
