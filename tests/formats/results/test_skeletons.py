"""Skeletons in every format."""

import io
import json
from pathlib import Path

import numpy as np
import pytest
import shapely

import vorotool
from support.readers.sources import read_as
from support.readers.written import rows_of, streamed, written
from vorotool.errors import UsageError
from vorotool.products.registry import parts_of

DATA = Path(__file__).parents[3] / "data"
SHAPES = vorotool.read(DATA / "two-shapes.json")
MADE = vorotool.skeleton_exact(SHAPES, side="both")


def text_of(fmt, skeleton=MADE, **options):
    return written(skeleton, fmt, **options)


def test_arcs_as_csv():
    rows = rows_of(text_of("csv"))
    header = (
        "label,id,arc,source_index,target_index,x0,y0,r0,x1,y1,r1,kind,cx,cy,site_a_index,site_b_index,side,length,"
        "error_bound,branch"
    )
    assert ",".join(rows[0]) == header
    assert len(rows) == len(MADE)
    inside, outside = rows[0], rows[-1]
    assert (inside["id"], inside["side"], inside["label"]) == ("branch", "interior", "1")
    assert (outside["id"], outside["side"], outside["label"]) == ("", "exterior", "")
    assert {(row["kind"], bool(row["cx"])) for row in rows} == {("line", False), ("parabola", True)}
    assert [float(row["x1"]) for row in rows] == MADE.vertices[MADE.arcs[:, 1], 0].tolist()


def test_npz_holds_all():
    with np.load(io.BytesIO(text_of("npz"))) as archive:
        for axis, name in enumerate(("source", "target")):
            assert np.array_equal(archive[f"arc_{name}"], MADE.arcs[:, axis])
        for axis, name in enumerate("xy"):
            assert np.array_equal(archive[f"vertex_{name}"], MADE.as_given.vertices[:, axis])
            assert np.array_equal(archive[f"arc_control_{name}"], MADE.control[:, axis], equal_nan=True)
        assert np.array_equal(archive["vertex_r"], MADE.radius)
        assert np.array_equal(archive["ring_x"], MADE.polygons.as_given.xy[:, 0])


def length_of(lines):
    return sum(line.length for line in lines)


@pytest.mark.parametrize("tolerance", [1.0, 0.01])
def test_geojson_is_flattened(tolerance):
    document = json.loads(text_of("geojson", flatten=tolerance))
    lines = [shapely.geometry.shape(feature["geometry"]) for feature in document["features"]]
    assert len(lines) == MADE.branch[-1] + 1
    fine = [shapely.geometry.shape(f["geometry"]) for f in json.loads(text_of("geojson", flatten=1e-6))["features"]]
    apart = max(shapely.hausdorff_distance(a, b, densify=0.1) for a, b in zip(lines, fine, strict=True))
    assert apart <= tolerance
    assert length_of(fine) == pytest.approx(MADE.length.sum(), rel=1e-8)


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


def test_wkt_is_the_same_as_geojson():
    lines = shapely.from_wkt(text_of("wkt", flatten=0.1).decode().splitlines())
    document = json.loads(text_of("geojson", flatten=0.1))
    assert [shapely.geometry.shape(f["geometry"]) for f in document["features"]] == list(lines)


@pytest.mark.parametrize("what", parts_of(MADE))
def test_nothing_is_written_too(what):
    nothing = vorotool.skeleton_exact([[0, 0], [1, 0], [0, 1]], side="exterior")
    for fmt in streamed(parts_of(MADE)[what]):
        text = text_of(fmt, nothing, what=what)
        if fmt in ("json", "geojson"):
            json.loads(text)


@pytest.mark.parametrize(
    ("fmt", "what", "words"),
    [
        ("obj", "skeleton", "json, csv, tsv, geojson"),
        ("wkt", "table", "csv, tsv, json, npz"),
        ("csv", "arcs", "skeleton"),
    ],
)
def test_what_cannot_be_written(fmt, what, words):
    with pytest.raises(UsageError, match=words):
        text_of(fmt, what=what)


def test_precision():
    assert all(len(row["length"].replace(".", "")) <= 4 for row in rows_of(text_of("csv", precision=3)))


def test_threads_change_nothing():

    for fmt in streamed(parts_of(MADE)["skeleton"]):
        assert text_of(fmt, threads=1) == text_of(fmt, threads=3)
