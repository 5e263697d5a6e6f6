"""Places along skeletons: what the core gives is what the formulas give, to the last bit, for any number of threads."""

import numpy as np
import pytest

from vorotool import points_along, prune, skeleton_exact
from vorotool.engines.skeleton.site_distances import SitePlaces

SQUARE = [[0, 0], [4, 0], [4, 4], [0, 4]]


def star(count, seed):
    random = np.random.default_rng(seed)
    angle = np.sort(random.uniform(0, 2 * np.pi, count))
    radius = 100 + 30 * np.sin(5 * angle) + random.normal(0, 2, count)
    return np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])


SKELETONS = {
    "rectangle": lambda: skeleton_exact([[0, 0], [8, 0], [8, 2], [0, 2]]),
    "star": lambda: skeleton_exact(star(200, 1)),
    "pruned": lambda: prune(skeleton_exact(star(200, 2)), angle=50),
    "outside": lambda: skeleton_exact(star(100, 3), side="both", frame=(-200, -200, 400, 400)),
    "gap": lambda: skeleton_exact(star(60, 4), gap=0.001),
    "several": lambda: skeleton_exact([SQUARE, star(50, 5)]),
}


def steps(skeleton, every):
    """The arc of each point, its way along the branch, and that along the arc."""
    whole = np.concatenate([[0.0], np.cumsum(skeleton.length)])
    start = np.flatnonzero(np.diff(skeleton.branch, prepend=-1))
    arcs, alongs, parts = [], [], []
    for first, end in zip(start, [*start[1:], len(skeleton)], strict=True):
        count = int(np.floor(np.add.reduceat(skeleton.length, start)[list(start).index(first)] / every)) + 1
        for along in every * np.arange(count):
            reached = whole[first] + along
            arc = min(max(int(np.searchsorted(whole, reached, side="right")) - 1, first), end - 1)
            arcs.append(arc)
            alongs.append(along)
            parts.append(min(max(along - (whole[arc] - whole[first]), 0), skeleton.length[arc]))
    return np.array(arcs), np.array(alongs), np.array(parts)


@pytest.mark.parametrize("name", SKELETONS)
@pytest.mark.parametrize("parts", [3.0, 101.0, 1500.0])
def test_steps_are_those_of_the_formulas(name, parts):
    skeleton = SKELETONS[name]()
    every = float(skeleton.length.sum()) / parts
    arc, along, within = steps(skeleton, every)
    measures = skeleton.measures(arc)
    u = measures.parameter(within)
    xy, radius = measures.place(u), measures.radius(u)
    sites = SitePlaces(skeleton)
    feet = np.stack([sites.feet(skeleton.sites[arc, hand], xy) for hand in (0, 1)], axis=1)
    for threads in (1, 3):
        found = points_along(skeleton, every=every, threads=threads)
        for ours, theirs in ((found.arc, arc), (found.along, along), (found.xy, xy), (found.radius, radius)):
            assert ours.tobytes() == theirs.astype(ours.dtype).tobytes()
        assert found.feet.tobytes() == feet.tobytes()
