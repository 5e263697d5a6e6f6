"""Offset curves as JSON: written, read, and refused."""

import json
from pathlib import Path

import numpy as np
import pytest

import vorotool
from support.readers.written import written
from vorotool.errors import InputError
from vorotool.formats.io.sources import Source
from vorotool.formats.parsing.reader_options import ReadOptions
from vorotool.formats.results.skeleton_files import read_offsets

SHAPES = vorotool.read(Path(__file__).parents[3] / "data" / "two-shapes.json")
ARRAYS = ("start", "end", "center", "site", "ring_starts", "shape_starts", "distance", "polygon")


def text_of(value, **options):
    return written(value, "json", **options)


def read(data):
    return read_offsets(Source("offsets.json", data), ReadOptions())


@pytest.mark.parametrize("distances", [[-20.0, -5.0, 3.0], [40.0], [-1000.0]])
def test_what_is_written_is_read(distances):
    made = vorotool.offset(SHAPES, distances)
    again = read(text_of(made))
    for name in ARRAYS:
        assert np.array_equal(getattr(made, name), getattr(again, name), equal_nan=name == "center"), name
    assert again.polygons.ids == ["branch", "key"]
    assert text_of(again) == text_of(made)
    vorotool.verify_offsets(again)


def test_the_library_reads_them_as_what_they_are(tmp_path):
    made = vorotool.offset(SHAPES, 3)
    vorotool.write(made, tmp_path / "offsets.json")
    assert vorotool.read(tmp_path / "offsets.json").length.tolist() == made.length.tolist()
    with pytest.raises(InputError, match=r"offsets.json"):
        vorotool.read(tmp_path / "offsets.json", geometry="polygons")
    with pytest.raises(InputError, match=r"offsets.json"):
        vorotool.read(tmp_path / "offsets.json", geometry="points")


def changed(member, index, **fields):
    document = json.loads(text_of(vorotool.offset(SHAPES, [-20.0, 3.0])))
    document[member][index].update(fields)
    return json.dumps(document).encode()


BROKEN = {
    "json": (b'{"type":"vorotool.offsets",', "not valid JSON"),
    "type": (b'{"type":"vorotool.skeleton","version":1}', "holds no offset curves; its type should be"),
    "version": (b'{"type":"vorotool.offsets","version":9}', "version 9 of vorotool.offsets"),
    "polygons": (b'{"type":"vorotool.offsets","version":1}', "polygons are None; write a list"),
    "distance": (changed("shapes", 1, distance=0), "shapes 1: the distance is 0"),
    "polygon": (changed("shapes", 0, polygon=2), "shapes 0: polygon is 2; write an integer from 0 to 1"),
    "first": (changed("rings", 1, first=0), "rings 1: the pieces"),
    "none": (changed("rings", 0, pieces=0), "rings 0: the pieces"),
    "fewer": (changed("shapes", -1, rings=1), r"shapes \d: the rings .* list all"),
    "start": (changed("pieces", 3, start=[1, None]), r"pieces 3: start is .*; write \[number, number\]"),
    "center": (changed("pieces", 0, kind="arc", center=None), r"pieces 0: the center of an arc is \[x, y\]"),
    "site": (changed("pieces", 2, site=-1), "pieces 2: site is -1"),
}


@pytest.mark.parametrize("name", BROKEN)
def test_what_is_broken_is_refused(name):
    data, words = BROKEN[name]
    with pytest.raises(InputError, match=words) as refused:
        read(data)
    assert str(refused.value).startswith("offsets.json")
