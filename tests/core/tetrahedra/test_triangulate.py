import itertools
from fractions import Fraction

import numpy as np
import pytest
from scipy.spatial import ConvexHull, Delaunay

from support.families import predicate_cases
from vorotool import _core
from vorotool._core import tetrahedra

GRID = np.array(list(itertools.product(range(3), repeat=3)), dtype=float)


def triangulate(points, threads=1):
    return tetrahedra.triangulate(np.ascontiguousarray(points, dtype=float), threads, None)


def fault(points, made, **other):
    arrays = {name: made[name] for name in ("tetrahedra", "neighbors", "first")} | other
    return tetrahedra.find_fault(np.ascontiguousarray(points, dtype=float), **arrays, threads=1, progress=None)


def places(points, made):
    """Each tetrahedron as the set of the places of its vertices."""
    return {frozenset(map(tuple, np.asarray(points)[row].tolist())) for row in made["tetrahedra"]}


def lattice(rng):
    return rng.permutation(np.array(list(itertools.product(range(6), range(5), range(7))), dtype=float))


def integer_sphere(rng):
    """All integer points at a squared distance of 5 109 from the origin."""
    side = np.arange(-71, 72)
    x, y, z = (axis.ravel() for axis in np.meshgrid(side, side, side))
    points = np.stack([x, y, z], axis=1)[x * x + y * y + z * z == 5109]
    return rng.permutation(points).astype(float)


def rounded_sphere(rng):
    v = rng.normal(size=(400, 3))
    return v / np.linalg.norm(v, axis=1, keepdims=True)


def cylinder(rng):
    circle = [(x, y) for x in range(-25, 26) for y in range(-25, 26) if x * x + y * y == 625]
    return rng.permutation(np.array([(x, y, z) for x, y in circle for z in range(0, 30, 5)], dtype=float))


def cubes(rng):
    corners = np.array(list(itertools.product((0.0, 1.0), repeat=3)))
    return np.concatenate([corners * size + rng.integers(0, 9, 3) for size in rng.integers(1, 7, 30)])


def skew_lines(rng):
    n = 40
    line = np.arange(n, dtype=float)
    return np.concatenate(
        [np.stack([line, 0 * line, 0 * line], axis=1), np.stack([0 * line, line, 0 * line + 3], axis=1)]
    )


def clusters(rng):
    return np.repeat(rng.random((8, 3)), 60, axis=0) + rng.normal(size=(480, 3)) * 10.0 ** rng.integers(
        -14, 0, (480, 1)
    )


def duplicates(rng):
    return rng.integers(0, 4, (300, 3)).astype(float)


def uniform(rng):
    return rng.random((700, 3))


def far_apart(rng):
    return np.ldexp(rng.normal(size=(60, 3)), rng.integers(-300, 300, (60, 1)))


FAMILIES = [
    lattice,
    integer_sphere,
    rounded_sphere,
    cylinder,
    cubes,
    skew_lines,
    clusters,
    duplicates,
    uniform,
    far_apart,
]


@pytest.mark.parametrize("family", FAMILIES)
def test_a_family_has_no_fault_and_one_result(family):
    """The tetrahedra depend on the places alone, their order too; so do the duplicates."""
    rng = np.random.default_rng(3)
    points = family(rng)
    made = triangulate(points)
    assert made["dimension"] == 3
    assert fault(points, made) is None
    distinct = len(np.unique(points, axis=0))
    assert made["duplicates"] == len(points) - distinct == (made["first"] != np.arange(len(points))).sum()
    np.testing.assert_array_equal(points[made["first"]], points)
    order = rng.permutation(len(points))
    again = triangulate(points[order])
    np.testing.assert_array_equal(points[order][again["tetrahedra"]], points[made["tetrahedra"]])
    np.testing.assert_array_equal(again["neighbors"], made["neighbors"])


@pytest.mark.parametrize("change", ["moved", "halved", "doubled"])
@pytest.mark.parametrize("family", [lattice, integer_sphere, cylinder, duplicates])
def test_moving_and_scaling_changes_nothing(family, change):
    points = family(np.random.default_rng(4))
    other = {"moved": points + 2.0**40, "halved": points * 2.0**-700, "doubled": points * 2.0**900}[change]
    np.testing.assert_array_equal(triangulate(other)["tetrahedra"], triangulate(points)["tetrahedra"])


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("n", [4, 5, 8, 50, 2000])
def test_general_position_is_as_in_scipy(n, seed):
    points = np.random.default_rng(seed).random((n, 3))
    found = {tuple(row) for row in np.sort(triangulate(points)["tetrahedra"], axis=1).tolist()}
    assert found == {tuple(row) for row in np.sort(Delaunay(points).simplices, axis=1).tolist()}


def rule(points):
    """The tetrahedra whose spheres are empty, ties broken, by trying all in integers."""
    rows = predicate_cases.rows_of(points.tolist())
    found = set()
    for four in itertools.combinations(range(len(points)), 4):
        sign = predicate_cases.exact_sign([rows[i] for i in four])
        if sign == 0:
            continue
        others = ([rows[i] for i in (*four, j)] for j in range(len(points)) if j not in four)
        if all((predicate_cases.exact_sign(p) or predicate_cases.tie_sign(p)) == -sign for p in others):
            found.add(frozenset(map(tuple, points[list(four)].tolist())))
    return found


def check_small(points):
    made = triangulate(points)
    assert fault(points, made) is None
    right = rule(points)
    assert places(points, made) == right
    assert len(made["tetrahedra"]) == len(right)
    assert (made["dimension"] == 3) == bool(right)


@pytest.mark.parametrize("n", [5, 6])
def test_sets_of_the_grid_follow_the_rule(n):
    rng = np.random.default_rng(n)
    for _ in range(40):
        check_small(GRID[rng.choice(27, n, replace=False)])


def symmetries():
    """(48, 27) where each symmetry of the cube moves each point of the grid."""
    number = np.array([9, 3, 1])
    turned = [GRID[:, axes] for axes in itertools.permutations(range(3))]
    mirrors = list(itertools.product((0, 2), repeat=3))
    return np.array([abs(grid - mirror) @ number for grid in turned for mirror in mirrors]).astype(int)


def sets_up_to_symmetry(n):
    """(k, n) one of the sets of n points of the grid that symmetries of the cube take into each other."""
    sets = np.array(list(itertools.combinations(range(27), n)))
    keys = (1 << sets).sum(axis=1)
    least = np.min([(1 << moved[sets]).sum(axis=1) for moved in symmetries()], axis=0)
    return sets[keys == least]


def test_sets_up_to_symmetry_are_as_many_as_burnside_counts():
    """A set stays as it is under a symmetry if it consists of cycles of points."""
    counts = np.zeros(28, dtype=int)
    for moved in symmetries().tolist():
        ways, left = [1], set(range(27))
        while left:
            point, length = left.pop(), 1
            while (point := moved[point]) in left:
                left.remove(point)
                length += 1
            ways = np.convolve(ways, [1, *[0] * (length - 1), 1])
        counts += ways
    assert [len(sets_up_to_symmetry(n)) for n in range(1, 6)] == (counts[1:6] // 48).tolist()


def check_all(sets, seed):
    """Each set, moved by some symmetry, since ties are broken by the order of coordinates, and in another order."""
    rng = np.random.default_rng(seed)
    for moved, chosen in zip(rng.choice(symmetries(), len(sets)), sets, strict=True):
        points = GRID[moved[chosen]]
        check_small(points)
        check_small(rng.permutation(points))


@pytest.mark.parametrize("n", [1, 2, 3, 4])
def test_all_small_sets_of_the_grid_follow_the_rule(n):
    check_all(sets_up_to_symmetry(n), n)


@pytest.mark.more
@pytest.mark.parametrize(("n", "part"), [(5, 0), (5, 1), *((6, part) for part in range(8))])
def test_all_sets_of_the_grid_follow_the_rule(n, part):
    check_all(sets_up_to_symmetry(n)[part :: 2 if n == 5 else 8], 10 * n + part)


@pytest.mark.parametrize("name", ["lattice", "boxes", "near_degenerate", "flat", "subnormal", "axis_parallel"])
def test_small_sets_follow_the_rule(name):
    for points, *_ in predicate_cases.FAMILIES[name](np.random.default_rng(2), 12, 8, 3)[:, None]:
        check_small(np.unique(points, axis=0))


def cells_of(points, made):
    """Vertices and tetrahedra of each polytope of tetrahedra with one sphere: centers in rationals."""
    cells = {}
    for row in made["tetrahedra"]:
        p = [[Fraction(v) for v in q] for q in points[row].tolist()]
        matrix = [[b - a for a, b in zip(p[0], q, strict=True)] for q in p[1:]]
        right = [sum(b * b - a * a for a, b in zip(p[0], q, strict=True)) / 2 for q in p[1:]]
        volume = predicate_cases.determinant(matrix)
        center = tuple(
            predicate_cases.determinant([[*m[:k], r, *m[k + 1 :]] for m, r in zip(matrix, right, strict=True)]) / volume
            for k in range(3)
        )
        cells.setdefault(center, []).append(frozenset(map(tuple, points[row].tolist())))
    return cells


@pytest.mark.parametrize("family", [lattice, cylinder, cubes, duplicates])
def test_a_cospherical_polytope_is_a_cone_from_its_first_vertex(family):
    points = family(np.random.default_rng(6))
    cells = cells_of(points, triangulate(points))
    assert max(map(len, cells.values())) > 4
    for tetrahedra_of_cell in cells.values():
        apex = min(frozenset.union(*tetrahedra_of_cell))
        assert all(apex in tetrahedron for tetrahedron in tetrahedra_of_cell)


def test_the_layer_of_a_prism_is_a_fan_from_its_first_vertex():
    """The rule of the plane: the facets of a flat hull are what `delaunay` makes of it."""
    plane = np.array(list(itertools.product(range(4), range(3))), dtype=float)
    points = np.concatenate([np.c_[plane, 0 * plane[:, 0]], [[1.25, 0.5, 7.0]]])
    made = triangulate(points)
    hull = {frozenset(row) for row in made["tetrahedra"].tolist()}
    bottom = {row - {len(plane)} for row in hull}
    flat = _core.delaunay.DelaunayTriangulation(plane, 1, None).arrays(1, None)["triangles"]
    assert bottom == {frozenset(row) for row in flat.tolist()}


@pytest.mark.parametrize(
    ("points", "dimension"),
    [
        (np.zeros((0, 3)), -1),
        (np.ones((3, 3)), 0),
        ([[0, 0, 0], [1, 2, 3]], 1),
        ([[0, 0, 0], [1, 0, 1], [0, 1, 1], [1, 1, 2]], 2),
        (np.outer(np.arange(9), [0.25, 0.5, 2]), 1),
        (np.c_[np.random.default_rng(0).random((50, 2)), np.zeros(50)], 2),
    ],
)
def test_flat_sets_are_left_to_the_caller(points, dimension):
    made = triangulate(points)
    assert made["dimension"] == dimension
    assert made["tetrahedra"].shape == made["neighbors"].shape == (0, 4)
    assert fault(points, made) is None


def test_volume_and_hull_are_those_of_the_points():
    points = np.random.default_rng(8).random((500, 3))
    made = triangulate(points)
    p = points[made["tetrahedra"]]
    volumes = np.linalg.det(p[:, 1:] - p[:, :1]) / 6
    hull = ConvexHull(points)
    assert np.isclose(volumes.sum(), hull.volume)
    assert (made["neighbors"] < 0).sum() == len(hull.simplices)


@pytest.mark.parametrize("family", ["uniform", "sphere", "lattice", "clusters"])
def test_threads_change_nothing(family):
    """Rounds of many points are inserted by all of them."""
    rng = np.random.default_rng(14)
    points = rng.random((60000, 3))
    if family == "sphere":
        points = points - 0.5
        points /= np.linalg.norm(points, axis=1, keepdims=True)
    elif family == "lattice":
        points = np.array(list(itertools.product(range(36), range(36), range(40))), dtype=float)
    elif family == "clusters":
        points = np.round(points[:6]).repeat(10000, axis=0) + rng.normal(size=(60000, 3)) * 1e-4
    made = triangulate(points)
    for threads in (2, 3):
        again = triangulate(points, threads)
        np.testing.assert_array_equal(again["tetrahedra"], made["tetrahedra"])
        np.testing.assert_array_equal(again["neighbors"], made["neighbors"])
    assert fault(points, made) is None


def test_progress_and_interrupts():
    points = np.random.default_rng(9).random((40000, 3))
    seen = []
    tetrahedra.triangulate(points, 1, seen.append)
    assert seen == sorted(seen)
    with pytest.raises(ZeroDivisionError):
        tetrahedra.triangulate(points, 1, lambda fraction: 1 / 0)


def test_rows_are_canonical():
    """The first vertex of a row is the first of the four along the curve, and so is the second of the others."""
    points = np.random.default_rng(10).random((300, 3))
    rows = triangulate(points)["tetrahedra"]
    _, firsts = np.unique(rows[:, 0], return_index=True)
    rank = {int(v): k for k, v in enumerate(rows[np.sort(firsts), 0])}
    ranks = [[rank[v] for v in row if v in rank] for row in rows.tolist()]
    assert [row[0] for row in ranks] == sorted(row[0] for row in ranks)
    complete = [row for row in ranks if len(row) == 4]
    assert len(complete) > 500
    assert all(first < second < min(others) for first, second, *others in complete)


POINTS = np.random.default_rng(11).random((60, 3))


def put(*place, value):
    return lambda rows: rows.__setitem__(place if len(place) > 1 else place[0], value)


def swapped(rows):
    rows[5, [2, 3]] = rows[5, [3, 2]]


def turned(rows):
    rows[7] = np.roll(rows[7], 1)


def cut(rows):
    t = np.flatnonzero((rows >= 0).all(axis=1))[0]
    u = rows[t, 0]
    rows[u, rows[u] == t] = -1
    rows[t, 0] = -1


@pytest.mark.parametrize(
    ("message", "name", "change"),
    [
        ("tetrahedron 5 is not positive", "tetrahedra", swapped),
        ("wrong neighbor", "neighbors", turned),
        ("the hull", "neighbors", cut),
        ("does not exist", "tetrahedra", put(3, 0, value=60)),
        ("does not exist", "tetrahedra", put(3, 0, value=-1)),
        ("neighbor that does not exist", "neighbors", lambda rows: put(3, 0, value=len(rows))(rows)),
        ("first is not the first point", "first", put(60, value=60)),
        ("first is not the first point", "first", put(5, value=4)),
    ],
)
def test_changed_arrays_are_found(message, name, change):
    points = np.concatenate([POINTS, POINTS[:1]]) if name == "first" else POINTS
    made = triangulate(points)
    array = made[name].copy()
    change(array)
    assert message in fault(points, made, **{name: array})


def test_a_missing_point():
    made = triangulate(POINTS)
    more = np.concatenate([POINTS, [POINTS.mean(axis=0)]])
    first = np.arange(61, dtype=np.int32)
    assert fault(more, made, first=first) == "no tetrahedron has point 60"
    outside = np.concatenate([POINTS, [[9.0, 9, 9]]])
    assert fault(outside, made, first=first) == "no tetrahedron has point 60"


def test_nothing():
    made = triangulate(POINTS)
    none = np.zeros((0, 4), np.int32)
    assert "not coplanar" in fault(POINTS, made, tetrahedra=none, neighbors=none)


def test_another_triangulation():
    """The Delaunay triangulation of points that are moved a little is none of the points where they were."""
    moved = POINTS + np.random.default_rng(12).normal(size=(60, 3)) * 0.01
    assert fault(POINTS, triangulate(moved)) is not None


@pytest.mark.parametrize("family", [lattice, cylinder, integer_sphere])
def test_ties_broken_in_another_way(family):
    """The same points seen in a mirror have another order."""
    points = family(np.random.default_rng(13))
    made = triangulate(points * [-1, 1, 1])
    other = {"tetrahedra": np.ascontiguousarray(made["tetrahedra"][:, [0, 1, 3, 2]])}
    other["neighbors"] = np.ascontiguousarray(made["neighbors"][:, [0, 1, 3, 2]])
    assert "ties are broken in another way" in fault(points, made, **other)


def test_a_hull_that_goes_round_twice():
    """Five tetrahedra around an edge, in the order of a pentagram."""
    angle = np.arange(5) * 4 * np.pi / 5
    points = np.concatenate([np.c_[np.cos(angle), np.sin(angle), 0 * angle], [[0, 0, -1], [0, 0, 1.0]]])
    rows = np.array([[5, 6, k, (k + 1) % 5] for k in range(5)], dtype=np.int32)
    neighbors = np.array([[-1, -1, (k + 1) % 5, (k - 1) % 5] for k in range(5)], dtype=np.int32)
    assert (tetrahedra.orient3d(points[rows]) == 1).all()
    made = {"tetrahedra": rows, "neighbors": neighbors, "first": np.arange(7, dtype=np.int32)}
    assert "round" in fault(points, made) or "not convex" in fault(points, made)
