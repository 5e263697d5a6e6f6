"""Strokes of pixels that are cut obliquely: centerlines end in the middle of the cut, without hooks."""

import numpy as np
import pytest

import vorotool


def stroke(step):
    """60 rows of 16 pixels, shifted by a step a row."""
    mask = np.zeros((60, 20 + 60), dtype=bool)
    for row in range(60):
        first = int(row * step) if step > 0 else int(60 + row * step)
        mask[row, first : first + 16] = True
    return mask


def line_of(mask, **options):
    return vorotool.centerline(vorotool.prune(vorotool.skeleton_exact(vorotool.outlines(mask)), scale=1.5), **options)


@pytest.mark.parametrize("step", [0, 0.1, 0.15, 0.2, 0.25, 0.5, 1, -0.1, -0.15, -0.2, -0.25, -0.5, -1])
def test_a_stroke_ends_in_the_middle_of_its_cut(step):
    mask = stroke(step)
    places = line_of(mask).flattened(0.01)[0]
    expected = sorted([np.flatnonzero(mask[row]).mean(), end] for row, end in ((0, -0.5), (59, 59.5)))
    assert sorted(places[[0, -1]].tolist()) == expected


def test_hooks_are_what_other_ends_have():
    assert line_of(stroke(1)).length[0] < line_of(stroke(1), ends="corner").length[0]
