"""Compare the predicates with Python integers on near-degenerate points: `--calls 1000000 --seed 1`.

Half of the calls are orient2d, half incircle; every level is compared as well where it decides.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections import Counter
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))
from support.families.predicate_cases import FAMILIES, NEAR_DEGENERATE, exact_signs
from vorotool import _core

UNDECIDED = 2
LEVELS = ("auto", "filter", "seen", "integers", "expansions", "wide")
BATCH = 500


def check(rng: np.random.Generator, name: str, n: int, decided: Counter[str]) -> int:
    """Check one batch on every level; give the number of wrong signs and add to what the levels decided."""
    points = np.ascontiguousarray(FAMILIES[name](rng, BATCH, n))
    right = exact_signs(points)
    predicate = _core.kernel.orient2d if n == 3 else _core.kernel.incircle
    wrong = 0
    for level in LEVELS:
        signs = predicate(points, level)
        known = signs != UNDECIDED
        wrong += int((signs[known] != right[known]).sum())
        decided[level] += int(known.sum())
    decided["zero"] += int((right == 0).sum())
    decided["calls"] += BATCH
    return wrong


def main() -> int:
    """Run until enough calls were compared; exit 1 if any sign was wrong or none was compared."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--calls", type=int, default=10**6)
    parser.add_argument("--seconds", type=float, default=np.inf, help="begin no batch after so many")
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    decided: dict[str, Counter[str]] = {name: Counter() for name in NEAR_DEGENERATE}
    calls = wrong = batch = 0
    start = time.monotonic()
    while calls < arguments.calls and time.monotonic() - start < arguments.seconds:
        name, n = NEAR_DEGENERATE[batch // 2 % len(NEAR_DEGENERATE)], 3 + batch % 2
        bad = check(np.random.default_rng([arguments.seed, batch]), name, n, decided[name])
        if bad:
            print(f"wrong: seed {arguments.seed}, batch {batch}, {name}, {n} points: {bad} signs")
        wrong, calls, batch = wrong + bad, calls + BATCH, batch + 1
    print(f"{'per cent decided':16}" + "".join(f"{key:>12}" for key in (*LEVELS[1:], "zero")) + f"{'calls':>12}")
    for name, count in decided.items():
        shares = (f"{100 * count[key] / max(count['calls'], 1):12.1f}" for key in (*LEVELS[1:], "zero"))
        print(f"{name:16}" + "".join(shares) + f"{count['calls']:12,}")
    print(f"{calls:,} calls, {wrong} wrong signs, {time.monotonic() - start:.0f} s")
    return int(wrong > 0 or calls == 0)


if __name__ == "__main__":
    sys.exit(main())
