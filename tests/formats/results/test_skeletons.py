"""Skeletons in every format."""

import json
from dataclasses import replace

import pytest

import vorotool
from support.documents import DATA
from support.readers.written import streamed, written
from vorotool.convert.polygons import as_polygons
from vorotool.products.registry import parts_of

SHAPES = vorotool.read(DATA / "two-shapes.json")
MADE = vorotool.skeleton_exact(SHAPES, side="both")


def test_geojson_keeps_ids_and_properties():
    crs = {"type": "name", "properties": {"name": "EPSG:3857"}}
    columns = {"name": ["α, β"], "kind": ["lake"]}
    polygons = replace(as_polygons([[0, 0], [400, 0], [0, 300]]), ids=[7], properties=columns, crs=crs)
    document = vorotool.to_geojson(vorotool.skeleton_exact(polygons), with_columns=["name", "kind"])
    assert document["crs"] == crs
    for feature in document["features"]:
        assert feature["id"] == 7
        assert feature["properties"]["name"] == "α, β"
        assert (feature["properties"]["kind"], feature["properties"]["voro_kind"]) == ("lake", "end")


@pytest.mark.parametrize("what", parts_of(MADE))
def test_nothing_is_written_too(what):
    nothing = vorotool.skeleton_exact([[0, 0], [1, 0], [0, 1]], side="exterior")
    for fmt in streamed(parts_of(MADE)[what]):
        text = written(nothing, fmt, what)
        if fmt in ("json", "geojson"):
            json.loads(text)
