"""Hausdorff and smallest distances: closed forms, brute force, ties, and what is refused."""

from dataclasses import replace

import numpy as np
import pytest
import shapely

import vorotool
from vorotool import InputError, VerificationError, distance, hausdorff, verify_distances

A = [(26, 8), (13, -2), (13, 19), (10, 19), (10, 23), (1, 17)]
B = [(15, 1), (28, 11), (13, 26), (1, 18)]
"""The two lines of shapely's issue 2458."""

SQUARE = shapely.box(0, 0, 9, 9)
RING = shapely.box(0, 0, 9, 9) - shapely.box(1, 1, 8, 8)


def test_the_lines_of_which_shapely_sees_the_vertices_only():
    a, b = shapely.LineString(A), shapely.LineString(B)
    found = hausdorff([a], [b])
    assert shapely.hausdorff_distance(a, b) == pytest.approx(4.949747468)
    # on x = 13, as far from the edge x - 28 = 11 - y as from the vertex (15, 1) and its edge
    assert found.from_a.on_a[0] == 13.0
    assert shapely.hausdorff_distance(a, b, densify=0.0001) == pytest.approx(found.distance, abs=1e-3)
    assert shapely.hausdorff_distance(a, b, densify=0.0001) <= found.distance


def test_a_square_goes_farthest_into_a_ring_at_its_middle():
    there = hausdorff([SQUARE], [RING]).from_a
    assert (there.distance, there.on_a) == (3.5, (4.5, 4.5))
    assert hausdorff([RING], [SQUARE]).distance == 3.5
    outlines = hausdorff([SQUARE], [RING], boundary=True)
    assert (outlines.from_a.distance, outlines.from_b.distance) == (0, 1)


@pytest.mark.parametrize("corners", [3, 4, 5, 7, 12, 101])
def test_the_middle_of_a_regular_hole_is_its_inradius_away(corners):
    angle = 2 * np.pi * np.arange(corners) / corners + 0.1
    hole = np.stack([np.cos(angle), np.sin(angle)], axis=1) * 0.7 + (0.3, 0.2)
    ring = {"shell": [[-2, -2], [3, -2], [3, 3], [-2, 3]], "holes": [hole]}
    found = hausdorff([shapely.box(-2, -2, 3, 3)], [ring])
    assert found.distance == pytest.approx(0.7 * np.cos(np.pi / corners), rel=4e-16)
    verify_distances(found)


def test_points_are_as_scipy_has_them():
    from scipy.spatial.distance import directed_hausdorff

    random = np.random.default_rng(1)
    a, b = random.random((200, 2)), random.random((100, 2))
    found = hausdorff(a, b)
    for way, (one, other) in ((found.from_a, (a, b)), (found.from_b, (b, a))):
        assert way.distance == pytest.approx(directed_hausdorff(one, other)[0], rel=1e-15)
    assert tuple(a[directed_hausdorff(a, b)[1]]) == found.from_a.on_a


@pytest.mark.parametrize(
    "shape",
    [[[3, 4]], ["LINESTRING (0 0, 0.1 0.3, 5 0.7)"], [shapely.Polygon(np.random.default_rng(2).random((3, 2)))]],
)
def test_equal_shapes_are_at_distance_0(shape):
    for boundary in (False, True):
        assert hausdorff(shape, shape, boundary=boundary).distance == 0
        assert distance(shape, shape, boundary=boundary).distance == 0


def test_the_first_of_several_places():
    found = hausdorff([[0, 1], [5, 1], [5, -1]], ["LINESTRING (-9 0, 9 0)"])
    assert (found.from_a.on_a, found.from_a.on_b) == ((0, 1), (0, 0))
    closest = distance([[7, 1], [5, 1]], ["LINESTRING (-9 0, 9 0)"]).smallest
    assert (closest.on_a, closest.on_b) == ((7, 1), (7, 0))


@pytest.mark.parametrize("empty", [[], np.empty((0, 2)), ["POLYGON EMPTY"]])
def test_what_has_no_places(empty):
    for function in (hausdorff, distance):
        with pytest.raises(InputError, match=r"invalid b: .*empty"):
            function([[0, 0]], empty)


def test_different_systems():
    geopandas = pytest.importorskip("geopandas")
    a, b = (geopandas.GeoSeries([shapely.Point(0, 0)], crs=crs) for crs in ("EPSG:2056", "EPSG:3857"))
    with pytest.raises(InputError, match="EPSG:2056 and EPSG:3857: reproject"):
        hausdorff(a, b)
    assert hausdorff(a, [[3, 4]]).crs is not None


def test_the_checker_finds_what_is_wrong():
    good = hausdorff([SQUARE], [RING])
    verify_distances(good)
    there = good.from_a
    line = [shapely.LineString(B)]
    lines, closest = hausdorff([shapely.LineString(A)], line), distance([shapely.LineString(A)], line)
    verify_distances(lines)
    verify_distances(closest)
    wrong = [
        replace(good, from_a=replace(there, distance=there.distance + 1)),
        replace(good, from_a=vorotool.PlacePair(0.0, (0.0, 0.0), (0.0, 0.0))),
        replace(good, from_b=vorotool.PlacePair(1.0, (0.0, 0.0), (1.0, 0.0))),
        replace(lines, from_a=hausdorff([A[0]], line).from_a),
        replace(closest, smallest=vorotool.PlacePair(11.0, (26.0, 8.0), (15.0, 8.0))),
        replace(closest, smallest=distance([A[-1]], line).smallest),
    ]
    for each in wrong:
        with pytest.raises(VerificationError):
            verify_distances(each)


def test_edges_that_bound_nothing_are_left_out_with_a_warning():
    spike = shapely.Polygon([(0, 0), (10, 0), (10, 10), (5, 10), (5, 30), (5, 10), (0, 10)])
    far = shapely.box(5, 28, 10, 40)
    with pytest.warns(vorotool.RepairWarning, match="feature 1 of b: edges cross or overlap"):
        assert distance(far, spike).smallest.distance == 18
    with pytest.warns(vorotool.RepairWarning, match="feature 2 of a: "):
        assert hausdorff([far, spike], far).from_b.distance == 0
