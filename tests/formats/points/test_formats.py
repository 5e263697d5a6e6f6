"""Which format points are in, and that all formats agree."""

import io
import json

import numpy as np
import pyarrow
import pyarrow.parquet
import pyogrio
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from support.readers.point_reading import error_of, npy, read
from support.readers.written import bytes_of
from vorotool.errors import InputError, LimitError, UsageError
from vorotool.formats.io.sources import STANDARD_INPUT, Source
from vorotool.formats.recognition import geometry_format
from vorotool.products.inputs import INPUTS

POINT_FORMATS = sorted(each.name for each in INPUTS.values() if "points" in each.readers)


@pytest.mark.parametrize(
    ("name", "content", "expected"),
    [
        ("a.csv", "[", "csv"),
        ("a.TSV", "", "csv"),
        ("a.node", "", "node"),
        ("a.npy", "", "npy"),
        ("a.geojson", "", "geojson"),
        ("a.wkt", "", "wkt"),
        ("a.json", "[[1, 2]]", "json"),
        ("a.json", '{"type": "Point"}', "geojson"),
        ("a.txt", "1 2", "csv"),
        (STANDARD_INPUT, "", "csv"),
        (STANDARD_INPUT, "\ufeff\n [[1, 2]]", "json"),
        (STANDARD_INPUT, "\n{", "geojson"),
        (STANDARD_INPUT, "point(1 2)", "wkt"),
        (STANDARD_INPUT, "SRID=4326;MULTIPOINT Z EMPTY", "wkt"),
        (STANDARD_INPUT, "point x,point y\n1,2", "csv"),
        (STANDARD_INPUT, npy(np.zeros((1, 2))), "npy"),
    ],
)
def test_detection(name, content, expected):
    assert geometry_format(Source(name, content if isinstance(content, bytes) else content.encode())) == expected


@pytest.mark.parametrize("suffix", [".gml", ".tab", ".mif"])
def test_files_to_convert(suffix):
    message = error_of(b"", f"data/towns{suffix}")
    assert message.startswith(f"data/towns{suffix}: {suffix} files are not supported")
    assert message.endswith(f"ogr2ogr -f GeoJSON data/towns.geojson data/towns{suffix}")


@pytest.mark.parametrize("suffix", [".shx", ".dbf", ".prj", ".cpg"])
def test_a_part_of_a_shapefile_names_the_file_to_read(suffix):
    assert error_of(b"\0\0\x27\x0a", f"data/towns{suffix}").endswith(": name data/towns.shp")


def test_options_that_do_not_fit():
    assert "expected one of csv, tsv, txt, node, ply" in error_of("", kind=UsageError, input_format="abc")
    for fmt in set(POINT_FORMATS) - {"csv", "json", "jsonl", "npz", "parquet", "gpkg", "ply", "xyz", "las"}:
        assert "columns applies to delimited text" in error_of("", kind=UsageError, input_format=fmt, columns="1,2")


def vector_file(geometry, driver):
    out = io.BytesIO()
    kind = {"driver": driver, "geometry_type": "Point", "crs": "EPSG:3857"}
    order = {"SPATIAL_INDEX": "NO"} if driver == "FlatGeobuf" else {}
    pyogrio.raw.write(out, shapely.to_wkb(geometry), [], [], layer="a", layer_options=order, **kind)
    return out.getvalue()


coordinates = st.floats(allow_nan=False, allow_infinity=False, min_value=-1e12, max_value=1e12)


@settings(deadline=None, max_examples=15)
@given(st.lists(st.tuples(coordinates, coordinates), min_size=1, max_size=8))
def test_all_formats_agree(points):
    pairs = [list(point) for point in points]
    array = np.array(pairs)
    node = "".join(f"{i} {x!r} {y!r}\n" for i, (x, y) in enumerate(points))
    texts = {
        "csv": "".join(f"{x!r};{y!r}\n" for x, y in points),
        "node": f"{len(points)} 2 0 0\n{node}",
        "npy": npy(array),
        "npz": bytes_of(np.savez, x=array[:, 0], y=array[:, 1]),
        "json": json.dumps(pairs),
        "geojson": json.dumps({"type": "MultiPoint", "coordinates": pairs}),
        "wkt": "".join(f"POINT ({x!r} {y!r})\n" for x, y in points),
        "jsonl": "".join(json.dumps({"x": x, "y": y}) + "\n" for x, y in points),
    }
    geometry = shapely.points(array)
    for fmt, driver in (("gpkg", "GPKG"), ("fgb", "FlatGeobuf")):
        texts[fmt] = vector_file(geometry, driver)
    texts["wkb"] = shapely.to_wkb(shapely.multipoints(array))
    texts["csv-wkt"] = "wkt\n" + "".join(f"POINT ({x!r} {y!r})\n" for x, y in points)
    columns = pyarrow.table({"x": array[:, 0], "y": array[:, 1]})
    texts["parquet"] = bytes_of(lambda out: pyarrow.parquet.write_table(columns, out))
    texts["ply"] = f"ply\nformat ascii 1.0\nelement vertex {len(points)}\nproperty double x\nproperty double y\n"
    texts["ply"] += "end_header\n" + "".join(f"{x!r} {y!r}\n" for x, y in points)
    texts["obj"] = "".join(f"v {x!r} {y!r} 7\n" for x, y in points)
    texts["xyz"] = "".join(f"{x!r} {y!r} 7\n" for x, y in points)
    others = {"shp", "kml", "gpx", "las"}  # of several files; of longitudes and latitudes; of integers
    assert set(texts) == set(POINT_FORMATS) - others
    for fmt, text in texts.items():
        np.testing.assert_array_equal(read(text, STANDARD_INPUT, input_format=fmt).xy, array)
    assert len(read(shapely.multipoints(array).wkt, STANDARD_INPUT)) == len(points)


def reason_against(data, fmt):
    try:
        read(data, "any", input_format=fmt)
    except (InputError, LimitError) as error:
        return str(error)
    return "any points are good"


@settings(deadline=None, max_examples=80)
@given(st.sampled_from(POINT_FORMATS), st.binary(max_size=60))
def test_any_bytes_give_points_or_a_reason(fmt, data):
    assert reason_against(data, fmt).startswith("any")


@settings(deadline=None, max_examples=80)
@given(st.sampled_from(["csv", "node", "wkt", "json"]), st.text('0123.,;-e \n"#()[]{}POINTMUL:x\t', max_size=60))
def test_any_text_gives_points_or_a_reason(fmt, text):
    assert reason_against(text, fmt).startswith("any")
