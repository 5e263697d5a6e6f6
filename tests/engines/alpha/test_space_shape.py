"""Alpha shapes of points in space: surfaces, measures, curves, the automatic radius, and the checker."""

from dataclasses import replace
from fractions import Fraction
from math import inf, sqrt

import gudhi
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import vorotool
from support.oracles.space_alpha_oracle import radii
from vorotool.engines.alpha.verify_alpha import check_surface

CUBE = np.array(list(np.ndindex(2, 2, 2)), dtype=float)
rng = np.random.default_rng(11)


def shell(count, inner, outer):
    """Points between two spheres."""
    places = rng.normal(size=(count, 3))
    return places / np.linalg.norm(places, axis=1)[:, None] * rng.uniform(inner, outer, (count, 1))


def ring(count):
    """Points near a circle."""
    turn = rng.uniform(0, 2 * np.pi, count)
    return np.c_[np.cos(turn), np.sin(turn), 0 * turn] + rng.uniform(-0.1, 0.1, (count, 3))


# ---- one shape -----------------------------------------------------------------------------------
def divergence(shape):
    """The volume that the surface encloses."""
    a, b, c = np.moveaxis(shape.points[shape.surface], 1, 0)
    return (a * np.cross(b, c)).sum() / 6


@pytest.mark.parametrize(
    "points", [rng.random((300, 3)), np.array(list(np.ndindex(5, 5, 5))) * 1.0, shell(300, 0.8, 1)]
)
def test_surfaces_are_closed_and_enclose_the_volume(points):
    family = vorotool.alpha_complex(points)
    for rank in np.linspace(0, len(family.spectrum) - 1, 7).astype(int).tolist():
        shape = vorotool.alpha_shape(family, r=family.radius_from(rank))
        assert shape.reached == rank + 1
        check_surface(shape)
        assert divergence(shape) == pytest.approx(shape.volume, rel=1e-12, abs=1e-14)
    assert shape.region_count == 1
    assert np.array_equal(vorotool.alpha_shape(family, r=inf).inside, shape.inside)


@given(st.lists(st.tuples(*[st.integers(0, 3)] * 3), min_size=5, max_size=9, unique=True), st.integers(1, 24))
@settings(max_examples=25)
def test_shapes_are_those_of_empty_balls(points, twelfths):
    r = Fraction(twelfths, 6)
    shape = vorotool.alpha_shape(np.array(points, float), r=r, allow_empty=True)
    vorotool.verify_alpha_shape(shape)
    for what in ("edges", "triangles"):
        corners = shape.family.simplices(what)
        classes = getattr(shape, f"{what[:-1]}_classes")
        expected = [sum(square <= r * r for square in row) for row in radii(points, corners.tolist())]
        assert classes.tolist() == expected
        assert np.array_equal(classes, shape.family.classes(what, r))


def test_a_radius_is_compared_exactly():
    family = vorotool.alpha_complex(CUBE)
    assert family.spectrum.tolist() == [0.5, sqrt(0.5), sqrt(0.75)]
    assert family.reached(0.5) == 1
    assert family.reached(np.nextafter(0.5, 0)) == 0
    root = Fraction(sqrt(0.75))
    assert family.reached(sqrt(0.75)) == (3 if root**2 >= Fraction(3, 4) else 2)
    assert family.reached(root + Fraction(1, 10**15)) == 3
    assert family.reached(inf) == 3
    assert vorotool.alpha_shape(CUBE, alpha=-2).r == 0.5


def test_singular_parts_are_told_apart():
    points = [[0, 0, 0], [2, 0, 0], [0, 2, 0], [9, 0, 0], [11, 0, 0], [30, 0, 0], [0, 0, 40]]
    shape = vorotool.alpha_shape(points, r=1.5)
    assert (len(shape.surface), shape.singular.tolist(), shape.singular_edges.tolist()) == (0, [[0, 2, 1]], [[3, 4]])
    assert shape.isolated.tolist() == [5, 6]
    assert (shape.part_count, shape.cavity_count, shape.tunnel_count, shape.euler) == (4, 0, 0, 4)


def test_cavities_and_tunnels():
    hollow = vorotool.alpha_shape(shell(900, 0.9, 1), r=0.4)
    assert (hollow.part_count, hollow.cavity_count, hollow.tunnel_count) == (1, 1, 0)
    bored = vorotool.alpha_shape(ring(400), r=0.3)
    assert (bored.part_count, bored.cavity_count, bored.tunnel_count) == (1, 0, 1)


def test_the_automatic_radius_is_the_smallest():
    points = np.concatenate([rng.random((80, 3)), rng.random((80, 3)) + np.array([3, 0, 0])])
    for regions in (1, 2):
        shape = vorotool.alpha_shape(points, regions=regions)
        assert shape.region_count <= regions
        assert set(shape.tetrahedra.reshape(-1).tolist()) == set(range(160))
        below = vorotool.alpha_shape(shape.family, r=shape.family.radius_from(shape.reached - 2))
        covers = set(below.tetrahedra.reshape(-1).tolist()) == set(range(160))
        assert not covers or below.region_count > regions


# ---- all radii -----------------------------------------------------------------------------------
@pytest.mark.parametrize("points", [rng.integers(0, 5, (40, 3)) * 1.0, rng.random((25, 3)), shell(60, 0.9, 1)])
@pytest.mark.filterwarnings("ignore:.*earlier point")
def test_curves_are_the_measures_of_all_shapes(points):
    family = vorotool.alpha_complex(points)
    curves = vorotool.alpha_curves(family)
    assert list(curves) == ["r", "volume", "area", "regions", "parts", "cavities", "tunnels"]
    for rank in range(0, len(family.spectrum), 1 + len(family.spectrum) // 40):
        shape = vorotool.alpha_shape(family, r=family.radius_from(rank))
        row = {name: curves[name][rank] for name in curves}
        counts = {"regions": shape.region_count, "parts": shape.part_count, "cavities": shape.cavity_count}
        assert {name: row[name] for name in counts} == counts
        assert row["tunnels"] == shape.tunnel_count
        assert (row["volume"], row["area"]) == pytest.approx((shape.volume, shape.area), rel=1e-12, abs=1e-13)


@pytest.mark.parametrize(
    "points", [rng.random((400, 3)), np.array(list(np.ndindex(4, 4, 4))) * 1.0, shell(200, 0.9, 1)]
)
def test_gudhi_has_the_same_values_and_betti_numbers(points):
    """Of cospherical points it may have other tetrahedra: there only the numbers are compared."""
    tree = gudhi.AlphaComplex(points=points, precision="exact").create_simplex_tree()
    values = {tuple(simplex): value for simplex, value in tree.get_filtration()}
    family = vorotool.alpha_complex(points)
    if len(set(map(tuple, points.tolist()))) != 64:
        for what in ("edges", "triangles", "tetrahedra"):
            squares = family.radii(what)[:, 0] ** 2
            expected = [values[tuple(sorted(row))] for row in family.simplices(what).tolist()]
            assert len(expected) == sum(
                len(simplex) == len(row) for simplex in values for row in [family.simplices(what)[0]]
            )
            np.testing.assert_allclose(squares, expected, rtol=1e-9)
    tree.compute_persistence()
    curves = vorotool.alpha_curves(family)
    for rank in np.linspace(0, len(family.spectrum) - 1, 9).astype(int).tolist():
        square = family.spectrum[rank] ** 2 * (1 + 1e-12)
        betti = [*tree.persistent_betti_numbers(square, square), 0, 0][:3]
        assert betti == [curves["parts"][rank], curves["tunnels"][rank], curves["cavities"][rank]]


# ---- few points, and what is refused -------------------------------------------------------------
def test_points_in_a_plane_have_singular_parts_only():
    flat = np.c_[rng.random((20, 2)), np.ones(20)]
    plane = vorotool.alpha_complex(flat[:, :2])
    family = vorotool.alpha_complex(flat)
    r = float(plane.spectrum[len(plane.spectrum) // 2])
    shape = vorotool.alpha_shape(family, r=r)
    assert (shape.volume, len(shape.surface), shape.region_count) == (0, 0, 0)
    assert len(shape.singular) == (plane.triangle_rank < plane.reached(r)).sum()
    vorotool.verify_alpha_shape(shape)
    with pytest.raises(vorotool.InputError, match=r"20 points in a plane span no tetrahedron"):
        vorotool.alpha_shape(family)
    with pytest.warns(vorotool.VorotoolWarning, match="the shape is empty"):
        assert vorotool.alpha_shape(family, allow_empty=True).isolated.tolist() == list(range(20))


def test_few_points_are_refused_or_empty():
    with pytest.raises(vorotool.InputError, match="needs at least two distinct points, but got 1 point"):
        vorotool.alpha_shape([[1, 2, 3]])
    two = vorotool.alpha_shape([[0, 0, 0], [0, 0, 2]], r=1)
    assert (two.edges.tolist(), two.part_count) == ([[0, 1]], 1)
    vorotool.verify_alpha_shape(two)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"rule": "printed"}, "rule='printed' is for points in the plane"),
        ({"hole_threshold": 2}, "hole_threshold=2 is for points in the plane"),
        ({"r": 1, "regions": 2}, "regions applies to the automatic radius"),
        ({"r": -1}, "a radius must be positive"),
        ({"r": 1, "alpha": -1}, "r and alpha each set the radius"),
    ],
)
def test_what_is_of_the_plane_is_refused(given, message):
    with pytest.raises(vorotool.UsageError, match=message):
        vorotool.alpha_shape(CUBE, **given)
    with pytest.raises(vorotool.UsageError, match="expected points, edges, triangles, tetrahedra"):
        vorotool.alpha_complex(CUBE).radii("faces")
    for points in (CUBE, vorotool.delaunay(CUBE), vorotool.alpha_complex(CUBE)):
        with pytest.raises(vorotool.InputError, match="persistence needs points in the plane; alpha_curves counts"):
            vorotool.persistence(points)


# ---- the checker ---------------------------------------------------------------------------------
@pytest.mark.parametrize(
    "points", [rng.random((200, 3)), CUBE, np.array(list(np.ndindex(4, 4, 4))) * 0.1, shell(100, 1, 1), CUBE * 1e-200]
)
def test_what_is_computed_passes(points):
    family = vorotool.alpha_complex(points)
    for rank in {0, len(family.spectrum) // 2, len(family.spectrum) - 1}:
        vorotool.verify_alpha_shape(vorotool.alpha_shape(family, r=family.radius_from(rank)))


def test_faults_are_found():
    points = rng.random((60, 3))
    shape = vorotool.alpha_shape(points, r=0.25)
    family = shape.family

    def fails(message, changed):
        with pytest.raises(vorotool.VerificationError, match=message):
            vorotool.verify_alpha_shape(changed)

    first = int(np.argmax(shape.inside))
    region = shape.region.copy()
    region[first] = -1
    fails(f"tetrahedron {first} is not in the shape, but its circumradius is at most r", replace(shape, region=region))
    fails("is in the shape, but its circumradius is greater than r", replace(shape, r=0.2))
    region = np.where(shape.region >= 0, 5, -1).astype(np.int32)
    fails("regions, but 6 are numbered", replace(shape, region=region))
    for name, message in (("triangle_min", "triangle .* is .*, but should be"), ("edge_min", "edge .* but should be")):
        ranks = getattr(family, name).copy()
        k = int(np.argmin(np.where(ranks < shape.reached, ranks, len(family.spectrum))))
        ranks[k] = len(family.spectrum) - 1
        fails(message, replace(shape, family=replace(family, **{name: ranks})))
    edges = family.edges[::-1].copy()
    edges[0] = edges[1]
    fails("the edges are not those of the triangulation", replace(shape, family=replace(family, edges=edges)))
