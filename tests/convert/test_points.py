"""Points from whatever callers hold."""

from decimal import Decimal
from fractions import Fraction
from pathlib import Path

import geopandas
import numpy as np
import pandas as pd
import pyarrow
import pytest
import shapely
import xarray
from hypothesis import given
from hypothesis import strategies as st

import vorotool
from vorotool import InputError, PolygonSet, Raster, UsageError, read
from vorotool.convert.points import as_place, as_points

XY = [[2.0, 1.0], [7.5, 5.0], [4.0, 9.0]]
POINTS = [shapely.Point(x, y) for x, y in XY]
SERIES = geopandas.GeoSeries(POINTS, index=["p", "q", "r"], crs=2056)
FRAME = geopandas.GeoDataFrame({"name": ["a", None, "c"]}, geometry=SERIES.values, index=SERIES.index)


@pytest.mark.parametrize(
    "source",
    [
        XY,
        tuple(map(tuple, XY)),
        iter(XY),
        memoryview(np.array(XY)),
        np.array(XY),
        np.array(XY, dtype=">f8"),
        *(np.array(XY, dtype=kind) for kind in (np.float16, np.float32, np.longdouble)),
        np.asfortranarray(XY),
        np.repeat(np.array(XY), 2, axis=0)[::2],
        np.array(XY, dtype=object),
        [[Fraction(x), Decimal(y)] for x, y in XY],
        np.ma.array(XY),
        np.ma.array(XY, mask=False),
        POINTS,
        tuple(POINTS),
        iter(POINTS),
        np.array(POINTS, dtype=object),
        [XY[0], POINTS[1], XY[2]],
        shapely.MultiPoint(POINTS),
        [POINTS[0], shapely.MultiPoint(POINTS[1:])],
        pd.Series(POINTS),
        SERIES,
        SERIES.values,
        FRAME,
        FRAME.__geo_interface__,
        SERIES.__geo_interface__,
        shapely.geometry.mapping(shapely.MultiPoint(POINTS)),
        [shapely.geometry.mapping(each) for each in POINTS],
        {"type": "GeometryCollection", "geometries": [shapely.geometry.mapping(each) for each in POINTS]},
        [each.wkt for each in POINTS],
        pd.Series([each.wkt for each in POINTS], dtype="string"),
        np.array([each.wkt for each in POINTS]),
        shapely.MultiPoint(POINTS).wkt,
        shapely.GeometryCollection(POINTS).wkt,
        [POINTS[0].wkt, POINTS[1], shapely.geometry.mapping(POINTS[2])],
        pd.DataFrame(XY, columns=["x", "y"]),
        pd.DataFrame(XY, columns=["a", "b"]),
        pd.DataFrame(XY, columns=["x", "y"]).convert_dtypes(),
        pd.DataFrame(XY, columns=["X", " Y "], dtype=np.float32),
        pd.DataFrame(np.array(XY)[:, ::-1], columns=["centroid-0", "centroid-1"]),
        FRAME.get_coordinates(),
        dict(zip("xy", np.array(XY).T.tolist(), strict=True)),
        pyarrow.table({"y": np.array(XY)[:, 1], "x": np.array(XY)[:, 0]}),
        np.array([tuple(each) for each in XY], dtype=[("x", "f8"), ("y", "f8")]),
        xarray.DataArray(XY),
    ],
    ids=lambda source: type(source).__name__,
)
def test_all_forms_have_the_same_places(source):
    made = as_points(source)
    assert made.xy.tolist() == XY
    assert made.xy.dtype == np.float64


@pytest.mark.parametrize(
    ("columns", "y_axis", "is_geographic"),
    [
        (("x", "y"), "none", False),
        (("LON", "Lat"), "up", True),
        (("longitude", "latitude"), "up", True),
        (("Easting", "Northing"), "up", False),
    ],
)
def test_names_of_columns_tell_as_in_files(columns, y_axis, is_geographic, tmp_path):
    frame = pd.DataFrame({columns[1]: [5.0, 6.0], "note": ["a", "b"], columns[0]: [1.0, 2.0]}, index=[30, 10])
    made = as_points(frame)
    assert made.xy.tolist() == [[1, 5], [2, 6]]
    assert (made.y_axis, made.crs is not None) == (y_axis, is_geographic)
    assert (made.index.tolist(), made.properties) == ([30, 10], {"note": ["a", "b"]})
    path = tmp_path / "a.csv"
    frame.to_csv(path, index=False)
    file = read(path)
    assert (file.xy.tolist(), file.y_axis, file.crs, file.properties) == (
        made.xy.tolist(),
        y_axis,
        made.crs,
        made.properties,
    )


def test_a_column_called_label_is_one_if_it_holds_integers_from_1():
    frame = pd.DataFrame({"label": [4, 2], "x": [1, 2], "y": [3, 4]})
    assert as_points(frame).labels.tolist() == [4, 2]
    more = as_points(frame.assign(id=[8, 9]))
    assert (more.labels.tolist(), more.properties) == ([4, 2], {"id": [8, 9]})
    other = as_points(frame.assign(label=[1, 0]))
    assert (other.labels, other.properties) == (None, {"label": [1, 0]})


def test_features_have_ids():
    document = {
        "type": "FeatureCollection",
        "features": [
            {
                "type": "Feature",
                "id": "k",
                "properties": {"id": 5},
                "geometry": {"type": "Point", "coordinates": [1, 2, 3]},
            },
            {"type": "Feature", "properties": {}, "geometry": {"type": "Point", "coordinates": []}},
        ],
    }
    made = as_points(document)
    assert (made.xy.tolist(), made.properties) == ([[1, 2]], {"id": ["k"], "property_id": [5]})


@pytest.mark.parametrize(
    "source",
    [(2, 1), [2, 1], np.array([2, 1]), POINTS[0], POINTS[0].wkt, shapely.geometry.mapping(POINTS[0]), SERIES.iloc[:1]],
    ids=lambda source: type(source).__name__,
)
def test_one_place(source):
    assert as_place(source, "start") == (2, 1)


@pytest.mark.parametrize("source", ["a", shapely.MultiPoint(POINTS), shapely.box(0, 0, 1, 1), (1, 2, 3), 5, None])
def test_what_is_no_place(source):
    with pytest.raises((InputError, UsageError), match=r"start"):
        as_place(source, "start")


@pytest.mark.parametrize(
    ("source", "message"),
    [
        (None, "None$"),
        (5, "but got an int$"),
        ("a.csv", "'a.csv'"),
        (Path("a.csv"), r"vorotool.read\('a.csv'\)"),
        (b"\x01\x01", "well-known text"),
        ({"a": 1}, "expected columns x, y or lon, lat, but got a dict with a"),
        (PolygonSet([], [0], [], []), "these are polygons or lines: give points"),
        (Raster(np.eye(3)), r"vorotool.seeds_from_raster\(sites\)"),
        (np.zeros((5, 3)), r"shape \(5, 3\): .*; sites\[:, :2\]"),
        (np.zeros((2, 5)), r"give sites\.T"),
        (np.zeros(2), r"one point is \[\[x, y\]\]"),
        (np.zeros((9, 9)), r"vorotool.seeds_from_raster\(sites\)"),
        (np.zeros((2, 2, 2)), r"\(2, 2, 2\)"),
        ([[1, 2], [3]], r"expected an .* array of numbers.* point \[0\] has 2 numbers and point \[1\] 1$"),
        (np.array([[1 + 1j, 2]]), "these have type complex128"),
        ([[1, np.nan]], r"point \[0\]"),
        (np.ma.array([[1, 2], [3, 4]], mask=[[0, 0], [1, 0]]), "points are masked in part"),
        (np.array([[2**53 + 1, 0]]), "a double would round it"),
        (pd.DataFrame({"x": [2**53 + 1], "y": [0.5]}), r"row \[0\]"),
        (pd.DataFrame({"x": ["1"], "y": [0.5]}), "the column x must hold numbers"),
        (pd.DataFrame({"x": pd.array([1, None], "Int64"), "y": [1, 2]}), r"point \[1\]"),
        (pd.DataFrame({"a": [1], "b": [2], "c": [3]}), r"with the columns a, b, c; .* sites\[\['a', 'b'\]\]"),
        (pd.DataFrame({"row": [1], "col": [2]}), r"with the columns row, col; .* sites\[\['col', 'row'\]\]"),
        (pd.DataFrame({"a": ["u"], "b": ["v"]}), "expected columns x, y or lon, lat"),
        (pd.DataFrame(), "DataFrame"),
        ({"x": [1, 2], "y": [1]}, "the columns x and y differ in length"),
        ([shapely.box(0, 0, 1, 1)], r"point \[0\]"),
        (shapely.LineString([(0, 0), (1, 1)]), "LineString"),
        (geopandas.GeoSeries([shapely.Point(1, 2), shapely.box(0, 0, 1, 1)]), r"point \[1\]"),
        ([[1, 2], shapely.box(0, 0, 1, 1)], r"point \[1\]"),
        ({"type": "LineString", "coordinates": [[0, 0], [1, 1]]}, "LineString"),
        ({"type": "Point", "coordinates": [1]}, r"point \[0\]"),
        ({"type": "Point", "coordinates": ["a", "b"]}, "must be an .* array of numbers"),
        (["POINT (1 2)", "POINT (1"], r"item \[1\]"),
    ],
)
def test_what_is_refused_names_the_parameter(source, message):
    with pytest.raises(InputError, match=f"^invalid sites: .*{message}"):
        as_points(source, "sites")


@given(st.lists(st.tuples(*[st.floats(allow_nan=False, allow_infinity=False)] * 2), max_size=8))
def test_places_are_kept_to_the_bit(pairs):
    expected = np.array(pairs, dtype=float).reshape(-1, 2)
    frame = pd.DataFrame(expected, columns=["x", "y"])
    series = geopandas.GeoSeries.from_xy(expected[:, 0], expected[:, 1])
    for source in (expected, frame, frame[["x", "y"]].to_numpy(), series, geopandas.GeoDataFrame(geometry=series)):
        assert as_points(source).xy.tobytes() == expected.tobytes()


def test_features_without_geometry_are_left_out_with_a_warning():
    points = [shapely.Point(0, 0), shapely.Point(), shapely.Point(4, 0), shapely.Point(0, 3), None]
    for function in (vorotool.delaunay, vorotool.alpha_shape):
        with pytest.warns(vorotool.VorotoolWarning, match="features at index 1, 4 have no geometry"):
            assert len(function(points).points) == 3
    assert len(vorotool.delaunay(geopandas.GeoSeries(points)).points) == 3
    assert vorotool.voronoi(points).areas[[1, 4]].tolist() == [0, 0]


def test_a_frame_that_is_not_computed_yet_is_refused():
    class LazyFrame:
        columns = ("x", "y")

        def __getitem__(self, name):
            raise TypeError("LazyFrame is not subscriptable")

    with pytest.raises(InputError, match="but got a LazyFrame"):
        vorotool.delaunay(LazyFrame())
