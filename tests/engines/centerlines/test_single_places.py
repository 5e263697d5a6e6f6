"""Centerlines of skeletons that pruning leaves a single place of."""

import numpy as np
import pytest
import shapely

import vorotool
from support.families.skeleton_shapes import crossing, star, valid
from support.few import few

pytestmark = pytest.mark.filterwarnings("ignore::vorotool.errors.VorotoolWarning")


def regular(count, offset):
    angle = np.arange(count) * 2 * np.pi / count
    return np.column_stack([10 * np.cos(angle), 10 * np.sin(angle)]) + offset


SHAPES = {
    **{f"{count} at {at}": regular(count, at) for count in (3, 4, 6, 32) for at in (0.0, 5e5)},
    **{
        f"{family.__name__} {k}": family(np.random.default_rng([k, 5]))
        for family in (star, crossing, valid)
        for k in range(2)
    },
}


ENDS = ["none", "corner", "middle"]
ONE_END = [(name, ENDS[(k + turn) % 3]) for turn in range(3) for k, name in enumerate(SHAPES)]


@pytest.mark.parametrize(("name", "ends"), few(ONE_END, len(SHAPES)))
def test_no_line_has_two_equal_points(name, ends):
    whole = vorotool.skeleton_exact(SHAPES[name])
    size = float(np.ptp(whole.polygons.xy, axis=0).max())
    for threshold in ({"scale": 1.5}, {"angle": 179}, {"chord": 2 * size}, {"length": size}):
        pruned = vorotool.prune(whole, **threshold)
        lines = vorotool.centerline(pruned, ends=ends)
        assert (shapely.length(lines.to_shapely()) > 0).all()
        assert len(lines) <= len(np.unique(pruned.polygon))
