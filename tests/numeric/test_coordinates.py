"""Coordinates of every kind: copied exactly, or refused in words."""

from fractions import Fraction

import numpy as np
import pytest

import vorotool
from vorotool.errors import InputError
from vorotool.types.points.point_set import PointSet

PAIRS = [[0, 0], [4, 0], [0, 3], [1, 1]]


def triangulated(points):
    return vorotool.delaunay(points).points


def tessellated(points):
    return vorotool.tessellate(points, shape=(4, 5)).seeds.sites


def skeletonized(points):
    return vorotool.skeleton_exact(points).polygons.xy


@pytest.mark.parametrize(
    ("values", "words"),
    [
        (np.ma.array(PAIRS, mask=[[0, 0], [0, 1], [0, 0], [0, 0]]), "are masked in part"),
        (np.array([[2**53 + 1, 0], [2**53, 0], [0, 1]]), "a double would round it"),
        (np.array([[2**64 - 1, 0], [2**53, 0], [0, 1]], dtype=np.uint64), "a double would round it"),
        ([[-(2**60) - 1, 0], [3, 1], [0, 1]], "a double would round it"),
        ([[10**400, 0], [3, 1], [0, 1]], "a double would round it"),
        ([[Fraction(10**400, 3), 0], [3, 1], [0, 1]], "must be finite"),
        ([[3, 1], [Fraction(1, 3), 0], [0, 1]], r"\[1\] is \(0.3333333333333333, 0\): a double would round it"),
        (np.array([[0, 0], [1, np.longdouble(2) ** -60 + 1]]), "\\[1\\] is .*: a double would round it"),
        (np.array([[0, 0], [1, np.longdouble(2) ** -60 + 1]], dtype=object), "\\[1\\] is .*: a double would round it"),
        (np.array(PAIRS, dtype=complex), "these have type complex128"),
        (np.array([["2020-01-01", "2020-01-02"]], dtype="M8[D]"), r"these have type datetime64"),
        ([["1", "2"], ["3", "4"]], "these have type <U1"),
        (np.array([["1", 1], [2, 3]], dtype=object), "these have type object"),
        (np.array([[None, 1], [2, 3]], dtype=object), "these have type object"),
    ],
)
def test_what_is_no_coordinate_is_refused(values, words):
    for take in (triangulated, tessellated, skeletonized):
        with pytest.raises(InputError, match=words.replace("2^", r"2\^")):
            take(values)


class TestMaskedImages:
    image = np.ma.array([[5, 5, 0], [0, 0, 7]], mask=[[1, 0, 0], [0, 0, 0]])

    def test_masked_pixels_are_background(self):
        assert vorotool.tessellate(vorotool.Raster(self.image)).seeds.labels.tolist() == [5, 7]
        assert vorotool.outlines(self.image).ids == [5, 7]
        assert vorotool.outlines(self.image).xy.min(axis=0).tolist() == [0.5, -0.5]

    def test_they_stay_so_when_foreground_is_exchanged(self):
        found = vorotool.seeds_from_raster(self.image, invert=True, mode="pixels")
        assert list(zip(found.x.tolist(), found.y.tolist(), strict=True)) == [(2, 0), (0, 1), (1, 1)]

    def test_they_do_not_count_for_a_threshold(self):
        image = np.ma.array([[200, 1, 1], [2, 9, 9]], mask=[[1, 0, 0], [0, 0, 0]])
        assert len(vorotool.seeds_from_raster(image, threshold="otsu", mode="pixels")) == 2

    def test_integers_of_values_are_not_masked(self):
        with pytest.raises(InputError, match="some are masked"):
            PointSet(PAIRS[:2], np.ma.array([1, 2], mask=[0, 1]))

    @pytest.mark.parametrize("masked", [True, False])
    def test_one_that_is_given_for_points_is_recognised(self, masked):
        image = np.zeros((20, 26), dtype=np.uint8)
        given = np.ma.masked_array(image, mask=np.eye(20, 26)) if masked else image
        with pytest.raises(InputError, match=r"^invalid points: .*shape \(20, 26\).*seeds_from_raster"):
            vorotool.delaunay(given)
        with pytest.warns(vorotool.VorotoolWarning, match="no foreground"):
            assert not vorotool.tessellate(given).labels.any()

    def test_points_in_space_are_no_image(self):
        with pytest.raises(InputError, match=r"shape \(9, 3\): points have two coordinates"):
            vorotool.voronoi(np.zeros((9, 3)))
