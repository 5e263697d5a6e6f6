from __future__ import annotations

import warnings
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

import vorotool
from alpha_oracle import alpha_edges, rounded_root
from point_families import FAMILIES, draw
from vorotool import (
    InputError,
    UsageError,
    VerificationError,
    VorotoolWarning,
    alpha_complex,
    alpha_curves,
    alpha_shape,
    verify_alpha_shape,
)
from vorotool.geometry.alpha_complex import CLASSES, classes_of

families = pytest.mark.parametrize("name", FAMILIES)
ARRAYS = ("edges", "sides", "r_min", "r_mid", "r_max", "rank_min", "rank_mid", "rank_max", "triangle_rank", "spectrum")


def quietly(points, **options):
    """The family; duplicates are expected."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", VorotoolWarning)
        return alpha_complex(points, **options)


def distinct(points):
    return len({(x, y) for x, y in np.asarray(points, float).tolist()})


def places(family, edge):
    return frozenset((Fraction(x), Fraction(y)) for x, y in family.points[family.edges[edge]].tolist())


def check_by_definition(points, most=20):
    """Edges and classes at critical radii, between them, and below the first."""
    family = quietly(points)
    squares = [family.squared_radius(k) for k in range(len(family.spectrum))]
    assert squares == sorted(set(squares))
    steps = max(1, len(squares) // most)
    for k in range(-1, len(squares), steps):
        here = squares[k] if k >= 0 else squares[0] / 2
        between = (squares[k] + squares[k + 1]) / 2 if 0 <= k < len(squares) - 1 else here * (1 if k < 0 else 2)
        classes = classes_of(family, k + 1, k + 1)
        ours = {places(family, e): CLASSES[classes[e]] for e in np.flatnonzero((classes == 1) | (classes == 2))}
        for square in {here, between}:
            assert ours == alpha_edges(points.tolist(), square), (k, square)


@families
def test_the_definition_in_rationals(name):
    for seed in range(4):
        points = draw(name, 4 + 2 * seed - (name == "any_double") * seed, seed)
        if distinct(points) > 1:
            check_by_definition(points)


lattice = st.lists(st.tuples(st.integers(-3, 3), st.integers(-3, 3)), min_size=2, max_size=11)
floats = st.floats(allow_nan=False, allow_infinity=False)
tiny_steps = st.integers(0, 3).map(lambda k: 0.5 + k * 2.0**-53)
near = st.lists(st.tuples(tiny_steps | st.integers(0, 2).map(float), tiny_steps | floats), min_size=2, max_size=7)


@settings(max_examples=50, deadline=None)
@given(lattice)
def test_any_lattice_points(points):
    if distinct(points) > 1:
        check_by_definition(np.array(points, float))


@settings(max_examples=30, deadline=None)
@given(near | st.lists(st.tuples(floats, floats), min_size=2, max_size=6))
def test_any_doubles(points):
    if distinct(points) > 1:
        check_by_definition(np.array(points, float))


def exact_radii(family):
    """Squares of the circumradii, and of half the lengths of the edges."""
    triangles = []
    for corners in family.points[family.mesh.triangles].tolist():
        (ax, ay), (bx, by), (cx, cy) = ((Fraction(x), Fraction(y)) for x, y in corners)
        sides = [(bx - cx) ** 2 + (by - cy) ** 2, (ax - cx) ** 2 + (ay - cy) ** 2, (ax - bx) ** 2 + (ay - by) ** 2]
        cross = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        triangles.append((sides[0] * sides[1] * sides[2] / (4 * cross * cross), sides))
    halves = []
    for ends in family.points[family.edges].tolist():
        (ax, ay), (bx, by) = ((Fraction(x), Fraction(y)) for x, y in ends)
        halves.append(((ax - bx) ** 2 + (ay - by) ** 2) / 4)
    return triangles, halves


@families
@pytest.mark.parametrize("n", [12, 60])
def test_radii_are_correctly_rounded_and_ranked(name, n):
    points = draw(name, n, 3)
    if distinct(points) < 2:
        return
    family = quietly(points)
    triangles, halves = exact_radii(family)
    values = set()
    for e, (t, u) in enumerate(family.sides.tolist()):
        around = sorted(triangles[k][0] for k in (t, u) if k >= 0)
        # Gabriel: no opposite corner strictly inside the diametral disc, by the law of cosines
        gabriel = all(
            2 * max(triangles[k][1]) <= sum(triangles[k][1]) or 4 * halves[e] != max(triangles[k][1])
            for k in (t, u)
            if k >= 0
        )
        least = halves[e] if gabriel else around[0]
        values |= {least, *around}
        exact = [least, *around, *[None] * (2 - len(around))]
        for radii, ranks, square in zip(
            (family.r_min, family.r_mid, family.r_max),
            (family.rank_min, family.rank_mid, family.rank_max),
            exact,
            strict=True,
        ):
            if square is None:
                assert (radii[e], ranks[e]) == (np.inf, len(family.spectrum))
            else:
                assert radii[e] == rounded_root(square)
                assert family.squared_radius(ranks[e]) == square
    assert [family.squared_radius(k) for k in range(len(family.spectrum))] == sorted(values)
    assert family.spectrum.tolist() == [rounded_root(square) for square in sorted(values)]


@families
def test_threads_change_nothing(name):
    points = draw(name, 400 if name == "any_double" else 3000, 4)  # exact levels take their time
    one = quietly(points, threads=1)
    for threads in (2, 5):
        other = quietly(points, threads=threads)
        for array in ARRAYS:
            np.testing.assert_array_equal(getattr(one, array), getattr(other, array))


@families
def test_permuting_the_points_permutes_their_numbers_only(name):
    points = draw(name, 200, 5)
    order = np.random.default_rng(6).permutation(len(points))
    family, other = quietly(points), quietly(points[order])
    for array in ARRAYS[2:]:
        np.testing.assert_array_equal(getattr(other, array), getattr(family, array))


@pytest.mark.parametrize("name", ["uniform", "small_lattice", "grid", "exact_circle", "by_ulps", "clustered"])
def test_moved_mirrored_and_scaled(name):
    points = draw(name, 120, 8)
    family = quietly(points)
    for turned, factor in (
        (points[:, ::-1], 1),
        (points * [-1, 1], 1),
        (points * 2.0**-30, 2.0**-30),
        (points * 2.0**700, 2.0**700),
    ):
        other = quietly(turned)
        np.testing.assert_array_equal(other.spectrum, family.spectrum * factor)
        for k in range(0, len(family.spectrum), 7):  # classes of edges on cocircular polygons aside, the same shapes
            assert (
                np.bincount(classes_of(other, k, k), minlength=4)[1:3].tolist()
                == np.bincount(classes_of(family, k, k), minlength=4)[1:3].tolist()
            )


def shape_triangles(shape):
    return shapely.polygons(shape.points[shape.family.mesh.triangles[shape.inside]])


def check_polygons(shape):
    """Polygons are valid, one a region, and together what the triangles are."""
    verify_alpha_shape(shape)
    polygons = shape.polygons
    assert len(polygons) == shape.region_count
    made = []
    for k in range(len(polygons)):
        shell, *holes = polygons.rings_of(k)
        for ring in (shell, *holes):
            assert len(np.unique(ring, axis=0)) == len(ring)
        assert shapely.is_ccw(shapely.linearrings(shell))
        assert not any(shapely.is_ccw(shapely.linearrings(hole)) for hole in holes)
        made.append(shapely.Polygon(shell, holes))
        assert made[-1].is_valid, shapely.is_valid_reason(made[-1])
    areas = shapely.area(shape_triangles(shape))
    np.testing.assert_allclose(shapely.area(made), shape.region_areas(), rtol=1e-9)
    assert shape.area == pytest.approx(areas.sum(), rel=1e-12)
    union = shapely.union_all(shape_triangles(shape))
    assert shape.area == pytest.approx(union.area, rel=1e-9)
    return union


def complement_holes(union):
    """Bounded components of what a union leaves, by taking it away from a frame."""
    if union.is_empty:
        return 0
    low_x, low_y, high_x, high_y = union.bounds
    frame = shapely.box(low_x - 1, low_y - 1, high_x + 1, high_y + 1)
    return len(shapely.get_parts(shapely.difference(frame, union))) - 1


@pytest.mark.parametrize("name", ["uniform", "small_lattice", "grid", "exact_circle", "clustered", "duplicates"])
def test_shapes_and_curves(name):
    for seed in range(3):
        points = draw(name, 90, seed)
        family = quietly(points)
        curves = alpha_curves(family)
        assert curves["r"] is family.spectrum
        for k in range(0, len(family.spectrum), max(1, len(family.spectrum) // 12)):
            shape = alpha_shape(family, r=family.radius_from(k))
            assert family.reached(shape.r) == k + 1
            assert (shape.family.triangle_rank <= k).tolist() == shape.inside.tolist()
            union = check_polygons(shape)
            assert curves["regions"][k] == shape.region_count
            assert curves["holes"][k] == shape.hole_count == complement_holes(union)
            assert curves["edges"][k] == len(shape.edges)
            assert curves["area"][k] == pytest.approx(shape.area, rel=1e-13)
            assert curves["perimeter"][k] == pytest.approx(shape.perimeter, rel=1e-13, abs=1e-13)
            assert shape.perimeter == pytest.approx(sum(part.length for part in _boundaries(shape)), rel=1e-12)
            everywhere = classes_of(family, k + 1, k + 1)
            np.testing.assert_array_equal(shape.edge_classes(), everywhere)
            np.testing.assert_array_equal(np.flatnonzero((everywhere == 1) | (everywhere == 2)), shape.edge_index)
            check_point_classes(shape, everywhere)


def _boundaries(shape):
    return [shapely.LinearRing(ring) for k in range(len(shape.polygons)) for ring in shape.polygons.rings_of(k)]


def check_point_classes(shape, classes):
    edges, first = shape.family.edges, shape.family.mesh.first
    for v, found in enumerate(shape.point_classes().tolist()):
        around = set(classes[(edges == first[v]).any(axis=1)].tolist())
        right = 2 if 2 in around else 3 if 3 in around else 1 if 1 in around else 0
        assert found == right
    touching = [set() for _ in shape.points]
    for t in np.flatnonzero(shape.inside):
        for v in shape.family.mesh.triangles[t]:
            touching[v].add(int(shape.region[t]))
    assert shape.point_regions().tolist() == [min(touching[v], default=-1) for v in first]
    assert shape.isolated.tolist() == [
        v
        for v in range(len(first))
        if first[v] == v and not {1, 2, 3} & set(classes[(edges == v).any(axis=1)].tolist())
    ]


def contains_every_point(shape):
    return all(shapely.intersects(shapely.union_all(shape_triangles(shape)), shapely.points(shape.points)))


@pytest.mark.parametrize("name", ["uniform", "small_lattice", "clustered", "exact_circle"])
@pytest.mark.parametrize("regions", [1, 2, 5])
def test_auto_is_the_smallest(name, regions):
    for seed in range(3):
        points = draw(name, 40, seed + 10)
        family = quietly(points)
        shape = alpha_shape(family, regions=regions)
        rank = family.reached(shape.r) - 1
        assert shape.region_count <= regions
        assert contains_every_point(shape)
        for k in range(rank):
            smaller = alpha_shape(family, r=family.radius_from(k))
            assert smaller.region_count > regions or not contains_every_point(smaller)


def test_auto_where_the_regions_are_not_monotone():
    """A hole of four triangles of which the inner one has the smallest circle: one region, two, then one again."""
    inner = np.array([[0, 0], [1, 0], [0.5, 0.75**0.5]])
    centre = inner.mean(axis=0)
    middles = (np.roll(inner, -1, axis=0) + np.roll(inner, -2, axis=0)) / 2
    outward = (middles - centre) / np.hypot(*(middles - centre).T)[:, None]
    apexes = middles + 0.9 * outward
    hexagon = shapely.Polygon([inner[0], apexes[2], inner[1], apexes[0], inner[2], apexes[1]])
    grid = np.stack(np.meshgrid(np.arange(-3, 4, 0.3), np.arange(-3, 4, 0.3)), axis=-1).reshape(-1, 2)
    around = grid[shapely.distance(hexagon, shapely.points(grid)) > 0.4]
    family = alpha_complex(np.concatenate([inner, apexes, around]))
    shape = alpha_shape(family)
    regions = alpha_curves(family)["regions"][family.reached(shape.r) - 1 :]
    assert regions[0] == regions[-1] == shape.region_count == 1
    assert regions.max() == 2


def test_the_printed_rule():
    """The counterexample of the errata: at r = 2.25 no empty disc shows the edge, the printed rule has it."""
    points = [[0, 0], [4, 0], [2, 1], [2, -5]]
    right, printed = alpha_complex(points), alpha_complex(points, rule="printed")
    edge = right.edges.tolist().index([0, 1])
    assert (right.r_min[edge], right.r_max[edge]) == (2.5, 2.9)
    assert (printed.r_min[edge], printed.r_max[edge]) == (2.0, 2.9)
    wrong = {tuple(e) for e in alpha_shape(printed, r=2.25).edges.tolist()}
    correct = {tuple(e) for e in alpha_shape(right, r=2.25).edges.tolist()}
    assert wrong - correct == {(0, 1)}
    pair = frozenset({(Fraction(0), Fraction(0)), (Fraction(4), Fraction(0))})
    assert pair not in alpha_edges(points, Fraction(9, 4) ** 2)
    # open intervals: at r_min itself the edge is not in yet
    assert (0, 1) not in {tuple(e) for e in alpha_shape(printed, r=2).edges.tolist()}
    assert (0, 1) in {tuple(e) for e in alpha_shape(right, r=2.5).edges.tolist()}


def test_the_printed_rule_is_wrong_on_about_a_third_of_inner_edges():
    points = draw("uniform", 5000, 0)
    right, printed = alpha_complex(points), alpha_complex(points, rule="printed")
    np.testing.assert_array_equal(right.edges, printed.edges)
    inner = (right.sides >= 0).all(axis=1)
    wrong = (right.r_min != printed.r_min)[inner].mean()
    assert 0.31 < wrong < 0.37  # of a Poisson process a third of the edges are no Gabriel edges
    np.testing.assert_array_equal(right.r_min[~inner], printed.r_min[~inner])


def test_a_radius_is_compared_exactly():
    """0.1 as a double is more than 1/10: three points whose circle has exactly that radius tell them apart."""
    family = alpha_complex([[0, 0], [4, 0], [0, 3]])
    for step, reached in ((Fraction(-1, 10**40), 2), (Fraction(0), 3), (Fraction(1, 10**40), 3)):
        assert family.reached(Fraction(5, 2) + step) == reached
    edge = alpha_complex([[0, 0], [0.2, 0]])  # half of the double 0.2 is the double 0.1
    assert edge.reached(0.1) == 1
    assert edge.reached(Fraction(1, 10)) == 0
    huge = alpha_complex([[-1e308, 0], [1e308, 0], [0, 1e308], [0, 1.7e308]])
    assert huge.reached(np.inf) == len(huge.spectrum)
    assert huge.reached(Fraction(10) ** 400) == len(huge.spectrum)
    flat = alpha_complex([[0, 0], [1e300, 1], [2e300, 0]])  # its circle is beyond the largest double
    assert flat.spectrum.tolist() == [5e299, np.inf]
    assert isinstance(flat.radius_from(1), Fraction)
    assert [flat.reached(flat.radius_from(k)) for k in range(2)] == [1, 2]
    assert flat.reached(1e308) == 1


def test_two_radii_in_one_double():
    """By ulps: different exact radii that round to one double keep their order, and a decimal tells them apart."""
    found = 0
    for seed in range(25):
        family = quietly(draw("by_ulps", 30, seed))
        for k in np.flatnonzero(np.diff(family.spectrum) == 0):
            r = family.radius_from(int(k))
            found += isinstance(r, Fraction)
            assert family.squared_radius(k) <= Fraction(r) ** 2 < family.squared_radius(k + 1)
            assert family.reached(r) == k + 1
    assert found


@pytest.mark.parametrize("n", [2, 3, 7])
def test_collinear_points_are_a_chain(n):
    points = np.stack([np.arange(n) ** 2, 2 * np.arange(n) ** 2], axis=1)
    family = alpha_complex(points)
    assert family.edges.shape == (n - 1, 2)
    assert np.isinf(family.r_mid).all()
    assert np.isinf(family.r_max).all()
    lengths = np.hypot(*np.diff(points, axis=0).T)
    np.testing.assert_allclose(np.sort(family.r_min), lengths / 2)
    shape = alpha_shape(family, r=1e9)
    assert set(shape.classes.tolist()) == {"singular"}
    assert (shape.region_count, shape.area, shape.hole_count) == (0, 0.0, 0)
    with pytest.raises(InputError, match="span no triangle, so no r gives a region that holds them: give r itself"):
        alpha_shape(family)


def test_thresholds():
    """A square frame of points with a small and a large gap, and a far pair of triangles."""
    grid = np.stack(np.meshgrid(np.arange(12), np.arange(9)), axis=-1).reshape(-1, 2).astype(float)
    x, y = grid.T
    gaps = ((abs(x - 3) <= 0) & (abs(y - 4) <= 0)) | ((abs(x - 8) <= 1) & (abs(y - 4) <= 1))
    far = np.array([[30.0, 0], [31, 0], [30, 1]])
    family = alpha_complex(np.concatenate([grid[~gaps], far]))
    plain = alpha_shape(family, r=0.8)
    assert (plain.region_count, plain.hole_count) == (2, 2)
    check_polygons(plain)
    small, large = 2.0, 14.0  # areas of the gaps, corners cut
    assert plain.area == 88 + 0.5 - small - large
    for threshold, holes in ((1.9, 2), (2, 1), (13.9, 1), (14, 0)):
        filled = alpha_shape(family, r=0.8, hole_threshold=threshold)
        assert filled.hole_count == holes
        check_polygons(filled)
    for threshold, regions in ((0.4, 2), (Fraction(1, 2), 1), (80, 0)):
        dropped = alpha_shape(family, r=0.8, region_threshold=threshold)
        assert dropped.region_count == regions
        check_polygons(dropped)
    both = alpha_shape(family, r=0.8, hole_threshold=100, region_threshold=80)
    assert (both.region_count, both.hole_count, both.area) == (1, 0, 88.0)
    np.testing.assert_array_equal(both.edge_classes() == 2, both.edge_classes() == 2)
    assert set(both.classes.tolist()) == {"boundary"}


def test_regions_and_rings_that_touch():
    """A gap that reaches the outside at a corner, and a region that meets another one in a point."""
    ring = [[0, 0], [1, 0], [2, 0], [0, 1], [2, 1], [0, 2], [1, 2], [2, 2]]
    shape = alpha_shape([*ring, [3, 3], [4, 3], [3, 4]], r=0.75)
    assert shape.region_count == 5
    check_polygons(shape)
    for seed in range(60):
        points = np.random.default_rng(seed).integers(0, 9, (30, 2)).astype(float)
        family = quietly(points)
        for r in (0.75, 1.0, 1.2, 1.6, 2.2):
            check_polygons(alpha_shape(family, r=r))


@pytest.mark.parametrize(
    ("options", "error", "message"),
    [
        ({"r": 0}, UsageError, "r is 0: a radius must be positive"),
        ({"r": -1}, UsageError, "r is -1: a radius must be positive"),
        ({"r": float("nan")}, UsageError, "r is nan: give a number"),
        ({"r": "x"}, UsageError, "r is 'x': give a number"),
        (
            {"alpha": 0.1},
            UsageError,
            r"alpha must be negative \(α = −1/r\): for the alphashape package's 0.1 use -r 10$",
        ),
        ({"alpha": 0}, UsageError, r"alpha must be negative \(α = −1/r\): for the convex hull use -r inf$"),
        ({"r": 1, "alpha": -1}, UsageError, "r and alpha are given, but each sets the radius: give one of"),
        ({"r": 1, "regions": 2}, UsageError, "regions is for the automatic choice"),
        ({"regions": 0}, UsageError, "regions is 0: at least 1"),
        ({"hole_threshold": -1}, UsageError, "hole_threshold is -1: give an area of at least 0"),
        ({"rule": "other"}, UsageError, "rule is 'other': use corrected, or printed"),
    ],
)
def test_bad_options(options, error, message):
    with pytest.raises(error, match=message):
        alpha_shape([[0, 0], [4, 0], [0, 3]], **options)


@pytest.mark.parametrize(
    ("points", "message"),
    [
        ([], "there are 0 points: an alpha shape needs at least two distinct points"),
        ([[1, 2]], "there is 1 point:"),
        ([[1, 2], [np.nan, 0]], "point 2 is"),
    ],
)
def test_too_few_points(points, message):
    with pytest.raises(InputError, match=message):
        alpha_shape(points, r=1)
    with pytest.warns(VorotoolWarning), pytest.raises(InputError, match="2 points, all at one place"):
        alpha_shape([[1, 2], [1, 2]], r=1)


def test_alpha_is_minus_one_over_r():
    shape = alpha_shape([[0, 0], [4, 0], [0, 3]], alpha=Fraction(-2, 5))
    assert (shape.r, shape.alpha, shape.region_count) == (Fraction(5, 2), -0.4, 1)
    assert alpha_shape([[0, 0], [4, 0], [0, 3]], alpha=-0.1).r == 10.0


def changed(shape, array, index, value):
    values = getattr(shape, array).copy()
    values[index] = value
    return replace(shape, **{array: values})


def test_the_checker_finds_faults():
    family = alpha_complex(draw("uniform", 60, 2))
    shape = alpha_shape(family, r=float(np.median(family.spectrum)))
    verify_alpha_shape(shape)
    inside, outside = int(np.argmax(shape.inside)), int(np.argmin(shape.inside))
    last = shape.region_count - 1
    polygons = shape.polygons
    faulty = {
        "is in the shape, but its circumradius": replace(shape, r=shape.r / 2),
        "is not in the shape, but its circumradius": replace(shape, r=shape.r * 2),
        "triangle": changed(shape, "region", outside, 0),
        "triangle ": changed(shape, "region", inside, -1),
        "but should be": changed(shape, "kind", 0, 3 - int(shape.kind[0])),
        "edge": replace(shape, edge_index=shape.edge_index[1:], kind=shape.kind[1:]),
        "regions": replace(shape, region=np.minimum(shape.region, last - 1)),
        "rings": replace(shape, polygons=replace(polygons, xy=np.roll(polygons.xy, 1, axis=0))),
        "edges are not those": replace(shape, family=replace(family, edges=np.roll(family.edges, 1, axis=1))),
        "no side of a triangle": replace(shape, family=replace(family, sides=np.roll(family.sides, 3, axis=0))),
    }
    for words, wrong in faulty.items():
        with pytest.raises(VerificationError, match=words):
            verify_alpha_shape(wrong)


@families
def test_every_family_passes_the_checker(name):
    points = draw(name, 40 if name == "any_double" else 150, 9)
    family = quietly(points)
    for k in (0, len(family.spectrum) // 2, len(family.spectrum) - 1):
        verify_alpha_shape(alpha_shape(family, r=family.radius_from(k)))
    verify_alpha_shape(alpha_shape(family, r=np.inf))


def test_agreement_with_gudhi():
    gudhi = pytest.importorskip("gudhi", reason="GUDHI is not installed: its alpha complex is not compared")
    for seed in range(3):
        points = draw("uniform", 2000, seed)
        family = alpha_complex(points)
        tree = gudhi.AlphaComplex(points=points, precision="exact").create_simplex_tree()
        theirs = {tuple(simplex): value for simplex, value in tree.get_filtration()}
        for (a, b), r in zip(family.edges.tolist(), family.r_min.tolist(), strict=True):
            assert r * r == pytest.approx(theirs[a, b], rel=1e-12)
        for corners, rank in zip(family.mesh.triangles.tolist(), family.triangle_rank, strict=True):
            assert family.spectrum[rank] ** 2 == pytest.approx(theirs[tuple(sorted(corners))], rel=1e-12)


def test_progress_can_stop_it():
    def stop(fraction):
        raise KeyboardInterrupt

    mesh = vorotool.delaunay(draw("uniform", 300_000, 0))
    with pytest.raises(KeyboardInterrupt):
        alpha_complex(mesh, threads=1, progress=stop)
