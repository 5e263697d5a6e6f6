"""Skeletons, offset curves and cells as JSON and NPZ: what is written is read back, and damage is named."""

import json

import numpy as np
import pytest
import shapely

import vorotool
from support.documents import DATA
from support.readers.written import ARCS, arrays_of, assert_same, bytes_of, written
from support.refusals import refused
from vorotool.errors import InputError, VorotoolError
from vorotool.formats.text.tables import write_arrays

TWO = vorotool.read(DATA / "two-shapes.json")
ELL = [[0, 0], [40, 0], [40, 12], [14, 12], [14, 30], [0, 30]]
HOLES_AND_LINES = [
    {"shell": [[0, 0], [30, 0], [30, 20], [0, 20]], "holes": [[[3, 3], [8, 3], [5, 8]], [[20, 9], [25, 9], [22, 12]]]},
    {"line": [[40, 0], [50, 9], [60, 0]]},
    {"shell": [[70, 0], [80, 0], [75, 9]]},
]
CLIP = [shapely.Point(20, 20).buffer(18) - shapely.Point(22, 20).buffer(7), shapely.box(42, 42, 60, 60)]
"""In several pieces, with a hole: cells have parts and holes, too, and some are empty."""
RINGS = ("xy", "ring_starts", "ring_kind", "ring_polygon")
SITES = ("kind", "polygon", "ring", "index", "source_ring", "source_index")
OFFSETS = ("start", "end", "center", "site", "ring_starts", "shape_starts", "distance", "polygon")
FORMATS = pytest.mark.parametrize("fmt", ["json", "npz"])


@pytest.fixture
def saved(tmp_path):
    def save(value, fmt):
        (tmp_path / f"a.{fmt}").write_bytes(value if isinstance(value, bytes) else written(value, fmt))
        return tmp_path / f"a.{fmt}"

    return save


@FORMATS
@pytest.mark.parametrize("side", ["interior", "exterior", "both"])
@pytest.mark.parametrize("gap", [0, 0.25])
def test_skeletons(saved, side, gap, fmt):
    for shapes in (ELL, HOLES_AND_LINES, TWO):
        made = vorotool.skeleton_exact(shapes, side=side, gap=gap)
        read = vorotool.read(saved(made, fmt))
        assert_same(ARCS, read, made)
        assert_same(RINGS, read.polygons, made.polygons)
        assert_same(SITES, read.site_table, made.site_table)
        assert (read.frame, read.gap, read.polygons.ids) == (made.frame, made.gap, made.polygons.ids)
        assert written(read, fmt) == written(made, fmt)
        vorotool.verify_skeleton(read)
        assert len(vorotool.read(saved(made, fmt), geometry="polygons")) == len(made.polygons)


@FORMATS
@pytest.mark.parametrize("features", ["separate", "together"])
def test_offset_curves(saved, features, fmt):
    for shapes, distances in ((HOLES_AND_LINES, [-1, 2, 300]), (TWO, [-20.0, 3.0]), (TWO, [-1000.0])):
        made = vorotool.offset(shapes, distances, features=features)
        read = vorotool.read(saved(made, fmt))
        assert_same(OFFSETS, read, made)
        assert (read.features, read.polygons.ids) == (features, made.polygons.ids)
        assert written(read, fmt) == written(made, fmt)
        vorotool.verify_offsets(read)


def test_cells_are_those_of_their_json(saved):
    places = np.random.default_rng(3).random((30, 2)) * 50
    cells = vorotool.voronoi_cells(vorotool.PointSet(places, None, {"id": [f"n{k}" for k in range(30)]}), clip=CLIP)
    one, other = (vorotool.read(saved(cells, fmt), geometry="polygons") for fmt in ("npz", "json"))
    assert_same((*RINGS, "feature"), one, other)
    assert (one.ids, one.properties) == (other.ids, other.properties)
    assert isinstance(vorotool.read(saved(cells, "npz")), vorotool.PolygonSet)


@FORMATS
@pytest.mark.parametrize("what", ["skeleton", "offset"])
def test_what_is_known_of_polygons(saved, what, fmt):
    described = {"ids": ["a", None], "properties": {"name": ["x", "y"], "of": [[1], {"k": 2}]}, "unit": "mm"}
    given = vorotool.PolygonSet(
        [[0, 0], [4, 0], [0, 3], [10, 0], [14, 0], [10, 3]], [0, 3, 6], [0, 0], [0, 1], y_axis="up", **described
    )
    made = vorotool.skeleton_exact(given, side="both") if what == "skeleton" else vorotool.offset(given, 1)
    read = vorotool.read(saved(made, fmt)).polygons
    assert (read.ids, read.properties, read.unit, read.y_axis) == (*described.values(), "up")


def test_the_members_are_those_of_the_format():
    document = json.loads(written(vorotool.skeleton_exact([[0, 0], [4, 0], [4, 2], [2, 1], [0, 2]]), "json"))
    assert (document["type"], document["version"]) == ("vorotool.skeleton", 1)
    assert document["polygons"] == [{"shell": [[0, 0], [4, 0], [4, 2], [2, 1], [0, 2]], "holes": []}]
    assert document["sites"][2] == {"kind": "vertex", "polygon": 0, "ring": 0, "index": 2, "source": [0, 2]}
    assert document["sites"][5]["kind"] == "edge"
    assert set(document["vertices"][0]) == {"x", "y", "r"}
    kinds = {arc["kind"]: arc["control"] for arc in document["arcs"]}
    assert kinds["line"] is None
    assert len(kinds["parabola"]) == 2
    needed = {"source", "target", "kind", "control", "sites", "side", "error_bound"}
    assert all(needed <= set(arc) and arc["side"] == "interior" and arc["error_bound"] == 0 for arc in document["arcs"])


# ---- damage ------------------------------------------------------------------------------------------
WHOLE = {"skeleton": vorotool.skeleton_exact(TWO), "offsets": vorotool.offset(TWO, [-20.0, 3.0])}
BENT = int(np.flatnonzero(WHOLE["skeleton"].is_parabola)[0])


def broken():
    """A value, a change of its JSON, and words of the message."""
    for words, change in {
        "version 2": lambda d: d.update(version=2),
        "arcs are 3": lambda d: d.update(arcs=3),
        "vertices 4: 3 is not an object": lambda d: d["vertices"].__setitem__(4, 3),
        "vertices 4: r": lambda d: d["vertices"][4].update(r=True),
        "arcs 1: target is 5000": lambda d: d["arcs"][1].update(target=5000),
        "arcs 1: source is -1": lambda d: d["arcs"][1].update(source=-1),
        "arcs 1: kind": lambda d: d["arcs"][1].update(kind="circle"),
        f"arcs {BENT}: the control point of a parabola": lambda d: d["arcs"][BENT].update(control=None),
        "arcs 1: sites": lambda d: d["arcs"][1].update(sites=[0, 1.5]),
        "arcs 1: side": lambda d: d["arcs"][1].update(side="left"),
        "no ring 9": lambda d: d["sites"][0].update(ring=9),
        "no vertex 22": lambda d: d["sites"][0].update(index=22),
        "the frame is": lambda d: d.update(frame=[1, 2]),
        "the gap is": lambda d: d.update(gap=-1),
        "polygon 1": lambda d: d["polygons"][0]["shell"].__setitem__(0, [1]),
    }.items():
        yield "skeleton", change, words
    for words, change in {
        "version 9 of vorotool.offsets": lambda d: d.update(version=9),
        "polygons are None; write a list": lambda d: d.update(polygons=None),
        "shapes 1: the distance is 0": lambda d: d["shapes"][1].update(distance=0),
        "shapes 0: polygon is 2; write an integer from 0 to 1": lambda d: d["shapes"][0].update(polygon=2),
        "rings 1: the pieces": lambda d: d["rings"][1].update(first=0),
        r"shapes \d: the rings .* list all": lambda d: d["shapes"][-1].update(rings=1),
        r"pieces 3: start is .*; write \[number, number\]": lambda d: d["pieces"][3].update(start=[1, None]),
        r"pieces 0: the center of an arc is \[x, y\]": lambda d: d["pieces"][0].update(kind="arc", center=None),
        "pieces 2: site is -1": lambda d: d["pieces"][2].update(site=-1),
    }.items():
        yield "offsets", change, words


@pytest.mark.parametrize(("name", "change", "words"), list(broken()))
def test_json_that_is_broken(saved, name, change, words):
    document = json.loads(written(WHOLE[name], "json"))
    change(document)
    refused(InputError, [words, "a.json"], vorotool.read, saved(json.dumps(document).encode(), "json"))


def test_other_json(saved):
    for value in WHOLE.values():
        refused(InputError, "a.json.*not valid JSON", vorotool.read, saved(written(value, "json")[:-30], "json"))
    for geometry in ("polygons", "points"):
        refused(InputError, r"a\.json", vorotool.read, saved(WHOLE["offsets"], "json"), geometry=geometry)


def about(**members):
    """Return the array with what is no list, with other members."""
    document = json.loads(arrays_of(vorotool.skeleton_exact(ELL))["about"].tobytes())
    return np.frombuffer(json.dumps(document | members).encode(), dtype=np.uint8)


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"arc_target": None}, "arc_target"),
        ({"about": None}, "has no array about"),
        ({"vertex_x": np.zeros(3)}, "arrays that belong together are of different lengths"),
        ({"vertex_r": np.nan}, "vertex_r"),
        ({"ring_x": np.nan}, "ring_x"),
        ({"ring_starts": np.array([0, 9])}, "ring_starts"),
        ({"ring_starts": np.array([0.0, 6.0])}, "ring_starts"),
        ({"ring_starts": np.array([0, 0, 6])}, "ring_starts"),
        ({"ring_polygon": np.array([1])}, "ring_polygon"),
        ({"ring_polygon": np.array([-1])}, "ring_polygon"),
        ({"arc_control_x": str, "arc_control_y": str}, "arc_control_x is of type"),
        ({"arc_source": 99}, "arc_source 0 is 99; write integers from 0"),
        ({"arc_kind": 99}, "arc_kind 0 is 99; write integers from 0 to 1"),
        ({"arc_side": 99}, "arc_side 0 is 99"),
        ({"arc_site_a": 99}, "arc_site_a 0 is 99"),
        ({"site_kind": 99}, "site_kind 0 is 99"),
        ({"site_index": 99}, "site_index 0 is 99"),
        ({"about": about(frame=[0, 0, 1])}, "the frame is"),
        ({"about": about(gap=-1)}, "-1"),
        ({"about": about(version=2)}, "version 2"),
        ({"about": np.zeros(3)}, "about is of type float64"),
        ({"arc_source": str}, "arc_source is of type"),
    ],
)
def test_npz_that_is_broken(saved, changed, words):
    arrays = {name: values.copy() for name, values in arrays_of(vorotool.skeleton_exact(ELL)).items()}
    for name, value in changed.items():
        if isinstance(value, float | int):
            arrays[name].flat[0] = value
        else:
            arrays[name] = arrays[name].astype(str) if value is str else value
    data = bytes_of(write_arrays, {name: values for name, values in arrays.items() if values is not None})
    refused(InputError, [words, "a.npz"], vorotool.read, saved(data, "npz"))


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"vertex_x": np.array([np.nan])}, "arrays that belong together are of different lengths"),
        ({"ring_starts": np.array([0, 1])}, "ring_starts"),
        ({"polygon_starts": np.array([0, 1])}, "polygon_starts"),
        ({"cell_starts": np.array([0, 1])}, "cell_starts"),
        ({"x": np.zeros(1)}, "its columns have other lengths than the 5 cells"),
    ],
)
def test_npz_of_cells_that_is_broken(saved, changed, words):
    arrays = arrays_of(vorotool.voronoi_cells([[0, 0], [4, 1], [2, 5], [6, 6], [1, 3]]))
    refused(InputError, words, vorotool.read, saved(bytes_of(write_arrays, arrays | changed), "npz"))


def test_cut_files_are_refused(saved):
    whole = written(vorotool.skeleton_exact(ELL), "npz")
    for size in range(4, len(whole), 97):
        for geometry in (None, "points", "polygons"):
            refused(VorotoolError, r"a\.npz", vorotool.read, saved(whole[:size], "npz"), geometry=geometry)
