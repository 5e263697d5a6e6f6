"""The checker of skeletons takes approximate ones, and refuses what is wrong with them."""

from dataclasses import replace

import numpy as np
import pytest

import vorotool
from support.families.skeleton_shapes import FAMILIES, small
from support.few import few
from vorotool import VerificationError, skeleton_approx, verify_skeleton
from vorotool.convert.polygons import as_polygons

SHAPES = {
    "room": [[0, 0], [8, 0], [8, 3], [4, 1], [0, 3]],
    "ring": [{"shell": [[0, 0], [9, 0], [9, 7], [0, 7]], "holes": [[[2, 2], [6, 2], [4, 5]]]}],
    "two": [[[0, 0], [4, 0], [4, 4], [0, 4]], [[2, 2], [7, 2], [7, 5], [2, 6]]],
    "far": [[[5e5 + 40 * np.cos(k), 4e6 + 30 * np.sin(k)] for k in np.arange(24) * np.pi / 12]],
}
OPTIONS = ({"step": 0.4}, {"step": 0.4, "sampling": "symmetric", "complete": True}, {"tolerance": 0.02})

pytestmark = pytest.mark.filterwarnings("ignore::vorotool.errors.VorotoolWarning")


SIDES, FEATURES = ["interior", "exterior", "both"], ["separate", "together"]
PAIRS_FIRST = [
    (name, side, FEATURES[(k + i + turn) % 2])
    for turn in range(2)
    for k, name in enumerate(SHAPES)
    for i, side in enumerate(SIDES)
]


@pytest.mark.parametrize(("name", "side", "features"), few(PAIRS_FIRST, len(SHAPES) * len(SIDES)))
def test_approximate_skeletons_pass_whatever_their_side(name, side, features):
    for options in OPTIONS:
        verify_skeleton(skeleton_approx(SHAPES[name], side=side, features=features, **options))


@pytest.mark.parametrize("family", FAMILIES, ids=lambda family: family.__name__)
def test_those_of_random_shapes_pass(family):
    for case in (0, 3):
        shape = small(family, 11 * case)
        size = float(np.ptp(as_polygons(shape).xy, axis=0).max()) or 1.0
        options = dict(OPTIONS[case % 2], side=("interior", "both")[case > 1])
        verify_skeleton(skeleton_approx(shape, **(options | {"step": size / 15})))


@pytest.mark.parametrize("connectivity", [4, 8])
def test_where_pixels_hang_together_cycles_through_corners_are_no_fault(connectivity):
    mask = np.zeros((14, 14), dtype=np.uint8)
    for row, column in ((1, 4), (4, 1), (4, 7), (7, 4)):
        mask[row : row + 3, column : column + 3] = 1
    outlines = vorotool.outlines(mask, connectivity=connectivity)
    for side in ("interior", "both"):
        verify_skeleton(skeleton_approx(outlines, step=0.5, complete=True, side=side))


def test_pruned_ones_pass():
    whole = skeleton_approx(SHAPES["ring"], tolerance=0.01)
    for threshold in ({"angle": 100}, {"scale": 1.3}, {"length": 1}):
        verify_skeleton(vorotool.prune(whole, **threshold))


def changed(skeleton, name, at, value):
    """The skeleton with another value in a column."""
    column = getattr(skeleton, name).copy()
    column[at] = value
    return replace(skeleton, **{name: column})


@pytest.mark.parametrize("features", few(["separate", "together"], 1))
@pytest.mark.parametrize("options", OPTIONS, ids=str)
@pytest.mark.parametrize("name", SHAPES)
def test_changed_ones_are_refused(name, options, features):
    made = skeleton_approx(SHAPES[name], features=features, **options)
    size, rng = float(np.ptp(made.polygons.xy, axis=0).max()), np.random.default_rng(1)
    for node in rng.choice(np.flatnonzero(made.radius > 0), 2).tolist():
        for factor in (0.999, 1.001):
            with pytest.raises(VerificationError, match="from the shapes, but its radius is"):
                verify_skeleton(changed(made, "radius", node, factor * made.radius[node]))
        turn = rng.random() * 2 * np.pi
        place = made.vertices[node] + size / 50 * np.array([np.cos(turn), np.sin(turn)])
        with pytest.raises(VerificationError):
            verify_skeleton(changed(made, "vertices", node, place))
    arc = int(rng.integers(len(made)))
    with pytest.raises(VerificationError, match=f"arc {arc} is outside, in polygon"):
        verify_skeleton(changed(made, "side", arc, 1))
    with pytest.raises(VerificationError, match=f"arc {arc} is a parabola"):
        verify_skeleton(changed(made, "control", arc, made.vertices[0]))


@pytest.mark.parametrize("options", OPTIONS, ids=str)
@pytest.mark.parametrize("name", ["room", "ring", "two"])
def test_bounds_that_are_too_small_are_refused(name, options):
    made = skeleton_approx(SHAPES[name], **options)
    with pytest.raises(VerificationError, match="beyond its bound"):
        verify_skeleton(replace(made, error_bound=made.error_bound / 16))


def with_arc(skeleton, ends):
    """The skeleton with one more straight arc, about which nothing is proved; each arc is a branch."""
    names = ("control", "sites", "polygon", "side", "length")
    columns = {name: np.concatenate([getattr(skeleton, name), getattr(skeleton, name)[:1]]) for name in names}
    count = len(skeleton) + 1
    return replace(
        skeleton,
        **columns,
        arcs=np.concatenate([skeleton.arcs, np.array([ends], dtype=np.int32)]),
        branch=np.arange(count, dtype=np.int32),
        error_bound=np.full(count, np.nan),
    )


def test_arcs_in_another_polygon_across_edges_and_around_nothing_are_refused(monkeypatch):
    made = skeleton_approx(SHAPES["two"], step=0.4)
    with pytest.raises(VerificationError, match="is not in polygon 1"):
        verify_skeleton(changed(made, "polygon", 0, 1))
    monkeypatch.setattr("vorotool.engines.skeleton.verify_skeleton.check_branches", lambda _: None)
    made = skeleton_approx(SHAPES["room"], step=0.4)
    first = int(np.flatnonzero((made.radius[made.arcs] > 0.5).all(axis=1))[0])
    with pytest.raises(VerificationError, match="in polygon 0 has 1 independent cycles, but at most 0"):
        verify_skeleton(with_arc(made, made.arcs[first]))
    legs = [[0, 0], [10, 0], [10, 8], [8, 8], [8, 2], [6, 2], [6, 8], [4, 8], [4, 2], [2, 2], [2, 8], [0, 8]]
    made = skeleton_approx(legs, step=0.4)
    outer = [int(np.square(made.vertices - place).sum(axis=1).argmin()) for place in ([1, 5], [9, 5])]
    with pytest.raises(VerificationError, match="meets edge"):
        verify_skeleton(with_arc(made, outer))
