"""Triangulate points of every family and check the result exactly: `--cases 100000 --seed 1`.

Each case is checked by the shipped checker; small ones also against the definition in rationals, and every one with a
permutation of its points and another number of threads, which must give the same triangles in the same order.
"""

from __future__ import annotations

import argparse
import sys
import time
import warnings
from collections import Counter
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))
from delaunay_oracle import delaunay_triangles
from point_families import FAMILIES, draw
from vorotool import VorotoolError, delaunay, verify_triangulation

SMALL = 7


def failure(points: np.ndarray, rng: np.random.Generator) -> str | None:
    """What is wrong with the triangulation of these points, if anything."""
    mesh = delaunay(points, threads=1)
    try:
        verify_triangulation(mesh, threads=1)
    except VorotoolError as error:
        return str(error)
    order = rng.permutation(len(points))
    other = delaunay(points[order], threads=int(rng.integers(1, 6)))
    for name in ("triangles", "neighbours", "hull"):
        ours, theirs = getattr(mesh, name), getattr(other, name)
        if name != "neighbours":
            ours, theirs = points[ours], other.points[theirs]
        if not np.array_equal(ours, theirs):
            return f"a permutation changes {name}"
    if len(points) <= SMALL:
        triangles = {frozenset(map(tuple, points[t].tolist())) for t in mesh.triangles}
        if triangles != {frozenset((float(x), float(y)) for x, y in t) for t in delaunay_triangles(points.tolist())}:
            return "not the triangles of the definition"
    return None


def main() -> int:
    """Run all cases; exit 1 if any failed."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--cases", type=int, default=10**5)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    warnings.simplefilter("ignore")
    names = list(FAMILIES)
    cases: Counter[str] = Counter()
    points_seen = failed = 0
    start = time.monotonic()
    for case in range(arguments.cases):
        rng = np.random.default_rng([arguments.seed, case])
        name = names[case % len(names)]
        n = int(rng.integers(0, SMALL + 1)) if rng.random() < 0.5 else int(2 ** rng.uniform(3, 10 if case % 50 else 13))
        points = draw(name, n, [arguments.seed, case])
        wrong = failure(points, rng)
        if wrong:
            print(f"wrong: seed {arguments.seed}, case {case}, {name}, {len(points)} points: {wrong}")
        cases[name] += 1
        points_seen += len(points)
        failed += wrong is not None
    for name, count in cases.items():
        print(f"{name:18} {count:10,} cases")
    seconds = time.monotonic() - start
    print(f"{arguments.cases:,} cases, {points_seen:,} points, {failed} failures, {seconds:.0f} s")
    return int(failed > 0)


if __name__ == "__main__":
    sys.exit(main())
