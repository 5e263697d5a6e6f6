"""Tessellates a frame far beyond memory into a Zarr store, in little memory, and compares windows of it.

The tool runs as a process of its own, whose peak of resident memory is measured. Windows at random places, at the
corners and across the borders of chunks are computed once more by brute force.
"""

import argparse
import os
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import zarr
from scipy.spatial import cKDTree

MEMORY = 1e9
"""Bytes that are allowed."""


def direct(seeds, x, y, side):
    """Labels of a window by brute force among the seeds that may be near: distances are whole numbers."""
    xs, ys = (k.ravel() for k in np.meshgrid(np.arange(x, x + side), np.arange(y, y + side)))
    reach = cKDTree(seeds).query([[x + side / 2, y + side / 2]])[0][0] + 2 * side
    near = np.flatnonzero((np.abs(seeds - [x + side / 2, y + side / 2]) <= reach).all(axis=1))
    squares = (xs[:, None] - seeds[near, 0]) ** 2 + (ys[:, None] - seeds[near, 1]) ** 2
    return (near[squares.argmin(axis=1)] + 1).reshape(side, side)  # the first of equals has the smallest label


def size_on_disk(folder):
    return sum(path.stat().st_size for path in folder.rglob("*") if path.is_file())


def tessellate(folder, side, options):
    """Run the tool; seconds, and the largest memory of a child process so far, in bytes."""
    command = [sys.executable, "-m", "vorotool", "tessellate", "seeds.npy", "--size", f"{side}x{side}"]
    start = time.perf_counter()
    subprocess.run([*command, "-o", "labels.zarr", *options], cwd=folder, check=True)
    return time.perf_counter() - start, resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss * 1024


def compare(seeds, store, side, windows, rng):
    """Compare windows; the number of pixels."""
    size = min(64, side)
    labels = zarr.open_array(store, mode="r")
    corners = [(0, 0), (side - size, 0), (0, side - size), (side - size, side - size)]
    columns, rows = (
        np.clip(chunk * rng.integers(1, max(2, side // chunk), windows) - size // 2, 0, side - size)
        for chunk in labels.chunks[::-1]
    )
    places = [*corners, *zip(columns.tolist(), rows.tolist(), strict=True)]
    places += rng.integers(0, side - size + 1, (windows, 2)).tolist()
    for x, y in places:
        np.testing.assert_array_equal(labels[y : y + size, x : x + size], direct(seeds, x, y, size), f"at ({x}, {y})")
    return len(places) * size * size


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--side", type=int, default=131072)
    parser.add_argument("--seeds", type=int, default=1_000_000)
    parser.add_argument("--windows", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--folder", type=Path, help="where there is room for some hundreds of megabytes")
    parser.add_argument("options", nargs="*", help="further options of the tool, after --")
    o = parser.parse_args()
    rng = np.random.default_rng(o.seed)
    folder = Path(tempfile.mkdtemp(dir=o.folder))
    try:
        seeds = rng.integers(0, o.side, (o.seeds, 2))
        seeds = seeds[np.sort(np.unique(seeds, axis=0, return_index=True)[1])]
        np.save(folder / "seeds.npy", seeds)
        seconds, memory = tessellate(folder, o.side, o.options)
        size = size_on_disk(folder / "labels.zarr")
        print(f"{o.side} x {o.side} pixels of {len(seeds)} seeds: {seconds:.0f} s, load {os.getloadavg()[0]:.1f}")
        print(f"peak memory {memory / 1e6:.0f} MB, {size / 1e6:.0f} MB on disk", flush=True)
        compared = compare(seeds, folder / "labels.zarr", o.side, o.windows, rng)
        print(f"{compared} pixels in windows are those of direct computation")
        assert memory < MEMORY, "it takes too much memory"
    finally:
        shutil.rmtree(folder)


if __name__ == "__main__":
    main()
