"""A hole that reaches far beyond its shell makes the lattice coarse, which the checkers know."""

import warnings
from dataclasses import replace

import pytest

import vorotool
from vorotool.engines.offsets.verify_offsets import verify_offsets
from vorotool.errors import VerificationError, VorotoolWarning

SHAPE = {"shell": [[0, 0], [80, 0], [72, 60], [0, 56]], "holes": [[[20, 20], [20, 44], [50, 2**32]]]}


def quietly(make, *arguments, **options):
    with warnings.catch_warnings(action="ignore", category=VorotoolWarning):  # the hole is cut off
        return make([SHAPE], *arguments, **options)


@pytest.mark.parametrize("features", ["separate", "together"])
@pytest.mark.parametrize("side", ["interior", "both"])
@pytest.mark.parametrize("gap", [0, 1])
def test_skeletons_are_right(features, side, gap):
    skeleton = quietly(vorotool.skeleton_exact, features=features, side=side, gap=gap)
    vorotool.verify_skeleton(skeleton)
    radius = skeleton.radius.copy()
    radius[radius.argmax()] += 2.0**-15 if gap == 0 else 8.0  # 64 times what 2^31 is rounded by; two steps
    with pytest.raises(VerificationError):
        vorotool.verify_skeleton(replace(skeleton, radius=radius))


@pytest.mark.parametrize("features", ["separate", "together"])
@pytest.mark.parametrize("distances", [[-1], [1, -1]])
def test_offsets_are_right(features, distances):
    offsets = quietly(vorotool.offset, distances, features=features)
    verify_offsets(offsets, distances=distances)
