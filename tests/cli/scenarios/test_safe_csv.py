"""``--safe-csv``: texts that spreadsheets would take for formulas."""

import csv
import io

import pytest
import shapely

from support.families.geojson import collection

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


@pytest.fixture
def features(folder):
    """Points, squares and their properties."""
    rows = [{"=name": text, "n": -x} for x, text in enumerate(TEXTS)]
    for name, give in (
        ("points", lambda x: shapely.Point(x, x * x)),
        ("squares", lambda x: shapely.box(x, 0, x + 1, 1)),
    ):
        (folder / f"{name}.geojson").write_text(collection([give(3 * x) for x in range(len(TEXTS))], rows))
    return folder


@pytest.mark.parametrize(
    "command",
    ["delaunay points.geojson --what cells -f csv", "skeleton-exact squares.geojson --what table"],
)
def test_texts_get_an_apostrophe_and_numbers_stay(run, features, command):
    run(command, "-q", "-o", "a.csv")
    run(command, "-q", "-o", "b.csv", "--safe-csv")
    (header, *before), (safe_header, *after) = (
        csv.reader(io.StringIO((features / name).read_bytes().decode(), newline="")) for name in ("a.csv", "b.csv")
    )
    name = header.index("=name")
    assert safe_header[name] == "'=name"
    assert [row[name] for row in before] == TEXTS
    assert [row[name] for row in after] == SAFE
    for column, title in enumerate(header):
        if title not in ("=name", "id"):
            assert [row[column] for row in after] == [row[column] for row in before]
