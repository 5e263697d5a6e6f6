"""Compare the predicates in space with Python integers on near-degenerate points: `--calls 1000000 --seed 1`.

Half of the calls are orient3d, half in_sphere with its ties; every level is compared as well where it decides.
"""

from __future__ import annotations

import sys
from collections import Counter
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))
from fuzz.runner import Cases, options
from support.families.space_cases import FAMILIES, NEAR_DEGENERATE, exact_signs, exact_ties
from vorotool._core import tetrahedra

UNDECIDED = 2
LEVELS = ("auto", "filter", "integers", "wide")
BATCH = 500


def check(rng: np.random.Generator, name: str, n: int, decided: Counter[str]) -> int:
    """Check one batch on every level; give the number of wrong signs and add to what the levels decided."""
    points = np.ascontiguousarray(FAMILIES[name](rng, BATCH, n))
    right = exact_signs(points)
    predicate = tetrahedra.orient3d if n == 4 else tetrahedra.in_sphere
    wrong = 0
    for level in LEVELS:
        signs = predicate(points, level)
        known = signs != UNDECIDED
        wrong += int((signs[known] != right[known]).sum())
        decided[level] += int(known.sum())
    if n == 5:
        wrong += int((tetrahedra.in_sphere(points, "ties") != exact_ties(points)).sum())
    decided["zero"] += int((right == 0).sum())
    decided["calls"] += BATCH
    return wrong


def main() -> int:
    """Run until enough calls were compared; exit 1 if any sign was wrong or none was compared."""
    arguments = options(10**6, "call").parse_args()
    arguments.count = -(-arguments.count // BATCH)
    sets, wrong = Cases(arguments, "set"), 0
    decided: dict[str, Counter[str]] = {name: Counter() for name in NEAR_DEGENERATE}
    for number in sets:
        name, n = NEAR_DEGENERATE[number // 2 % len(NEAR_DEGENERATE)], 4 + number % 2
        bad = check(sets.random(number), name, n, decided[name])
        sets.judge(number, name, f"{bad} signs" if bad else None, f"{n} points")
        wrong += bad
    print(f"{'per cent decided':16}" + "".join(f"{key:>12}" for key in (*LEVELS[1:], "zero")) + f"{'calls':>12}")
    for name, count in decided.items():
        shares = (f"{100 * count[key] / max(count['calls'], 1):12.1f}" for key in (*LEVELS[1:], "zero"))
        print(f"{name:16}" + "".join(shares) + f"{count['calls']:12,}")
    return sets.end(f"sets of {BATCH} calls, {wrong} wrong signs")


if __name__ == "__main__":
    sys.exit(main())
