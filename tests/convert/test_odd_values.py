"""No value of any kind ends in an error that is not ours."""

import collections
import datetime
import inspect
import pathlib
import warnings
import zlib

import geopandas as gpd
import numpy as np
import pandas as pd
import pytest
import shapely
import xarray

import vorotool
import vorotool as v
from support.families.values import example_values
from support.few import few
from vorotool import VorotoolError
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


RING = [[0, 0], [4, 0], [0, 3]]


class Odd:
    """An object that is nothing."""


def list_in_itself():
    made = [[0, 0]]
    made.append(made)
    return made


def closed_file():
    with pathlib.Path(__file__).open(encoding="utf-8") as file:
        return file


def read_only_array():
    array = np.zeros((3, 2))
    array.flags.writeable = False
    return array


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
    Odd(),
    Odd,
    print,
    list_in_itself(),
    *(10**400, -(10**400), -1, 0, 5, 0.5, float("inf"), "12", "\ud800"),
    *(["1", "a"], [[1]] * 4, [[1, 2], [3]], [{}, {}], [Odd(), Odd()], RING),
    datetime.datetime(2020, 1, 1),
    np.array(3.5),
    np.eye(4, dtype=bool),
    np.array(RING, dtype=np.float16),
    np.asfortranarray(np.array(RING, dtype=float)),
    np.ma.masked_array(np.array(RING, dtype=float), mask=[[0, 1], [0, 0], [0, 0]]),
    np.array([Odd(), None], dtype=object),
    np.array(["a", "b"]),
    read_only_array(),
    [shapely.Point(), None, shapely.Polygon([(0, 0), (1, 1), (1, 0)])],
    closed_file(),
    pathlib.Path(__file__).parent,
    str(pathlib.Path(__file__).parent),
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


# ---- arguments of public functions ------------------------------------------------------------


FUNCTIONS = sorted(name for name in vorotool.__all__ if inspect.isfunction(getattr(vorotool, name)))


MORE = {"prune": {"length": 0}, "skeleton_approx": {"step": 1}}


"""Arguments that are right where one of several is needed."""


PARTS = 8


"""`make test` tries one part of the values for each argument of each function, `make test-all` all."""


CALLBACKS = ("progress", "note", "check")


"""Parameters that are called as they are."""


@pytest.fixture(scope="module")
def known():
    """Arguments that are right, by the names of parameters or by their types, and by a function before these."""
    mask = np.eye(4, dtype=bool)
    skeleton = vorotool.skeleton_exact([RING])
    digital = vorotool.digital_triangulation(RING)
    image = vorotool.tessellate([[1, 1], [3, 2]], shape=(4, 4))
    made = example_values() | dict.fromkeys(("points", "seeds", "sites", "shapes", "a", "b", "source"), RING)
    made |= {"mask": mask, "raster": mask, "labels": mask.astype(int), "volume": mask[None], "image": image}
    made |= {"skeleton": skeleton, "lines": skeleton, "joined": vorotool.join_junctions(skeleton), "polygons": [RING]}
    made |= {"pruned": vorotool.prune(skeleton, length=0), "family": vorotool.alpha_complex([*RING, [5, 5]])}
    made |= {"shape": vorotool.alpha_shape(RING, r=5), "mesh": vorotool.delaunay(RING)}
    made |= {"graph": vorotool.planar_graph([RING])}
    made |= {"r": 5, "distances": [1], "every": 1, "tolerance": 0.1, "criterion": "length", "name": "dots.csv"}
    made |= {"value": skeleton, "path": "out.json", "cells": vorotool.voronoi_cells(RING), "found": digital}
    made |= {"thickness": vorotool.local_thickness(mask)}
    special = {
        ("read", "path"): "in.wkt",
        ("seeds_from_xyz", "points"): [[0, 0, 0], [1, 2, 3]],
        ("table", "value"): made["mesh"],
        ("verify_distances", "found"): vorotool.hausdorff(RING, [[9, 9]]),
        ("verify_proximity_graph", "graph"): vorotool.proximity_graph(RING, kind="gabriel"),
        ("verify_tessellation", "image"): image,
        ("verify_thickness", "skeleton"): vorotool.skeleton_exact(vorotool.outlines(mask)),
        ("verify_voronoi", "cells"): vorotool.voronoi(RING),
        ("voronoi_diagram", "image"): image,
    }
    return made, special


def raised(function, arguments):
    """Call; give what is raised."""
    with warnings.catch_warnings(action="ignore"):
        try:
            function(**arguments)
        except Exception as error:
            return error
    return None


def values_of(name, parameter, part):
    """Give a part of the odd values by their numbers; which ones is another for each argument."""
    begin = zlib.crc32(f"{name} {parameter}".encode()) + part
    return list(enumerate(ODD))[begin % PARTS :: PARTS]


@pytest.mark.parametrize("part", few(range(PARTS), 1))
@pytest.mark.parametrize("name", FUNCTIONS)
def test_odd_arguments(name, part, known, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "in.wkt").write_text("POINT (1 2)\n")
    function = getattr(vorotool, name)
    parameters = inspect.signature(function).parameters.values()
    plain = [each for each in parameters if each.kind not in (each.VAR_KEYWORD, each.VAR_POSITIONAL)]
    made, special = known
    needed = {
        each.name: special.get((name, each.name), made.get(each.name, made.get(each.annotation)))
        for each in plain
        if each.default is each.empty
    }
    needed |= MORE.get(name, {})
    failed = raised(function, needed)
    strange = {} if failed is None else {"all right": repr(failed)}
    for parameter in plain:
        for what, value in values_of(name, parameter.name, part) if parameter.name not in CALLBACKS else ():
            failed = raised(function, needed | {parameter.name: value})
            if failed is not None and not isinstance(failed, vorotool.VorotoolError):
                strange[f"{parameter.name} = {what}, {type(value).__name__}"] = repr(failed)[:200]
    assert not strange, "\n".join(f"{key}: {text}" for key, text in strange.items())


@pytest.mark.parametrize(
    "by", [5, [[1]] * 3, [{"name": "a"}] * 3, float("nan"), np.array(3.5), object(), closed_file()]
)
def test_by(by):
    with pytest.raises(VorotoolError, match="by"):
        vorotool.voronoi(RING, by=by)


def test_by_a_path_into_objects():
    features = [
        {
            "type": "Feature",
            "geometry": {"type": "Point", "coordinates": [x, 0]},
            "properties": {"classification": {"name": name}},
        }
        for x, name in enumerate("aba")
    ]
    document = {"type": "FeatureCollection", "features": features}
    assert vorotool.voronoi(document, by="classification.name").ids == ["a", "b"]
    with pytest.raises(VorotoolError, match=r"classification\.name|column\.name"):
        vorotool.voronoi(document, by="classification")
    with pytest.raises(VorotoolError, match=r"classification\.color"):
        vorotool.voronoi(document, by="classification.color")
