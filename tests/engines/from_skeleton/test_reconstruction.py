"""Shapes rebuilt from their skeletons, beside what these were made of and beside discs."""

import warnings

import numpy as np
import pytest
import shapely

import vorotool
from support.families.skeleton_shapes import FAMILIES, TOUCHING, small
from support.few import few
from support.oracles.offset_oracle import check_rebuilt
from vorotool.types.polygons.shapely_geometry import to_shapely


def skeleton_of(shape):
    with warnings.catch_warnings(action="ignore"):
        return vorotool.skeleton_exact(shape)


@pytest.mark.parametrize("family", few([*FAMILIES, *TOUCHING], 6), ids=lambda family: family.__name__)
def test_shapes_are_rebuilt(family):
    for seed in range(3):
        skeleton = skeleton_of(family(np.random.default_rng(seed)))
        check_rebuilt(vorotool.rebuild(skeleton), skeleton.polygons)


@pytest.mark.parametrize("criterion", few(["angle", "chord", "length"], 1))
@pytest.mark.parametrize("family", TOUCHING, ids=lambda family: family.__name__)
def test_pruned_shapes_are_what_their_discs_cover(family, criterion):
    skeleton = skeleton_of(small(family, 1, most=100))
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
