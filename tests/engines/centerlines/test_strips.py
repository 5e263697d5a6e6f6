"""Strips with known axes: lines end in the middles of their ends, whatever these and the sides look like."""

import numpy as np
import pytest
import shapely

import vorotool
from support.families.strips import strip
from support.few import few


def skeletons(made):
    """The skeleton of a strip, and a pruned one."""
    whole = vorotool.skeleton_exact(made.ring)
    return whole, vorotool.prune(whole, scale=1.3)


@pytest.mark.parametrize("seed", few(range(40), 10))
def test_strips_end_in_the_middle_of_their_ends(seed):
    random, made = np.random.default_rng([2, seed]), None
    while made is None:  # where the sides of a strip meet it is none
        made = strip(random)
    width, true = made.width, made.axis[[0, -1]]
    for skeleton in skeletons(made):
        line = vorotool.centerline(skeleton).flattened(width / 1000)[0]
        assert max(np.hypot(*(line[[0, -1]] - end).T).min() for end in true) < 0.01 * width, made.kind
        assert shapely.LineString(line).hausdorff_distance(shapely.LineString(made.axis)) < 0.15 * width, made.kind
    extended = vorotool.extend_ends(skeleton)
    vorotool.verify_extended(extended, skeleton)
    ends = extended.ends[~np.isnan(extended.ends[:, :, 0])]
    assert max(np.hypot(*(ends - end).T).min() for end in true) < 0.01 * width, made.kind


@pytest.mark.parametrize("cap", ["flat", "round"])
@pytest.mark.parametrize("count", [20, 100, 1000])
def test_a_bent_road_ends_in_the_middle(cap, count):
    turns = np.linspace(0, 2, count)
    axis = 10 * np.stack([np.cos(turns), np.sin(turns)], axis=1)
    road = shapely.LineString(axis).buffer(2, cap_style=cap)
    out = np.stack([axis[0] - axis[1], axis[-1] - axis[-2]])
    true = axis[[0, -1]] + (2 * out / np.hypot(*out.T)[:, None] if cap == "round" else 0)
    found = vorotool.centerline(vorotool.skeleton_exact(road)).ends[0]
    assert max(np.hypot(*(found - end).T).min() for end in true) < 0.04


@pytest.mark.parametrize("begin", [0.3, 1.2, 2.9, 4.4])
def test_a_bent_stroke_of_pixels_ends_in_the_middle(begin):
    y, x = np.mgrid[:200, :200] - 100.0
    angle = (np.arctan2(y, x) - begin) % (2 * np.pi)
    mask = (np.abs(np.hypot(x, y) - 70) < 8) & (angle < 3)
    found = vorotool.centerline(vorotool.skeleton_exact(vorotool.outlines(mask))).flattened(0.1)[0][[0, -1]]
    for end in (begin, begin + 3):
        assert np.hypot(*(found - 100 - 70 * np.array([np.cos(end), np.sin(end)])).T).min() < 1.5
