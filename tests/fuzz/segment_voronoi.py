"""Compute segment diagrams of every family under symmetries and check them exactly: `--cases 10000 --seed 1`.

Each case is checked by the shipped checker. Its points and segments are also permuted, and another number of threads is
used, which must give the same diagram but for the numbers.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections import Counter
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))
from segment_families import FAMILIES, draw, renumbered, symmetries
from vorotool import VorotoolError
from vorotool.engines.segment_verification import verify_segment_voronoi
from vorotool.engines.segment_voronoi import segment_voronoi


def failure(points: np.ndarray, segments: np.ndarray, rng: np.random.Generator) -> str | None:
    """What is wrong with the diagram of this graph, if anything."""
    try:
        diagram = segment_voronoi(points, segments, threads=1)
        verify_segment_voronoi(diagram, threads=1)
        new_points, new_segments, number = renumbered(points, segments, rng)
        other = segment_voronoi(new_points, new_segments, threads=int(rng.integers(1, 4)))
    except (VorotoolError, RuntimeError) as error:
        return str(error)
    for name in ("vertices", "radius", "vertex_start", "edges"):
        if not np.array_equal(getattr(diagram, name), getattr(other, name)):
            return f"a permutation changes {name}"
    if not np.array_equal(number[diagram.edge_sites], other.edge_sites):
        return "a permutation changes the sites of the edges"
    return None


def main() -> int:
    """Run all cases; exit 1 if any failed."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--cases", type=int, default=10**4)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--largest", type=int, default=400)
    parser.add_argument("--family", choices=FAMILIES, nargs="+", default=list(FAMILIES))
    arguments = parser.parse_args()
    cases: Counter[str] = Counter()
    seconds: Counter[str] = Counter()
    segments_seen = failed = 0
    for case in range(arguments.cases):
        rng = np.random.default_rng([arguments.seed, case])
        name = arguments.family[case % len(arguments.family)]
        n = int(np.exp(rng.uniform(0, np.log(arguments.largest))))
        points, segments = draw(name, n, [arguments.seed, case])
        turned = list(symmetries(points))[int(rng.integers(0, 8))]
        start = time.monotonic()
        wrong = failure(turned, segments, rng)
        seconds[name] += time.monotonic() - start
        if wrong:
            print(f"wrong: seed {arguments.seed}, case {case}, {name}, {len(segments)} segments: {wrong}", flush=True)
        cases[name] += 1
        segments_seen += len(segments)
        failed += wrong is not None
    for name, count in cases.items():
        print(f"{name:14} {count:8,} cases {seconds[name]:8.1f} s")
    print(f"{arguments.cases:,} cases, {segments_seen:,} segments, {failed} failures")
    return int(failed > 0)


if __name__ == "__main__":
    sys.exit(main())
