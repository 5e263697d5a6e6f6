"""Writing GeoPackage, FlatGeobuf, Shapefile and GeoParquet: other programs read what was meant, and so do we."""

import time
from datetime import UTC, date, datetime

import numpy as np
import pandas
import pytest
import shapely

import vorotool
from support.families.vector_files import DRIVERS, load
from support.refusals import refused
from vorotool.convert.polygons import as_polygons
from vorotool.errors import OutputError, UsageError, silent
from vorotool.formats.gis.feature_writer import FeatureRows
from vorotool.types.polygons.polygon_set import PolygonSet

FORMATS = list(DRIVERS)
SWISS = {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::2056"}}
BOXES = shapely.box([0, 20, 40], 0, [9, 33.3, 41], [9, 0.1, 1 / 3])


def shapes(**described):
    return PolygonSet(
        shapely.get_coordinates([shapely.LinearRing(box.exterior.coords[:-1]) for box in BOXES]).reshape(3, 5, 2)[:, :4]
        .reshape(-1, 2), [0, 4, 8, 12], [0, 0, 0], [0, 1, 2], y_axis="up", **described,
    )  # fmt: skip


@pytest.mark.parametrize("fmt", FORMATS)
def test_other_programs_read_what_was_written(tmp_path, fmt):
    path = tmp_path / f"a.{fmt}"
    columns = {"name": ["ä", None, "c"], "code": ["007", "8", "9"], "n": [3, -4, 2**40], "r": [0.1, 2.0, None]}
    vorotool.write(shapes(properties=columns, crs=SWISS), path)
    read = load(path)
    assert read.crs.to_epsg() == 2056
    assert all(one.equals(box) for one, box in zip(read.geometry, BOXES, strict=True))
    plain = [[None if pandas.isna(value) else value for value in read[name]] for name in columns]
    assert dict(zip(columns, plain, strict=True)) == columns
    assert (read["n"].dtype, read["r"].dtype) == (np.int64, np.float64)


def test_the_same_bytes_at_any_time(tmp_path):
    for name in ("a", "b"):
        for fmt in FORMATS:
            vorotool.write(shapes(properties={"n": [1, 2, 3]}, crs=SWISS), tmp_path / f"{name}.{fmt}")
        if name == "a":
            time.sleep(1.1)
    parts = list(tmp_path.glob("a.*"))
    assert len(parts) == len(FORMATS) + 4  # a Shapefile has five parts
    for part in parts:
        assert part.read_bytes() == (tmp_path / f"b{part.suffix}").read_bytes(), part.suffix


def test_several_kinds_and_several_parts(tmp_path):
    collection = [shapely.box(0, 0, 1, 1), shapely.MultiPolygon([shapely.box(2, 0, 3, 1), shapely.box(4, 0, 5, 1)])]
    both = as_polygons(collection)
    vorotool.write(both, tmp_path / "a.gpkg")
    assert set(load(tmp_path / "a.gpkg").geom_type) == {"MultiPolygon"}
    mixed = as_polygons([*collection, shapely.LineString([(0, 0), (1, 1)])])
    for fmt in ("gpkg", "fgb", "parquet"):
        vorotool.write(mixed, tmp_path / f"b.{fmt}")
        assert [len(shapely.get_parts(each)) for each in load(tmp_path / f"b.{fmt}").geometry] == [1, 2, 1]
    refused(OutputError, r"b.shp", vorotool.write, mixed, tmp_path / "b.shp")
    assert not list(tmp_path.glob("b.shp")) + list(tmp_path.glob("b.dbf"))


def test_attributes_that_are_called_as_parts_of_a_geopackage(tmp_path):
    columns = {"FID": ["a", "b", "c"], "geom": [1, 2, 3], "ogc_fid": [4, 5, 6]}
    vorotool.write(shapes(properties=columns), tmp_path / "a.gpkg")
    read = load(tmp_path / "a.gpkg")
    assert {name: read[name].tolist() for name in columns} == columns


def test_names_that_differ_by_case_alone_are_one_in_a_geopackage(tmp_path):
    columns = {"Name": ["a", "b", "c"], "NAME": [1, 2, 3], "name_2": [4, 5, 6], "name": [7, 8, 9]}
    with pytest.warns(vorotool.VorotoolWarning, match="NAME is NAME_3; name is name_4"):
        vorotool.write(shapes(properties=columns), tmp_path / "a.gpkg")
    read = load(tmp_path / "a.gpkg")
    assert [read[name].tolist() for name in ("Name", "NAME_3", "name_2", "name_4")] == list(columns.values())


def rows_of(*features):
    rows = FeatureRows()
    rows.write(b'{"type":"FeatureCollection","features":[\n')
    rows.write(b",\n".join(b'{"type":"Feature","properties":%b,"geometry":null}' % each for each in features))
    rows.write(b"\n]}\n")
    return rows.columns()


@pytest.mark.parametrize(
    ("values", "kind"),
    [
        ([b"1", b"null", b"-3"], "int64"),
        ([b"1", b"2.0"], "float64"),
        ([b"1", b"9223372036854775808"], "float64"),
        ([b"true", b"false"], "bool"),
        ([b"true", b"1"], "object"),
        ([b'"2020-01-31"', b"null"], "datetime64[D]"),
        ([b'"2020-01-31"', b'"2020-02-30"'], "object"),
        ([b'"2020-01-31T01:02:03"', b'"1999-01-01T00:00:00.5"'], "datetime64[ms]"),
        ([b'"2020-01-31T01:02:03"', b'"1999-01-01T00:00:00Z"'], "object"),
        ([b'"007"', b'"8"'], "object"),
        ([b"[1,2]", b'{"a":1}'], "object"),
        ([b"null", b"null"], "object"),
    ],
)
def test_one_type_a_column(values, kind):
    column = rows_of(*(b'{"a":%b}' % value for value in values))["a"]
    assert column.values.dtype == kind
    assert column.missing.tolist() == [value == b"null" for value in values]


def test_times_of_a_zone(tmp_path):
    column = rows_of(b'{"a":"2020-01-31T01:02:03+02:00"}')["a"]
    assert column.is_utc
    assert column.values[0] == np.datetime64("2020-01-30T23:02:03")
    moment = datetime(2020, 1, 31, 1, 2, 3, tzinfo=UTC)
    for fmt in ("gpkg", "parquet"):
        vorotool.write(shapes(properties={"t": [moment, None, moment]}), tmp_path / f"a.{fmt}")
        assert vorotool.read(tmp_path / f"a.{fmt}").properties["t"] == [moment, None, moment]
        vorotool.write(shapes(properties={"d": [date(2020, 1, 31)] * 3}), tmp_path / f"b.{fmt}")
        assert vorotool.read(tmp_path / f"b.{fmt}").properties["d"] == [date(2020, 1, 31)] * 3


def test_a_shapefile_needs_a_file(tmp_path):
    with pytest.raises(UsageError, match="a Shapefile is several files, which the stream - cannot hold"):
        vorotool.write(shapes(), "-", fmt="shp")


def test_every_coordinate_comes_back_to_the_bit(tmp_path):
    points = np.random.default_rng(3).standard_normal((500, 2)) * 10.0 ** np.arange(-12, 13, 0.05)[:500, None]
    cells = vorotool.voronoi_cells(points[:200])
    for fmt in ("gpkg", "fgb", "parquet", "shp"):
        with silent():
            vorotool.write(cells, tmp_path / f"a.{fmt}")
        made = load(tmp_path / f"a.{fmt}").geometry
        assert len(made) == 200
        expected = vorotool.to_geojson(cells)["features"]
        for one, feature in zip(made, expected, strict=True):
            polygon = shapely.Polygon(feature["geometry"]["coordinates"][0])
            both = [shapely.get_coordinates(each.normalize()).tobytes() for each in (one, polygon)]
            assert both[0] == both[1]
