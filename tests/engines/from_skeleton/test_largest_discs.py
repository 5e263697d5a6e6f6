"""The largest discs inside polygons and between shapes: closed forms, brute force, and faults that the checker sees."""

from dataclasses import replace

import numpy as np
import pytest
import shapely

import vorotool
from fuzz.discs import check_greedy
from support.families.skeleton_shapes import regular
from vorotool import InputError, VerificationError, largest_discs, largest_empty_discs, verify_discs


def rectangle(width, height, x=0.0, y=0.0):
    return np.array([[x, y], [x + width, y], [x + width, y + height], [x, y + height]])


# ---- closed forms --------------------------------------------------------------------------------
@pytest.mark.parametrize(("width", "height"), [(4, 4), (9, 2), (2, 9), (1e6, 3), (0.75, 0.125)])
def test_of_a_rectangle_the_middle(width, height):
    discs = largest_discs(rectangle(width, height, -1.5, 7.25))
    np.testing.assert_allclose(discs.xy, [[-1.5 + width / 2, 7.25 + height / 2]], rtol=1e-15)
    np.testing.assert_allclose(discs.radius, [min(width, height) / 2], rtol=1e-15)
    assert np.diff(discs.foot_starts).tolist() == [4 if width == height else 2]


def test_of_triangles_the_incircle():
    for seed in range(40):
        corners = np.random.default_rng(seed).uniform(-100, 100, (3, 2))
        sides = np.sqrt(np.square(np.roll(corners, -1, axis=0) - corners).sum(axis=1))
        area = abs(np.linalg.det(np.column_stack([corners, np.ones(3)]))) / 2
        center = (np.roll(sides, -1)[:, None] * corners).sum(axis=0) / sides.sum()
        discs = largest_discs(corners)
        # corners are on a lattice of 31 bits
        np.testing.assert_allclose(discs.radius, [2 * area / sides.sum()], rtol=1e-6)
        np.testing.assert_allclose(discs.xy, [center], atol=1e-5)
        assert len(discs.feet) == 3


@pytest.mark.parametrize("count", [3, 5, 8, 64, 360])
def test_of_regular_polygons_the_apothem(count):
    discs = largest_discs(regular(count))
    np.testing.assert_allclose(discs.radius, [1000 * np.cos(np.pi / count)], rtol=1e-8)
    np.testing.assert_allclose(discs.xy, [[0, 0]], atol=1e-3)


def test_features_each_have_their_own():
    parts = shapely.MultiPolygon([shapely.box(0, 0, 2, 2), shapely.box(5, 0, 9, 4)])
    discs = largest_discs([parts, shapely.box(1, 1, 4, 4)], count=2)
    assert discs.polygon.tolist() == [1, 0, 2, 2]
    assert discs.radius[:3].tolist() == [2.0, 1.0, 1.5]
    verify_discs(discs)


@pytest.mark.filterwarnings("ignore::vorotool.VorotoolWarning")
def test_features_together_bound_each_other():
    together = largest_discs([shapely.box(0, 0, 4, 4), shapely.box(2, 0, 4, 4)], features="together")
    assert together.features == "together"
    verify_discs(together)


@pytest.mark.filterwarnings("ignore::vorotool.VorotoolWarning")
def test_dense_packing_against_samples():
    check_greedy(vorotool.skeleton_exact(regular(7)), count=25)


# ---- empty discs ---------------------------------------------------------------------------------
def test_empty_discs_between_points_by_brute_force():
    places = np.stack(np.meshgrid(*[np.linspace(0, 40, 161)] * 2), axis=-1).reshape(-1, 2)
    for seed in range(6):
        points = np.random.default_rng(seed).integers(0, 40, (15, 2)).astype(float)
        discs = largest_empty_discs(points, within=(0, 0, 40, 40), count=3)
        most = np.sqrt(np.square(places[:, None] - points).sum(axis=-1)).min(axis=1).max()
        assert most - 1e-9 <= discs.radius[0] <= most + 0.25
        verify_discs(discs)


# ---- refusals, faults ----------------------------------------------------------------------------
def test_what_is_no_region():
    with pytest.raises(InputError, match="within"):
        largest_empty_discs([[0, 0]], within=(0, 0, -1, 1))
    with pytest.raises(InputError, match="no area"):
        largest_empty_discs([[0, 0]], within="LINESTRING (0 0, 1 0)")


def test_the_checker_sees_faults():
    discs = largest_discs([rectangle(8, 4), rectangle(3, 3, 10, 10)], count=3)
    verify_discs(discs)
    shifted = discs.xy + np.array([0.01, 0])
    faults = {
        "off its circle": {"xy": shifted},
        "rank": {"rank": discs.rank[::-1].copy()},
        "foot": {"feet": discs.feet + 0.01},
        "larger": {"radius": discs.radius[::-1].copy(), "feet": discs.feet},
        "in no polygon": {"polygon": np.full(len(discs), -1)},
    }
    for said, changed in faults.items():
        with pytest.raises(VerificationError, match="foot" if said == "larger" else said):
            verify_discs(replace(discs, **changed))


def test_the_checker_sees_that_a_larger_one_fits():
    small = largest_discs(rectangle(9, 2))
    shape = {"shell": [[0, 0], [9, 0], [9, 2], [20, 2], [20, 13], [9, 13], [9, 2.5], [0, 2.5]]}
    whole = largest_discs(shape, local=True)
    other = np.flatnonzero(whole.radius < whole.radius[0])[:1]
    assert len(other) or len(small)
    feet = np.concatenate([whole.feet_of(int(k)) for k in other])
    sites = np.concatenate([whole.foot_site[slice(*whole.foot_starts[[k, k + 1]])] for k in other])
    alone = replace(
        whole,
        xy=whole.xy[other],
        radius=whole.radius[other],
        polygon=whole.polygon[other],
        rank=np.array([1]),
        foot_starts=np.array([0, len(feet)]),
        feet=feet,
        foot_site=sites,
    )
    with pytest.raises(VerificationError, match="a disc of radius"):
        verify_discs(alone)
