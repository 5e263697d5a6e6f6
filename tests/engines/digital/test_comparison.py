from __future__ import annotations

import re
from collections import Counter
from fractions import Fraction
from itertools import combinations

import numpy as np
import pytest
import shapely

import vorotool
from support.families.families import distinct_pixels
from support.few import few
from support.oracles.delaunay_oracle import circle, cross
from support.oracles.digital_oracle import edge_is_delaunay, paper_rule, parts
from vorotool import InputError, LimitError, compare_digital, delaunay
from vorotool.engines.digital.comparison import CocircularTies, voronoi_lengths


def rational(seeds):
    return [(Fraction(int(x)), Fraction(int(y))) for x, y in seeds]


def triangle_is_delaunay(sites, triangle):
    """Whether some, and whether every Delaunay triangulation has it: empty circle; nothing else on it."""
    corners = [sites[v] for v in triangle]
    if cross(*corners) == 0:
        return False, False
    center, square = circle(*corners)
    others = [p for k, p in enumerate(sites) if k not in triangle]
    distances = [(x - center[0]) ** 2 + (y - center[1]) ** 2 for x, y in others]
    return all(d >= square for d in distances), all(d > square for d in distances)


@pytest.mark.parametrize("seed", few(range(30), 4))
def test_ties_by_the_definition(seed):
    m = (4, 5, 6, 9, 40)[seed % 5]  # small lattices: nearly everything is cocircular
    seeds = distinct_pixels(seed, m, min(m * m, 9))
    sites = rational(seeds)
    mesh = delaunay(seeds)
    ties = CocircularTies(mesh)
    for edge in combinations(range(len(sites)), 2):
        assert ties.has_edge(edge) == edge_is_delaunay(sites, *edge)[0], edge
    for triangle in combinations(range(len(sites)), 3):
        assert ties.has_triangle(triangle) == triangle_is_delaunay(sites, triangle)[0], triangle
    for edge, unique in zip(mesh.edges.tolist(), ties.unique_edges, strict=True):
        assert unique == edge_is_delaunay(sites, *edge)[1], edge
    for triangle, unique in zip(mesh.triangles.tolist(), ties.unique_triangles, strict=True):
        assert unique == triangle_is_delaunay(sites, triangle)[1], triangle


@pytest.mark.parametrize("seed", few(range(12), 4))
def test_precision_and_recall_by_the_definition(seed):
    m = (6, 9, 14, 20)[seed % 4]
    seeds = distinct_pixels(seed, m, 10)
    sites = rational(seeds)
    image = vorotool.tessellate(seeds, shape=(m, m)).labels
    found = [{tuple(v - 1 for v in members) for members in kind} for kind in paper_rule(image)]
    comparison = compare_digital(seeds, shape=(m, m))
    for kind, size, test in (("edge", 2, edge_is_delaunay), ("triangle", 3, None)):
        members = list(combinations(range(10), size))
        verdict = {t: test(sites, *t) if test else triangle_is_delaunay(sites, t) for t in members}
        some, every = ({t for t in members if verdict[t][k]} for k in (0, 1))
        have = found[size - 2]
        assert getattr(comparison, f"{kind}_precision") == (len(have & some) / len(have) if have else 1.0)
        assert getattr(comparison, f"{kind}_recall") == (len(have & every) / len(every) if every else 1.0)
        table = comparison.differences
        rows = {"missing": set(), "false": set(), "tie": set()}
        for i in range(table.rows):
            if table["kind"][i] == kind:
                labels = [table[f"label_{name}"][i] - 1 for name in "abc"[:size]]
                rows[table["difference"][i]].add(tuple(sorted(labels)))
                assert table["cause"][i] != "split_region" or any(parts(image, v + 1) > 1 for v in labels)
        assert rows["missing"] == every - have
        assert rows["false"] == have - some
        assert not rows["tie"] & (every | (have - some))


def test_every_difference_has_a_cause():
    counts = Counter()
    for seed in range(30):
        counts.update(compare_digital(distinct_pixels(seed, 64, 150), shape=(64, 64)).counts)
    causes = {name.split()[2] for name in counts}
    assert causes == {"off_frame", "four_labels", "short_edge", "split_region", "cocircular"}


def test_a_suggested_window_shows_more():
    seeds = distinct_pixels(7, 100, 60)
    comparison = compare_digital(seeds, shape=(100, 100))
    window = tuple(map(int, re.match(r"window=\((.*?)\)", comparison.suggestion)[1].split(",")))
    assert comparison.suggestion.typed.startswith(f"--window {','.join(map(str, window))} ")
    wider = compare_digital(seeds, window=window)
    assert wider.triangle_recall > comparison.triangle_recall
    held, of = (int(word) for word in comparison.suggestion.split("holds ")[1].split()[:3:2])
    off = comparison.counts["triangle missing off_frame"]
    assert (of, held) == (off, off - wider.counts.get("triangle missing off_frame", 0))


def test_lengths_of_voronoi_edges():
    seeds = distinct_pixels(3, 50, 40).astype(float)
    mesh = delaunay(seeds)
    centers = mesh.circumcenters
    low, high = np.array([0.0, 0.0]), np.array([49.0, 49.0])
    whole, inside = voronoi_lengths(mesh, centers, low, high)
    place = {frozenset(e): i for i, e in enumerate(mesh.edges.tolist())}
    box = shapely.box(*low, *high)
    for t, row in enumerate(mesh.neighbors.tolist()):
        for k, u in enumerate(row):
            a, b = (mesh.triangles[t][(k + j) % 3] for j in (1, 2))
            i = place[frozenset((int(a), int(b)))]
            if u < 0:
                dx, dy = seeds[b] - seeds[a]
                end = centers[t] + 1e4 * np.array([dy, -dx])
                assert np.isinf(whole[i])
            else:
                end = centers[u]
                assert whole[i] == pytest.approx(np.hypot(*(centers[u] - centers[t])))
            line = shapely.LineString([centers[t], end])
            assert inside[i] == pytest.approx(line.intersection(box).length, abs=1e-6)


def test_what_cannot_be_compared():
    with pytest.raises(InputError, match="label 1 has "):
        compare_digital(vorotool.read("data/blobs.png"))
    with pytest.raises(LimitError):
        compare_digital([[0, 0], [9, 9]], max_pixels=5)
