"""The table of points in space and the spheres of tetrahedra, against rationals."""

import itertools
from fractions import Fraction

import numpy as np
import pytest

from support.oracles.space_alpha_oracle import cross, dot, minus
from vorotool._core import tetrahedra

FACES = ((1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1))
VOLUME_ERROR = Fraction(1, 2**40)
WAY_ERROR = Fraction(1, 2**43)


def lattice(rng):
    return rng.permutation(np.array(list(itertools.product(range(4), repeat=3)), dtype=float))


def rotated(rng):
    return lattice(rng) @ np.linalg.qr(rng.normal(size=(3, 3)))[0]


def moved(rng):
    """Rotated, and so far away that few bits are left."""
    return rotated(rng) + 2.0**40


def clusters(rng):
    return rng.random((5, 3)).repeat(16, axis=0) + rng.normal(size=(80, 3)) * 10.0 ** rng.integers(-12, -2, (80, 1))


def uniform(rng):
    return rng.random((90, 3))


def sphere(rng):
    ways = rng.normal(size=(60, 3))
    return np.vstack([ways / np.linalg.norm(ways, axis=1, keepdims=True), rng.normal(size=(4, 3)) * 1e-3])


def tiny(rng):
    return np.ldexp(uniform(rng), -700)


def huge(rng):
    return np.ldexp(rotated(rng), 700)


def far_apart(rng):
    return np.ldexp(rng.normal(size=(40, 3)), rng.integers(-200, 200, (40, 1)))


def flat(rng):
    """Inner points that are nearly on the hull have cells that are long and thin."""
    inner = np.c_[rng.random((40, 2)), 2.0**-45 * rng.integers(0, 4, 40)]
    return np.vstack([inner, [[-1, -1, 0], [3, -1, 0], [-1, 3, 0], [0.3, 0.3, 5]]])


FAMILIES = [lattice, rotated, moved, clusters, uniform, sphere, tiny, huge, far_apart, flat]


def made_of(points):
    made = tetrahedra.triangulate(points, 1, None)
    return made["tetrahedra"], made["neighbors"]


def table(points, threads=1, labels=None):
    labels = np.arange(len(points)) if labels is None else labels
    return tetrahedra.point_table(points, *made_of(points), labels, threads, None)


# ---- rationals -----------------------------------------------------------------------------------
def exact_sphere(corners):
    """The way from the first corner to the center, and the volume."""
    b, c, d = (minus(corner, corners[0]) for corner in corners[1:])
    normals = cross(c, d), cross(d, b), cross(b, c)
    six = dot(b, normals[0])
    return [
        sum(dot(p, p) * n[i] for p, n in zip((b, c, d), normals, strict=True)) / (2 * six) for i in range(3)
    ], six / 6


def exact_cells(points, rows):
    """Volumes of cells: the part of a corner of a tetrahedron is between its edges, its faces, and planes half-way."""
    exact = [[Fraction(x) for x in point] for point in points.tolist()]
    volumes = [Fraction(0)] * len(points)
    for row in rows.tolist():
        corners = [exact[v] for v in row]
        way, _ = exact_sphere(corners)
        for i, face in enumerate(FACES):
            center = minus(way, minus(corners[i], corners[0]))
            for j, k in zip(face, (*face[1:], face[0]), strict=True):
                u, v = minus(corners[j], corners[i]), minus(corners[k], corners[i])
                normal = cross(u, v)
                height = dot(center, normal) / dot(normal, normal)
                volumes[row[i]] += height * dot(minus(v, u), cross(normal, center)) / 12
    return volumes


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("family", FAMILIES)
def test_volumes_of_cells_are_within_their_bound(family, seed):
    points = family(np.random.default_rng(seed))
    rows, neighbors = made_of(points)
    found = table(points)
    on_hull = np.zeros(len(points), dtype=bool)
    for place in range(4):
        on_hull[rows[neighbors[:, place] < 0][:, FACES[place]]] = True
    assert found["on_hull"].astype(bool).tolist() == on_hull.tolist()
    assert not on_hull.all()
    assert np.isinf(found["cell_volume"][on_hull]).all()
    right = exact_cells(points, rows)
    for v in np.flatnonzero(~on_hull):
        if right[v] > 2**1020 or right[v] < Fraction(1, 2**1022):
            assert found["cell_volume"][v] in (np.inf, 0) or abs(
                Fraction(found["cell_volume"][v]) - right[v]
            ) < Fraction(1, 2**1073)
        else:
            assert abs(Fraction(found["cell_volume"][v]) - right[v]) <= VOLUME_ERROR * right[v]


@pytest.mark.parametrize("family", FAMILIES)
def test_spheres_are_within_their_bound(family):
    points = family(np.random.default_rng(5))
    rows, _ = made_of(points)
    ways, volumes = tetrahedra.spheres(points, rows, 1, None)
    for row, way, volume in zip(rows.tolist(), ways.tolist(), volumes.tolist(), strict=True):
        right, right_volume = exact_sphere([[Fraction(x) for x in points[v].tolist()] for v in row])
        if max(map(abs, right)) < 2**1023 and right_volume > Fraction(1, 2**1000) and right_volume < 2**1023:
            difference = minus([Fraction(x) for x in way], right)
            assert dot(difference, difference) <= WAY_ERROR**2 * dot(right, right)
            assert abs(Fraction(volume) - right_volume) <= WAY_ERROR * right_volume / 2


# ---- neighbors -----------------------------------------------------------------------------------
@pytest.mark.parametrize("family", FAMILIES)
def test_neighbors_and_nearest_points_are_those_of_brute_force(family):
    rng = np.random.default_rng(7)
    points = family(rng)
    points = np.vstack([points, points[:5]])
    labels = rng.permutation(len(points))
    rows, _ = made_of(points)
    found = table(points, labels=labels)
    edges = {pair for row in rows.tolist() for pair in itertools.permutations(row, 2)}
    degrees = np.bincount([a for a, _ in edges], minlength=len(points))
    assert found["neighbors"].tolist() == degrees.tolist()
    exact = [[Fraction(x) for x in point] for point in points.tolist()]
    used = np.flatnonzero(degrees).tolist()
    assert (found["nearest"][degrees == 0] == -1).all()
    for v in used:
        ways = {w: minus(exact[w], exact[v]) for w in used if w != v}
        assert found["nearest"][v] == min(ways, key=lambda w: (dot(ways[w], ways[w]), labels[w]))


def test_nearest_corners_of_triangles_and_edges():
    plane = np.array([(x, y, 0.0) for x, y in itertools.product(range(4), repeat=2)])
    triangles = np.array(
        [(k, k + 4, k + 1) for k in range(11) if k % 4 < 3] + [(k + 4, k + 5, k + 1) for k in range(11) if k % 4 < 3],
        dtype=np.int32,
    )
    labels = np.arange(len(plane))[::-1].copy()
    found = tetrahedra.nearest_corners(plane, triangles, labels, 1, None)
    for v, nearest in enumerate(found.tolist()):
        near = [w for w in range(16) if np.abs(plane[w] - plane[v]).sum() == 1]
        assert nearest == max(near)
    line = np.outer([0.0, 1, 3, 4], [1, 2, 2])
    edges = np.array([(0, 1), (1, 2), (2, 3)], dtype=np.int32)
    assert tetrahedra.nearest_corners(line, edges, np.arange(4), 1, None).tolist() == [1, 0, 3, 2]


# ---- threads, refusals ---------------------------------------------------------------------------
@pytest.mark.parametrize("family", ["uniform", "rotated", "clusters"])
def test_threads_change_nothing(family):
    rng = np.random.default_rng(2)
    points = rng.random((30000, 3))
    if family == "rotated":
        points = (
            np.array(list(itertools.product(range(12), repeat=3)), dtype=float)
            @ np.linalg.qr(rng.normal(size=(3, 3)))[0]
        )
    elif family == "clusters":
        points = np.round(points[:300] * 4) + points[:300] * 1e-9
        points = points[np.unique(points, axis=0, return_index=True)[1]]
    one = table(points)
    for threads in (2, 3, 4):
        for name, values in table(points, threads).items():
            np.testing.assert_array_equal(values, one[name])


def test_wrong_arrays_are_refused():
    points = np.random.default_rng(3).random((30, 3))
    rows, neighbors = made_of(points)
    labels = np.arange(30)
    for wrong, arrays in {
        "names a point": (np.full_like(rows, 30), neighbors, labels),
        "no tetrahedron": (rows, np.full_like(neighbors, len(rows)), labels),
        "lengths": (rows, neighbors[1:].copy(), labels),
    }.items():
        with pytest.raises(ValueError, match=wrong):
            tetrahedra.point_table(points, *arrays, 1, None)
    with pytest.raises(ValueError, match="names a point"):
        tetrahedra.spheres(points, np.full_like(rows, -1), 1, None)
    with pytest.raises(ValueError, match="label"):
        tetrahedra.nearest_corners(points, rows[:, :3].copy(), labels[1:], 1, None)
