"""Measure the segment Voronoi diagram, in one run: `make bench`.

Nanoseconds a segment, the least of several runs: of the engine, and of the arrays made from it. Ratios are what to
compare, since machines differ. `visited` are the Voronoi vertices tested a segment, `exact` the tests of a thousand
segments that took multiprecision; memory is the most that the process grew by, bytes a segment: the engine alone, and
with the arrays. pyvoronoi (Boost's diagram) is measured beside it where it is installed, on at most 10^5 segments.
"""

from __future__ import annotations

import argparse
import resource
import subprocess
import sys
import time
from importlib.util import find_spec
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))
from segment_families import draw
from vorotool import _core

FAMILIES = ("star_smooth", "contour", "hilbert", "koch", "comb", "comb_tapered", "star_rough")


def peak() -> int:
    """Most bytes that the process has held."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024


def graph(name: str, n: int) -> tuple[np.ndarray, np.ndarray]:
    """The graph of a family with about n segments."""
    aims = {"comb": 2 * n, "contour": round(1.75 * n)}
    return draw(name, aims.get(name, n), 1)


def pyvoronoi_seconds(points: np.ndarray, segments: np.ndarray) -> float:
    """Boost's diagram with its vertices, edges and cells, as pyvoronoi gives it."""
    import pyvoronoi

    lines = points[segments].tolist()
    start = time.perf_counter()
    diagram = pyvoronoi.Pyvoronoi(1)
    for line in lines:
        diagram.AddSegment(line)
    diagram.Construct()
    diagram.GetVertices()
    diagram.GetEdges()
    diagram.GetCells()
    return time.perf_counter() - start


def measure(name: str, n: int, threads: int, runs: int) -> str:
    """One row of the table, from a process of its own."""
    points, segments = graph(name, n)
    small = _core.SegmentVoronoi(points[:3].copy(), segments[:0].copy(), threads, None)
    small.arrays(threads, None)
    before = peak()
    engine, arrays = [], []
    memory = 0
    for _ in range(runs):
        start = time.perf_counter()
        diagram = _core.SegmentVoronoi(points, segments, threads, None)
        engine.append(time.perf_counter() - start)
        memory = memory or peak() - before
        start = time.perf_counter()
        result = diagram.arrays(threads, None)
        arrays.append(time.perf_counter() - start)
        del result
    whole_memory = peak() - before
    count = len(segments)
    made = [1e9 * min(times) / count for times in (engine, arrays)]
    row = f"| {name} | {count:,} | {threads} | {made[0]:,.0f} + {made[1]:,.0f} |"
    row += f" {diagram.counts['visited'] / count:.1f} | {1000 * diagram.counts['exact'] / count:.2f} |"
    row += f" {memory / count:.0f} | {whole_memory / count:.0f} |"
    if find_spec("pyvoronoi") and n <= 10**5 and threads == 1:
        peer = 1e9 * pyvoronoi_seconds(points, segments) / count
        row += f" {peer:,.0f} ({peer / sum(made):.1f} ×) |"
    else:
        row += " |"
    return row


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--segments", type=int, nargs="+", default=[10_000, 100_000, 1_000_000])
    parser.add_argument("--threads", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--family", choices=FAMILIES, nargs="+", default=FAMILIES)
    parser.add_argument("--row", action="store_true", help="only this row, in this process")
    arguments = parser.parse_args()
    if arguments.row:
        print(measure(arguments.family[0], arguments.segments[0], arguments.threads[0], arguments.runs))
        return
    print("nanoseconds a segment: engine + arrays\n")
    print("| family | segments | threads | ours | visited | exact, ‰ | bytes | with arrays | pyvoronoi |")
    print("|---" * 9 + "|")
    for n in arguments.segments:
        for name in arguments.family:
            for threads in arguments.threads:
                row = ["--row", "--family", name, "--segments", str(n), "--threads", str(threads)]
                command = [sys.executable, __file__, *row, "--runs", str(arguments.runs)]
                print(subprocess.run(command, check=True, capture_output=True, text=True).stdout, end="", flush=True)


if __name__ == "__main__":
    main()
