"""Measure the segment Voronoi diagram beside Boost, in one run: `make bench`.

Nanoseconds a segment, the least of several runs: of the engine, and of the arrays made from it. Ratios are what to
compare, since machines differ: `(5.0 ×, 4.0 ×)` is five times as long as the engine, which makes what Boost makes, and
four times as long as both. `visited` are the Voronoi vertices tested a
segment, `exact` the tests of a thousand segments that took multiprecision; memory is the most that the process grew by,
bytes a segment: the engine alone, and with the arrays.

Boost is measured on the same integers by `boost_voronoi.cpp`, which is compiled if there are headers: those of the
system, or in `$BOOST_ROOT`. pyvoronoi (Boost's diagram as Python objects) is measured where it is installed, on at most
10^5 segments. A second table tells how the visited vertices grow with the number of segments.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from importlib.util import find_spec
from itertools import product
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))
from benchmarks.timing import in_own_process, peak, print_head, reset_peak
from support.families import segment_families
from vorotool import _core

FAMILIES = ("star_smooth", "contour", "hilbert", "koch", "comb", "comb_tapered", "star_rough")
GROWING = [name for name in segment_families.FAMILIES if name not in segment_families.JOINED]
GROWTH = (10**3, 10**4, 10**5, 10**6)


def graph(name: str, n: int) -> tuple[np.ndarray, np.ndarray]:
    """The graph of a family with about n segments."""
    aims = {"comb": 2 * n, "contour": round(1.75 * n)}
    return segment_families.draw(name, aims.get(name, n), 1)


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


def compiled(folder: str) -> Path | None:
    """Boost's benchmark, or nothing where there are no headers."""
    compiler = os.environ.get("CXX", "c++")
    include = [f"-I{os.environ['BOOST_ROOT']}"] if "BOOST_ROOT" in os.environ else []
    header = subprocess.run(
        [compiler, "-E", "-x", "c++", *include, "-"],
        input="#include <boost/polygon/voronoi.hpp>\n",
        capture_output=True,
        text=True,
        check=False,
    )
    if header.returncode:
        return None
    program = Path(folder) / "boost_voronoi"
    source = Path(__file__).with_name("boost_voronoi.cpp")
    subprocess.run([compiler, "-std=c++20", "-O3", "-DNDEBUG", *include, "-o", program, source], check=True)
    return program


def boost_measures(program: Path, points: np.ndarray, segments: np.ndarray, runs: int) -> tuple[float, float]:
    """Least nanoseconds and most bytes of Boost's diagram, a segment."""
    with tempfile.NamedTemporaryFile() as file:
        points[segments].astype(np.int32).tofile(file.name)
        told = subprocess.run(
            [program, file.name, str(runs)], check=True, capture_output=True, text=True
        ).stdout.split()
    return float(told[1]) / len(segments), float(told[2]) / len(segments)


def measure(name: str, n: int, threads: int, runs: int, boost: Path | None) -> str:
    """One row of the table, from a process of its own."""
    points, segments = graph(name, n)
    small = _core.segment_voronoi.SegmentVoronoi(points[:3].copy(), segments[:0].copy(), threads, None)
    small.take_arrays(None, threads, None)
    reset_peak()
    before = peak()
    engine, arrays = [], []
    memory = whole_memory = 0  # of the first run: what is freed may be kept for the next one
    for _ in range(runs):
        start = time.perf_counter()
        diagram = _core.segment_voronoi.SegmentVoronoi(points, segments, threads, None)
        engine.append(time.perf_counter() - start)
        memory = memory or peak() - before
        start = time.perf_counter()
        result = diagram.take_arrays(None, threads, None)
        arrays.append(time.perf_counter() - start)
        whole_memory = whole_memory or peak() - before
        del result
    count = len(segments)
    made = [1e9 * min(times) / count for times in (engine, arrays)]

    def beside(peer: float) -> str:
        return f"{peer:,.0f} ({peer / made[0]:.1f} ×, {peer / sum(made):.1f} ×)"

    row = f"| {name} | {count:,} | {threads} | {made[0]:,.0f} + {made[1]:,.0f} |"
    row += f" {diagram.counts['visited'] / count:.1f} | {1000 * diagram.counts['exact'] / count:.2f} |"
    row += f" {memory / count:.0f} | {whole_memory / count:.0f} |"
    if boost and threads == 1:
        peer, peer_memory = boost_measures(boost, points, segments, runs)
        row += f" {beside(peer)} | {peer_memory:.0f} |"
    else:
        row += " | |"
    if find_spec("pyvoronoi") and n <= 10**5 and threads == 1:
        row += f" {beside(1e9 * pyvoronoi_seconds(points, segments) / count)} |"
    else:
        row += " |"
    return row


def growth_row(name: str) -> str:
    """Visited vertices a segment for ten times as many segments each, and how the last step compares to the mean."""
    visited = []
    for n in GROWTH:
        try:
            points, segments = graph(name, n)
        except AssertionError:  # so many do not fit the lattice
            break
        visited.append(
            _core.segment_voronoi.SegmentVoronoi(points, segments, 1, None).counts["visited"] / len(segments)
        )
    mean = (visited[-1] - visited[0]) / (len(visited) - 1)
    ratio = f"{(visited[-1] - visited[-2]) / mean:.2f}" if mean > 0.5 else ""
    cells = [f"{value:.1f}" for value in visited] + [""] * (len(GROWTH) - len(visited))
    return f"| {name} | {' | '.join(cells)} | {mean:.1f} | {ratio} |"


def print_times(families: Sequence[str], sizes: list[int], threads: list[int], runs: int) -> None:
    """The table of times and memory."""
    with tempfile.TemporaryDirectory() as folder:
        boost = compiled(folder)
        print("nanoseconds a segment: engine + arrays")
        if boost is None:
            print("no headers of Boost: its columns are empty (install them, or set BOOST_ROOT)")
        columns = ("family", "segments", "threads", "ours", "visited", "exact, ‰", "bytes", "with arrays")
        print()
        print_head(*columns, "Boost", "its bytes", "pyvoronoi")
        for n, name, count in product(sizes, families, threads):
            print(in_own_process(measure, name, n, count, runs, boost), flush=True)


def print_growth(families: Sequence[str]) -> None:
    """The table of visited vertices."""
    print("\nVoronoi vertices visited a segment, one thread. If they grow as log n, every tenfold adds as much:")
    print("last / mean is 1. If they grew as the square root of n, it would be 2.1.\n")
    print_head("family", *(f"{n:,}" for n in GROWTH), "mean step", "last / mean")
    for name in families:
        print(in_own_process(growth_row, name), flush=True)


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--segments", type=int, nargs="+", default=[10_000, 100_000, 1_000_000])
    parser.add_argument("--threads", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--family", choices=GROWING, nargs="+")
    parser.add_argument("--table", choices=["times", "growth"], nargs="+", default=["times", "growth"])
    arguments = parser.parse_args()
    if "times" in arguments.table:
        print_times(arguments.family or FAMILIES, arguments.segments, arguments.threads, arguments.runs)
    if "growth" in arguments.table:
        print_growth(arguments.family or GROWING)


if __name__ == "__main__":
    main()
