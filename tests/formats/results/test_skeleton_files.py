"""Skeletons as JSON: written, read, and refused."""

import json
from pathlib import Path

import numpy as np
import pytest

import vorotool
from support.readers.written import ARCS, written
from vorotool.errors import InputError
from vorotool.formats.io.sources import Source
from vorotool.formats.parsing.reader_options import ReadOptions
from vorotool.formats.results.skeleton_files import read_skeleton

SHAPES = vorotool.read(Path(__file__).parents[3] / "data" / "two-shapes.json")


def text_of(value, **options):
    return written(value, "json", **options)


def read(data):
    return read_skeleton(Source("skeleton.json", data), ReadOptions())


@pytest.mark.parametrize(
    "options", [{}, {"side": "both"}, {"gap": 3.0}, {"side": "exterior", "frame": (0, 0, 300, 150)}]
)
def test_what_is_written_is_read(options):
    made = vorotool.skeleton_exact(SHAPES, **options)
    again = read(text_of(made))
    for name in ARCS:
        assert np.array_equal(
            getattr(made, name), getattr(again, name), equal_nan=name in ("control", "error_bound")
        ), name
    for name in ("kind", "polygon", "ring", "index", "source_ring", "source_index"):
        assert np.array_equal(getattr(made.site_table, name), getattr(again.site_table, name)), name
    assert (again.frame, again.gap) == (made.frame, made.gap)
    assert again.polygons.ids == ["branch", "key"]
    assert text_of(again) == text_of(made)
    vorotool.verify_skeleton(again)


def test_the_members_are_those_of_the_format():
    document = json.loads(text_of(vorotool.skeleton_exact([[0, 0], [4, 0], [4, 2], [2, 1], [0, 2]])))
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


DOCUMENT = json.loads(text_of(vorotool.skeleton_exact(SHAPES)))


def put(path, value):
    document = json.loads(json.dumps(DOCUMENT))
    at = document
    for key in path[:-1]:
        at = at[key]
    at[path[-1]] = value
    return json.dumps(document).encode()


PARABOLA = next(k for k, arc in enumerate(DOCUMENT["arcs"]) if arc["kind"] == "parabola")
BROKEN = {
    "version": (put(["version"], 2), "version 2"),
    "type": (put(["type"], "other"), "no skeleton"),
    "no list": (put(["arcs"], 3), "arcs are 3"),
    "no object": (put(["vertices", 4], 3), "vertices 4: 3 is not an object"),
    "no number": (put(["vertices", 4, "r"], "a"), "vertices 4: r is \"a\"|vertices 4: r is 'a'"),
    "true": (put(["vertices", 4, "r"], True), "vertices 4: r"),
    "index": (put(["arcs", 1, "target"], 5000), "arcs 1: target is 5000"),
    "negative": (put(["arcs", 1, "source"], -1), "arcs 1: source is -1"),
    "kind": (put(["arcs", 1, "kind"], "circle"), "arcs 1: kind"),
    "control": (put(["arcs", PARABOLA, "control"], None), f"arcs {PARABOLA}: the control point of a parabola"),
    "sites": (put(["arcs", 1, "sites"], [0, 999]), "arcs 1: sites"),
    "half": (put(["arcs", 1, "sites"], [0, 1.5]), "arcs 1: sites"),
    "pair": (put(["arcs", 1, "sites"], [0]), "arcs 1: sites"),
    "side": (put(["arcs", 1, "side"], "left"), "arcs 1: side"),
    "ring": (put(["sites", 0, "ring"], 9), "no ring 9"),
    "vertex": (put(["sites", 0, "index"], 22), "no vertex 22"),
    "frame": (put(["frame"], [1, 2]), "the frame is"),
    "gap": (put(["gap"], -1), "the gap is"),
    "polygons": (put(["polygons", 0, "shell", 0], [1]), "polygon 1"),
    "truncated": (json.dumps(DOCUMENT).encode()[:-30], "not valid JSON"),
}


@pytest.mark.parametrize("name", BROKEN)
def test_what_is_broken_is_refused(name):
    data, words = BROKEN[name]
    with pytest.raises(InputError, match=words) as refused:
        read(data)
    assert "skeleton.json" in str(refused.value)
