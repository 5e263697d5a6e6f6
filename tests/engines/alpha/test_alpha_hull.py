from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
import shapely

from support.families.point_families import draw
from vorotool import UsageError, alpha_complex, alpha_hull, alpha_shape

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
