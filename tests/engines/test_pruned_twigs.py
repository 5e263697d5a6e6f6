"""Ends of centerlines stay where they are when a part of their twigs is pruned."""

import numpy as np
import pytest
import shapely

import vorotool
from vorotool.engines.pruned_twigs import with_pruned_twigs

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
    [
        *(bar(left, right) for left, right in ((60, 90), (76, 90), (76, 76), (76, 104), (104, 60), (120, 90))),
        [[0, 0], [20, 0], [20, 2], [18, 4], [0, 4]],
    ],
    ids=str,
)
def test_ends_are_those_of_the_whole_skeleton(polygon):
    whole = vorotool.skeleton_exact([polygon])
    expected = ends(whole)
    for criterion in CRITERIA:
        assert ends(vorotool.prune(whole, **criterion)) == pytest.approx(expected, abs=0.1), criterion


def test_no_twig_is_added_to_a_whole_skeleton():
    random = np.random.default_rng(5)
    for _ in range(40):
        hull = shapely.MultiPoint(random.integers(0, 64, (12, 2))).convex_hull
        shape = hull.union(shapely.box(20, 20, 90, 40)).difference(shapely.box(28, 28, 32, 31))
        shell, *holes = (list(ring.coords)[:-1] for ring in (shape.exterior, *shape.interiors))
        skeleton = vorotool.skeleton_exact([{"shell": shell, "holes": holes}])
        assert with_pruned_twigs(skeleton) is skeleton


@pytest.mark.parametrize("turn", [1, -1])
def test_a_twig_is_added_whichever_way_the_ring_goes(turn):
    skeleton = vorotool.prune(vorotool.skeleton_exact([[[0, 0], [20, 0], [21, 4], [1, 4]][::turn]]), scale=1.3)
    made = with_pruned_twigs(skeleton)
    assert sorted(made.vertices[made.arcs[len(skeleton) :, 1]].tolist()) == [[1, 4], [20, 0]]
