"""Skeletons with a gap inside features: each is what it would be if there were no others."""

from dataclasses import replace

import numpy as np
import pytest

import vorotool
from fuzz import features as fuzz
from support.few import few
from support.readers.written import ARCS, differing
from vorotool.engines.skeleton.diagrams import feature_elements
from vorotool.errors import VerificationError, VorotoolWarning

EXACT = [name for name in ARCS if name not in ("polygon", "error_bound")]
OUTER = [[0, 0], [20, 0], [20, 20], [0, 20]]
INNER = [[6, 6], [14, 6], [14, 14], [6, 14]]
ACROSS = [[-4, 8], [30, 8], [30, 11], [-4, 11]]


@pytest.mark.parametrize("family", [fuzz.tiles, fuzz.nested, fuzz.parts, fuzz.scattered])
@pytest.mark.parametrize("seed", few(range(4), 1))
@pytest.mark.filterwarnings("ignore::vorotool.errors.VorotoolWarning")
def test_features_of_any_family_are_what_they_are_alone(family, seed):
    polygons = fuzz.as_set(family(np.random.default_rng(seed)))
    count = int(polygons.feature.max())
    gap = 2.0**-20 * float(np.ptp(polygons.xy))
    made = feature_elements(polygons, gap, threads=2).skeleton
    for feature in range(min(count, 12)):
        given = fuzz.chosen(polygons, [feature, count])
        alone = feature_elements(given, gap, threads=1).skeleton
        assert fuzz.differing(fuzz.inside_of(made, feature, polygons), fuzz.inside_of(alone, 0, given)) is None


@pytest.mark.parametrize("complete", [True, False])
@pytest.mark.parametrize("family", [fuzz.tiles, fuzz.nested, fuzz.parts, fuzz.scattered])
@pytest.mark.filterwarnings("ignore::vorotool.errors.VorotoolWarning")
def test_batches_of_features_are_what_each_is_by_itself(family, complete):
    polygons = fuzz.as_set(family(np.random.default_rng(7)))
    gap = 2.0**-20 * float(np.ptp(polygons.xy))
    batches = feature_elements(polygons, gap, complete=complete).skeleton
    one_by_one = feature_elements(polygons, gap, complete=complete, look=lambda *_: None).skeleton
    assert differing(batches, one_by_one, EXACT) == []
    assert batches.features == one_by_one.features == "separate"


@pytest.mark.parametrize("side", ["interior", "exterior", "both"])
@pytest.mark.parametrize("complete", [True, False])
def test_the_checker_passes_features_over_each_other(side, complete):
    shapes = [OUTER, INNER, ACROSS]
    made = vorotool.skeleton_exact(shapes, gap=0.25, side=side, complete=complete, strict=True)
    vorotool.verify_skeleton(made)
    assert set(made.polygon.tolist()) == {"interior": {0, 1, 2}, "exterior": {-1}, "both": {-1, 0, 1, 2}}[side]
    with pytest.warns(VorotoolWarning, match="crossings"):
        drawing = vorotool.skeleton_exact(shapes, gap=0.25, side=side, complete=complete, features="together")
    vorotool.verify_skeleton(drawing)


def test_the_checker_refuses_what_is_between_features():
    made = vorotool.skeleton_exact([OUTER, INNER], gap=0.25, features="together")
    with pytest.raises(VerificationError, match="another feature"):
        vorotool.verify_skeleton(replace(made, features="separate"))
