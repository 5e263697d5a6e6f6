"""Pruned skeletons and centerlines: beside brute force, nested, connected."""

import networkx
import numpy as np
import pytest

import vorotool
from support.readers.written import differing
from vorotool.engines.pruning import pruning
from vorotool.engines.pruning.pruning import independent_parts
from vorotool.errors import UsageError

COMB = [[0, 0], [30, 0], [30, 6], [26, 6], [26, 12], [24, 12], [24, 6], [6, 6], [6, 9], [4, 9], [4, 6], [0, 6]]


@pytest.mark.parametrize("criterion", ["angle", "chord", "scale", "length", "ratio"])
def test_what_is_left_is_a_connected_part(criterion):
    whole = vorotool.skeleton_exact(COMB)
    lengths = []
    for threshold in (1.5, 3.0, 20.0):
        left = vorotool.prune(whole, **{criterion: threshold})
        vorotool.verify_pruning(left, whole)
        assert networkx.is_connected(left.to_networkx())
        lengths.append(left.length.sum())
    assert lengths == sorted(lengths, reverse=True)
    assert lengths[0] <= whole.length.sum()


def test_one_criterion_is_needed():
    whole = vorotool.skeleton_exact(COMB)
    for options in ({}, {"angle": 20, "scale": 1.5}, {"angle": 200}, {"scale": 0.5}, {"length": -1}):
        with pytest.raises(UsageError):
            vorotool.prune(whole, **options)


@pytest.mark.parametrize(
    ("criterion", "threads"), [("angle", 1), ("chord", 2), ("scale", 1), ("scale", 2), ("length", 1), ("ratio", 2)]
)
def test_parts_have_what_the_whole_has(criterion, threads, monkeypatch):
    random = np.random.default_rng(5)
    polygons = vorotool.outlines(random.integers(0, 3, (24, 24)), mode="labels", connectivity=4)
    for side in ("interior", "exterior", "both"):
        whole = vorotool.skeleton_exact(polygons, side=side)
        group = np.where(whole.polygon < 0, len(polygons), whole.polygon)
        for threshold in (1.1, 1.5, 100.0):
            assert len(independent_parts(whole, group)) == 1
            expected = vorotool.prune(whole, **{criterion: threshold})
            with monkeypatch.context() as patch:
                patch.setattr(pruning, "PART", 50)
                assert side == "exterior" or len(independent_parts(whole, group)) > 5
                assert differing(vorotool.prune(whole, **{criterion: threshold}, threads=threads), expected) == []
