"""The engine's decisions, whichever level takes them, against the exact level."""

import itertools
import random

import numpy as np

from support.core_testing import segment_voronoi as core
from support.families import segment_cases

CASES = 4000


def rows(cases):
    return np.array([[s.a + s.b for s in case] for case in cases], dtype=np.int32)


def discs_of(seed):
    """Of mirrored sites and any others: three that have a disc of positive radius, and another one."""
    rng = random.Random(seed)
    cases = []
    for k in range(CASES):
        *three, fourth = segment_cases.case(rng) if k % 4 == 0 else segment_cases.mirrored_sites(rng)
        cases += [[*three, fourth], [*three[::-1], fourth]]
    valid = have_discs(rows(cases)[:, :3])
    return [case for case, is_valid in zip(cases, valid, strict=True) if is_valid and not collinear(case[:3])]


def collinear(sites):
    """Whether two segments are on one line: in a diagram the cell of an end is between theirs."""
    segments = [s for s in sites if not s.is_point]
    return any(s.height(t.a) == s.height(t.b) == 0 for s, t in itertools.combinations(segments, 2))


def clearance_signs(discs, queries):
    return core.clearance_signs(np.concatenate([discs, queries[:, None]], axis=1))


def have_discs(triples):
    """Whether the discs have a positive radius, and touch their segments within these."""
    triples = np.ascontiguousarray(triples)
    found = core.discs(triples)[:, 2] > 0
    for k in range(3):
        found &= clearance_signs(triples, triples[:, k]) == 0
    return found


def test_every_level_tells_what_the_exact_one_does():
    cases = [case for case in discs_of(1) if not case[3].is_point]
    given = rows(cases)
    for end in ([0, 1, 0, 1], [2, 3, 2, 3]):  # no disc of a diagram holds an end of a segment
        given = np.ascontiguousarray(given[clearance_signs(given[:, :3], given[:, 3, end]) >= 0])
    got, level = core.conflicts(given).T
    signs = core.clearance_signs(given)
    np.testing.assert_array_equal(got, signs < 0)
    ties = np.bincount(level[signs == 0], minlength=4)
    assert ties[1] > 100  # told by integers
    assert ties[3] > 30  # by multiprecision
    assert (level[signs != 0] == 0).sum() > 100


def test_vertices_coincide_where_their_discs_are_one():
    pairs = []
    for case in discs_of(2):
        others = [(case[i], t, case[(i + 1) % 3]) for i, t in itertools.product(range(3), case[3:])]
        pairs += [[*case[:3], *other] for other in others]
    given = rows(pairs)
    given = np.ascontiguousarray(given[have_discs(given[:, 3:])])
    right = core.same_disc(given)
    np.testing.assert_array_equal(core.coincidences(given), right)
    assert right.sum() > 100
