"""Polygons and lines as plain JSON."""

import json

import pytest

from support.readers.polygon_reading import assert_same, error_of, notes_of, read, rings, written

SHELL = [[0, 0], [9, 0], [0, 9]]
HOLE = [[1, 1], [2, 1], [1, 2]]


def test_many():
    items = [
        {"id": "a", "part": 1, "shell": SHELL, "holes": [HOLE, HOLE], "properties": {"n": 1}},
        {"id": "a", "part": 2, "line": SHELL},
        {"id": 7, "shell": SHELL, "holes": None, "properties": {"m": [1]}},
        {"shell": []},
        SHELL,
    ]
    shapes = read(json.dumps({"polygons": items}))
    assert [kind for kind, _, _ in rings(shapes)] == [0, 1, 1, 2, 0, 0]
    assert shapes.part.tolist() == [1, 2, 1, 1]
    assert shapes.ids == ["a", "a", 7, None]
    assert shapes.properties == {"n": [1, None, None, None], "m": [None, None, [1], None]}
    assert notes_of(json.dumps({"polygons": items})) == ["shapes.json: 1 feature without geometry skipped"]
    assert_same(read(written(shapes, "json")), shapes)
    bare = read(json.dumps({"polygons": items}), properties=False)
    assert (bare.ids, bare.properties) == (None, {})


@pytest.mark.parametrize("text", ["[]", '{"polygons": []}', '{"polygons": [[]]}'])
def test_nothing(text):
    shapes = read(text)
    assert len(shapes) == 0
    assert written(shapes, "json") == '{"y_axis":"none","polygons":[]}\n'


def test_writing():
    shapes = read("[[0, 0.1], [1e-9, 1e300], [0.30000000000000004, 2]]")
    assert written(shapes, "json").replace("e+", "e") == (  # which versions of orjson write or not
        '{"y_axis":"none","polygons":[\n{"shell":[[0.0,0.1],[1e-9,1e300],[0.30000000000000004,2.0]],"holes":[]}\n]}\n'
    )
    assert "[0.3,2.0]" in written(read("[[0, 0.1], [1, 3], [0.32, 2]]"), "json", decimals=1)
    assert_same(read(written(shapes, "json")), shapes)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[[0, 0], [1, ]]", "line 1"),
        ("5", "shapes.json: 5 is not a polygon; write [[x, y], …], or {"),
        ("{}", "shapes.json: the object has no list of polygons; write {"),
        ("[[0, 0], [1, 0], [1]]", "polygon 1, vertex 3: [1]"),
        ("[[0, 0], [1, true]]", "polygon 1, vertex 2: [1"),
        ("[[0, 0], [1, 0, 7]]", "polygon 1, vertex 2: [1, 0, 7]"),
        ("[[[0, 0]], 5]", "polygon 2"),
        ('{"polygons": [{"shell": [[0, 0]], "line": []}]}', "polygon 1"),
        ('{"polygons": [{"holes": []}]}', "polygon 1"),
        ('{"polygons": [{"shell": [[0, 0]], "holes": [3]}]}', "polygon 1"),
        ('{"polygons": [{"shell": [[0, 0]], "holes": [[], [[1, 1], ["a", 2]]]}]}', "hole 1, vertex 2"),
        ('{"polygons": [{"shell": [[0, 0]], "properties": 3}]}', "polygon 1"),
        ('{"polygons": [{"shell": [[0, 0]], "part": 2}]}', "polygon 1"),
        ("[" * 1000, "line 1"),
    ],
)
def test_bad_json(text, message):
    error = error_of(text)
    assert error.startswith("shapes.json")
    assert message in error
