"""Polygons and lines from whatever callers hold."""

import geopandas
import numpy as np
import pandas as pd
import pytest
import shapely

import vorotool
from vorotool import InputError
from vorotool.convert.polygons import as_geometry, as_polygons
from vorotool.types.polygons.polygon_set import SHELL

TRIANGLE = [[0, 0], [9, 0], [0, 9]]
HOLED = shapely.Polygon(TRIANGLE, [[[1, 1], [2, 1], [1, 2]]])
PATH = shapely.LineString([(0, 0), (1, 1), (2, 0)])


def test_one_shell():
    for source in (TRIANGLE, np.array(TRIANGLE), [*TRIANGLE, [0, 0]], [tuple(p) for p in TRIANGLE], [TRIANGLE]):
        shapes = as_polygons(source)
        assert shapes.xy.tolist() == TRIANGLE
        assert shapes.ring_kind.tolist() == [SHELL]
    assert as_polygons(shapes) is shapes


# ---- forms of other libraries -----------------------------------------------------------------------
SHAPES = [HOLED, shapely.MultiPolygon([shapely.box(20, 20, 30, 30), HOLED]), PATH]
FRAME = geopandas.GeoDataFrame(
    {"name": ["a", None, "c"], "count": [1, 2, 3]}, geometry=SHAPES, index=["p", "q", "r"], crs=2056
)


def rings(polygons):
    """Everything that says where polygons lie."""
    return [getattr(polygons, name).tolist() for name in ("xy", "ring_starts", "ring_kind", "ring_polygon", "feature")]


@pytest.mark.parametrize(
    "source",
    [
        FRAME,
        FRAME.geometry,
        FRAME.geometry.values,
        pd.Series(SHAPES, index=list("pqr")),
        np.array(SHAPES, dtype=object),
        tuple(SHAPES),
        iter(SHAPES),
        FRAME.__geo_interface__,
        FRAME.__geo_interface__["features"],
        [shapely.geometry.mapping(each) for each in SHAPES],
        [each.wkt for each in SHAPES],
        np.array([each.wkt for each in SHAPES]),
        [{"shell": np.array(HOLED.exterior.coords), "holes": [np.array(HOLED.interiors[0].coords)]}, *SHAPES[1:]],
        pd.Series([each.wkt for each in SHAPES]),
        [SHAPES[0].wkt, SHAPES[1], shapely.geometry.mapping(SHAPES[2])],
    ],
    ids=lambda source: type(source).__name__,
)
def test_all_forms_are_those_of_shapely(source):
    assert rings(as_polygons(source)) == rings(as_polygons(SHAPES))


@pytest.mark.filterwarnings("ignore:.*treated as planar")
def test_a_system_without_a_code_is_spelled_out():
    own = FRAME.set_crs("+proj=laea +lat_0=47 +lon_0=8", allow_override=True)
    text = as_polygons(own).crs["properties"]["name"]
    assert FRAME.set_crs(text, allow_override=True).crs == own.crs
    assert as_polygons(FRAME.set_crs("OGC:CRS84", allow_override=True)).crs["properties"]["name"].endswith("CRS84")


def test_what_is_missing_or_empty_is_left_out_in_step():
    rows = FRAME.reindex(["q", "x", "p", "r"])
    rows.loc["p", "geometry"] = shapely.Polygon()
    made = as_polygons(rows)
    assert made.index.tolist() == ["q", "q", "r"]
    assert made.feature.tolist() == [0, 0, 3]
    assert made.properties["count"] == [2, 2, 3]
    assert as_polygons([None, HOLED, None]).feature.tolist() == [1]
    assert as_polygons({"type": "MultiLineString", "coordinates": [[], [[0, 0], [1, 1]]]}).is_line.tolist() == [True]
    assert len(as_polygons(FRAME.iloc[:0])) == len(as_polygons(geopandas.GeoSeries([None, None]))) == 0


def test_features_of_geojson_have_ids_and_properties():
    features = [
        {"type": "Feature", "id": 7, "properties": {"a": 1}, "geometry": shapely.geometry.mapping(HOLED)},
        {"type": "Feature", "properties": None, "geometry": None},
        {"type": "Feature", "properties": {"b": 2}, "geometry": shapely.geometry.mapping(SHAPES[1])},
    ]
    crs = {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::2056"}}
    made = as_polygons({"type": "FeatureCollection", "crs": crs, "features": features})
    assert (made.ids, made.properties) == ([7, None, None], {"a": [1, None, None], "b": [None, 2, 2]})
    assert (made.crs, made.feature.tolist()) == (crs, [0, 2, 2])
    assert as_polygons(features[0]).properties == {"a": [1]}


def test_extended_text_names_its_system():
    assert as_polygons(f"SRID=2056;{HOLED.wkt}").crs["properties"]["name"] == "urn:ogc:def:crs:EPSG::2056"
    with pytest.raises(InputError, match="invalid shapes: geometry is in EPSG:2056 and EPSG:3857"):
        as_polygons([f"SRID=2056;{HOLED.wkt}", f"SRID=3857;{HOLED.wkt}"], "shapes")


@pytest.mark.parametrize(
    ("source", "message"),
    [
        (geopandas.GeoSeries.from_xy([1], [2]), r"item \[0\]"),
        ({"type": "Point", "coordinates": [1, 2]}, r"item \[0\]"),
        (pd.DataFrame({"x": [1], "y": [2]}), "DataFrame"),
        (np.ones((9, 9), int), r"vorotool.outlines\(shapes\)"),
        (vorotool.Raster(np.ones((9, 9), bool)), r"Raster"),
        (np.ones((9, 3)), r"shapes\[:, :2\]"),
        (np.ones((2, 9)), r"give the transpose, \.T"),
        (
            "GEOMETRYCOLLECTION (" * 10**5 + HOLED.wkt + ")" * 10**5,
            "brackets of the text are nested more than 100 deep",
        ),
        ([HOLED.wkt, "hello"], "'hello'"),
        ({"type": "Polygon"}, "'Polygon'"),
        ({"type": "Polygon", "coordinates": [[["a", "b"]]]}, "ring 1"),
        ({"type": "FeatureCollection"}, "FeatureCollection"),
        ({"type": "FeatureCollection", "features": [1]}, "Feature"),
        ({"type": "Feature", "properties": 1, "geometry": None}, "feature 1"),
        (
            {
                "type": "Feature",
                "properties": {},
                "geometry": {"type": "Polygon", "coordinates": [[[0, float("nan")]]]},
            },
            "coordinates must be finite",
        ),
    ],
)
def test_what_is_refused_of_them_names_the_parameter(source, message):
    with pytest.raises(InputError, match=f"^invalid shapes: .*{message}"):
        as_polygons(source, "shapes")


def test_geometry_is_not_changed_on_its_way():
    made, crs = as_geometry(FRAME, "clip")
    assert [given is own for given, own in zip(made, FRAME.geometry, strict=True)] == [True] * 3
    assert crs["properties"]["name"].endswith("2056")
    rebuilt, _ = as_geometry(FRAME.__geo_interface__, "clip")
    assert shapely.equals(shapely.union_all(rebuilt[:3]), shapely.union_all(SHAPES[:2]))


def test_a_mask_of_xarray_is_a_mask():
    xarray = pytest.importorskip("xarray")
    mask = np.zeros((9, 9), dtype=bool)
    mask[2:7, 2:5] = True
    made = as_polygons(xarray.DataArray(mask, dims=("y", "x")))
    assert made.xy.tolist() == as_polygons(mask).xy.tolist()
