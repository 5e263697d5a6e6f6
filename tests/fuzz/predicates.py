"""Compare the predicates with Python integers on near-degenerate points: `--calls 1000000 --seed 1`.

A quarter of the calls each are orient2d, incircle, orient3d and in_sphere, the last with its ties; every level is
compared as well where it decides.
"""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))
from fuzz.runner import Cases, options
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


def check(rng: np.random.Generator, name: str, number: int, decided: Counter[str]) -> int:
    """Check one batch on every level; give the number of wrong signs and add to what the levels decided."""
    predicate, n, d = PREDICATES[number]
    points = np.ascontiguousarray(FAMILIES[name](rng, BATCH, n, d))
    right = exact_signs(points)
    wrong = 0
    for level in LEVELS[d]:
        signs = predicate(points, level)
        known = signs != UNDECIDED
        wrong += int((signs[known] != right[known]).sum())
        decided[level] += int(known.sum())
    if n == 5:
        wrong += int((predicate(points, "ties") != exact_ties(points)).sum())
    decided["zero"] += int((right == 0).sum())
    decided["calls"] += BATCH
    return wrong


def main() -> int:
    """Run until enough calls were compared; exit 1 if any sign was wrong or none was compared."""
    arguments = options(10**6, "call").parse_args()
    arguments.count = -(-arguments.count // BATCH)
    sets, wrong = Cases(arguments, "set"), 0
    decided: dict[tuple[int, str], Counter[str]] = {(d, name): Counter() for d in (2, 3) for name in NEAR_DEGENERATE[d]}
    for case in sets:
        number = case % len(PREDICATES)
        _, n, d = PREDICATES[number]
        name = NEAR_DEGENERATE[d][case // len(PREDICATES) % len(NEAR_DEGENERATE[d])]
        bad = check(sets.random(case), name, number, decided[d, name])
        sets.judge(case, name, f"{bad} signs" if bad else None, f"{n} points in {d} dimensions")
        wrong += bad
    columns = (*LEVELS[2][1:], "zero")
    print(f"{'per cent decided':18}" + "".join(f"{key:>12}" for key in columns) + f"{'calls':>12}")
    for (d, name), count in decided.items():
        shares = (f"{100 * count[key] / max(count['calls'], 1):12.1f}" for key in columns)
        print(f"{name:16}{d:2}" + "".join(shares) + f"{count['calls']:12,}")
    return sets.end(f"sets of {BATCH} calls, {wrong} wrong signs")


if __name__ == "__main__":
    sys.exit(main())
