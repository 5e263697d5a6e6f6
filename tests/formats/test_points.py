"""Points of every format: what is read, and what each bad input is told."""

import io
import json
import math

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from vorotool.errors import InputError, LimitError, UsageError
from vorotool.formats.points import POINT_FORMATS, detect_point_format, read_points
from vorotool.formats.sources import STANDARD_INPUT, Source


def read(text, name="seeds.csv", **options):
    data = text if isinstance(text, bytes) else text.encode()
    return read_points(Source(name, data), **options)


def rows(text, name="seeds.csv", **options):
    return read(text, name, **options).xy.tolist()


def error_of(text, name="seeds.csv", kind=InputError, **options):
    with pytest.raises(kind) as caught:
        read(text, name, **options)
    return str(caught.value)


def notes_of(text, name="seeds.csv", **options):
    notes = []
    read(text, name, note=notes.append, **options)
    return notes


def npy(array, **options):
    out = io.BytesIO()
    np.save(out, array, **options)
    return out.getvalue()


# ---- delimited text: which columns -----------------------------------------------------------------
@pytest.mark.parametrize(
    "text",
    [
        "1,2\n3,4.5\n",
        "1;2\r\n3;4.5\r\n",
        "1\t2\n3\t4.5",
        " 1   2 \n3 4.5\n",
        "1, 2\r3, 4.5\r",
        "\ufeff1,2\n3,4.5\n",
        "\ufeffx,y\n1,2\n3,4.5\n",
        "# made by hand\n\nX;Y\n1;2\n# more\n3;4.5\n",
        '"x","y"\n"1","2"\n"3","4.5"\n',
        "x y\n1 2\n3 4.5\n",
        "y,x\n2,1\n4.5,3\n",
    ],
)
def test_two_columns(text):
    assert rows(text) == [[1, 2], [3, 4.5]]
    assert rows(text, STANDARD_INPUT) == [[1, 2], [3, 4.5]]


@pytest.mark.parametrize(
    ("header", "used", "point"),
    [
        ("id,X,Y", "X, Y", [2, 3]),
        ("x,y,lon,lat", "x, y", [1, 2]),
        ("Lat,Lon,z", "Lon, Lat", [2, 1]),
        ("latitude,longitude,z", "longitude, latitude", [2, 1]),
        ("label,centroid-0,centroid-1", "centroid-1, centroid-0", [3, 2]),
        ("index,axis-0,axis-1", "axis-1, axis-0", [3, 2]),
    ],
)
def test_recognised_headers(header, used, point):
    text = f"{header}\n" + ",".join(str(i + 1) for i in range(header.count(",") + 1))
    assert rows(text) == [point]
    notes = notes_of(text)
    if used.lower() == "x, y":  # needs no word
        assert notes == []
        return
    assert notes[0] == f"seeds.csv: columns {used} are read as x, y"
    degrees = "seeds.csv: longitude and latitude are treated as planar, lengths are in degrees"
    assert notes[1:] == ([degrees] if used.lower().startswith("lon") else [])


def test_labels():
    points = read("label,x,y\n7,1,2\n9,3,4\n")
    assert points.labels.tolist() == [7, 9]
    assert points.properties == {}
    assert notes_of("x,y,label\n1,2,7\n") == ["seeds.csv: columns x, y, label are read as x, y, label"]
    points = read("x,y,label,name\n1,2,7,a\n")
    assert points.labels is None
    assert points.properties == {"label": ["7"], "name": ["a"]}
    assert read("x,y,label,name\n1,2,7,a\n", columns="x,y,label").labels.tolist() == [7]
    assert read("1,2,7\n", columns="1,2,3").labels.tolist() == [7]
    assert read("x,y,label\n1,2,4294967295.0\n").labels.tolist() == [4294967295]


@pytest.mark.parametrize(
    ("columns", "point"),
    [("1,2", [1, 2]), ("3,1", [3, 1]), ("b,a", [2, 1]), ("A,3", [1, 3]), (" c , 2 ", [3, 2])],
)
def test_chosen_columns(columns, point):
    assert rows("a,b,c\n1,2,3\n", columns=columns) == [point]


def test_chosen_columns_without_a_header():
    assert rows("1,2,3\n4,5,6\n", columns="3,1") == [[3, 1], [6, 4]]
    assert rows("n1,2,3\nn2,5,6\n", columns="2,3") == [[2, 3], [5, 6]]
    assert notes_of("n,lon,lat\nn1,5,6\n", columns="lon,lat") == [
        "seeds.csv: longitude and latitude are treated as planar, lengths are in degrees"
    ]


def test_names_that_differ_in_case_alone():
    assert rows("a,A\n1,2\n", columns="A,a") == [[2, 1]]
    assert "several columns are called 'v'" in error_of("v,v\n1,2\n", columns="v,2")


def test_further_columns_stay_text():
    text = '"id",x,,y,id\n007,1,é,2,"a, ""b"""\n008,3,,4,\n'
    assert read(text).properties == {"id": ["007", "008"], "column_3": ["é", ""], "id_2": ['a, "b"', ""]}
    assert read(text, properties=False).properties == {}


@pytest.mark.parametrize("text", ["", "\n\n", "# nothing\n", "\ufeff", "x,y\n", "a,x,y"])
def test_no_points(text):
    assert len(read(text)) == 0


# ---- delimited text: errors ------------------------------------------------------------------------
@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "x,y\n1,2\n# c\n\n3,abc\n",
            "line 5: 'abc' in column 2 (y) is not a number; correct it, or choose other columns with --columns",
        ),
        ("1,2\n3,\n", "line 2: column 2 is empty; fill in a number, or remove the line"),
        ("1,2\nNaN,3\n", "line 2: 'NaN' in column 1 is not a finite number; correct it, or remove the line"),
        ("inf,2\n", "line 1: 'inf' in column 1 is not a finite number; correct it, or remove the line"),
        (
            "x;y\r\n1;2\r\n1,5;2\r\n",
            "line 3: '1,5' in column 1 (x) is not a number: decimal commas are not read, write 1.5",
        ),
        ("1,5;2,5\n", "line 1: '1,5' in column 1 is not a number: decimal commas are not read, write 1.5"),
        (
            "1,2\n3,4\n5,6,7\n",
            "line 3: 3 fields, but the first row (line 1) has 2; give every line the same number of fields",
        ),
        (
            "#\nx,y\n1\n",
            "line 3: 1 field, but the header (line 2) has 2; give every line the same number of fields",
        ),
        (
            '1,2\n3,"4\n5,6\n',
            "line 2: the quote that opens column 2 is not closed before the next delimiter; close it, or remove it",
        ),
        (
            "x,y,label\n1,2,3\n\n4,5,0\n",
            "line 4: the label 0 is not a whole number from 1 to 4294967295; correct it, or "
            "leave the label out of "
            "--columns",
        ),
        (
            "x,y,label\n1,2,1.5\n",
            "line 2: the label 1.5 is not a whole number from 1 to 4294967295; correct it, or "
            "leave the label out "
            "of --columns",
        ),
        (
            "x,y,label\n1,2,b\n",
            "line 2: 'b' in column 3 (label) is not a number; correct it, or choose other columns with --columns",
        ),
    ],
)
def test_bad_lines(text, message):
    assert error_of(text) == f"seeds.csv, {message}"
    assert error_of(text, threads=1) == error_of(text, threads=3)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "1,2,3\n",
            "3 columns without a header; say which are x and y, for example --columns 1,2 (its "
            "columns are 1 = 1, "
            "2 = 2, 3 = 3)",
        ),
        (
            "id,east,north\n1,2,3\n",
            "the header names no known pair of coordinates; say which are x and y, for example "
            "--columns id,east "
            "(its columns are 1 = id, 2 = east, 3 = north)",
        ),
        (
            "lng,lat\n1,2\n",
            "the header names no known pair of coordinates; say which are x and y, for example "
            "--columns lng,lat "
            "(its columns are 1 = lng, 2 = lat)",
        ),
        (
            "1|2\n",
            "the first line has one column, '1|2'; give x and y, separated by a comma, a semicolon, a tab or blanks",
        ),
    ],
)
def test_unknown_columns(text, message):
    assert error_of(text) == f"seeds.csv: {message}"


def test_many_columns_are_not_all_listed():
    message = error_of(",".join(f"c{i}" for i in range(500)) + "\n")
    assert message.endswith("12 = c11, … 500 in all)")


@pytest.mark.parametrize("columns", ["x", "x,y,label,more", "x,,y", "", "0,1", "x,x", "1,1"])
def test_malformed_columns(columns):
    message = error_of("x,y\n1,2\n", kind=UsageError, columns=columns)
    assert message.startswith(f"--columns is {columns!r}: name two or three different columns")


def test_columns_that_are_not_there():
    assert (
        error_of("x,y\n1,2\n", columns="x,z")
        == "seeds.csv: there is no column 'z'; its columns are 1 = x, 2 = y; correct --columns"
    )
    message = "seeds.csv: --columns names column 3, but there are 2; its columns are 1 = x, 2 = y"
    assert error_of("x,y\n1,2\n", columns="1,3") == message
    assert "names one column twice" in error_of("x,y\n1,2\n", columns="x,1")


def test_other_encodings():
    assert "is UTF-16 text; save it as UTF-8" in error_of("1,2\n".encode("utf-16"))
    assert "is binary, not a list of points" in error_of(b"\x89PNG\r\n\0\0")
    message = error_of("x,y,name\n1,2,a\n3,4,é\n".encode("latin-1"))
    assert message == ("seeds.csv, line 3: the byte 0xe9 is not UTF-8; save the file as UTF-8, or use --no-properties")
    assert len(read("x,y,name\n1,2,é\n".encode("latin-1"), properties=False)) == 1


def test_the_limit_of_text():
    text = "# c\nx,y\n\n1,2\n3,4\n5,6\n"
    assert len(read(text, max_sites=3)) == 3
    message = error_of(text, kind=LimitError, max_sites=2)
    assert message == "seeds.csv holds 3 points, more than the limit of 2: raise --max-sites or split the file"


# ---- formats ---------------------------------------------------------------------------------------
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
    assert detect_point_format(Source(name, content if isinstance(content, bytes) else content.encode())) == expected


@pytest.mark.parametrize("suffix", [".shp", ".gpkg", ".dxf"])
def test_files_to_convert(suffix):
    message = error_of(b"", f"data/towns{suffix}")
    assert message == (
        f"data/towns{suffix}: {suffix} files are not read; convert it: "
        f"ogr2ogr -f GeoJSON data/towns.geojson data/towns{suffix}"
    )


def test_options_that_do_not_fit():
    assert "use csv, node, npy" in error_of("", kind=UsageError, input_format="xyz")
    for fmt in POINT_FORMATS[1:]:
        assert "--columns is for delimited text" in error_of("", kind=UsageError, input_format=fmt, columns="1,2")


# ---- Triangle --------------------------------------------------------------------------------------
@pytest.mark.parametrize("base", [0, 1])
def test_node(base):
    text = f"# box\n3 2 1 1 # header\n{base} 0 0 1.50 1\n{base + 1} 4 0.5 2 0\n\n{base + 2} -4 1e1 x 7 # last\n"
    points = read(text, "box.node")
    assert points.xy.tolist() == [[0, 0], [4, 0.5], [-4, 10]]
    assert points.labels is None
    assert points.properties == {"attribute_1": ["1.50", "2", "x"], "boundary_marker": ["1", "0", "7"]}
    assert read(text, "box.node", properties=False).properties == {}


def test_node_with_a_short_header():
    assert rows("1\n1 2 3\n", "a.node") == [[2, 3]]
    assert rows("0 2 0 0\n", "a.node") == []


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "",
            ": the file is empty; a .node file begins with <vertices> 2 <attributes> <0 or 1 boundary markers>",
        ),
        (
            "1.5 2\n",
            ", line 1: '1.5 2' is no header of a .node file; write <vertices> 2 <attributes> <0 or 1 boundary markers>",
        ),
        ("#\n1 3 0 0\n1 0 0 0\n", ", line 2: the vertices have 3 dimensions; only 2 are read"),
        (
            "2 2 0 0\n1 0 0\n",
            ", line 1: 2 vertices are announced, but 1 follow; correct the header, or complete the file",
        ),
        (
            "1 2 0 0\n1 0 0\n2 0 0\n",
            ", line 1: 1 vertices are announced, but 2 follow; correct the header, or complete the file",
        ),
        (
            "2 2 0 0\n1 0 0\n#\n3 0 0\n",
            ", line 4: vertex 3 stands where 2 is due; number the vertices from 0 or 1 without gaps",
        ),
        ("1 2 0 0\n1 0 b\n", ", line 2: 'b' in column 3 is not a number; correct it, or remove the line"),
        (
            "1 2 1 0\n1 0 0\n",
            ", line 2: 3 fields, but each vertex after the header (line 1) has 4; give every "
            "line the same number of "
            "fields",
        ),
        (
            "1 2 0 2\n1 0 0 0 0\n",
            ", line 1: 0 attributes and 2 boundary markers a vertex; write <vertices> 2 "
            "<attributes> <0 or 1 boundary markers>",
        ),
    ],
)
def test_bad_node(text, message):
    assert error_of(text, "a.node") == "a.node" + message


def test_the_limit_of_node():
    message = error_of("99999999999999 2 0 0\n", "a.node", LimitError)
    assert message == "a.node holds 99999999999999 points, more than the limit of 4294967295: split the file"


# ---- NPY -------------------------------------------------------------------------------------------
@pytest.mark.parametrize("dtype", ["f8", ">f8", "f4", "i2", "u1", ">i8"])
@pytest.mark.parametrize("order", ["C", "F"])
def test_npy(dtype, order):
    array = np.array([[1, 2, 7], [3, 4, 9]], dtype=dtype, order=order)
    points = read(npy(array), "a.npy")
    assert points.xy.tolist() == [[1, 2], [3, 4]]
    assert points.labels.tolist() == [7, 9]
    assert read(npy(array[:, :2]), "a.npy").labels is None
    assert len(read(npy(array[:0]), "a.npy")) == 0


def header(text, version=b"\x01\x00", size=None):
    padded = text.encode() + b"\n"
    return b"\x93NUMPY" + version + (len(padded) if size is None else size).to_bytes(2, "little") + padded


SHAPE = "{{'descr': '<f8', 'fortran_order': False, 'shape': {}}}"


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (
            npy(np.array([[1, "a"]], dtype=object), allow_pickle=True),
            "holds pickled Python objects, which are never loaded",
        ),
        (npy(np.array([["1", "2"]])), "holds values of type <U1, not numbers"),
        (npy(np.array([[1j, 2]])), "holds values of type complex128, not numbers"),
        (npy(np.zeros((3, 4))), "holds an array of shape (3, 4); save an (n, 2) or (n, 3) array"),
        (npy(np.zeros(4)), "holds an array of shape (4,)"),
        (npy(np.zeros((1, 2), dtype=[("x", "f8")])), "holds values of type [('x', '<f8')], not numbers"),
        (
            npy(np.zeros((5, 2)))[:-1],
            "is truncated: shape (5, 2) of float64 needs 80 bytes after the header, but",
        ),
        (b"\x93NUMPY\x01\x00", "the NPY header cannot be read"),
        (b"", "the NPY header cannot be read"),
        (header("{"), "the NPY header cannot be read"),
        (header("(" * 5000), "the NPY header cannot be read"),
        (header("{'descr': '<f8'}"), "the NPY header cannot be read"),
        (header(SHAPE.format("(2, 2)"), size=65535), "the NPY header cannot be read"),
        (header(SHAPE.format("(-1, 2)")), "holds an array of shape (-1, 2)"),
        (header(SHAPE.format("(1, 2)"), b"\x03\x00"), "version (3, 0) of the NPY format is not read"),
        (
            npy(np.array([[1, 2], [3, math.nan]])),
            "row 2: (3.0, nan) is not finite; correct or remove it (1 such rows)",
        ),
        (
            npy(np.array([[1.0, 2, 1], [3, 4, 0.5]])),
            "row 2: the label 0.5 is not a whole number from 1 to 4294967295",
        ),
        (npy(np.array([[1, 2, -1]])), "row 1: the label -1 is not a whole number"),
        (npy(np.array([[1.0, 2, math.nan]])), "row 1: the label nan is not a whole number"),
    ],
)
def test_bad_npy(data, message):
    found = error_of(data, "a.npy")
    assert found.startswith("a.npy")
    assert message in found
    assert ";" in found


def test_the_limit_of_npy():
    data = header(SHAPE.format("(100000000000, 2)"))
    assert "holds 100000000000 points, more than the limit of 4294967295" in error_of(data, "a.npy", LimitError)
    assert "more than the limit of 5: raise --max-sites" in error_of(
        npy(np.zeros((6, 2))), "a.npy", LimitError, max_sites=5
    )


# ---- JSON and GeoJSON ------------------------------------------------------------------------------
def test_json():
    points = read("[[1, 2], [3.5, -4]]", "a.json")
    assert points.xy.tolist() == [[1, 2], [3.5, -4]]
    assert not points.y_up
    assert len(read("[]", "a.json")) == 0
    assert rows(b"\xef\xbb\xbf[[1, 2]]", STANDARD_INPUT) == [[1, 2]]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[[1, 2],\n [3, ]]", "a.json, line 2, column "),
        ("[[1, 2], [3, NaN]]", "a.json, line 1, column "),
        ('[[1, 2], ["3", 4]]', "a.json, point 2: ['3', 4] is not a pair of finite numbers; write [x, y]"),
        ("[[1, 2], [true, 4]]", "a.json, point 2: [True, 4] is not a pair of finite numbers; write [x, y]"),
        ("[[1, 2], [null, 4]]", "a.json, point 2: [None, 4] is not a pair of finite numbers; write [x, y]"),
        ("[[1, 2], [3]]", "a.json, point 2: [3] is not a pair of finite numbers; write [x, y]"),
        ("[1, 2]", "a.json, point 1: 1 is not a pair of finite numbers; write [x, y]"),
        ("[[1, 2, 3]]", "a.json, point 1: [1, 2, 3] has 3 numbers; write [x, y]"),
        ('"seeds"', "a.json: 'seeds' is no list of points; write [[x, y], …]"),
        ("[" * 1000, "a.json, line 1: brackets are nested more than 100 deep; check the brackets"),
        ('{"points": []}', "a.json: the object has no GeoJSON type; write GeoJSON, or [[x, y], …]"),
    ],
)
def test_bad_json(text, message):
    assert error_of(text, "a.json", input_format="json").startswith(message)


def test_the_limit_of_json():
    assert "holds 3 points" in error_of("[[1, 2], [3, 4], [5, 6]]", "a.json", LimitError, max_sites=2)
    assert len(read("[[1, 2], [3, 4]]", "a.json", max_sites=2)) == 2


def feature(coordinates, kind="Point", **members):
    return {
        "type": "Feature",
        "geometry": {"type": kind, "coordinates": coordinates},
        "properties": None,
        **members,
    }


def collection(*features, **members):
    return json.dumps({"type": "FeatureCollection", "features": features, **members})


def test_geojson():
    crs = {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::2056"}}
    text = collection(
        feature([1, 2], id="a", properties={"name": "A", "n": 1}),
        feature([3.5, 4], id=7, properties={"n": {"deep": [1]}, "id": "own"}),
        crs=crs,
    )
    points = read(text, "a.geojson")
    assert points.xy.tolist() == [[1, 2], [3.5, 4]]
    assert points.y_up
    assert points.crs == crs
    assert points.properties == {
        "id": ["a", 7],
        "name": ["A", None],
        "n": [1, {"deep": [1]}],
        "property_id": [None, "own"],
    }
    assert read(text, "a.geojson", properties=False).properties == {}
    assert notes_of(text, "a.geojson") == []


@pytest.mark.parametrize(
    "text",
    [
        '{"type": "MultiPoint", "coordinates": [[1, 2], [3, 4]]}',
        json.dumps(feature([[1, 2], [3, 4]], "MultiPoint")),
        json.dumps(
            {
                "type": "GeometryCollection",
                "geometries": [
                    {"type": "Point", "coordinates": [1, 2]},
                    {"type": "Point", "coordinates": [3, 4]},
                ],
            }
        ),
    ],
)
def test_geojson_of_one_object(text):
    points = read(text, STANDARD_INPUT)
    assert points.xy.tolist() == [[1, 2], [3, 4]]
    assert points.properties == {"part": [1, 2]}


def test_geojson_parts_share_properties():
    text = collection(
        feature([[1, 2], [3, 4]], "MultiPoint", id=5, properties={"part": "p"}),
        feature([5, 6], properties={}),
    )
    assert read(text, "a.geojson").properties == {
        "id": [5, 5, None],
        "part": ["p", "p", None],
        "voro_part": [1, 2, 1],
    }


def test_geojson_notes():
    empty = {"type": "Feature", "geometry": None, "properties": {}}
    text = collection(feature([7.5, 46.9, 500]), empty, feature([]))
    assert notes_of(text, "a.geojson") == [
        "a.geojson: 2 features without a geometry are left out",
        "a.geojson: only x and y are used, heights are left out",
        "a.geojson: longitude and latitude are treated as planar, lengths are in degrees",
    ]
    assert len(read(text, "a.geojson")) == 1
    wgs84 = {"type": "name", "properties": {"name": "urn:ogc:def:crs:OGC:1.3:CRS84"}}
    assert len(notes_of(collection(feature([7, 46]), crs=wgs84), "a.geojson")) == 1
    assert len(read(collection(), "a.geojson")) == 0


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            collection(feature([1, 2]), feature([[[0, 0], [1, 0], [1, 1], [0, 0]]], "Polygon")),
            "a.geojson, feature 2: 'Polygon' is not a point; replace it by its centroid or its vertices "
            "(skeleton-exact reads polygons and lines)",
        ),
        (
            collection(feature([1, 2]), feature([1, "2"])),
            "a.geojson, feature 2: [1, '2'] is not a pair of finite numbers; write [x, y]",
        ),
        (collection(feature(None)), "a.geojson, feature 1: coordinates of the Point are None; write a list"),
        (collection(5), 'a.geojson, feature 1: 5 is no Feature; give it "type": "Feature"'),
        (
            collection(feature([1, 2], properties=[])),
            "a.geojson, feature 1: properties are []; write an object or null",
        ),
        (
            collection({"type": "Feature", "geometry": "x"}),
            "a.geojson, feature 1: the geometry is 'x'; write an object with type and coordinates",
        ),
        (
            '{"type": "FeatureCollection"}',
            'a.geojson: the FeatureCollection has no list of features; add "features": […]',
        ),
        ('{"type": "Circle"}', "a.geojson: 'Circle' is not a point; use Point or MultiPoint"),
        ("[]", "a.geojson: GeoJSON is an object with a type; use --input-format json for [[x, y], …]"),
        ('{"a":' * 1000, "a.geojson, line 1: brackets are nested more than 100 deep; check the brackets"),
        ("", "a.geojson, line 1, column 1: this is not JSON"),
    ],
)
def test_bad_geojson(text, message):
    assert error_of(text, "a.geojson").startswith(message)


def test_the_limits_of_geojson():
    text = collection(feature([[1, 2]] * 3, "MultiPoint"))
    assert "holds 3 points, more than the limit of 2" in error_of(text, "a.geojson", LimitError, max_sites=2)
    text = collection(*(feature([1, 2], properties={f"k{i}": i}) for i in range(10001)))
    assert "has 10001 different properties on 10001 points" in error_of(text, "a.geojson", LimitError)
    assert len(read(text, "a.geojson", properties=False)) == 10001


# ---- WKT -------------------------------------------------------------------------------------------
def test_wkt():
    text = (
        "POINT (1 2)\n# comment\n\nSRID=4326;MULTIPOINT ((3 4), (5 6.5))\n"
        "GEOMETRYCOLLECTION (POINT (7 8), POINT EMPTY)\n"
    )
    points = read(text, "a.wkt")
    assert points.xy.tolist() == [[1, 2], [3, 4], [5, 6.5], [7, 8]]
    assert points.y_up
    assert points.properties == {"part": [1, 1, 2, 1]}
    assert read("POINT (1 2)", STANDARD_INPUT).properties == {}
    assert rows("MULTIPOINT\n (\n 1 2,\n 3 4)\nPOINT(5 6)", "a.wkt") == [[1, 2], [3, 4], [5, 6]]
    assert notes_of("POINT Z (1 2 3)", "a.wkt") == ["a.wkt: only x and y are used, heights are left out"]


@pytest.mark.parametrize("text", ["", "\n", "POINT EMPTY", "MULTIPOINT EMPTY", "GEOMETRYCOLLECTION EMPTY"])
def test_wkt_without_points(text):
    assert len(read(text, "a.wkt")) == 0
    assert read(text, "a.wkt").y_up


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "POINT (1 2)\n\nPOINT (1 b)\n",
            "a.wkt, line 3: 'POINT (1 b)' is not WKT; write for example POINT (3 4)",
        ),
        ("1,2\n", "a.wkt, line 1: '1,2' is not WKT; write for example POINT (3 4)"),
        (
            "POINT (1 2)\nLINESTRING (0 0, 1 1)\n",
            "a.wkt, line 2: a LineString is not a point; replace it by its centroid or its "
            "vertices (skeleton-exact "
            "reads polygons and lines)",
        ),
        ("GEOMETRYCOLLECTION (POLYGON EMPTY)", "a.wkt, line 1: a Polygon is not a point"),
        ("GEOMETRYCOLLECTION (" * 5000, "a.wkt, line 1: brackets are nested more than 100 deep"),
        ("POINT (1 2)\nPOINT (1 inf)", "a.wkt, line 2: 'POINT (1 inf)' is not"),
        ("POINT (nan 1)", "a.wkt, line 1: 'POINT (nan 1)' is not"),
        ("POINT (1 1e999)", "a.wkt, line 1: 'POINT (1 1e999)' is not"),
    ],
)
def test_bad_wkt(text, message):
    assert error_of(text, "a.wkt").startswith(message)


def test_the_limit_of_wkt():
    assert "holds 2 points" in error_of("MULTIPOINT (1 2, 3 4)", "a.wkt", LimitError, max_sites=1)


# ---- all formats -----------------------------------------------------------------------------------
coordinates = st.floats(allow_nan=False, allow_infinity=False, min_value=-1e12, max_value=1e12)


@settings(deadline=None, max_examples=50)
@given(st.lists(st.tuples(coordinates, coordinates), min_size=1, max_size=8))
def test_all_formats_agree(points):
    pairs = [list(point) for point in points]
    array = np.array(pairs)
    node = "".join(f"{i} {x!r} {y!r}\n" for i, (x, y) in enumerate(points))
    texts = {
        "csv": "".join(f"{x!r};{y!r}\n" for x, y in points),
        "node": f"{len(points)} 2 0 0\n{node}",
        "npy": npy(array),
        "json": json.dumps(pairs),
        "geojson": json.dumps({"type": "MultiPoint", "coordinates": pairs}),
        "wkt": "".join(f"POINT ({x!r} {y!r})\n" for x, y in points),
    }
    assert set(texts) == set(POINT_FORMATS)
    for fmt, text in texts.items():
        np.testing.assert_array_equal(read(text, STANDARD_INPUT, input_format=fmt).xy, array)
    whole = shapely.multipoints(array).wkt
    assert len(read(whole, STANDARD_INPUT)) == len(points)


def reason_against(data, fmt):
    try:
        read(data, "any", input_format=fmt)
    except (InputError, LimitError) as error:
        return str(error)
    return "any points are good"


@settings(deadline=None, max_examples=300)
@given(st.sampled_from(POINT_FORMATS), st.binary(max_size=60))
def test_any_bytes_give_points_or_a_reason(fmt, data):
    assert reason_against(data, fmt).startswith("any")


@settings(deadline=None, max_examples=300)
@given(st.sampled_from(["csv", "node", "wkt", "json"]), st.text('0123.,;-e \n"#()[]{}POINTMUL:x\t', max_size=60))
def test_any_text_gives_points_or_a_reason(fmt, text):
    assert reason_against(text, fmt).startswith("any")
