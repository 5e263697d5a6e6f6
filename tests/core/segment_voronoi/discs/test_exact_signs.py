from __future__ import annotations

import itertools
import random

import numpy as np
import pytest

from support.core_testing import segment_voronoi as core
from support.families import segment_cases
from support.oracles import segment_oracle
from support.oracles.tangent_discs import (
    Site,
    certain,
    clearance,
    counter_clockwise,
    sign,
    sites_of,
    tangent_circles,
    touches,
)

NO_DISC = 2
CASES = 250


def rows(*cases):
    return np.array([[s.a + s.b for s in case] for case in cases], dtype=np.int32)


def discs_in_order(sites):
    """Of every order of contact of three sites: the discs with their feet on the segments."""

    def decide(tie, sure):
        found = {}
        for disc in tangent_circles(sites):
            if not all(touches(disc, s, tie, sure) for s in sites):
                continue
            orders = [counter_clockwise(disc, list(enumerate(sites)), tie, sure)]
            if sign(disc.r, tie, sure) == 0:  # at a common end no order is wrong
                orders = [[0, 1, 2], [0, 2, 1]]
            for order in orders:
                k = order.index(0)
                same = found.setdefault(tuple(order[k:] + order[:k]), [])
                if not any(all(sign(getattr(disc, v) - getattr(d, v), tie, sure) == 0 for v in "xyr") for d in same):
                    same.append(disc)
        return found

    return certain(decide)


def clearance_sign(disc, query):
    return certain(lambda tie, sure: sign(clearance(disc, query), tie, sure))


@pytest.mark.parametrize("seed", range(4))
def test_signs_and_values_against_many_digits(seed):
    seen = 0
    for sites in segment_cases.cases(seed, CASES):
        for order, discs in discs_in_order(sites[:3]).items():
            assert len(discs) == 1, f"{sites}: the order of contact does not tell which disc"
            (disc,) = discs
            case = [sites[k] for k in order] + sites[3:]
            (got,) = core.clearance_signs(rows(case))
            assert got == clearance_sign(disc, sites[3]), case
            right = np.array([float(disc.x), float(disc.y), float(disc.r)])
            np.testing.assert_allclose(core.discs(rows(case[:3]))[0], right, rtol=2.0**-52, atol=0)
            seen += 1
    assert seen > CASES // 3


def test_the_start_of_the_order_does_not_matter():
    for sites in segment_cases.cases(11, 100):
        turns = rows(sites, [*sites[1:3], sites[0], sites[3]], [sites[2], *sites[:2], sites[3]])
        assert len(set(core.clearance_signs(turns).tolist())) == 1


def test_turned_and_mirrored_sites_give_the_same_signs():
    for sites in segment_cases.cases(12, 100):
        given = rows(sites)
        turned = given[..., [1, 0, 3, 2]] * np.array([-1, 1, -1, 1], dtype=np.int32)
        mirrored = given[:, [2, 1, 0, 3]] * np.array([-1, 1, -1, 1], dtype=np.int32)
        swapped = given[..., [2, 3, 0, 1]]
        right = core.clearance_signs(given)
        for image in (turned, mirrored, swapped):
            np.testing.assert_array_equal(core.clearance_signs(np.ascontiguousarray(image)), right)


def test_a_disc_touches_its_own_sites():
    for sites in segment_cases.cases(13, 200):
        for order in discs_in_order(sites[:3]):
            case = [sites[k] for k in order]
            assert core.clearance_signs(rows(*([*case, s] for s in case))).tolist() == [0, 0, 0]


def point(x, y):
    return Site((x, y), (x, y))


def segment(ax, ay, bx, by):
    return Site((ax, ay), (bx, by))


def test_corners_have_radius_0():
    corner, x_axis, y_axis, up = point(0, 0), segment(0, 0, 5, 0), segment(0, 7, 0, 0), segment(0, 0, -3, 3)
    for case in itertools.permutations([corner, x_axis, y_axis]):
        np.testing.assert_array_equal(core.discs(rows(case)), [[0, 0, 0]])
    for case in itertools.permutations([up, x_axis, y_axis]):
        queries = [
            [*case, point(0, 1)],
            [*case, corner],
            [*case, segment(-2, -2, 0, 0)],
            [*case, segment(0, -1, 1, -1)],
        ]
        assert core.clearance_signs(rows(*queries)).tolist() == [1, 0, 0, 1]


def test_collinear_segments_touch_at_their_common_end():
    left, right, end, above = segment(-9, 0, 0, 0), segment(0, 0, 5, 0), point(0, 0), point(3, 4)
    # the centre is (0, h) with h² = 9 + (4 - h)²
    for case in ([left, right, above], [left, end, above], [end, right, above]):
        np.testing.assert_array_equal(core.discs(rows(case)), [[0, 3.125, 3.125]])
        assert core.clearance_signs(rows([case[1], case[0], case[2], end])).tolist() == [NO_DISC]
    assert np.isnan(core.discs(rows([left, right, end], [left, end, right]))).all()


def test_parallel_segments():
    bottom, top = segment(-9, 0, 9, 0), segment(-9, 2, 9, 2)
    case = [bottom, point(4, 1), top]
    np.testing.assert_array_equal(core.discs(rows(case, case[::-1])), [[3, 1, 1], [5, 1, 1]])
    assert np.isnan(core.discs(rows([bottom, top, segment(-9, 4, 9, 4)]))).all()


def test_coordinates_beyond_the_lattice_are_refused():
    with pytest.raises(IndexError):
        core.discs(rows([point(2**30, 0), point(0, 1), point(2, 2)]))


def has_disc(sites):
    return not np.isnan(core.discs(rows(sites))).any()


def test_the_same_disc():
    """Any three sites of a vertex, in the order of its ring, have its disc."""
    rng = random.Random(5)
    seen = {0: 0, 1: 0}
    for _ in range(30):
        sites = sites_of(*segment_cases.random_graph(rng, 7, 4, rng.choice([1, 1, 2, 3])))
        triples = [
            (v, case)
            for v, vertex in enumerate(segment_oracle.find_vertices(sites))
            if vertex.disc.r > 1e-9
            for triple in itertools.combinations(vertex.ring, 3)
            if has_disc(case := [sites[k] for k in triple])
        ]
        pairs = list(itertools.combinations(triples, 2))
        right = [int(v == w) for (v, _), (w, _) in pairs]
        if pairs:
            got = core.same_disc(rows(*(first + second for (_, first), (_, second) in pairs)))
            assert got.tolist() == right
        for same in right:
            seen[same] += 1
    assert min(seen.values()) > 150


# ---- the middle of an edge, against the diagrams before and after ----


def corner_order(ring, sites, chosen):
    """Three sites of a ring, in its order, that have one disc: not only two collinear segments and their end."""
    for triple in itertools.combinations(ring, 3):
        if set(chosen) <= set(triple) and has_disc([sites[k] for k in triple]):
            return [sites[k] for k in triple]
    return None


def inserted(points, edges):
    """The diagram without the last segment and with it, as (sites, vertices, edges) and (vertices, edges)."""
    sites = sites_of(points, edges)
    old, new = (segment_oracle.find_vertices(s) for s in (sites[:-1], sites))
    return sites, old, segment_oracle.find_edges(sites[:-1], old), new, segment_oracle.find_edges(sites, new)


def survivors(sites, left, right, first, second, new, new_edges):
    """1 if a piece between the two vertices is left."""

    def place(vertex):
        return segment_oracle.place_on_bisector(sites[left], sites[right], vertex.disc, (vertex.disc.x, vertex.disc.y))

    query = len(sites) - 1
    branch, start = place(first)
    _, stop = place(second)
    places = [
        place(new[v])
        for *ends, a, b in new_edges
        if (a, b) == (left, right)
        for v in ends
        if v >= 0 and query in new[v].ring
    ]
    if any(start < at < stop and side == branch for side, at in places):
        return 1
    return -1


@pytest.mark.parametrize("seed", range(3))
def test_the_middle_of_edges_against_diagrams(seed):
    rng = random.Random(seed)
    seen = {1: 0, -1: 0}
    for _ in range(40):
        points, edges = segment_cases.random_graph(rng, 6, rng.choice([1, 3, 5]), rng.choice([3, 5, 8, 1000, 2**29]))
        if not edges:
            continue
        sites, old, old_edges, new, new_edges = inserted(points, edges)
        for v, w, left, right in old_edges:
            if min(v, w) < 0:
                continue
            chosen = [corner_order(old[k].ring, sites, (left, right)) for k in (v, w)]
            if None in chosen or any(old[k].disc.r == 0 for k in (v, w)):
                continue
            if core.clearance_signs(rows(*([*case, sites[-1]] for case in chosen))).tolist() != [-1, -1]:
                continue
            case = [sites[left], sites[right], *chosen[0], *chosen[1], sites[-1]]
            right_sign = survivors(sites, left, right, old[v], old[w], new, new_edges)
            assert core.edge_clearance_signs(rows(case)).tolist() == [right_sign], (points, edges, v, w)
            seen[right_sign] += 1
    assert seen[-1] > 10
    assert seen[1] > 0
