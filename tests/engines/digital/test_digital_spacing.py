"""Triangulations read off tessellations of rectangular pixels."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

import vorotool
from vorotool.engines.digital.triangulation import digital_triangulation, repair_digital
from vorotool.engines.digital.verify_digital import verify_digital_triangulation
from vorotool.errors import UsageError, VerificationError
from vorotool.types.spacing import pixel_sides

SPACINGS = [(1.5, 0.325), (2, 3), (Fraction(1, 3), 1), 0.25]
SHAPE = (40, 30)


def points_of(seed, count=25):
    return np.unique(np.random.default_rng(seed).integers(0, 30, (count, 2)), axis=0)


@pytest.mark.parametrize("spacing", SPACINGS)
@pytest.mark.parametrize("seed", range(4))
def test_edges_are_those_of_neighboring_regions(seed, spacing):
    points = points_of(seed)
    found = digital_triangulation(points, shape=SHAPE, spacing=spacing)
    image = vorotool.tessellate(points, shape=SHAPE, spacing=spacing)
    borders = vorotool.neighbor_table(image)
    assert found.labels[found.edges].tolist() == np.stack([borders["label_a"], borders["label_b"]], axis=1).tolist()
    assert np.allclose(found.edge_lengths(), borders["centroid_distance"])
    height, width = map(float, pixel_sides(spacing).lengths)
    assert np.allclose(found.points, points * (width, height))
    again = digital_triangulation(image)
    assert np.array_equal(again.points, found.points)
    assert np.array_equal(again.triangles, found.triangles)
    verify_digital_triangulation(found, points, shape=SHAPE, spacing=spacing)
    with pytest.raises(VerificationError):
        verify_digital_triangulation(replace(found, edges=found.edges[1:]), points, shape=SHAPE, spacing=spacing)


@pytest.mark.parametrize("spacing", SPACINGS)
@pytest.mark.parametrize("seed", range(4))
def test_the_repair_gives_the_triangulation_of_the_places_in_the_unit(seed, spacing):
    points, sides = points_of(seed), pixel_sides(spacing)
    mesh, repair = repair_digital(points, shape=SHAPE, spacing=spacing)
    exact = vorotool.delaunay(points * (sides.x, sides.y))
    assert np.array_equal(mesh.triangles, exact.triangles)
    assert np.array_equal(mesh.edges, exact.edges)
    assert np.array_equal(mesh.points, exact.points * sides.step.numerator / sides.step.denominator)
    assert (repair.route, repair.fault) == ("repaired", None)


def test_a_label_image_has_its_own_spacing():
    image = vorotool.tessellate(points_of(1), shape=SHAPE, spacing=(1, 2))
    assert digital_triangulation(image, spacing=(1, 2)) == digital_triangulation(image)
    with pytest.raises(UsageError, match=r"label image, \(1, 2\): leave it out"):
        digital_triangulation(image, spacing=2)
