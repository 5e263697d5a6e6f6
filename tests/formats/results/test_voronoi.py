"""Voronoi maps as files: every format, what is read back, and files that are no maps."""

import json
import warnings
from dataclasses import replace

import geopandas
import numpy as np
import pytest
import shapely

import vorotool
from support.documents import DATA
from support.readers.written import arrays_of, bytes_of, rows_of, written
from support.refusals import refused
from vorotool.errors import InputError
from vorotool.formats.text.tables import write_arrays

SHAPES = geopandas.GeoDataFrame(
    {"name": ["Zürich", None, "c", "d", "e"], "count": [1, 2, 3, 4, 2**60]},
    geometry=[
        shapely.Point(0, 0),
        None,
        shapely.MultiLineString([[(1, 1), (2, 2)], [(3, 0), (4, 1)]]),
        shapely.box(6, 0, 9, 3) - shapely.box(7, 1, 8, 2),
        shapely.box(6.5, 0.5, 8.5, 2.5),  # nothing is left to it but the hole
    ],
    crs="EPSG:2056",
)
LABELS = np.kron(np.array([[0, 7, 0, 9], [0, 0, 3, 3]]), np.ones((3, 4), dtype=np.int64))


def maps():
    with warnings.catch_warnings(action="ignore"):
        yield "mixed", vorotool.voronoi(SHAPES)
        yield "joined", vorotool.voronoi(SHAPES, by=["a", "b", "a", "b", "c"])
        yield "nothing", vorotool.voronoi([])
        yield "one", vorotool.voronoi(["POINT (2 3)"])
        yield "twice the same", vorotool.voronoi([[0, 0], [0, 0], [4, 4]])
        yield "labels", vorotool.voronoi(LABELS)
        yield "lakes", vorotool.voronoi(vorotool.read(DATA / "great-lakes.geojson"))
        yield "limited", vorotool.voronoi(SHAPES, max_distance=1.25)


MAPS = dict(maps())


def unindexed(cells):
    """What a file holds of a map: all but the index of a data frame."""
    return replace(cells, index=None, polygons=replace(cells.polygons, index=None))


@pytest.fixture
def saved(tmp_path):
    def save(data, fmt="json"):
        path = tmp_path / f"cells.{fmt}"
        path.write_bytes(data if isinstance(data, bytes) else json.dumps(data).encode())
        return path

    return save


# ---- all that a map holds ----------------------------------------------------------------------------
@pytest.mark.parametrize("fmt", ["json", "npz"])
@pytest.mark.parametrize("name", MAPS)
def test_what_is_read_back_is_equal(saved, name, fmt):
    data = written(MAPS[name], fmt)
    again = vorotool.read(saved(data, fmt))
    assert again == unindexed(MAPS[name])
    assert written(again, fmt) == data == written(MAPS[name], fmt, threads=2)


@pytest.mark.parametrize("fmt", ["json", "npz"])
def test_cuts_and_units_are_read_back(saved, fmt):
    polygons = replace(vorotool.voronoi(SHAPES).polygons, unit="mm", index=None)
    clip = vorotool.outlines(np.ones((3, 3), dtype=bool))
    lines = replace(vorotool.voronoi(["LINESTRING (0 0, 9 9)", "POINT (1 2)"]).polygons, crs=polygons.crs)
    cells = replace(unindexed(MAPS["mixed"]), polygons=polygons, clip=clip, enclosures=lines, max_distance=2.5)
    assert vorotool.read(saved(written(cells, fmt), fmt)) == cells


# ---- features ----------------------------------------------------------------------------------------
@pytest.mark.parametrize("name", [name for name in MAPS if name != "nothing"])
@pytest.mark.parametrize("flatten", [None, 0.4])
def test_cells_are_the_polygons_of_the_library(name, flatten):
    cells = MAPS[name]
    right = cells.to_shapely(flatten=flatten)
    features = json.loads(written(cells, "geojson", flatten=flatten))["features"]
    got = [each["geometry"] and shapely.geometry.shape(each["geometry"]) for each in features]
    assert [shape is None for shape in got] == shapely.is_empty(right).tolist()
    assert all(shape is None or shapely.equals_exact(shape, other) for shape, other in zip(got, right, strict=True))
    texts = written(cells, "wkt", flatten=flatten).decode().splitlines()
    assert all(shapely.equals_exact(shapely.from_wkt(t), r) for t, r in zip(texts, right, strict=True))
    rows = rows_of(written(cells, "csv", flatten=flatten).decode())
    assert [row["wkt"] for row in rows] == [t if not t.endswith("EMPTY") else "" for t in texts]
    np.testing.assert_allclose([float(row["area"]) for row in rows], cells.areas)


def test_features_have_ids_columns_and_the_reference_system():
    document = json.loads(written(MAPS["mixed"], "geojson"))
    assert "EPSG::2056" in document["crs"]["properties"]["name"]
    assert [each["properties"]["name"] for each in document["features"]] == ["Zürich", None, "c", "d", "e"]
    assert document["features"][4]["properties"]["count"] == 2**60
    assert [each["id"] for each in json.loads(written(MAPS["labels"], "geojson"))["features"]] == [3, 7, 9]
    assert [row["id"] for row in rows_of(written(MAPS["joined"], "csv").decode())] == ["a", "b", "c"]


# ---- borders and tables ------------------------------------------------------------------------------
@pytest.mark.parametrize("name", MAPS)
def test_borders_are_one_line_a_piece(name):
    cells = MAPS[name]
    rows = rows_of(written(cells, "csv", what="edges").decode())
    features = json.loads(written(cells, "geojson", what="edges"))["features"]
    texts = written(cells, "wkt", what="edges").decode().splitlines()
    assert len(rows) == len(features) == len([text for text in texts if text]) == cells.is_border.sum()
    for row, feature in zip(rows, features, strict=True):
        own, places = feature["properties"], feature["geometry"]["coordinates"]
        assert (own["label_a"], own["label_b"], own["kind"]) == (int(row["label_a"]), int(row["label_b"]), row["kind"])
        assert own["label_a"] < own["label_b"]
        assert places[0] == [float(row["x0"]), float(row["y0"])]
        assert places[-1] == [float(row["x1"]), float(row["y1"])]
        assert (row["cx"] == "") == (row["kind"] == "line")
        assert shapely.LineString(places).length <= float(row["length"]) * (1 + 1e-12)


# ---- files that are none -----------------------------------------------------------------------------
def faulty():
    """A change of the JSON of a map, and words of the message."""
    yield lambda d: d.update(version=2), "version 2 of vorotool.voronoi"
    yield lambda d: d.update(frame=[0, 0, 1]), "the frame is"
    yield lambda d: d.update(frame=None), "the frame is None"
    yield lambda d: d.update(max_distance=-1), "max_distance is -1; write a length above 0"
    yield lambda d: d.update(clip=[]), r"clip: \[\] is not an object"
    yield lambda d: d.update(clip={"polygons": [{"shell": [[0, 0], [1, 0], [0, 1]]}]}), "clip, polygons 0: feature"
    yield lambda d: d.update(unit=5), "the unit is 5"
    yield lambda d: d.update(vertices=None), "vertices are None"
    yield lambda d: d["vertices"][0].update(x=None), "vertices 0: x is None"
    yield lambda d: d["vertices"][0].update(r="far"), "vertices 0: r is 'far'"
    yield lambda d: d["arcs"][2].update(source=10**6), "arcs 2: source is 1000000; write an integer"
    yield lambda d: d["arcs"][0].update(source=d["arcs"][0]["target"]), "arcs 0: it is from vertex"
    yield lambda d: d["arcs"][0].update(sites=[0, 99]), "arcs 0: sites is"
    yield lambda d: d["arcs"][0].update(sites=d["arcs"][0]["sites"][::-1]), "whose side is"
    yield lambda d: d["arcs"][0].update(kind="spline"), "arcs 0: kind is 'spline'"
    yield lambda d: d["arcs"][0].update(kind="circle", control=None), r"the center of a circle is \[x, y\]"
    yield lambda d: d["arcs"][0].update(cut=1), "arcs 0: cut is 1; write true or false"
    yield lambda d: d["sites"].append({}), "5 cells, but 6 sites"
    yield lambda d: d["sites"][0].update(properties=[1]), r"sites 0: properties is \[1\]"
    yield lambda d: d["polygons"][0].update(site=77), "polygons 0: site is 77"
    yield lambda d: d["polygons"][0].update(line=[]), "a polygon has no vertices"
    yield lambda d: d["polygons"][0].update(feature=4), "feature must not decrease"
    yield lambda d: d["cells"][0].update(rings=[[0]]), "cells 0: rings are"
    yield lambda d: d["cells"][0].update(rings=7), "cells 0: rings are 7"
    yield lambda d: d["cells"][0].update(shells=[]), "cells 0: shells are"
    yield lambda d: d["cells"][0].update(shells=[0, 5]), "cells 0: shells are"
    yield lambda d: d["cells"][0]["rings"][0].append(10**6), "cells 0: a ring has arc 1000000"
    yield lambda d: d["cells"][0]["rings"][0].pop(), "cells 0: a ring continues at vertex"
    yield lambda d: d["cells"][0].update(rings=2 * d["cells"][0]["rings"]), "side 2 times; expected 1"
    yield lambda d: d["cells"][0].update(rings=[], shells=[]), "side 0 times; expected 1"


@pytest.mark.parametrize(("change", "words"), list(faulty()))
def test_json_that_is_no_map(saved, change, words):
    document = json.loads(written(MAPS["mixed"], "json"))
    change(document)
    refused(InputError, [words, "cells.json"], vorotool.read, saved(document))


def faulty_arrays():
    yield lambda a: a.pop("arc_left"), "arc_left"
    yield lambda a: a.update(vertex_r=a["vertex_r"][1:]), "arrays that belong together are of different lengths"
    yield lambda a: a.update(vertex_x=np.full(len(a["vertex_x"]), np.inf)), "vertex_x 0 is inf; write finite numbers"
    yield lambda a: a.update(arc_source=a["arc_source"] + 1000), "arc_source 0 is"
    yield lambda a: a.update(arc_source=a["arc_source"] * 0.5), "write integers"
    yield lambda a: a.update(arc_control_x=np.zeros(len(a["arc_cut"]))), "arc_control_x or arc_control_y"
    yield lambda a: a.update(cell_starts=a["cell_starts"][::-1].copy()), "cell_starts must increase"
    yield lambda a: a.update(cell_ring_arcs=-a["cell_ring_arcs"]), "whose side is"
    yield lambda a: a.update(about=np.zeros(3)), "about is of type float64"
    yield lambda a: a.update(about=np.frombuffer(b"[1", dtype=np.uint8)), "about, line 1"
    yield lambda a: a.update(about=np.frombuffer(b"{}", dtype=np.uint8)), "about holds no Voronoi map"
    yield lambda a: a.update(ring_kind=a["ring_kind"] + 9), "must be a shell and then holes"
    yield lambda a: a.update(polygon_site=a["polygon_site"] + 9), "polygon_site 0 is 9"


@pytest.mark.parametrize(("change", "words"), list(faulty_arrays()))
def test_npz_that_is_no_map(saved, change, words):
    arrays = arrays_of(MAPS["mixed"])
    change(arrays)
    refused(InputError, [words, "cells.npz"], vorotool.read, saved(bytes_of(write_arrays, arrays), "npz"))
