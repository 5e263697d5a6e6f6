"""Compare the predicates with Python integers on near-degenerate points: `--calls 1000000 --seed 1`.

A quarter of the calls each are orient2d, incircle, orient3d and in_sphere, the last with its ties; every level is
compared as well where it decides.
"""

from collections.abc import Callable
from typing import Any

import numpy as np

from fuzz.runner import Cases, Comparison, Verdict
from support.families.predicate_cases import FAMILIES, NEAR_DEGENERATE, exact_signs, exact_ties
from vorotool._core import kernel, tetrahedra

UNDECIDED = 2
LEVELS = {2: ("auto", "filter", "seen", "integers", "expansions", "wide"), 3: ("auto", "filter", "integers", "wide")}
PREDICATES: tuple[tuple[Callable[..., Any], int, int], ...] = (
    *((kernel.orient2d, 3, 2), (kernel.incircle, 4, 2)),
    *((tetrahedra.orient3d, 4, 3), (tetrahedra.in_sphere, 5, 3)),
)
"""Each with how many points it takes, and of how many dimensions."""
BATCH = 500


def check(case: int, cases: Cases) -> Verdict:
    """Check one batch on every level."""
    number = case % len(PREDICATES)
    predicate, n, d = PREDICATES[number]
    name = NEAR_DEGENERATE[d][case // len(PREDICATES) % len(NEAR_DEGENERATE[d])]
    points = np.ascontiguousarray(FAMILIES[name](cases.random(case), BATCH, n, d))
    right = exact_signs(points)
    wrong = 0
    for level in LEVELS[d]:
        signs = predicate(points, level)
        known = signs != UNDECIDED
        wrong += int((signs[known] != right[known]).sum())
        cases.counts[f"decided in {d} dimensions by {level}"] += int(known.sum())
    if n == 5:
        wrong += int((predicate(points, "ties") != exact_ties(points)).sum())
    cases.counts["zeros"] += int((right == 0).sum())
    cases.counts["calls"] += BATCH
    return name, f"{wrong} signs" if wrong else None, f"{n} points in {d} dimensions"


COMPARISON = Comparison(10**6, check, "call")
