"""Reading GeoPackage, FlatGeobuf, Shapefile and GeoParquet as other programs write them."""

import io
import zipfile

import numpy as np
import pyogrio
import pytest
import shapely

import vorotool
from support.families.vector_files import ATTRIBUTES, DRIVERS, SHAPES, frame, load, save
from support.refusals import refused
from vorotool.errors import InputError, LimitError, UsageError
from vorotool.numeric.crs import crs_name
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.polygons.shapely_geometry import to_shapely

FORMATS = list(DRIVERS)


def notes_of(path, **options):
    notes = []
    vorotool.read(path, note=notes.append, **options)
    return notes


@pytest.mark.parametrize("fmt", FORMATS)
def test_polygons_with_all_that_they_carry(tmp_path, fmt):
    shapes = vorotool.read(save(frame(), tmp_path / f"a.{fmt}"))
    assert isinstance(shapes, PolygonSet)
    assert shapes.feature.tolist() == [0, 1, 1, 2]
    assert shapes.part.tolist() == [1, 1, 2, 1]
    assert shapes.y_axis == "up"
    assert crs_name(shapes.crs) == "EPSG:2056"
    parts = [part for shape in SHAPES for part in shapely.get_parts(shape)]
    assert all(shapely.equals(made, part) for made, part in zip(to_shapely(shapes), parts, strict=True))
    for name, values in ATTRIBUTES.items():
        expected = [values[0], values[1], values[1], values[2]]
        assert shapes.properties[name] == expected, name
        assert [type(value) for value in shapes.properties[name]] == [type(value) for value in expected], name


@pytest.mark.parametrize("driver", ["GPKG", "FlatGeobuf"])
def test_types_of_attributes(tmp_path, driver):
    columns = {
        "flag": np.array([True, False, False]),
        "whole": np.array([2**53 + 1, 0, -(2**53) - 1]),
        "real": np.array([1.0, 0, -0.5]),
        "time": np.array(["2020-01-31T01:02:03", "2000-01-01", "1999-12-01T00:00:00.25"], "datetime64[ms]"),
    }
    missing = [np.array([False, True, False])] * len(columns)
    path = tmp_path / {"GPKG": "a.gpkg", "FlatGeobuf": "a.fgb"}[driver]
    order = {"layer_options": {"SPATIAL_INDEX": "NO"}} if driver == "FlatGeobuf" else {}
    pyogrio.raw.write(
        path, shapely.to_wkb(shapely.points([[0, 0], [1, 2], [3, 4]])), list(columns.values()), list(columns),
        field_mask=missing, driver=driver, geometry_type="Point", crs="EPSG:3857", **order,
    )  # fmt: skip
    read = vorotool.read(path).properties
    assert read["flag"] == [True, None, False]
    assert read["whole"] == [2**53 + 1, None, -(2**53) - 1]
    assert read["real"] == [1.0, None, -0.5]
    assert [type(read[name][0]) for name in ("flag", "whole", "real")] == [bool, int, float]
    times = [None if time is None else time.replace(tzinfo=None).isoformat() for time in read["time"]]
    assert times[::2] == ["2020-01-31T01:02:03", "1999-12-01T00:00:00.250000"]


def test_layers(tmp_path):
    path = tmp_path / "a.gpkg"
    frame().to_file(path, layer="lakes", driver="GPKG")
    assert len(vorotool.read(path)) == 4
    frame(SHAPES[:1], name=["b"]).to_file(path, layer="ponds", driver="GPKG")
    refused(InputError, r"a.gpkg", vorotool.read, path)
    refused(InputError, r"'rivers'", vorotool.read, path, layer="rivers")
    assert vorotool.read(path, layer="ponds").properties == {"name": ["b"]}


@pytest.mark.parametrize("fmt", FORMATS)
def test_systems_that_have_no_number(tmp_path, fmt):
    spelled = 'PROJCS["Swiss oblique",GEOGCS["CH1903",DATUM["CH1903",SPHEROID["Bessel 1841",6377397.155,299.1528128]],'
    spelled += 'PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]],PROJECTION["Mercator_1SP"],UNIT["metre",1]]'
    shapes = vorotool.read(save(frame(crs=spelled), tmp_path / f"a.{fmt}"))
    assert crs_name(shapes.crs).replace("_", " ") == "Swiss oblique"
    vorotool.write(shapes, tmp_path / "again.gpkg")
    assert load(tmp_path / "again.gpkg").crs == load(tmp_path / f"a.{fmt}").crs
    refused(InputError, r"EPSG:2056", vorotool.read, tmp_path / f"a.{fmt}", crs="EPSG:2056")


@pytest.mark.parametrize("fmt", FORMATS)
def test_another_system(tmp_path, fmt):
    lakes = frame([shapely.box(8.5, 47.2, 8.8, 47.4)], crs="EPSG:4326", name=["Zürichsee"])
    path = save(lakes, tmp_path / f"a.{fmt}")
    shapes = vorotool.read(path, to_crs="EPSG:2056")
    expected = lakes.to_crs("EPSG:2056").geometry[0]
    assert shapely.equals_exact(to_shapely(shapes)[0], expected, 1e-6, normalize=True)
    assert crs_name(shapes.crs) == "EPSG:2056"
    assert shapes.properties == {"name": ["Zürichsee"]}
    assert notes_of(path, to_crs="EPSG:2056") == []
    unnamed = save(frame(crs=None), tmp_path / f"b.{fmt}")
    refused(InputError, "to_crs", vorotool.read, unnamed, to_crs="EPSG:2056")
    refused(UsageError, r"EPSG:99999", vorotool.read, path, to_crs="EPSG:99999")


def test_places_that_another_system_has_not(tmp_path):
    path = save(frame([shapely.box(98, 0, 99, 1)], crs="EPSG:4326", n=[1]), tmp_path / "a.gpkg")
    refused(InputError, r"EPSG:32632", vorotool.read, path, to_crs="EPSG:32632")


# ---- Shapefiles ------------------------------------------------------------------------------------
def zipped(folder, stem, out):
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        for part in folder.glob(f"{stem}.*"):
            archive.write(part, part.name)
    return out


@pytest.mark.parametrize("name", ["a.zip", "a.shz", "a.shp.zip"])
def test_zipped_shapefiles(tmp_path, name):
    (tmp_path / "in").mkdir()
    save(frame(), tmp_path / "in" / "lakes.shp")
    path = zipped(tmp_path / "in", "lakes", tmp_path / name)
    assert vorotool.read(path).properties["code"] == ["007", "010", "010", "99"]
    save(frame(SHAPES[:1], n=[1]), tmp_path / "in" / "ponds.shp")
    both = tmp_path / "both.zip"
    with zipfile.ZipFile(both, "w") as archive:
        for part in (tmp_path / "in").iterdir():
            archive.write(part, part.name)
    refused(InputError, r"both.zip", vorotool.read, both)
    assert len(vorotool.read(both, layer="ponds")) == 1


@pytest.mark.parametrize("missing", [".shx", ".dbf"])
def test_shapefiles_of_which_a_part_is_missing(tmp_path, missing):
    path = save(frame(), tmp_path / "a.shp")
    path.with_suffix(missing).unlink()
    with pytest.raises(InputError, match=rf"a.shp is a part of a Shapefile, whose \{missing} is not beside it: copy"):
        vorotool.read(path)


def test_shapefiles_in_capitals_and_without_a_system(tmp_path):
    save(frame(), tmp_path / "lakes.shp")
    for part in list(tmp_path.iterdir()):
        part.rename(tmp_path / part.name.upper())
    assert len(vorotool.read(tmp_path / "LAKES.SHP")) == 4
    (tmp_path / "LAKES.PRJ").unlink()
    shapes = vorotool.read(tmp_path / "LAKES.SHP", crs="EPSG:2056")
    assert crs_name(shapes.crs) == "EPSG:2056"


def test_names_that_other_programs_take_for_archives_or_addresses(tmp_path):
    folder = tmp_path / "a!b?c"
    folder.mkdir()
    for name in ("x!y.gpkg", "zip:x.gpkg", "x!y.shp"):
        assert len(vorotool.read(save(frame(), tmp_path / f"a.{name[-4:].strip('.')}"))) == 4
        for part in tmp_path.glob("a.*"):
            part.rename(folder / (name.rpartition(".")[0] + part.suffix))
        assert len(vorotool.read(folder / name)) == 4


def test_geoparquet_in_another_encoding(tmp_path):
    save(frame(SHAPES[2:], n=[1]), tmp_path / "a.parquet", geometry_encoding="geoarrow", schema_version="1.1.0")
    refused(InputError, r"a.parquet", vorotool.read, tmp_path / "a.parquet")


# ---- what is none ----------------------------------------------------------------------------------
def reason_against(path, geometry):
    try:
        vorotool.read(path, geometry=geometry)
    except InputError as error:
        return str(error)
    return "fine"


@pytest.mark.parametrize("fmt", FORMATS)
@pytest.mark.parametrize("geometry", [None, "points", "polygons"])
def test_damaged_files(tmp_path, fmt, geometry):
    data = save(frame(), tmp_path / f"a.{fmt}").read_bytes()
    random = np.random.default_rng(1)
    for size in [0, 5, len(data) // 3, len(data) - 7, *random.integers(0, len(data), 10).tolist()]:
        damaged = bytearray(data[:size])
        for place in random.integers(0, max(size, 1), min(size, 8)).tolist():
            damaged[place] ^= 1 << int(random.integers(8))
        (tmp_path / f"a.{fmt}").write_bytes(damaged)
        said = reason_against(tmp_path / f"a.{fmt}", geometry)
        assert said.startswith((str(tmp_path / f"a.{fmt}"), "item", "fine"))
        assert "vsimem" not in said


def test_files_that_name_others_are_not_opened(tmp_path):
    """A virtual format of GDAL could read anything."""
    save(frame(), tmp_path / "a.gpkg")
    virtual = f'<OGRVRTDataSource><OGRVRTLayer name="a"><SrcDataSource>{tmp_path}/a.gpkg</SrcDataSource></OGRVRTLayer>'
    for fmt in ("gpkg", "fgb", "shp", "kml", "gpx"):
        for comment in ("", f"<!-- <{fmt}> -->", f"<?x <{fmt} ?>"):
            path = tmp_path / f"b.{fmt}"
            path.write_text(f"{comment}{virtual}</OGRVRTDataSource>")
            refused(InputError, r"b\.\w+ is not a \w+( file)?: its first bytes", vorotool.read, path, input_format=fmt)


def test_longitudes_and_latitudes_of_kml_and_gpx(tmp_path):
    (tmp_path / "a.kml").write_text(
        '<?xml version="1.0"?><kml xmlns="http://www.opengis.net/kml/2.2"><Placemark><name>a</name><Point>'
        "<coordinates>8.5,47.25,400</coordinates></Point></Placemark></kml>"
    )
    (tmp_path / "a.gpx").write_text(
        '<?xml version="1.0"?><gpx version="1.1" xmlns="http://www.topografix.com/GPX/1/1">'
        '<wpt lat="47.25" lon="8.5"><name>a</name></wpt></gpx>'
    )
    for name, layer in (("a.kml", None), ("a.gpx", "waypoints")):
        points = vorotool.read(tmp_path / name, layer=layer)
        assert points.xy.tolist() == [[8.5, 47.25]]
        assert crs_name(points.crs) in ("EPSG:4326", "OGC:CRS84")


def test_streams(tmp_path, monkeypatch):
    data = save(frame(), tmp_path / "a.gpkg").read_bytes()
    for fmt in ("gpkg", "fgb", "parquet"):
        data = save(frame(), tmp_path / f"a.{fmt}").read_bytes()
        monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(data)))
        assert len(vorotool.read("-")) == 4
    data = save(frame(), tmp_path / "a.shp").read_bytes()
    monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(data)))
    refused(InputError, r".shp", vorotool.read, "-")
    zipped(tmp_path, "a", tmp_path / "all.zip")
    monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO((tmp_path / "all.zip").read_bytes())))
    assert len(vorotool.read("-")) == 4


def test_archives_of_many_shapefiles(tmp_path):
    (tmp_path / "in").mkdir()
    save(frame(), tmp_path / "in" / "lakes.shp")
    path = zipped(tmp_path / "in", "lakes", tmp_path / "many.zip")
    with zipfile.ZipFile(path, "a") as archive:
        for number in range(2000):
            archive.writestr(f"pond{number}.shp", b"")
            archive.writestr(f"{number}.txt", b"")
    refused(LimitError, r"many.zip", vorotool.read, path)
    assert len(vorotool.read(path, layer="lakes")) > 0
