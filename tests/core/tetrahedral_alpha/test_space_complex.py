"""Radii of simplices of points in space against empty balls in fractions."""

from math import inf, isfinite, sqrt

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from support.oracles.space_alpha_oracle import radii
from vorotool import _core, delaunay
from vorotool.types.mesh.tetrahedralization import FACES


def complex_of(points, threads=1):
    mesh = delaunay(np.asarray(points, dtype=np.float64))
    chain = mesh.edges if mesh.dimension == 1 else np.empty((0, 2), np.int32)
    return mesh, _core.tetrahedral_alpha.space_complex(
        mesh.points, mesh.tetrahedra, mesh.neighbors, mesh.planar, chain, threads, None
    )


def ranks_of(mesh, found):
    """All simplices of a complex with their three ranks."""
    last = len(found["spectrum"])
    of_tetrahedra = np.append(found["tetrahedron_rank"], last)
    if len(mesh):
        t, k = np.divmod(found["facet"], 4)
        triangles = mesh.tetrahedra[t[:, None], FACES[k]]
        sides = np.sort([of_tetrahedra[t], of_tetrahedra[mesh.neighbors[t, k]]], axis=0)
    else:
        triangles = mesh.planar
        sides = np.full((2, len(triangles)), last)
    yield mesh.tetrahedra, np.stack([found["tetrahedron_rank"]] * 3, axis=1)
    yield triangles, np.stack([found["triangle_min"], *sides], axis=1)
    yield found["edges"], np.stack([found["edge_min"], found["edge_mid"], found["edge_max"]], axis=1)


def check(points):
    mesh, found = complex_of(points)
    simplices, ranks = zip(*ranks_of(mesh, found), strict=True)
    points = np.asarray(points, dtype=np.float64).tolist()
    expected = [square for rows in simplices for square in radii(points, rows.tolist())]
    assert None not in expected
    spectrum = sorted({square for each in expected for square in each if square != inf})
    place = {square: k for k, square in enumerate([*spectrum, inf])}
    assert len(found["spectrum"]) == len(spectrum)
    assert [tuple(place[square] for square in each) for each in expected] == [
        tuple(row) for each in ranks for row in each.tolist()
    ]
    assert (np.diff(found["spectrum"]) >= 0).all()
    for radius, square in zip(found["spectrum"].tolist(), spectrum, strict=True):
        if 2.0**-900 < square < 2.0**900:
            assert radius == pytest.approx(sqrt(square), rel=2.0**-40)
    items = [row for each in simplices for row in each.tolist()]
    for rank, item in enumerate(found["witness"].tolist()):
        assert radii(points, [items[item]])[0][0] == spectrum[rank]
    return mesh, found


def distinct(coordinates, least, most):
    return st.lists(st.tuples(*[coordinates] * 3), min_size=least, max_size=most, unique=True)


@given(distinct(st.integers(0, 2), 2, 14))
@settings(max_examples=25)
def test_lattices_of_few_points(points):
    check(points)


def test_the_lattice_of_27_points():
    _mesh, found = check([(x, y, z) for x in range(3) for y in range(3) for z in range(3)])
    assert found["spectrum"].tolist() == [0.5, sqrt(0.5), sqrt(0.75)]
    assert (found["tetrahedron_rank"] == 2).all()


@given(distinct(st.integers(-1000, 1000), 5, 9))
@settings(max_examples=15)
def test_random_integers(points):
    check(points)


@given(distinct(st.floats(-1, 1), 5, 8))
@settings(max_examples=15)
def test_doubles(points):
    check(points)


@given(distinct(st.sampled_from([0.1 * k for k in range(4)]), 5, 9))
@settings(max_examples=12)
def test_almost_lattices(points):
    """Multiples of a tenth are nearly on a lattice: many radii differ in their last bits only."""
    check(points)


@given(
    distinct(st.integers(-3, 3), 5, 8),
    st.sampled_from([2.0**-1074, 2.0**-1050, 2.0**-600, 2.0**500, 2.0**1010]),
    st.booleans(),
)
@settings(max_examples=12)
def test_tiny_and_huge_ones(points, scale, is_mixed):
    check(np.array(points) * scale + (np.arange(3 * len(points)).reshape(-1, 3) % 7 == 3) * is_mixed)


@pytest.mark.parametrize("scale", [1, 0.1])
def test_points_of_a_sphere(scale):
    """Integer points at a distance of 3 from one place."""
    points = [p for p in np.ndindex(7, 7, 7) if sum((x - 3) ** 2 for x in p) == 9][::2]
    _mesh, found = check(np.array(points) * float(scale))
    assert scale != 1 or len(set(found["tetrahedron_rank"].tolist())) == 1


def test_flat_ones_are_those_of_the_plane():
    rng = np.random.default_rng(5)
    xy = rng.integers(0, 20, (40, 2)).astype(float)
    from vorotool import alpha_complex

    plane = alpha_complex(xy)
    for turned in (np.c_[xy, 0 * xy[:, 0]], np.c_[0 * xy[:, 0], xy], np.c_[xy, xy[:, 0]][:, [0, 2, 1]] * [0.5, 0.5, 1]):
        mesh, found = complex_of(turned)
        assert len(found["triangle_min"]) == len(mesh.planar) == len(plane.mesh.triangles)
        assert (found["edge_mid"] == len(found["spectrum"])).all()
        if (turned[:, 2] == 0).all():
            expected = {tuple(e): r for e, r in zip(plane.edges.tolist(), plane.r_min.tolist(), strict=True)}
            got = dict(zip(map(tuple, found["edges"].tolist()), found["spectrum"][found["edge_min"]], strict=True))
            assert expected == pytest.approx(got, rel=1e-14)
    check(np.c_[xy[:9], 0 * xy[:9, 0]])


def test_points_on_a_line_and_fewer():
    _, found = check([(0, 0, 0), (4, 4, 0), (1, 1, 0)])
    assert found["spectrum"].tolist() == [sqrt(0.5), sqrt(4.5)]
    for few in ([], [(1, 2, 3)]):
        _, found = complex_of(np.reshape(few, (-1, 3)))
        assert len(found["edges"]) == len(found["spectrum"]) == 0


@pytest.mark.parametrize("kind", ["uniform", "lattice", "tenths"])
def test_threads_and_order_of_points_change_nothing(kind):
    rng = np.random.default_rng(3)
    points = {"uniform": rng.random((9000, 3)), "lattice": np.array(list(np.ndindex(20, 20, 20)), float)}.get(
        kind, np.array(list(np.ndindex(14, 14, 14))) * 0.1
    )
    _, one = complex_of(points)
    _, four = complex_of(points, threads=4)
    for name, values in one.items():
        assert np.array_equal(values, four[name]), name
    order = rng.permutation(len(points))
    _, permuted = complex_of(points[order])
    for name in ("tetrahedron_rank", "facet", "triangle_min", "edge_min", "edge_mid", "edge_max", "spectrum"):
        assert np.array_equal(one[name], permuted[name]), name
    assert isfinite(one["spectrum"][-1])
    assert np.array_equal(np.sort(one["edges"]), np.sort(order[permuted["edges"]]))


@pytest.mark.parametrize("decimals", [16, 1])
def test_progress_never_goes_back(decimals):
    points = np.unique(np.round(3 * np.random.default_rng(8).random((30_000, 3)), decimals), axis=0)
    mesh, fractions = delaunay(points), []
    cells = mesh.points, mesh.tetrahedra, mesh.neighbors, mesh.planar, np.empty((0, 2), np.int32)
    _core.tetrahedral_alpha.space_complex(*cells, 1, fractions.append)
    assert fractions == sorted(fractions)
    assert all(0 <= fraction <= 1 for fraction in fractions)


def test_edges_of_a_vertex_with_very_many():
    """A center whose edges alone need more than 16 bits, against the tetrahedra around each edge."""
    q = np.random.default_rng(8).normal(size=(70_000, 3))
    mesh, found = complex_of(np.r_[np.zeros((1, 3)), q / np.sqrt((q * q).sum(axis=1))[:, None]], threads=2)
    assert (np.bincount(found["edges"].ravel()) > 1 << 16).sum() == 1
    last, rank = len(found["spectrum"]), found["tetrahedron_rank"]
    ends = np.sort(mesh.tetrahedra[:, [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]]], axis=2).reshape(-1, 2)
    keys = ends[:, 0].astype(np.int64) << 32 | ends[:, 1]
    edges = found["edges"][:, 0].astype(np.int64) << 32 | found["edges"][:, 1]
    order = np.argsort(edges)
    assert np.array_equal(edges[order], np.unique(keys))
    least, most = np.full(len(order), last), np.full(len(order), -1)
    place = np.searchsorted(edges[order], keys)
    np.minimum.at(least, place, np.repeat(rank, 6))
    np.maximum.at(most, place, np.repeat(rank, 6))
    assert np.array_equal(found["edge_mid"][order], least)
    inner = found["edge_max"][order] < last
    assert np.array_equal(found["edge_max"][order][inner], most[inner])
    assert (found["edges"][order][~inner] > 0).all()  # on the hull
