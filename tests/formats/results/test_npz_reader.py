"""Skeletons and cells as NPZ: what their JSON gives is read back, and damage is named."""

import io
import json

import numpy as np
import pytest
import shapely

import vorotool
from support.readers.written import ARCS, assert_same, written
from vorotool.errors import InputError, VorotoolError
from vorotool.formats.text.tables import write_arrays

SHAPES = {
    "polygon": [[0, 0], [40, 0], [40, 12], [14, 12], [14, 30], [0, 30]],
    "holes and lines": {
        "polygons": [
            {
                "shell": [[0, 0], [30, 0], [30, 20], [0, 20]],
                "holes": [[[3, 3], [8, 3], [5, 8]], [[20, 9], [25, 9], [22, 12]]],
            },
            {"line": [[40, 0], [50, 9], [60, 0]]},
            {"shell": [[70, 0], [80, 0], [75, 9]]},
        ]
    },
}


CLIP = [shapely.Point(20, 20).buffer(18) - shapely.Point(22, 20).buffer(7), shapely.box(42, 42, 60, 60)]
"""In several pieces, with a hole: cells have parts and holes, too, and some are empty."""


@pytest.fixture
def shapes(tmp_path):
    def read(name):
        (tmp_path / "in.json").write_text(json.dumps(SHAPES[name]))
        return vorotool.read(tmp_path / "in.json", geometry="polygons")

    return read


@pytest.mark.parametrize("name", SHAPES)
@pytest.mark.parametrize("side", ["interior", "exterior", "both"])
@pytest.mark.parametrize("gap", [0, 0.25])
def test_skeletons_are_those_of_the_library(shapes, tmp_path, name, side, gap):
    skeleton = vorotool.skeleton_exact(shapes(name), side=side, gap=gap)
    for fmt in ("npz", "json"):
        vorotool.write(skeleton, tmp_path / f"a.{fmt}")
    read, plain = (vorotool.read(tmp_path / f"a.{fmt}") for fmt in ("npz", "json"))
    assert_same(ARCS, read, skeleton)
    assert_same(("xy", "ring_starts", "ring_kind", "ring_polygon"), read.polygons, skeleton.polygons)
    assert_same(
        ("kind", "polygon", "ring", "index", "source_ring", "source_index"), read.site_table, skeleton.site_table
    )
    assert (read.frame, read.gap) == (plain.frame, plain.gap) == (skeleton.frame, skeleton.gap)
    assert len(vorotool.read(tmp_path / "a.npz", geometry="polygons")) == len(skeleton.polygons)


def test_cells_are_those_of_their_json(tmp_path):
    points = vorotool.PointSet(
        np.random.default_rng(3).random((30, 2)) * 50, None, {"id": [f"n{k}" for k in range(30)]}
    )
    cells = vorotool.voronoi_cells(points, clip=CLIP)
    read = []
    for fmt in ("npz", "json"):
        vorotool.write(cells, tmp_path / f"a.{fmt}")
        read.append(vorotool.read(tmp_path / f"a.{fmt}", geometry="polygons"))
    assert_same(("xy", "ring_starts", "ring_kind", "ring_polygon", "feature"), *read)
    assert read[0].ids == read[1].ids
    assert read[0].properties == read[1].properties
    assert type(vorotool.read(tmp_path / "a.npz")).__name__ == "PolygonSet"


def arrays_of(value, what=None):
    with np.load(io.BytesIO(written(value, "npz", what))) as arrays:
        return dict(arrays)


def damaged(tmp_path, arrays):
    with (tmp_path / "a.npz").open("wb") as out:
        write_arrays(out, arrays)
    return tmp_path / "a.npz"


def about(**members):
    """Return the array with what is no list, with other members."""
    document = json.loads(arrays_of(vorotool.skeleton_exact(SHAPES["polygon"]))["about"].tobytes())
    return np.frombuffer(json.dumps(document | members).encode(), dtype=np.uint8)


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"arc_target": None}, "arc_target"),
        ({"about": None}, "has no array about"),
        ({"vertex_x": np.zeros(3)}, "arrays that belong together are of different lengths"),
        ({"vertex_r": "nan"}, "vertex_r"),
        ({"ring_x": "nan"}, "ring_x"),
        ({"ring_starts": np.array([0, 9])}, "ring_starts"),
        ({"ring_starts": np.array([0.0, 6.0])}, "ring_starts"),
        ({"ring_starts": np.array([0, 0, 6])}, "ring_starts"),
        ({"ring_starts": np.array([], int)}, "ring_starts"),
        ({"ring_kind": np.zeros(2, int), "ring_polygon": np.zeros(2, int)}, "ring_kind"),
        ({"ring_polygon": np.array([1])}, "ring_polygon"),
        ({"ring_polygon": np.array([-1])}, "ring_polygon"),
        ({"arc_control_x": "text", "arc_control_y": "text"}, "arc_control_x is of type"),
        ({"arc_source": "large"}, "arc_source 0 is 99; write integers from 0"),
        ({"arc_kind": "large"}, "arc_kind 0 is 99; write integers from 0 to 1"),
        ({"arc_side": "large"}, "arc_side 0 is 99"),
        ({"arc_site_a": "large"}, "arc_site_a 0 is 99"),
        ({"site_kind": "large"}, "site_kind 0 is 99"),
        ({"site_index": "large"}, "site_index 0 is 99"),
        ({"about": about(frame=[0, 0, 1])}, "the frame is"),
        ({"about": about(gap=-1)}, "-1"),
        ({"about": about(version=2)}, "version 2"),
        ({"about": np.zeros(3)}, "about is of type float64"),
        ({"arc_source": np.array([f"{k}" for k in range(9)])}, "arc_source is of type"),
    ],
)
def test_damage_is_named(tmp_path, changed, words):
    arrays = arrays_of(vorotool.skeleton_exact(SHAPES["polygon"]))
    for name, value in changed.items():
        if value is None:
            del arrays[name]
        elif isinstance(value, str) and value == "text":
            arrays[name] = arrays[name].astype(str)
        elif isinstance(value, str):
            arrays[name] = arrays[name].copy()
            arrays[name].flat[0] = {"nan": np.nan, "large": 99}[value]
        else:
            arrays[name] = value
    with pytest.raises(InputError) as refused:
        vorotool.read(damaged(tmp_path, arrays))
    assert words in str(refused.value)
    assert "a.npz" in str(refused.value)


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
def test_damage_of_cells_is_named(tmp_path, changed, words):
    arrays = arrays_of(vorotool.voronoi_cells([[0, 0], [4, 1], [2, 5], [6, 6], [1, 3]]))
    with pytest.raises(InputError, match=words):
        vorotool.read(damaged(tmp_path, arrays | changed))


def test_cut_files_are_refused(tmp_path):
    whole = written(vorotool.skeleton_exact(SHAPES["polygon"]), "npz")
    for size in range(4, len(whole), 97):
        (tmp_path / "a.npz").write_bytes(whole[:size])
        for geometry in (None, "points", "polygons"):
            with pytest.raises(VorotoolError, match=r"a\.npz"):
                vorotool.read(tmp_path / "a.npz", geometry=geometry)


OFFSETS = ("start", "end", "center", "site", "ring_starts", "shape_starts", "distance", "polygon")


@pytest.mark.parametrize("features", ["separate", "together"])
def test_offset_curves_are_read(shapes, tmp_path, features):
    made = vorotool.offset(shapes("holes and lines"), [-1, 2, 300], features=features)
    vorotool.write(made, tmp_path / "a.npz")
    read = vorotool.read(tmp_path / "a.npz")
    assert_same(OFFSETS, read, made)
    assert read.features == features
    vorotool.verify_offsets(read)
    polygons = vorotool.read(tmp_path / "a.npz", geometry="polygons")
    assert np.array_equal(polygons.xy, made.polygons.xy)


@pytest.mark.parametrize("what", ["skeleton", "offset"])
def test_what_is_known_of_polygons_is_read(tmp_path, what):
    described = {"ids": ["a", None], "properties": {"name": ["x", "y"], "of": [[1], {"k": 2}]}, "unit": "mm"}
    given = vorotool.PolygonSet(
        [[0, 0], [4, 0], [0, 3], [10, 0], [14, 0], [10, 3]], [0, 3, 6], [0, 0], [0, 1], y_axis="up", **described
    )
    made = vorotool.skeleton_exact(given, side="both") if what == "skeleton" else vorotool.offset(given, 1)
    vorotool.write(made, tmp_path / "a.npz")
    read = vorotool.read(tmp_path / "a.npz").polygons
    assert (read.ids, read.properties, read.unit, read.y_axis) == (*described.values(), "up")
