"""``--safe-csv``: texts that spreadsheets would take for formulas."""

import csv
import io
import json

import pytest

PAIRS = {
    "=1+1": "'=1+1",
    "+cmd": "'+cmd",
    "-cmd": "'-cmd",
    "@SUM(A1)": "'@SUM(A1)",
    "\tx": "'\tx",
    "\rx": "'\rx",
    "-": "'-",
    '=1,"2"': '\'=1,"2"',
    **{text: text for text in ("plain", "-2.5", "+3", "-.5e3", "a=b", "'=quoted", "")},
}
TEXTS, SAFE = list(PAIRS), list(PAIRS.values())


def rows(text):
    return list(csv.reader(io.StringIO(text, newline="")))


@pytest.fixture
def features(folder):
    """Points, squares and their properties."""

    def square(x):
        return {"type": "Polygon", "coordinates": [[[x, 0], [x + 1, 0], [x + 1, 1], [x, 1], [x, 0]]]}

    for name, geometry in (("points", lambda x: {"type": "Point", "coordinates": [x, x * x]}), ("squares", square)):
        collection = [
            {"type": "Feature", "id": text, "geometry": geometry(3 * x), "properties": {"=name": text, "n": -x}}
            for x, text in enumerate(TEXTS)
        ]
        (folder / f"{name}.geojson").write_text(json.dumps({"type": "FeatureCollection", "features": collection}))
    return folder


@pytest.mark.parametrize(
    "command",
    ["delaunay points.geojson --what cells -f csv", "skeleton-exact squares.geojson --what table"],
)
def test_texts_get_an_apostrophe_and_numbers_stay(run, features, command):
    run(command, "-q", "-o", "a.csv")
    run(command, "-q", "-o", "b.csv", "--safe-csv")
    (header, *before), (safe_header, *after) = (
        rows((features / name).read_bytes().decode()) for name in ("a.csv", "b.csv")
    )
    name = header.index("=name")
    assert safe_header[name] == "'=name"
    assert [row[name] for row in before] == TEXTS
    assert [row[name] for row in after] == SAFE
    for column, title in enumerate(header):
        if title not in ("=name", "id"):
            assert [row[column] for row in after] == [row[column] for row in before]
