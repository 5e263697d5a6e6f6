"""Values declare their fields: these are checked and read-only, and arrays of the caller stay as they are."""

from dataclasses import fields, replace
from fractions import Fraction
from importlib import import_module

import numpy as np
import pytest
import shapely

import vorotool
from vorotool import InputError, UsageError
from vorotool.numeric.checks import is_equal
from vorotool.types import fields as f
from vorotool.types.fields import Meaning, Record, record, with_y_axis
from vorotool.types.scaling import scaled, scaled_table, stretched
from vorotool.types.table import Table
from vorotool.types.values import Value

ROOM = [[0, 0], [4, 0], [4, 1.5], [6, 1.5], [6, 0], [12, 0], [12, 6], [6, 6], [6, 2.5], [4, 2.5], [4, 4], [0, 4]]
POINTS = [[0, 0], [4, 0], [0, 3], [5, 5], [2, 1]]


VALUES = {
    "points": lambda: vorotool.PointSet(POINTS, labels=[3, 1, 2, 5, 4]),
    "seeds": lambda: vorotool.SeedSet([1, 2], [3, 4], [1, 2]),
    "mesh": lambda: vorotool.delaunay(POINTS),
    "cells": lambda: vorotool.voronoi_cells(vorotool.delaunay(POINTS)),
    "graph": lambda: vorotool.proximity_graph(POINTS, "gabriel"),
    "shape": lambda: vorotool.alpha_shape(POINTS, r=3),
    "family": lambda: vorotool.alpha_complex(POINTS),
    "hull": lambda: vorotool.alpha_hull(vorotool.alpha_shape(POINTS, r=3)),
    "skeleton": lambda: vorotool.skeleton_exact(ROOM),
    "polygons": lambda: vorotool.skeleton_exact(ROOM).polygons,
    "sites": lambda: vorotool.skeleton_exact(ROOM).site_table,
    "necks": lambda: vorotool.necks(ROOM),
    "parts": lambda: vorotool.parts(ROOM),
    "offsets": lambda: vorotool.offset(ROOM, [-0.25]),
    "discs": lambda: vorotool.largest_discs(ROOM, count=2),
    "points along": lambda: vorotool.points_along(vorotool.skeleton_exact(ROOM), every=1),
    "centerlines": lambda: vorotool.centerline(vorotool.skeleton_exact(ROOM)),
    "critical values": lambda: vorotool.critical_values(vorotool.skeleton_exact(ROOM), "angle"),
    "map": lambda: vorotool.voronoi([ROOM]),
}


@pytest.mark.parametrize("value", VALUES)
def test_arrays_of_values_are_read_only_and_of_their_types(value):
    value = VALUES[value]()
    arrays = {name: each for name, each in value._declared.items() if each.dtype is not None and each.shape}
    arrays = {name: each for name, each in arrays.items() if getattr(value, name) is not None}
    assert arrays
    for name, each in arrays.items():
        array = getattr(value, name)
        assert array.dtype == each.dtype
        with pytest.raises(ValueError, match="read-only"):
            array[...] = array[...]
    assert is_equal(replace(value), value)


def test_every_array_of_a_value_is_declared():
    for make in VALUES.values():
        value = make()
        kept = {each.name for each in fields(value) if isinstance(getattr(value, each.name), np.ndarray)}
        assert kept <= value._declared.keys() | {"vertices", "point_holes"}, type(value).__name__


def test_the_array_that_is_given_stays_the_callers():
    xy = np.array(POINTS, dtype=float)
    mesh = vorotool.delaunay(xy)
    kept = mesh.points.copy()
    xy[0] = 7
    assert xy.flags.writeable
    assert isinstance(mesh, Value)
    assert (mesh.points == kept).all()


@record
class Strip(Record):
    """What a value may declare."""

    rows: np.ndarray = f.starts("rows", "items", least=1)
    xy: np.ndarray = f.position("items", 2)
    width: np.ndarray = f.length("rows")
    other: np.ndarray | None = f.index("rows", default=None)


GOOD = {"rows": [0, 2, 3], "xy": [[0, 0], [1, 0], [2, 0]], "width": [1, 2]}


@pytest.mark.parametrize(
    ("changed", "named"),
    [
        ({"xy": [[0, 0, 0]] * 3}, r"xy must have shape \(3, 2\), but has shape \(3, 3\)"),
        ({"xy": [[0, 0]] * 2}, r"xy must have shape \(3, 2\)"),
        ({"width": [1]}, r"width must have shape \(2,\), but has shape \(1,\)"),
        ({"width": [[1, 2]]}, "width must have shape"),
        ({"rows": [0, 0, 3]}, "rows must increase from 0 to 3, without empty rows"),
        ({"rows": [1, 2, 3]}, "rows must increase from 0 to 3"),
        ({"rows": []}, "rows must have one dimension"),
        ({"other": [1, 2, 3]}, r"other must have shape \(2,\)"),
    ],
)
def test_what_does_not_go_together_is_refused(changed, named):
    assert Strip(**GOOD).other is None
    assert Strip(**GOOD, other=[1, 0]).other.tolist() == [1, 0]
    with pytest.raises(InputError, match=named):
        Strip(**{**GOOD, **changed})


def test_no_rows_need_no_shape():
    empty = Strip([0], [], [])
    assert (empty.xy.shape, empty.width.shape, empty.rows.tolist()) == ((0, 2), (0,), [0])


def test_lengths_and_positions_scale_as_they_are_declared():
    scaled = import_module("vorotool.types.scaling").scaled
    made = scaled(Strip(**GOOD), 2, (10.0, 20.0))
    assert made.width.tolist() == [2, 4]
    assert made.xy.tolist() == [[10, 20], [12, 20], [14, 20]]
    assert {each.meaning for each in made._declared.values()} == {
        Meaning.NUMBER,
        Meaning.POSITION,
        Meaning.LENGTH,
    }


def test_an_axis_is_that_of_all_values_in_one():
    skeleton = vorotool.skeleton_exact([[0, 0], [0.4, 0.1], [0.1, 0.3]])
    assert skeleton.polygons.as_given is not skeleton.polygons
    up = with_y_axis(skeleton, "up")
    assert (skeleton.y_axis, up.y_axis, up.as_given.y_axis, up.polygons.as_given.y_axis) == ("none", "up", "up", "up")
    assert up == skeleton
    assert np.array_equal(up.polygons.as_given.xy, skeleton.polygons.as_given.xy)
    found = vorotool.hausdorff(["POINT (0 0)"], ["POINT (3 4)"])
    assert [shape.y_axis for shape in with_y_axis(found, "down").shapes] == ["down", "down"]
    cells = vorotool.voronoi([[0, 0], [4, 1]], enclosures=[shapely.LineString([(0, 3), (9, 3)])])
    assert with_y_axis(cells, "down").enclosures.y_axis == with_y_axis(cells, "down").y_axis == "down"


THIRD = Fraction(1, 3)


def test_ties_are_decided_as_before():
    """A third of a lattice is no lattice: what was cocircular stays so."""
    lattice = np.array([[x, y] for x in range(5) for y in range(5)], dtype=float)
    mesh = vorotool.delaunay(lattice)
    found = scaled(mesh, THIRD)
    assert found.triangles is mesh.triangles
    assert np.array_equal(found.points, lattice / 3)


def test_skeletons_with_frame():
    skeleton = vorotool.skeleton_exact([[0, 0], [9, 0], [9, 9], [5, 3], [0, 9]], side="both", frame=(-3, -3, 15, 15))
    found = scaled(skeleton, THIRD)
    assert np.allclose(found.frame, np.array(skeleton.frame) / 3, rtol=1e-15)
    assert np.array_equal(found.on_frame, skeleton.on_frame)
    assert np.allclose(found.length, skeleton.length / 3, rtol=1e-15)
    assert np.array_equal(np.isnan(found.control), np.isnan(skeleton.control))


def test_missing_fields_stay_missing():
    table = scaled_table(Table({"x": np.ma.array([3.0, 0], mask=[False, True]), "area": [9, 18]}), THIRD)
    assert table["x"].tolist() == [1.0, None]
    assert table["area"].tolist() == [1.0, 2.0]


def test_what_has_no_size():
    with pytest.raises(UsageError, match="a list cannot be scaled"):
        scaled([1, 2], THIRD)


def test_mirrored_places():
    frame = vorotool.Frame(2, 3, 10, 4)
    seeds = stretched(vorotool.SeedSet([1, 2], [3, 4], [1, 2], scale=2, frame=frame, y_axis="down"), 1, -1)
    assert (seeds.x.tolist(), seeds.y.tolist(), seeds.y_axis) == ([1, 2], [-3, -4], "up")
    assert (seeds.frame, seeds.sites.tolist()) == (vorotool.Frame(2, -6, 10, 4), [[0.5, -1.5], [1, -2]])
    with pytest.raises(UsageError, match="a SeedSet cannot be scaled"):
        scaled(seeds, THIRD)
    ring = np.array([[0, 0], [3, 0], [3, 2]])
    shape = stretched(vorotool.skeleton_exact(ring).polygons, 1, -1)
    assert shape.xy.tolist() == [[0, 0], [3, -2], [3, 0]]
