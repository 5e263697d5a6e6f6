"""Ends of centerlines stay where they are when a part of their twigs is pruned."""

import numpy as np
import pytest
import shapely

import vorotool
from support.few import few
from vorotool.engines.centerlines.pruned_twigs import with_pruned_twigs

CRITERIA = [
    *({"scale": value} for value in (1.1, 1.2, 1.3, 1.42, 2.0)),
    *({"angle": value} for value in (30, 60, 90, 100, 120)),
    *({"length": value} for value in (1, 2, 2.5, 2.9)),
    *({"chord": value} for value in (1, 2, 3, 3.5)),
    *({"ratio": value} for value in (1, 1.3, 1.42, 1.6)),
]


def ends(skeleton):
    line = vorotool.centerline(skeleton).flattened(0.01)[0]
    return np.array(sorted(line[[0, -1]].round(9).tolist()))


def bar(left, right):
    """20 by 4, with ends at these degrees."""
    shifts = [4 / np.tan(np.radians(angle)) for angle in (left, right)]
    return [[0, 0], [20, 0], [20 + shifts[1], 4], [shifts[0], 4]]


@pytest.mark.parametrize(
    "polygon",
    few(
        [
            [[0, 0], [20, 0], [20, 2], [18, 4], [0, 4]],
            *(bar(left, right) for left, right in ((60, 90), (76, 104), (76, 90), (76, 76), (104, 60), (120, 90))),
        ],
        3,
    ),
    ids=str,
)
def test_ends_are_those_of_the_whole_skeleton(polygon):
    whole = vorotool.skeleton_exact([polygon])
    expected = ends(whole)
    for criterion in CRITERIA:
        assert ends(vorotool.prune(whole, **criterion)) == pytest.approx(expected, abs=0.1), criterion


def slot(edges):
    """16 by 4, with half-round ends of as many edges."""
    turns = np.linspace(-np.pi / 2, np.pi / 2, edges + 1)
    half = 2 * np.stack([np.cos(turns), np.sin(turns)], axis=1)
    return [*np.add(half, [12, 0]).tolist(), *(-half).tolist()]


@pytest.mark.parametrize("edges", few([5, 8, 32], 2))
def test_a_slot_is_gone_through_along_the_middle(edges):
    whole = vorotool.skeleton_exact([slot(edges)])
    for criterion in ({"length": 2}, {"length": 1.99}, {"scale": 1.2}, {"angle": 60}, *CRITERIA):
        line = vorotool.centerline(vorotool.prune(whole, **criterion)).flattened(0.01)[0]
        assert np.abs(line[:, 1]).max() < 1e-7, criterion
        assert np.ptp(line[:, 0]) == pytest.approx(16, abs=0.2), criterion


def convex_polygon(random):
    """A convex hull, three times as long as wide."""
    hull = shapely.MultiPoint(random.integers(0, 4096, (int(random.integers(4, 40)), 2)) * [3, 1]).convex_hull
    return list(hull.exterior.coords)[:-1]


def drawn(skeleton):
    return shapely.MultiLineString(list(skeleton.vertices[skeleton.arcs]))


def test_what_is_added_is_what_was_pruned():
    random = np.random.default_rng(11)
    added = 0
    for _ in range(25):
        whole = vorotool.skeleton_exact([convex_polygon(random)])
        for criterion in ({"scale": 1.2}, {"angle": 100}, {"length": 500}, {"ratio": 1.5}, {"chord": 300}):
            pruned = vorotool.prune(whole, **criterion)
            if not pruned.length.sum():
                continue
            made = with_pruned_twigs(pruned)
            added += len(made) - len(pruned)
            far = shapely.distance(shapely.points(made.vertices), drawn(whole)).max()
            if not {"angle", "chord"} & set(criterion):  # these leave parts of twigs
                far = drawn(made).hausdorff_distance(drawn(whole))
            assert far < 1e-3
    assert added > 400
