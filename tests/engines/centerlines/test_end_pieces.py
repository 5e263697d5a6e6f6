"""No branch is lost when skeletons are led on to their ends: discs with stems, balls at their ends, letters."""

import numpy as np
import pytest
import shapely

import vorotool
from support.families.stems import disc_with_stems, letter, lines_of, lost, mask_of
from support.few import few
from vorotool.engines.centerlines.end_pieces import TIP

DISC = [(40, 0), (28, 28), (8, 36), (8, 80), (-8, 80), (-8, 36), (-28, 28), (-40, 0), (-28, -28), (0, -40), (28, -28)]


def extended_of(shape):
    """The pruned skeleton of a shape or a mask, and the one that is led on, which is checked."""
    polygons = vorotool.outlines(shape) if isinstance(shape, np.ndarray) else shape
    pruned = vorotool.prune(vorotool.skeleton_exact(polygons), scale=1.5)
    extended = vorotool.extend_ends(pruned)
    vorotool.verify_extended(extended, pruned)
    return pruned, extended


@pytest.mark.parametrize("seed", few(range(12), 5))
def test_stems_of_discs_are_kept(seed):
    shape, stems = disc_with_stems(np.random.default_rng(seed))
    mask, corner = mask_of(shape)
    for pruned, extended in (extended_of(shape), extended_of(mask)):
        before, after = lines_of(pruned), shapely.union_all(extended.to_shapely(flatten=0.01))
        for place, width in stems:
            at = shapely.Point(place if pruned.polygons.connectivity is None else place - corner)
            assert after.distance(at) <= max(width / 2, before.distance(at) + 0.02)
        assert lost(pruned, extended) == []


@pytest.mark.parametrize("seed", few(range(9), 4))
def test_letters_keep_their_strokes(seed):
    pytest.importorskip("matplotlib")
    _, shape = letter(np.random.default_rng(seed), (24, 60, 150)[seed % 3])
    assert lost(*extended_of(shape)) == []
    assert lost(*extended_of(mask_of(shape)[0])) == []


def test_a_ball_beyond_a_narrow_neck_is_kept():
    ball = shapely.Point(0, 0).buffer(40) | shapely.Point(58, 0).buffer(20) | shapely.box(0, -1, 58, 1)
    pruned, extended = extended_of(ball)
    assert lines_of(extended.path).distance(shapely.Point(58, 0)) < 1
    assert lost(pruned, extended) == []


def test_the_checker_notices_a_branch_that_is_missing():
    pruned = vorotool.prune(vorotool.skeleton_exact(DISC), scale=1.5)
    few = vorotool.prune(pruned, scale=TIP)
    with pytest.raises(vorotool.VerificationError, match="a branch is missing: it continues for 36 from"):
        vorotool.verify_extended(vorotool.ExtendedSkeleton(few, np.full((1, 2, 2), np.nan)), pruned)
