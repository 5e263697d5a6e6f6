"""Results in other units: what was decided stays."""

from fractions import Fraction

import numpy as np
import pytest

import vorotool
from vorotool import UsageError
from vorotool.types.scaling import scaled, scaled_table
from vorotool.types.table import Table

THIRD = Fraction(1, 3)


def test_ties_are_decided_as_before():
    """A third of a lattice is no lattice: what was cocircular stays so."""
    lattice = np.array([[x, y] for x in range(5) for y in range(5)], dtype=float)
    mesh = vorotool.delaunay(lattice)
    found = scaled(mesh, THIRD)
    assert found.triangles is mesh.triangles
    assert np.array_equal(found.points, lattice / 3)


def test_skeletons_with_frame():
    skeleton = vorotool.skeleton_exact([[0, 0], [9, 0], [9, 9], [5, 3], [0, 9]], side="both", frame=(-3, -3, 15, 15))
    found = scaled(skeleton, THIRD)
    assert np.allclose(found.frame, np.array(skeleton.frame) / 3, rtol=1e-15)
    assert np.array_equal(found.on_frame, skeleton.on_frame)
    assert np.allclose(found.length, skeleton.length / 3, rtol=1e-15)
    assert np.array_equal(np.isnan(found.control), np.isnan(skeleton.control))


def test_missing_fields_stay_missing():
    table = scaled_table(Table({"x": np.ma.array([3.0, 0], mask=[False, True]), "area": [9, 18]}), THIRD)
    assert table["x"].tolist() == [1.0, None]
    assert table["area"].tolist() == [1.0, 2.0]


def test_what_has_no_size():
    with pytest.raises(UsageError, match="a list cannot be scaled"):
        scaled([1, 2], THIRD)
