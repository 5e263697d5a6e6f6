"""Numbers of every kind, taken exactly or refused in words."""

from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest

import vorotool
from vorotool.engines import masks
from vorotool.errors import InputError, LimitError, UsageError
from vorotool.numeric.numbers import finite_double, real_number, shown_number

POINTS = [[0, 0], [2, 0], [2, 2], [0, 2], [9, 1]]
NO_NUMBERS = [
    *("10", b"10", None, float("nan"), Decimal("nan"), Decimal("sNaN"), 1j, [1], np.array([1.0])),
    *(np.datetime64("2020"), np.float64("nan"), Decimal("1e999999999")),
    pytest.param(object(), id="object"),  # whose text is another in each run
]


@pytest.mark.parametrize("value", NO_NUMBERS, ids=shown_number)
def test_what_is_no_number_is_refused(value):
    with pytest.raises(UsageError, match=r"^r is .*: give a number$"):
        real_number(value, "r")


@pytest.mark.parametrize(
    ("value", "exact"),
    [
        (np.float32(0.1), Fraction(float(np.float32(0.1)))),
        (np.int64(2**62 + 1), Fraction(2**62 + 1)),
        (np.array(3), Fraction(3)),
        (Decimal("0.1"), Fraction(1, 10)),
        (Fraction(1, 3), Fraction(1, 3)),
        (2**53 + 1, Fraction(2**53 + 1)),
        (np.longdouble(1) / 4, Fraction(1, 4)),
        (10**400, Fraction(10**400)),
    ],
)
def test_numbers_are_taken_exactly(value, exact):
    assert Fraction(real_number(value, "r")) == exact


def test_doubles_stay_doubles():
    assert [type(real_number(value, "r")) for value in (2, 2.5, np.float64(3), np.int8(4), np.inf)] == [float] * 5


@pytest.mark.parametrize(
    "value", [10**400, float("inf"), -(10**5000), Fraction(10**400), Decimal("Infinity")], ids=shown_number
)
def test_lengths_are_finite(value):
    with pytest.raises(UsageError, match="give a finite number"):
        finite_double(value, "step")


def test_numbers_beyond_doubles_are_shown_briefly():
    assert shown_number(-(10**5000)) == "-1.0e+5000"
    assert shown_number(Fraction(1, 10**5000)) == "1.0e-5000"


@pytest.mark.parametrize(
    "r", [10**400, Fraction(10**400), Decimal("1e400"), 10**5000, float("inf"), np.inf], ids=shown_number
)
def test_a_radius_beyond_doubles_gives_the_hull(r):
    shape = vorotool.alpha_shape(POINTS, r=r)
    assert shape.area == vorotool.alpha_shape(POINTS, r=float("inf")).area
    assert shape.alpha == 0
    vorotool.verify_alpha_shape(shape)


@pytest.mark.parametrize("r", [Fraction(1, 10**400), Decimal("1e-400"), 5e-324])
def test_a_radius_below_doubles_gives_points(r):
    assert len(vorotool.alpha_shape(POINTS, r=r).edges) == 0


@pytest.mark.parametrize("name", ["hole_threshold", "region_threshold"])
def test_thresholds_beyond_doubles_are_compared_exactly(name):
    whole = vorotool.alpha_shape(POINTS, r=10, **{name: 10**400})
    assert whole.area == (0 if name == "region_threshold" else vorotool.alpha_shape(POINTS, r=10).area)
    for wrong in (-1, float("inf"), float("nan"), "2"):
        with pytest.raises(UsageError, match=name):
            vorotool.alpha_shape(POINTS, r=10, **{name: wrong})


SQUARE = [[0, 0], [4, 0], [4, 4], [0, 4]]
IMAGE = np.pad(np.full((3, 3), 200, dtype=np.uint8), 2)
TAKERS = {
    "offset": lambda x: vorotool.offset(SQUARE, [x]),
    "one offset": lambda x: vorotool.offset(SQUARE, x),
    "verify_offsets": lambda x: vorotool.verify_offsets(vorotool.offset(SQUARE, 1), distances=[x]),
    "frame": lambda x: vorotool.voronoi_cells(SQUARE, frame=(0, 0, x, 1)),
    "Box": lambda x: vorotool.Box(0, 0, x, 1),
    "Frame": lambda x: vorotool.Frame(x, 0, 1, 1),
    "step": lambda x: vorotool.skeleton_approx(SQUARE, step=x),
    "tolerance": lambda x: vorotool.skeleton_approx(SQUARE, tolerance=x),
    "gap": lambda x: vorotool.skeleton_exact(SQUARE, gap=x),
    "threshold": lambda x: vorotool.outlines(IMAGE, threshold=x),
    "seeds": lambda x: vorotool.seeds_from_raster(IMAGE, threshold=x),
    "simplify": lambda x: vorotool.outlines(IMAGE, threshold=1, simplify=x),
    "flatten": lambda x: vorotool.to_geojson(vorotool.skeleton_exact(SQUARE), flatten=x),
    "flatten offsets": lambda x: vorotool.to_geojson(vorotool.offset(SQUARE, 1), flatten=x),
    "every": lambda x: vorotool.points_along(vorotool.skeleton_exact(SQUARE), every=x),
    "start": lambda x: vorotool.centerline(vorotool.skeleton_exact(SQUARE), start=(x, 0)),
    "end": lambda x: vorotool.centerline(vorotool.skeleton_exact(SQUARE), end=x),
    "passes": lambda x: vorotool.tessellate(SQUARE, passes=x),
    "shape": lambda x: vorotool.tessellate(SQUARE, shape=(5, x)),
    "window": lambda x: vorotool.tessellate(SQUARE, window=(x, 0, 5, 5)),
    "max_distance": lambda x: vorotool.tessellate(SQUARE, max_distance=x),
    "regions": lambda x: vorotool.alpha_shape(SQUARE, regions=x),
    "connectivity": lambda x: vorotool.outlines(IMAGE, threshold=1, connectivity=x),
    "side": lambda x: vorotool.skeleton_exact(SQUARE, side=x),
    "features": lambda x: vorotool.largest_discs(SQUARE, features=x),
    "outline": lambda x: vorotool.outlines(IMAGE, threshold=1, outline=x),
    "border": lambda x: vorotool.outlines(IMAGE, threshold=1, border=x),
    "mode": lambda x: vorotool.seeds_from_raster(IMAGE, mode=x),
    "image": lambda x: vorotool.tessellate(SQUARE, image=x),
    "kind": lambda x: vorotool.proximity_graph(vorotool.delaunay(SQUARE), x),
    "hint": lambda x: vorotool.insert_points(vorotool.delaunay(SQUARE), [[1, 1]], hint=x),
    "rule": lambda x: vorotool.alpha_shape(SQUARE, rule=x),
    "what": lambda x: vorotool.to_geojson(vorotool.skeleton_exact(SQUARE), what=x),
    **{
        name: lambda x, name=name: vorotool.prune(vorotool.skeleton_exact(SQUARE), **{name: x})
        for name in ("angle", "chord", "scale", "length", "ratio")
    },
}


FRAMES = [(0, 0, 0, 1), (0, 0, 1, -1), (0, 0, 1), (0, 0, float("nan"), 1), (0, 0, float("inf"), 1), 5, "abcd"]
SPACE_FRAMES = [(0, 0, 1, 1), (0, 0, 0, 1, 1, 0), (0, 0, 0, 1, 1, float("nan")), 3]
WRONG = {
    "smooth": (lambda x: vorotool.smooth(vorotool.skeleton_exact(SQUARE), x), [0, -1, float("inf")]),
    "voronoi": (lambda x: vorotool.voronoi(SQUARE, frame=x), FRAMES),
    "limit": (lambda x: vorotool.voronoi(SQUARE, max_distance=x), [0, -1, float("inf"), 1e90]),
    "voronoi_cells": (lambda x: vorotool.voronoi_cells(SQUARE, frame=x), [*FRAMES, (1e17, 0, 1, 1), (0, 0, "w", 1)]),
    "cells in space": (lambda x: vorotool.voronoi_cells(np.eye(3), frame=x), SPACE_FRAMES),
    "offset": (TAKERS["offset"], [0, float("inf"), (0,)]),
    "offsets": (lambda x: vorotool.offset(SQUARE, x), [[], [1, 0], [1, 2, 1]]),
    "gap": (TAKERS["gap"], [-1]),
    "skeleton frame": (lambda x: vorotool.skeleton_exact(SQUARE, frame=x), FRAMES),
    "step": (TAKERS["step"], [0, -1, float("inf")]),
    "tolerance": (TAKERS["tolerance"], [0, -1, float("inf")]),
    "necks": (lambda x: vorotool.necks(SQUARE, neck=x), [-0.1, 1.5]),
    "parts": (lambda x: vorotool.parts(SQUARE, neck=x), [-0.1, 1.5]),
    "expand_labels": (lambda x: masks.expand_labels([[7]], x), [-1]),
    "max_distance": (TAKERS["max_distance"], [-1]),
    "r": (lambda x: vorotool.alpha_shape(POINTS, r=x), [0, -1, Fraction(-1, 2)]),
    "regions": (TAKERS["regions"], [0]),
    "count": (lambda x: vorotool.largest_discs(SQUARE, count=x), [0, 1.5]),
    "count of empty": (lambda x: vorotool.largest_empty_discs(SQUARE, count=x), [0, 1.5]),
    "r of edges": (lambda x: vorotool.alpha_edges(vorotool.alpha_complex(POINTS), x), [0, -1]),
}


@pytest.mark.parametrize("taker", sorted({*TAKERS, *WRONG}))
def test_options_that_are_wrong_or_huge_are_refused_in_short(taker):
    take, wrong = WRONG.get(taker) or (TAKERS[taker], [])
    for value in (-(10**5000), "a", [10**400, "a"], float("nan"), *wrong):
        with pytest.raises((UsageError, InputError, LimitError)) as refused:
            take(value)
        assert len(str(refused.value)) < 200


def test_names_may_be_huge_numbers():
    for take in (
        lambda: vorotool.delaunay({10**5000: [1, 2]}),
        lambda: vorotool.polygon_table(vorotool.skeleton_exact(SQUARE), columns={10**5000: 1}),
    ):
        with pytest.raises(InputError, match="of type int"):
            take()


@pytest.mark.parametrize("taker", ["regions", "max_distance"])
def test_huge_limits_are_none(taker):
    assert TAKERS[taker](10**400) is not None


@pytest.mark.parametrize("name", ["width", "precision"])
def test_numbers_of_files_are_refused_in_short(tmp_path, name):
    path = tmp_path / ("a.svg" if name == "width" else "a.geojson")
    for value in (10**5000, "a", 1.5, -1):
        with pytest.raises(UsageError) as refused:
            vorotool.write(vorotool.skeleton_exact(SQUARE), path, **{name: value})
        assert len(str(refused.value)) < 200


def test_fractions_are_lengths():
    assert vorotool.offset(SQUARE, Fraction(1, 2)).distance.tolist() == [0.5]
    assert len(vorotool.outlines(IMAGE, threshold=Decimal("3.5"), simplify=Fraction(1, 2)).xy) == 4
