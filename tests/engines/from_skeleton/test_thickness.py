"""Local thickness beside closed forms, bounds that know no skeleton, and a search of all arcs."""

import warnings

import numpy as np
import pytest
import shapely
from scipy import ndimage

import vorotool
from support.families.skeleton_shapes import TOUCHING, small
from support.few import few
from support.oracles.thickness_oracle import check_thickness
from vorotool.engines.from_skeleton.thickness import thickness_of_pixels
from vorotool.types.polygons.shapely_geometry import to_shapely

NEAR = {"rtol": 0, "atol": 1e-11}


def blobs(side, sigma, seed=0):
    return ndimage.gaussian_filter(np.random.default_rng(seed).random((side, side)), sigma) > 0.5


def in_rectangle(height, width):
    """Of a rectangle: the disc over a pixel near a corner touches both sides, and has it on its rim."""
    y, x = np.indices((height, width)) + 0.5
    x, y = np.minimum(x, width - x), np.minimum(y, height - y)
    return np.minimum(min(height, width), 2 * (x + y + np.sqrt(2 * x * y)))


@pytest.mark.parametrize("size", [(1, 1), (1, 7), (2, 2), (5, 9), (40, 21), (64, 64), (200, 31)])
def test_a_rectangle_has_its_closed_form(size):
    mask = np.pad(np.ones(size, dtype=bool), 2)
    made = vorotool.local_thickness(mask)
    np.testing.assert_allclose(made[2:-2, 2:-2], in_rectangle(*size), **NEAR)
    assert np.array_equal(made > 0, mask)


@pytest.mark.parametrize(("side", "sigma"), few([(60, 1.0), (100, 3.0), (120, 8.0)], 2))
def test_larger_masks_are_as_all_arcs_have_them(side, sigma):
    mask = blobs(side, sigma)
    skeleton = vorotool.skeleton_exact(vorotool.outlines(mask))
    made = thickness_of_pixels(skeleton, mask.shape)
    assert np.array_equal(made > 0, mask)
    vorotool.verify_thickness(made, skeleton, samples=400)


def test_a_spacing_is_the_unit():
    mask = blobs(80, 2.0, seed=6)
    made = vorotool.local_thickness(mask)
    np.testing.assert_allclose(vorotool.local_thickness(mask, spacing=0.3), 0.3 * made, **NEAR)
    wide = vorotool.local_thickness(mask[::5, ::5], spacing=(0.5, 0.2))
    shapes = vorotool.outlines(mask[::5, ::5])
    polygons = vorotool.PolygonSet(
        shapes.xy * (0.2, 0.5), shapes.ring_starts, shapes.ring_kind, shapes.ring_polygon, shapes.ids
    )
    check_thickness(wide, polygons, (0.5, 0.2), 0.02)


def test_rows_go_up_where_the_polygons_are_drawn_so():
    from dataclasses import replace

    mask = blobs(50, 2.0, seed=7)
    shapes = vorotool.outlines(mask)
    xy = shapes.xy * (1, -1)
    upwards = replace(shapes, xy=xy, y_axis="up")
    made = thickness_of_pixels(vorotool.skeleton_exact(upwards), mask.shape)
    np.testing.assert_allclose(made, vorotool.local_thickness(mask), **NEAR)


def test_what_is_outside_is_left_out():
    mask = blobs(50, 2.0, seed=8)
    skeleton = vorotool.skeleton_exact(vorotool.outlines(mask), side="both")
    np.testing.assert_allclose(thickness_of_pixels(skeleton, mask.shape), vorotool.local_thickness(mask), **NEAR)


def test_a_gap_is_refused():
    skeleton = vorotool.skeleton_exact([[0, 0], [8, 0], [8, 8]], gap=0.5)
    with pytest.raises(vorotool.InputError, match="has a gap"):
        thickness_of_pixels(skeleton, (8, 8))


@pytest.mark.parametrize("factor", [0.99, 1.01, 0.0])
def test_the_check_finds_values_that_are_wrong(factor):
    mask = blobs(60, 2.0)
    skeleton = vorotool.skeleton_exact(vorotool.outlines(mask))
    made = thickness_of_pixels(skeleton, mask.shape)
    vorotool.verify_thickness(made, skeleton)
    with pytest.raises(vorotool.VerificationError, match="the thickness in row"):
        vorotool.verify_thickness(made * factor, skeleton, samples=40)
    outside = np.where(mask, made, 1.0)
    with pytest.raises(vorotool.VerificationError, match="the thickness in row"):
        vorotool.verify_thickness(outside, skeleton, samples=4000)


# ---- Shapes rebuilt from their skeletons, beside what these were made of and beside discs ----
def skeleton_quietly(shape):
    with warnings.catch_warnings(action="ignore"):
        return vorotool.skeleton_exact(shape)


@pytest.mark.parametrize("criterion", few(["angle", "chord", "length"], 1))
@pytest.mark.parametrize("family", TOUCHING, ids=lambda family: family.__name__)
def test_pruned_shapes_are_what_their_discs_cover(family, criterion):
    skeleton = skeleton_quietly(small(family, 1, most=100))
    middle = float(np.median(vorotool.critical_values(skeleton, criterion).ends))
    pruned = vorotool.prune(skeleton, **{criterion: min(middle, 170)})
    extent = float(np.ptp(skeleton.polygons.xy, axis=0).max())
    found = shapely.union_all(to_shapely(vorotool.rebuild(pruned, flatten=extent * 1e-6)))
    along = vorotool.points_along(pruned, every=extent / 200)
    covered = shapely.union_all(shapely.buffer(shapely.points(along.xy), along.radius, quad_segs=32))
    # between two discs a step apart there is at most a triangle of the step and its height, on both sides
    assert shapely.difference(covered, found).area <= 1e-5 * extent * covered.length
    assert shapely.difference(found, covered).area <= 2e-3 * extent * covered.length


FLAT = {
    "a point": [[[5, 5]]],
    "a segment": [[[3, 5], [6, 5]]],
    "both": [[[2, 3]], [[3, 5], [6, 6]]],
    "a segment given twice": [[[3, 5], [6, 5], [3, 5]]],
}


@pytest.mark.parametrize("holes", FLAT.values(), ids=FLAT)
@pytest.mark.parametrize("side", ["interior", "both"])
@pytest.mark.parametrize("chord", [None, 100])
def test_points_and_segments_are_holes_again(holes, side, chord):
    square = [[0, 0], [10, 0], [10, 10], [0, 10]]
    skeleton = vorotool.skeleton_exact([{"shell": square, "holes": holes}, [[20, 0], [24, 0], [24, 4]]], side=side)
    again = vorotool.rebuild(skeleton if chord is None else vorotool.prune(skeleton, chord=chord))
    first = slice(1, int(again.polygon_starts[1]))
    assert again.ring_kind[first].tolist() == [1] * len(holes)
    places = [{tuple(place) for place in ring} for ring in holes]
    assert [{tuple(place) for place in again.ring(k + 1).tolist()} for k in range(len(holes))] == places
