"""Skeletons in every format."""

import json
from pathlib import Path

import pytest

import vorotool
from support.readers.sources import read_as
from support.readers.written import streamed, written
from vorotool.products.registry import parts_of

DATA = Path(__file__).parents[3] / "data"
SHAPES = vorotool.read(DATA / "two-shapes.json")
MADE = vorotool.skeleton_exact(SHAPES, side="both")


def text_of(fmt, skeleton=MADE, **options):
    return written(skeleton, fmt, **options)


def test_geojson_keeps_ids_and_properties():
    source = {
        "type": "FeatureCollection",
        "crs": {"type": "name", "properties": {"name": "EPSG:3857"}},
        "features": [
            {
                "type": "Feature",
                "id": 7,
                "properties": {"name": "α, β", "kind": "lake"},
                "geometry": {"type": "Polygon", "coordinates": [[[0, 0], [400, 0], [0, 300], [0, 0]]]},
            }
        ],
    }
    from vorotool.formats.io.sources import Source

    polygons = read_as(Source("a.geojson", json.dumps(source).encode()))
    document = vorotool.to_geojson(vorotool.skeleton_exact(polygons), with_columns=["name", "kind"])
    assert document["crs"] == source["crs"]
    for feature in document["features"]:
        assert feature["id"] == 7
        assert feature["properties"]["name"] == "α, β"
        assert (feature["properties"]["kind"], feature["properties"]["voro_kind"]) == ("lake", "end")


@pytest.mark.parametrize("what", parts_of(MADE))
def test_nothing_is_written_too(what):
    nothing = vorotool.skeleton_exact([[0, 0], [1, 0], [0, 1]], side="exterior")
    for fmt in streamed(parts_of(MADE)[what]):
        text = text_of(fmt, nothing, what=what)
        if fmt in ("json", "geojson"):
            json.loads(text)
