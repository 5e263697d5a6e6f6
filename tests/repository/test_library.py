"""What the library is given by mistake: every outcome is one of its own errors, in words."""

import numpy as np
import pytest
import shapely

import vorotool
from support.refusals import refused
from vorotool.errors import InputError, UsageError

POINTS = [[1, 1], [5, 3]]
SHAPE = (4, 6)
LINE = shapely.LineString([(0, 0), (1, 1)])


@pytest.mark.parametrize("method", ["exact", "propagation"])
@pytest.mark.parametrize("out", [[[0] * 6] * 4, np.zeros((4, 5), np.uint16), np.zeros((6, 4), np.uint16).T])
def test_out(method, out):
    with pytest.raises(UsageError, match="out must be a writeable C-contiguous array of shape"):
        vorotool.tessellate(POINTS, shape=SHAPE, method=method, out=out)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"max_distance": "3"}, "max_distance is '3'"),
        ({"max_distance": float("nan")}, "max_distance is nan"),
        ({"threads": None}, "threads is None"),
        ({"threads": 1.5}, "threads is 1.5"),
        ({"threads": -1}, "threads is -1"),
        ({"shape": 3}, "shape must be two integers"),
        ({"shape": (3, 4, 5)}, "shape must be two integers"),
        ({"shape": (3.5, 4)}, "shape must be two integers"),
        ({"shape": None, "window": (3, 4, 5)}, "window must be four integers"),
        ({"dtype": "foo"}, "dtype is 'foo'"),
        ({"passes": 1}, "passes is 1, which needs method='propagation'"),
    ],
)
def test_options(options, message):
    refused(UsageError, message, vorotool.tessellate, POINTS, **{"shape": SHAPE, **options})


def test_empty_points_are_left_out_with_a_warning():
    with pytest.warns(vorotool.VorotoolWarning, match="feature at index 1 has no geometry"):
        made = vorotool.tessellate([shapely.Point(1, 1), shapely.Point()], shape=(2, 2))
    assert made.labels.tolist() == [[1, 1], [1, 1]]


@pytest.mark.parametrize(
    ("geometry", "message"),
    [
        ([LINE], "invalid seeds: .*polygons or lines"),
        (LINE, "invalid seeds: .*polygons or lines"),
        (shapely.Point(), "no seeds"),
        ("seeds.csv", "invalid seeds: 'seeds.csv' is not"),
        (5, "invalid seeds: expected an .* but got an int"),
    ],
)
def test_geometry_that_is_no_point(geometry, message):
    refused(InputError, message, vorotool.tessellate, geometry, shape=SHAPE)


def test_arrays_are_taken_for_images():
    image = np.array([[1, 0, 1], [0, 0, 1]])
    seeds = vorotool.seeds_from_raster(image)
    assert seeds.labels.tolist() == vorotool.seeds_from_raster(vorotool.Raster(image)).labels.tolist() == [1, 2, 2]
    assert vorotool.region_table(image)["area"].tolist() == [3]
    assert vorotool.neighbor_table(image).rows == 0
    assert vorotool.color_regions(image).tolist() == [0, 1]
    for function in (vorotool.region_table, vorotool.neighbor_table, vorotool.color_regions):
        refused(InputError, r"^invalid image: expected truth values or integers", function, np.ones((2, 2)))
    refused(InputError, r"^invalid raster: expected an image", vorotool.seeds_from_raster, [["a", "b"]])
    with pytest.raises(InputError, match=r"^invalid image: expected a LabelImage of vorotool\.tessellate"):
        vorotool.verify_tessellation(image)
    refused(UsageError, "no seeds", vorotool.verify_tessellation, vorotool.LabelImage(np.array(image)))
    refused(InputError, "is a list", vorotool.voronoi_diagram, image, out=[[0] * 3] * 2)


@pytest.mark.parametrize(
    ("x", "labels", "message"),
    [
        ([1, 2], [0, 1], r"label of seed \[0\] is 0: it must be an integer from 1 to 4294967295"),
        ([1, 2], [1, -1], r"label of seed \[1\] is -1"),
        ([1, 2], [1, 2**32], r"label of seed \[1\] is 4294967296"),
        ([1, 2], [1, 2**70], r"label of seed \[1\] is"),
        ([1, 2], [1, 1.5], r"label of seed \[1\] is 1.5"),
        ([1, 2.5], [1, 2], r"x of seed \[1\] is 2.5"),
        ([1, np.nan], [1, 2], r"x of seed \[1\] is nan"),
        ([1, 2.0**63], [1, 2], r"x of seed \[1\] is 9.2"),
        ([-(2**70), 1], [1, 2], r"x of seed \[0\] is -1180591620717411303424"),
        (["a", "b"], [1, 2], "each x of seed must be an integer"),
        ([[1], [2, 3]], [1, 2], "each x of seed must be an integer"),
    ],
)
def test_seeds_that_are_no_integers(x, labels, message):
    refused(InputError, message, vorotool.SeedSet, x, [1, 2], labels)


def test_points_that_are_none():
    refused(InputError, "array of numbers", vorotool.PointSet, [["a", "b"]])
    refused(InputError, r"label of point \[0\] is 1\.5", vorotool.PointSet, POINTS, labels=[1.5, 2])


@pytest.mark.parametrize("path", [5, None, b"data/dots.csv", [[0, 0], [1, 1]]])
def test_paths_that_are_none(path):
    refused(InputError, "is not a path: give the name of a file", vorotool.read, path)


def test_reading_and_writing(tmp_path):
    (tmp_path / "a.csv").write_text("1,2\n")
    for threads in (-1, None):
        refused(UsageError, "threads is", vorotool.read, tmp_path / "a.csv", threads=threads)
    image = vorotool.tessellate(POINTS, shape=SHAPE)
    for target in ({"path": tmp_path / "a.svg"}, {"path": tmp_path / "b", "fmt": "svg"}):
        vorotool.write(image, **target)
        assert target["path"].read_bytes().startswith(b"<svg ")
    for fmt in ("tif", "TIFF", ".tif"):
        vorotool.write(image, tmp_path / "labels", fmt=fmt)
        assert (tmp_path / "labels").read_bytes().startswith(b"II*\0")
    vorotool.write(image, tmp_path / "labels", fmt="txt")
    np.testing.assert_array_equal(np.loadtxt(tmp_path / "labels", dtype=int), image.labels)
