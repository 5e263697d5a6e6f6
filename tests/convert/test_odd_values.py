"""No value of any kind ends in an error that is not ours."""

import collections
import datetime

import geopandas as gpd
import numpy as np
import pandas as pd
import pytest
import shapely
import xarray

import vorotool as v
from vorotool.convert.images import as_label_image, as_raster
from vorotool.convert.points import as_place, as_points
from vorotool.convert.polygons import as_geometry, as_polygons
from vorotool.engines.tessellation.frames import as_seeds
from vorotool.engines.tessellation.raster_objects import numbered_components
from vorotool.types.box import as_box, as_extent


def geometry(kind, coordinates):
    """An object of GeoJSON."""
    return {"type": kind, "coordinates": coordinates}


GEOMETRY = {
    "Point": [5, "ab", [], [[1, 2]], [None, 1]],
    "MultiPoint": [[1, 2], [[]], 5],
    "Polygon": [[1, 2], [[1, 2]], [[[1, 2], [3]]], [], [[]], [[[[1, 2]]]], [None]],
    "MultiPolygon": [[[1]], [1], 5],
    "LineString": [[1, 2], [], ["a"]],
}


ODD = [
    *(geometry(kind, each) for kind, listed in GEOMETRY.items() for each in listed),
    ...,
    int,
    len,
    np,
    object(),
    set(),
    {1, 2},
    {(1, 2), (3, 4)},
    (x for x in [None, 3]),
    iter([]),
    b"",
    b"\x00",
    "",
    " ",
    {},
    {1: 2},
    {"x": 1, "y": 2},
    {"x": "ab", "y": "cd"},
    {"x": [1], "y": [[1]]},
    {"type": 5},
    {"type": None},
    {"type": "Feature"},
    {"type": "Feature", "geometry": 5},
    {"type": "FeatureCollection", "features": "ab"},
    {"type": "FeatureCollection", "features": {"a": 1}},
    {"type": "GeometryCollection", "geometries": 5},
    {"type": "GeometryCollection", "geometries": [5, None]},
    {"type": "GeometryCollection"},
    {"shell": 5},
    {"shell": "abc"},
    {"shell": []},
    {"shell": [[0, 0], [1, 0], [0, 1]], "holes": 5},
    {"shell": [[0, 0], [1, 0], [0, 1]], "holes": "ab"},
    {"line": None},
    {"line": {}},
    [None],
    [None, None],
    [None, "POINT (1 2)"],
    ["POINT (1 2)", 5],
    ["POINT (1 2)", b"x"],
    [5, "POINT (1 2)"],
    [shapely.Point(1, 2), 5],
    [shapely.Point(1, 2), "x"],
    [shapely.box(0, 0, 1, 1), 5],
    [shapely.box(0, 0, 1, 1), {}],
    [{}],
    [{}, {}],
    [[]],
    [[], []],
    [[[]]],
    [[[[1]]]],
    [[1]],
    [1],
    ["a"],
    ["a", "b"],
    [["a", 1]],
    [{"a": 1}],
    [geometry("Point", [1, 2]), 5],
    [geometry("Point", [1, 2]), None],
    [{"type": "Feature", "geometry": None, "properties": {}}],
    [{"type": "Feature"}],
    np.array(5),
    np.array("a"),
    np.array(None),
    np.array([None, None]),
    np.array([[None]]),
    np.array([{}], dtype=object),
    np.array([], dtype=object),
    np.array([], dtype=str),
    np.zeros((0, 3)),
    np.zeros((3, 0)),
    np.zeros((0, 0), int),
    np.zeros((0, 0), bool),
    np.zeros((1, 1, 1, 1)),
    np.zeros((2, 0, 3)),
    np.array(["2020"], dtype="M8[D]"),
    np.array([[1, 2]], dtype="m8[s]"),
    np.array([b"POINT (1 2)"]),
    np.zeros(3, dtype=[("x", "f8")]),
    np.zeros((2, 2), dtype=[("x", "f8"), ("y", "f8")]),
    np.zeros(3, dtype=[("x", "O"), ("y", "U3")]),
    np.zeros((3, 2), dtype=complex),
    np.zeros((9, 9), dtype=complex),
    np.zeros((9, 9), dtype=object),
    np.ma.masked,
    np.ma.array([[1, 2]], mask=True),
    np.ma.array(np.ones((9, 9), bool), mask=True),
    np.void(b"ab"),
    np.float64(3),
    np.array([[np.nan] * 9] * 9),
    np.array([[2**64 - 1] * 9] * 9, dtype=np.uint64),
    -np.ones((9, 9), int),
    pd.DataFrame(),
    pd.DataFrame({"x": []}),
    pd.DataFrame({"x": [1], "y": [None]}),
    pd.DataFrame({"x": ["a"], "y": [1]}),
    pd.DataFrame({"x": [[1]], "y": [1]}),
    pd.DataFrame({"a": [1.5], "b": [None]}),
    pd.DataFrame([[1, 2]], columns=pd.MultiIndex.from_tuples([("a", "x"), ("a", "y")])),
    pd.DataFrame([[1, 2, 3]], columns=["x", "x", "y"]),
    pd.DataFrame({0: [1], 1: [2]}),
    pd.DataFrame({"x": pd.to_datetime(["2020-01-01"]), "y": [1]}),
    pd.Series([1, 2]),
    pd.Series(["a"]),
    pd.Series([], dtype=object),
    pd.Series([None]),
    pd.Index([1, 2]),
    pd.NA,
    pd.NaT,
    pd.Timestamp("2020-01-01"),
    pd.Categorical(["a"]),
    pd.Series(pd.Categorical(["a"])),
    pd.DataFrame({"label": ["a"], "x": [1], "y": [2]}),
    pd.DataFrame({"label": [None], "x": [1], "y": [2]}),
    pd.DataFrame({"label": pd.array([1, None], "Int64"), "x": [1, 2], "y": [2, 2]}),
    gpd.GeoSeries([]),
    gpd.GeoSeries([None]),
    gpd.GeoDataFrame(),
    gpd.GeoDataFrame({"a": [1]}),
    gpd.GeoDataFrame({"x": [1.0], "y": [2.0]}),
    gpd.GeoDataFrame({"a": [1]}, geometry=[None]),
    gpd.GeoSeries([shapely.Point(1, 2), shapely.box(0, 0, 1, 1)]),
    gpd.GeoSeries([shapely.Point(np.nan, 2)]),
    gpd.GeoSeries([shapely.GeometryCollection()]),
    shapely.GeometryCollection([shapely.Point(1, 2), shapely.box(0, 0, 1, 1)]),
    shapely.LinearRing([(0, 0), (1, 0), (0, 1)]),
    shapely.LineString(),
    shapely.Polygon(),
    shapely.Point(1, 2, 3),
    shapely.Point(np.inf, 1),
    xarray.DataArray(5),
    xarray.DataArray([1, 2]),
    xarray.DataArray(np.zeros((2, 3, 4))),
    xarray.Dataset(),
    xarray.Dataset({"x": ("a", [1]), "y": ("a", [2])}),
    xarray.DataArray(np.ones((3, 3), int), dims=("y", "x"), coords={"y": [1, 1, 1], "x": [1, 2, 3]}),
    xarray.DataArray(np.zeros((0, 3), int), dims=("y", "x"), coords={"y": [], "x": [1, 2, 3]}),
    xarray.DataArray(np.ones((1, 3), bool), dims=("y", "x"), coords={"y": [7], "x": [1, 2, 3]}),
    xarray.DataArray(
        np.ones((3, 3), bool), dims=("y", "x"), coords={"y": pd.date_range("2020", periods=3), "x": [1, 2, 3]}
    ),
    collections.UserDict({"x": [1], "y": [2]}),
    collections.deque([(1, 2), (3, 4)]),
    range(5),
    datetime.date(2020, 1, 1),
    memoryview(b"abc"),
    bytearray(b"abc"),
    True,
    1j,
    float("nan"),
    v,
    v.Box(0, 0, 1, 1),
    v.delaunay([[0, 0], [1, 0], [0, 1]]),
    v.skeleton_exact([[0, 0], [1, 0], [0, 1]]),
    v.alpha_shape([[0, 0], [1, 0], [0, 1]], r=3),
    v.Table({"x": np.array([1.0, 2]), "y": np.array([3.0, 4])}),
    v.region_table(np.eye(3, dtype=int)),
    v.tessellate([[1, 1], [2, 2]]),
    v.PolygonSet([], [0], [], []),
    v.PointSet([]),
    v.SeedSet([], [], []),
    v.Raster(np.zeros((3, 3, 3))),
    v.Raster(np.full((3, 3), 0.5)),
]


CALLS = {
    "points": as_points,
    "place": as_place,
    "polygons": as_polygons,
    "geometry": as_geometry,
    "box": as_box,
    "extent": as_extent,
    "raster": as_raster,
    "grey": lambda value, name: as_raster(value, name, is_gray=True),
    "labels": lambda value, name: as_label_image(value, name, numbered_components),
    "seeds": as_seeds,
    "seeds of an image": lambda value, name: as_seeds(value, name, image=True),
    "seeds of points": lambda value, name: as_seeds(value, name, image=False),
}


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("call", CALLS)
def test_odd_values(call):
    taken = refused = 0
    for value in ODD:
        try:
            CALLS[call](value, "argument")
            taken += 1
        except (v.InputError, v.UsageError) as error:
            assert str(error)  # noqa: PT017 - any other error fails the test
            refused += 1
    assert taken
    assert refused > len(ODD) / 4
