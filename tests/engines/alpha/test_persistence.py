"""Persistence of regions beside the union of all triangles in the order of their radii, and beside the curves."""

from __future__ import annotations

import numpy as np
import pytest

import vorotool
from support.families.alpha_cases import quietly
from support.families.point_families import FAMILIES, draw
from support.few import few
from vorotool import UsageError, alpha_curves, alpha_shape, persistence


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
