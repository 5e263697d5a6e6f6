"""Offsets of shapes beside the buffers of shapely."""

import sys
import warnings
from pathlib import Path

import numpy as np
import pytest

import vorotool
from vorotool.engines.skeleton_exact import shape_diagram

sys.path.insert(0, str(Path(__file__).parents[1]))
from offset_oracle import check_offsets
from skeleton_shapes import FAMILIES, TOUCHING


@pytest.mark.parametrize("family", [*FAMILIES, *TOUCHING], ids=lambda family: family.__name__)
def test_offsets_are_those_of_shapely(family):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        shapes = shape_diagram(family(np.random.default_rng(3)))
    polygons = shapes.placed.polygons
    extent = float(np.ptp(polygons.xy, axis=0).max()) or 1.0
    distances = [extent * part for part in (0.11, 0.03, -0.01, -0.04)]
    check_offsets(vorotool.offset(shapes, distances), distances)


def test_a_square_has_round_corners_outside():
    made = vorotool.offset([[0, 0], [4, 0], [4, 4], [0, 4]], [1.0, -1.0])
    assert sorted(made.area.tolist()) == pytest.approx([4.0, 32 + np.pi])


def test_what_has_vanished_is_not_there():
    made = vorotool.offset([[0, 0], [4, 0], [4, 2], [0, 2]], [-1.5])
    assert len(made.area) == 0
