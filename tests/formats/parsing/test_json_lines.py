"""JSON lines: features and rows of tables, by line and by record separator; what one document of them would hold."""

import json

import numpy as np
import pytest

import vorotool
from support.few import few
from support.refusals import refused
from vorotool.errors import InputError, UsageError


def feature(kind, coordinates, **properties):
    return {"type": "Feature", "properties": properties, "geometry": {"type": kind, "coordinates": coordinates}}


POINTS = [{**feature("Point", [k, 2.5], name=f"n{k}"), "id": k} for k in range(4)]
SHAPES = [feature("Polygon", [[[x, 9], [x + 4, 9], [x, 12], [x, 9]]], k=1) for x in (0, 9)]
SHAPES += [feature("LineString", [[1, 1], [2, 5]], k=2)]
ROWS = [{"label": 3, "x": 1, "y": 0.5, "note": "ä\u2028\x1e"}, {"label": 4, "x": -1e300, "y": 7, "note": None}]


def lines_of(items, **options):
    return "".join(json.dumps(item, **options) + "\n" for item in items)


def sequence_of(items, **options):
    return "".join(f"\x1e{json.dumps(item, **options)}\n" for item in items)


FORMS = {
    "lines": lines_of,
    "Windows": lambda items: lines_of(items).replace("\n", "\r\n"),
    "blank lines": lambda items: "\n" + lines_of(items).replace("\n", "\n\n"),
    "no last end": lambda items: lines_of(items)[:-1],
    "byte order mark": lambda items: "\ufeff" + lines_of(items),
    "sequence": sequence_of,
    "sequence over lines": lambda items: sequence_of(items, indent=2),
    "with its letters": lambda items: lines_of(items, ensure_ascii=False),
}


@pytest.fixture
def written(tmp_path):
    def write(text, name="a.jsonl"):
        (tmp_path / name).write_bytes(text.encode())
        return tmp_path / name

    return write


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("name", few(["a.jsonl", "a.geojson", "a", "a.ndjson", "a.geojsonl", "a.json"], 3))
@pytest.mark.parametrize("items", [POINTS, SHAPES], ids=["points", "shapes"])
def test_features_are_those_of_a_collection(written, form, name, items):
    if form == "blank lines" and name in ("a.geojson", "a.json", "a"):
        pytest.skip("lines are told by the first two")
    whole = vorotool.read(written(json.dumps({"type": "FeatureCollection", "features": items}), "whole.geojson"))
    read = vorotool.read(written(FORMS[form](items), name))
    assert type(read) is type(whole)
    assert np.array_equal(read.xy, whole.xy)
    assert read.properties == whole.properties
    assert read.y_axis == "up"


def test_a_system_that_features_name_is_that_of_all(written):
    crs = {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::3857"}}
    items = [{**POINTS[0], "crs": crs}, POINTS[1], {**POINTS[2], "crs": crs}]
    assert vorotool.read(written(lines_of(items))).crs == crs
    other = {"type": "name", "properties": {"name": "EPSG:2056"}}
    refused(InputError, r"EPSG:2056", vorotool.read, written(lines_of([*items[:2], {**POINTS[2], "crs": other}])))


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ('{"x":1,"y":2}\n{"x":1,\n', "line 2, column 8"),
        ('{"x":1,"y":2}\n\n[1,2]\n', r"line 3: \[1"),
        ('{"x":1,"y":2} {"x":1,"y":2}\n', "line 1, column 15"),
        ('{"x":1,"y":2}\n{"x":1}\n', "row 2"),
        ('{"type":"Point","coordinates":[1,2]}\n{"x":1}\n', "line 2"),
        ('{"type":"Point","coordinates":[1,2]}\n{"type":"Point","coordinates":[1]}\n', r"feature 2"),
        ('\x1e{"x":1,\n"y":2}\n\x1e{"x":\n1,}', "line 4, column 2"),
        ("[" * 200, "nest"),
        ("", "a.jsonl is empty"),
        ("\n \n", "a.jsonl is empty"),
        ("[1,2]\n[3,4]\n", r"line 1: \[1"),
        ("null\n", "line 1"),
    ],
)
def test_what_is_wrong_is_named_with_its_line(written, text, words):
    refused(InputError, words, vorotool.read, written(text))


def test_polygons_are_not_made_of_rows(written):
    with pytest.raises(InputError, match=r"a.jsonl holds a table, whose rows have label, x, y, note, not polygons"):
        vorotool.read(written(lines_of(ROWS)), geometry="polygons")
    refused(UsageError, "columns applies to delimited text", vorotool.read, written(lines_of(POINTS)), columns="x,y")
