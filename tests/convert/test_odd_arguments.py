"""Every public function and every argument with odd values: an error of ours, or a result."""

import datetime
import inspect
import pathlib
import warnings
import zlib

import numpy as np
import pytest
import shapely

import vorotool
from support.few import few
from vorotool import VorotoolError

FUNCTIONS = sorted(name for name in vorotool.__all__ if inspect.isfunction(getattr(vorotool, name)))


class Odd:
    """An object that is nothing."""


def _itself():
    made = [[0, 0]]
    made.append(made)
    return made


def _closed_file():
    with pathlib.Path(__file__).open(encoding="utf-8") as file:
        return file


def _read_only():
    array = np.zeros((3, 2))
    array.flags.writeable = False
    return array


MORE = {"prune": {"length": 0}, "skeleton_approx": {"step": 1}}
"""Arguments that are right where one of several is needed."""

RING = [[0, 0], [4, 0], [0, 3]]

VALUES = {
    "none": None,
    "nan": float("nan"),
    "empty text": "",
    "empty bytes": b"",
    "empty list": [],
    "empty mapping": {},
    "object": Odd(),
    "class": Odd,
    "function": print,
    "list in itself": _itself(),
    "huge": 10**400,
    "negative": -1,
    "minus huge": -(10**400),
    "zero": 0,
    "number": 5,
    "half": 0.5,
    "infinity": float("inf"),
    "complex": 1j,
    "true": True,
    "text": "12",
    "texts": ["1", "a"],
    "text with surrogates": "\ud800",
    "point of texts": {"type": "Point", "coordinates": ["a", "b"]},
    "point of nothing": {"type": "Point", "coordinates": []},
    "point of a point": {"type": "Point", "coordinates": [[[0, 0]]]},
    "line of numbers": {"type": "LineString", "coordinates": [1, 2]},
    "ring of two points": {"type": "Polygon", "coordinates": [[[0, 0], [1, 1]]]},
    "ring of none": {"type": "Polygon", "coordinates": [None]},
    "polygon of texts": {"type": "MultiPolygon", "coordinates": ["abc"]},
    "collection of numbers": {"type": "GeometryCollection", "geometries": [1]},
    "feature of a list": {"type": "Feature", "geometry": [1], "properties": None},
    "features of none": {"type": "FeatureCollection", "features": [None]},
    "shell of text": {"shell": "abc"},
    "holes of numbers": {"shell": RING, "holes": 5},
    "line of none": {"line": None},
    "lists": [[1]] * 4,
    "list of lists": [[[[1]]]],
    "ragged": [[1, 2], [3]],
    "nones": [None, None],
    "objects": [Odd(), Odd()],
    "mappings": [{}, {}],
    "set": {1, 2},
    "generator": "generator",
    "points": RING,
    "complex array": np.zeros((3, 2), dtype=complex),
    "dates": np.array([["2020-01-01", "2020-01-02"]], dtype="datetime64[D]"),
    "date": datetime.datetime(2020, 1, 1),
    "structured": np.zeros(3, dtype=[("a", float), ("b", "U3")]),
    "0 axes": np.array(3.5),
    "4 axes": np.zeros((2, 2, 2, 2)),
    "no rows": np.zeros((0, 2)),
    "no columns": np.zeros((2, 0), dtype=int),
    "read-only": _read_only(),
    "Fortran": np.asfortranarray(np.array(RING, dtype=float)),
    "masked": np.ma.masked_array(np.array(RING, dtype=float), mask=[[0, 1], [0, 0], [0, 0]]),
    "mask": np.eye(4, dtype=bool),
    "objects in an array": np.array([Odd(), None], dtype=object),
    "texts in an array": np.array(["a", "b"]),
    "bytes in an array": np.array([b"a", b"b"]),
    "half precision": np.array(RING, dtype=np.float16),
    "empty point": shapely.Point(),
    "empty polygon": shapely.Polygon(),
    "empty collection": shapely.GeometryCollection(),
    "geometries": [shapely.Point(), None, shapely.Polygon([(0, 0), (1, 1), (1, 0)])],
    "closed file": _closed_file(),
    "folder": pathlib.Path(__file__).parent,
    "folder in text": str(pathlib.Path(__file__).parent),
}

PARTS = 3
"""`make test` tries one part of the values for each argument of each function, `make test-all` all."""

CALLBACKS = ("progress", "note", "check")
"""Parameters that are called as they are."""


@pytest.fixture(scope="module")
def known():
    """Arguments that are right, by the names of parameters, and by a function before these."""
    mask = np.eye(4, dtype=bool)
    skeleton = vorotool.skeleton_exact([RING])
    digital = vorotool.digital_triangulation(RING)
    image = vorotool.tessellate([[1, 1], [3, 2]], shape=(4, 4))
    made = dict.fromkeys(("points", "seeds", "sites", "shapes", "a", "b", "source"), RING)
    made |= {"mask": mask, "raster": mask, "labels": mask.astype(int), "volume": mask[None], "image": image}
    made |= {"skeleton": skeleton, "lines": skeleton, "joined": vorotool.join_junctions(skeleton), "polygons": [RING]}
    made |= {"extended": vorotool.extend_ends(skeleton), "pruned": vorotool.prune(skeleton, length=0)}
    made |= {"smoothed": vorotool.smooth(skeleton, 0.1), "offsets": vorotool.offset([RING], [1])}
    made |= {"discs": vorotool.largest_discs([RING]), "necks": vorotool.necks([RING]), "parts": vorotool.parts([RING])}
    made |= {"family": vorotool.alpha_complex([*RING, [5, 5]]), "shape": vorotool.alpha_shape(RING, r=5)}
    made |= {"mesh": vorotool.delaunay(RING), "graph": vorotool.planar_graph([RING])}
    made |= {"r": 5, "distances": [1], "every": 1, "tolerance": 0.1, "criterion": "length", "name": "dots.csv"}
    made |= {"value": skeleton, "path": "out.json", "cells": vorotool.voronoi_cells(RING), "found": digital}
    made |= {"thickness": vorotool.local_thickness(mask)}
    special = {
        ("read", "path"): "in.wkt",
        ("seeds_from_xyz", "points"): [[0, 0, 0], [1, 2, 3]],
        ("table", "value"): made["mesh"],
        ("verify_distances", "found"): vorotool.hausdorff(RING, [[9, 9]]),
        ("verify_proximity_graph", "graph"): vorotool.proximity_graph(RING, kind="gabriel"),
        ("verify_tessellation", "image"): image,
        ("verify_thickness", "skeleton"): vorotool.skeleton_exact(vorotool.outlines(mask)),
        ("verify_voronoi", "cells"): vorotool.voronoi(RING),
        ("voronoi_diagram", "image"): image,
    }
    return made, special


def raised(function, arguments):
    """Call; give what is raised."""
    with warnings.catch_warnings(action="ignore"):
        try:
            function(**arguments)
        except Exception as error:
            return error
    return None


def values_of(name, parameter, part):
    """Give a third of the odd values; which ones a part has is another for each argument."""
    begin = zlib.crc32(f"{name} {parameter}".encode()) + part
    return list(VALUES.items())[begin % PARTS :: PARTS]


@pytest.mark.parametrize("part", few(range(PARTS), 1))
@pytest.mark.parametrize("name", FUNCTIONS)
def test_odd_arguments(name, part, known, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "in.wkt").write_text("POINT (1 2)\n")
    function = getattr(vorotool, name)
    parameters = inspect.signature(function).parameters.values()
    plain = [each for each in parameters if each.kind not in (each.VAR_KEYWORD, each.VAR_POSITIONAL)]
    made, special = known
    needed = {
        each.name: special.get((name, each.name), made.get(each.name)) for each in plain if each.default is each.empty
    }
    needed |= MORE.get(name, {})
    failed = raised(function, needed)
    strange = {} if failed is None else {"all right": repr(failed)}
    for parameter in plain:
        for what, value in values_of(name, parameter.name, part) if parameter.name not in CALLBACKS else ():
            given = (k for k in range(2)) if what == "generator" else value
            failed = raised(function, needed | {parameter.name: given})
            if failed is not None and not isinstance(failed, vorotool.VorotoolError):
                strange[f"{parameter.name} = {what}"] = repr(failed)[:200]
    assert not strange, "\n".join(f"{key}: {text}" for key, text in strange.items())


def closed_file():
    with pathlib.Path(__file__).open(encoding="utf-8") as file:
        return file


@pytest.mark.parametrize(
    "by", [5, [[1]] * 3, [{"name": "a"}] * 3, float("nan"), np.array(3.5), object(), closed_file()]
)
def test_by(by):
    with pytest.raises(VorotoolError, match="by"):
        vorotool.voronoi(RING, by=by)


def test_by_a_path_into_objects():
    features = [
        {
            "type": "Feature",
            "geometry": {"type": "Point", "coordinates": [x, 0]},
            "properties": {"classification": {"name": name}},
        }
        for x, name in enumerate("aba")
    ]
    document = {"type": "FeatureCollection", "features": features}
    assert vorotool.voronoi(document, by="classification.name").ids == ["a", "b"]
    with pytest.raises(VorotoolError, match=r"classification\.name|column\.name"):
        vorotool.voronoi(document, by="classification")
    with pytest.raises(VorotoolError, match=r"classification\.color"):
        vorotool.voronoi(document, by="classification.color")
