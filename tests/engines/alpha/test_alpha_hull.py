""""""

from itertools import pairwise

import numpy as np
import pytest
import shapely

import vorotool
from support.families.alpha_cases import quietly
from support.families.point_families import FAMILIES, draw
from support.few import few
from vorotool import UsageError, alpha_complex, alpha_curves, alpha_hull, alpha_shape, persistence

families = pytest.mark.parametrize("name", ["uniform", "small_lattice", "clustered", "exact_circle", "grid"])


def empty_centers(points, r, rng, probes):
    """Centers of discs of radius r that hold no point: those with two points on their circles, and many others."""
    i, j = np.triu_indices(len(points), 1)
    across = points[j] - points[i]
    half = np.hypot(*across.T) / 2
    close = (half > 0) & (half <= r)
    i, j, across, half = i[close], j[close], across[close], half[close]
    normal = np.stack([-across[:, 1], across[:, 0]], axis=1) / (2 * half)[:, None]
    offset = normal * np.sqrt((r - half) * (r + half))[:, None]
    middle = (points[i] + points[j]) / 2
    angle = rng.uniform(0, 2 * np.pi, (len(points), 60))
    around = points[:, None] + r * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    away = probes[:, None] - points  # from each point through each probe, and the probe itself
    through = points + r * away / np.hypot(*away.transpose(2, 0, 1))[..., None]
    parts = middle + offset, middle - offset, around.reshape(-1, 2), through.reshape(-1, 2), probes
    centers = np.concatenate(parts)
    nearest = np.min(np.hypot(*(centers[:, None] - points).transpose(2, 0, 1)), axis=1)
    return centers[nearest > r * (1 - 1e-12)]


def hull_polygon(hull, tolerance=1e-7):
    """The region on the left of the rings, by the number of times that they wind around."""
    xy, starts = hull.flattened(tolerance)
    rings = [shapely.linearrings(xy[a:b]) for a, b in pairwise(starts)]
    area = shapely.Polygon()
    for ring in rings:  # even-odd: rings do not cross
        area = area.symmetric_difference(shapely.Polygon(ring).buffer(0))
    return area, shapely.MultiLineString([shapely.LineString(ring) for ring in rings])


@families
def test_membership_by_brute_force(name):
    checked = 0
    for seed in range(2):
        rng = np.random.default_rng(seed)
        points = np.unique(draw(name, 30, seed), axis=0)
        family = alpha_complex(points)
        spectrum = family.spectrum
        for r in np.quantile(spectrum[spectrum > 0], [0.3, 0.6, 0.75, 0.9, 0.97]) * 1.01:
            hull = alpha_hull(alpha_shape(family, r=float(r)))
            area, lines = hull_polygon(hull, tolerance=r * 1e-6)
            triangles = points[family.mesh.triangles[rng.integers(0, len(family.mesh.triangles), 80)]]
            probes = (triangles * rng.dirichlet([1, 1, 1], 80)[..., None]).sum(axis=1)
            centers = empty_centers(points, r, rng, probes)
            inside = shapely.contains_xy(area, *probes.T)
            distance = np.min(np.hypot(*(probes[:, None] - centers).transpose(2, 0, 1)), axis=1)
            clear = shapely.distance(lines, shapely.points(probes)) > 1e-4 * r if len(hull) else np.ones(80, bool)
            covered = distance < r * (1 - 1e-9)
            np.testing.assert_array_equal(inside[clear], ~covered[clear])
            checked += int(clear.sum())
    assert checked > 500


@families
def test_arcs_are_on_empty_circles_and_follow_one_another(name):
    for seed in range(3):
        points = np.unique(draw(name, 60, seed), axis=0)
        family = alpha_complex(points)
        for r in np.quantile(family.spectrum, [0.5, 0.8, 0.95]) * 1.003:
            hull = alpha_hull(alpha_shape(family, r=float(r)))
            scale = np.abs(points).max() + r
            for ends in (hull.start, hull.end):
                np.testing.assert_allclose(np.hypot(*(ends - hull.center).T), r, atol=1e-9 * scale)
            nearest = np.hypot(*(hull.center[:, None] - points).transpose(2, 0, 1))
            assert (nearest > r - 1e-9 * scale).all()
            for a, b in pairwise(hull.ring_starts):
                np.testing.assert_array_equal(hull.end[a:b], np.roll(hull.start[a:b], -1, axis=0))
            assert (hull.angles <= np.pi).all()


def test_an_infinite_radius_is_refused():
    with pytest.raises(UsageError, match="the hull of an infinite radius is the convex hull"):
        alpha_hull(alpha_shape([[0, 0], [1, 0], [0, 1]], r=np.inf))


# ---- Persistence of regions beside the union of all triangles in the order of their radii, and beside the curves ----
def components(triangles):
    """Sets of triangles, given by their corners, that are joined through edges: by growing each from one of them."""
    left, found = set(triangles), []
    while left:
        part, edge = {left.pop()}, True
        while edge:
            edge = {t for t in left if any(len(t & other) == 2 for other in part)}
            part |= edge
            left -= edge
        found.append(frozenset(part))
    return found


def by_definition(family):
    """Births, deaths and sizes of regions: all shapes one after the other."""
    corners = [frozenset(t) for t in family.mesh.triangles.tolist()]
    alive, ended = {}, []  # a set of triangles -> [birth, first triangle]
    for rank in range(len(family.spectrum)):
        now = components([t for t, r in zip(corners, family.triangle_rank, strict=True) if r <= rank])
        then = {}
        for part in now:
            older = [
                (birth, -len(frozenset().union(*old)), first, old)
                for old, (birth, first) in alive.items()
                if old <= part
            ]
            if not older:
                then[part] = (rank, min(corners.index(t) for t in part))
                continue
            older.sort(key=lambda each: each[:3])
            then[part] = (older[0][0], older[0][2])
            ended += [(birth, rank, -size, len(old)) for birth, size, _, old in older[1:]]
        alive = then
    never = len(family.spectrum)
    last = [(birth, never, len(frozenset().union(*part)), len(part)) for part, (birth, _) in alive.items()]
    return sorted(ended + last)


def ours(family):
    found, radius = persistence(family), np.append(family.spectrum, np.inf)
    spectrum = radius.tolist()
    rows = zip(found.birth.tolist(), found.death.tolist(), found.points.tolist(), found.triangles.tolist(), strict=True)
    return sorted((spectrum.index(b), spectrum.index(d), points, triangles) for b, d, points, triangles in rows)


@pytest.mark.parametrize("name", ["uniform", "clustered", "small_lattice", "grid", "collinear", "exact_circle"])
def test_all_shapes_one_after_the_other(name):
    for seed in range(4):
        points = draw(name, 6 + 6 * seed, seed)
        if len(np.unique(points, axis=0)) < 2:
            continue
        family = quietly(points)
        if len(np.unique(family.spectrum)) == len(family.spectrum):  # else radii do not tell ranks
            assert ours(family) == by_definition(family), (name, seed)


@pytest.mark.parametrize("name", few(FAMILIES, 8))
def test_as_many_live_as_the_curves_count(name):
    for seed in range(3):
        points = draw(name, 40 + 30 * seed, seed)
        if len(np.unique(points, axis=0)) < 2:
            continue
        family = quietly(points)
        found, m = persistence(family), len(family.spectrum)
        radius = np.append(family.spectrum, np.inf)
        counts = alpha_curves(family)["regions"]
        for k in range(m):
            if radius[k + 1] == radius[k]:
                continue  # the next has the same double
            assert ((found.birth <= radius[k]) & ~(found.death <= radius[k])).sum() == counts[k]
        assert (found.death > found.birth).all() or len(np.unique(radius)) <= m


def two_clusters(seed):
    rng = np.random.default_rng(seed)
    return np.concatenate([rng.random((80, 2)), rng.random((60, 2)) + np.array([4, 1])])


def test_what_stands_out():
    for seed in range(5):
        found = persistence(two_clusters(seed))
        assert found.suggested == 2
        assert np.sort(found.points[np.argsort(-found.persistence)[:2]])[0] in range(50, 84)
        assert 1 < found.apart_until < 3
        assert alpha_shape(two_clusters(seed), r=found.apart_until * 0.999).region_count == 2
    one = persistence(np.random.default_rng(1).random((300, 2)))
    assert one.suggested == 1
    assert one.apart_until == np.inf


def test_without_triangles():
    found = persistence([[0, 0], [1, 0], [5, 0]])
    assert (len(found), found.suggested, found.apart_until) == (0, 0, np.inf)
    with pytest.raises(UsageError, match="corrected rule"):
        persistence(vorotool.alpha_complex(draw("uniform", 9, 1), rule="printed"))
