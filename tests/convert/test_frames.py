"""Results as data frames and graphs: index, reference system and columns of the input, and geometry that is right."""

import geopandas
import numpy as np
import pandas
import pytest
import shapely
from pandas.testing import assert_frame_equal, assert_index_equal

import vorotool
from support.families.values import empty_values, example_values, label_image
from vorotool.types.pixels import map_grid

VALUES = example_values()
WITH_GEOMETRY = [name for name, value in VALUES.items() if hasattr(value, "to_geopandas")]
WITH_TABLE = [name for name, value in VALUES.items() if hasattr(value, "to_pandas")]


@pytest.mark.parametrize("name", WITH_GEOMETRY)
def test_geometry_is_that_of_shapely_and_of_features(name):
    value = VALUES[name]
    frame, geometry = value.to_geopandas(), value.to_shapely()
    assert isinstance(frame, geopandas.GeoDataFrame)
    assert shapely.equals_identical(frame.geometry.values, geometry).all()
    assert len(frame) == len(geometry) > 0
    is_placed = name not in {"SeedSet", "LabelImage", "DigitalTriangulation"}
    assert (frame.crs and frame.crs.to_epsg()) == (2056 if is_placed else None)
    features = value.__geo_interface__
    again = geopandas.GeoDataFrame.from_features(features)
    if name == "Skeleton":
        again_shapes, geometry = again.geometry.values, value.to_shapely(by="branch")
    elif name == "PolygonSet":  # GeoJSON has the parts of a feature as one
        again_shapes = again.explode().geometry.values
    else:
        again_shapes = again.geometry.values
    filled = ~shapely.is_empty(geometry)
    if name not in {"AlphaShape", "CellSet"}:  # rings begin elsewhere
        assert shapely.equals_exact(again_shapes[filled], geometry[filled], 1e-9).all()
    assert shapely.equals(again_shapes[filled], geometry[filled]).all()
    assert len(shapely.geometry.shape(features["features"][0]["geometry"]).wkt) > 0


@pytest.mark.parametrize("name", WITH_TABLE)
def test_the_table_is_that_of_the_library(name):
    value = VALUES[name]
    frame, columns = value.to_pandas(), value.table()
    assert list(frame.columns) == list(columns)
    for column, own in columns.items():
        expected = own if isinstance(own, np.ndarray) else np.array(own)
        got = frame[column]
        mask = np.ma.getmaskarray(expected) if isinstance(expected, np.ma.MaskedArray) else pandas.isna(expected)
        np.testing.assert_array_equal(got.isna().to_numpy(), mask)
        if expected.dtype.kind in "iu":
            assert got.dtype == ("Int64" if mask.any() else expected.dtype)
        assert got[~mask].tolist() == np.ma.getdata(expected)[~mask].tolist()


@pytest.mark.parametrize(
    "name", [name for name, value in {**VALUES, **empty_values()}.items() if type(value).__name__ == "Table"]
)
def test_pandas_takes_tables(name):
    table = {**VALUES, **empty_values()}[name]
    assert_frame_equal(pandas.DataFrame(table), table.to_pandas(), check_column_type=False)
    assert_frame_equal(pandas.DataFrame(dict(table)), table.to_pandas(), check_column_type=False)


def test_a_table_is_a_mapping_that_does_not_change():
    mesh = VALUES["Triangulation"]
    table = vorotool.edge_table(mesh)
    assert table["length"].tolist() == mesh.edge_lengths().tolist() == table.get("length").tolist()
    assert table.get("none", 3) == 3
    assert "length" in table
    assert [name for name, _ in table.items()] == list(table) == list(table.keys())
    assert {**table}["length"].tolist() == list(table.values())[-1].tolist() == dict(table)["length"].tolist()
    for change in (
        lambda: table.update(a=1),
        lambda: table.pop("length"),
        lambda: table.setdefault("a", 1),
        table.clear,
        table.popitem,
        lambda: table.__setitem__("a", 1),
        lambda: table.__delitem__("length"),
        lambda: table.__ior__({"a": 1}),
    ):
        with pytest.raises(TypeError, match="read-only"):
            change()
    assert len(table) == 7
    joined = table | {"further": [1]}
    assert ("Lookup" in str(joined), list(joined)[-1], type({} | table)) == (False, "further", dict)
    assert vorotool.Table(table) == table.copy() == table
    assert table != vorotool.Table({name: table[name] for name in reversed(table)})


def places(seed, count=60):
    rng = np.random.default_rng(seed)
    frame = geopandas.GeoDataFrame(
        {"name": [f"s{k}" for k in range(count)], "size": rng.integers(0, 9, count)},
        geometry=shapely.points(rng.random((count, 2)) * 1000 + 2_600_000),
        crs="EPSG:2056",
        index=pandas.Index(rng.permutation(count) + 1000, name="station"),
    )
    return frame


@pytest.mark.parametrize("seed", range(3))
def test_cells_of_a_data_frame_are_those_of_geopandas(seed):
    frame = places(seed)
    clip = shapely.box(*np.add(frame.total_bounds, [-50, -50, 50, 50]))
    left, bottom, right, top = clip.bounds
    cells = vorotool.voronoi_cells(vorotool.delaunay(frame), frame=(left, bottom, right - left, top - bottom))
    got = cells.to_geopandas()
    assert_index_equal(got.index, frame.index)
    assert got.crs == frame.crs
    assert_frame_equal(
        got[["name", "size"]], frame[["name", "size"]].astype({"name": got["name"].dtype}), check_like=True
    )
    theirs = frame.geometry.voronoi_polygons(extend_to=clip).clip(clip)
    joined = geopandas.sjoin(frame[["geometry"]], geopandas.GeoDataFrame(geometry=theirs.reset_index(drop=True)))
    expected = theirs.area.to_numpy()[joined["index_right"].reindex(frame.index).to_numpy()]
    np.testing.assert_allclose(got.area, expected, rtol=1e-9)
    np.testing.assert_allclose(got["area"], got.area, rtol=1e-9)
    assert got.contains(frame.geometry).all()
    assert_index_equal(cells.to_pandas().index, frame.index)


@pytest.mark.parametrize(
    ("name", "parts"),
    [
        ("Triangulation", ("triangles", "edges", "points")),
        ("DigitalTriangulation", ("triangles", "edges", "points")),
        ("AlphaShape", ("polygons", "edges", "points")),
        ("SkeletonPoints", ("points", "transects")),
    ],
)
def test_parts(name, parts):
    value = VALUES[name]
    for part in parts:
        assert shapely.equals_identical(
            value.to_geopandas(what=part).geometry.values, value.to_shapely(what=part)
        ).all()
    with pytest.raises(vorotool.UsageError, match="'cells'"):
        value.to_shapely(what="cells")


def test_regions_cover_the_pixels_of_their_labels():
    image = label_image()
    regions = image.to_geopandas()
    assert regions["label"].tolist() == list(range(1, 10))
    np.testing.assert_array_equal(regions.area, regions["area"])
    assert regions.is_valid.all()
    np.testing.assert_allclose(shapely.union_all(regions.geometry.values).bounds, (-0.5, -0.5, 39.5, 29.5))
    scattered = vorotool.LabelImage(np.array([[5, 0, 5], [0, 5, 0], [2, 2, 0]], np.uint8))
    frame = scattered.to_geopandas()
    assert frame.geometry.geom_type.tolist() == ["Polygon", "MultiPolygon"]
    assert frame.area.tolist() == frame["area"].tolist() == [2, 3]
    assert frame.is_valid.all()


@pytest.mark.parametrize("transform", [(2.0, 0.0, 2600000.0, 0.0, -2.0, 1200000.0), (2.0, 0.5, 10.0, 0.5, -2.0, 20.0)])
def test_regions_lie_on_the_map(transform):
    rasterio_features = pytest.importorskip("rasterio.features")
    rasterio = pytest.importorskip("rasterio")
    labels = np.kron(np.array([[1, 2], [3, 1]]), np.ones((4, 5))).astype(np.int32)
    image = vorotool.LabelImage(
        labels, grid=map_grid(transform, crs={"type": "name", "properties": {"name": "EPSG:2056"}})
    )
    frame = image.to_geopandas()
    assert frame.crs.to_epsg() == 2056
    shapes = rasterio_features.shapes(labels, transform=rasterio.Affine(*transform))
    theirs = geopandas.GeoDataFrame(
        [(shapely.geometry.shape(s), int(v)) for s, v in shapes], columns=["geometry", "label"]
    )
    theirs = theirs.set_geometry("geometry").dissolve("label").geometry
    assert shapely.equals(frame.geometry.values, theirs.values).all()
    if "area" in frame:
        np.testing.assert_allclose(frame["area"], frame.area)
        assert not {"bbox_x", "bbox_y"} & set(frame.columns)
