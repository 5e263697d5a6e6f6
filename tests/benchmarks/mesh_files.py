"""Measure whole processes from a list of points to files: `make bench`.

Seconds, the least of several runs of ``vorotool delaunay points.npy -o FILE``: wall clock, and user time of all
threads. The bare process reads three points, so that it tells what starting costs.
"""

from __future__ import annotations

import argparse
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

OUTPUTS = ("edges.csv", "edges.npz", "edges.json", "edges.geojson", "edges.obj", "edges.svg", "edges.png")


def measured(command: list[str], runs: int) -> tuple[float, float]:
    """Least wall-clock and user seconds of a command."""
    times = []
    for _ in range(runs):
        before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
        subprocess.run(command, check=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        times.append((time.perf_counter() - start, after.ru_utime - before.ru_utime))
    return min(wall for wall, _ in times), min(user for _, user in times)


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--points", type=int, default=1_000_000)
    parser.add_argument("--runs", type=int, default=3)
    options = parser.parse_args()
    rng = np.random.default_rng(1)
    with tempfile.TemporaryDirectory() as folder:
        small, large = Path(folder, "small.npy"), Path(folder, "points.npy")
        np.save(small, rng.random((3, 2)))
        np.save(large, rng.random((options.points, 2)))
        print(f"{options.points} points, whole process    wall    user    MB")
        for source, name in ((small, "edges.csv"), *((large, name) for name in OUTPUTS)):
            target = Path(folder, name)
            command = [sys.executable, "-m", "vorotool", "delaunay", str(source), "-o", str(target)]
            wall, user = measured(command, options.runs)
            what = name if source == large else "three points"
            print(f"  {what:32} {wall:7.2f} {user:7.2f} {target.stat().st_size / 1e6:7.1f}", flush=True)


if __name__ == "__main__":
    main()
