"""Tessellates frames and images far beyond memory into Zarr stores, in little memory, and compares windows of them.

The tool runs as a process of its own, whose peak of resident memory is measured. Windows at random places, at the
corners and across the borders of chunks are computed once more by brute force. With --image the seeds are the
components of a mask in tiles, which SciPy numbers. The areas of a table are compared with the pixels of all labels.
"""

import argparse
import os
import shutil
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import zarr
from scipy import ndimage
from scipy.spatial import cKDTree

sys.path.insert(0, str(Path(__file__).parents[1]))
from support.processes.peak_memory import peak_memory

MEMORY = 1e9
"""Bytes that are allowed."""


def direct(seeds, numbers, tree, x, y, side):
    """Labels of a window by brute force among the seeds that may be near: distances are whole numbers."""
    xs, ys = (k.ravel() for k in np.meshgrid(np.arange(x, x + side), np.arange(y, y + side)))
    middle = [x + side / 2, y + side / 2]
    near = np.array(tree.query_ball_point(middle, tree.query(middle)[0] + 2 * side))
    squares = (xs[:, None] - seeds[near, 0]) ** 2 + (ys[:, None] - seeds[near, 1]) ** 2
    is_nearest = squares == squares.min(axis=1, keepdims=True)
    return np.where(is_nearest, numbers[near], np.iinfo(np.int64).max).min(axis=1).reshape(side, side)


def size_on_disk(folder):
    return sum(path.stat().st_size for path in folder.rglob("*") if path.is_file())


def tessellate(folder, source, options, output="labels.zarr"):
    """Run the tool; seconds, and the peak of its memory in bytes."""
    start = time.perf_counter()
    memory = peak_memory(["tessellate", source, "-o", output, "-q", *options], folder)
    return time.perf_counter() - start, memory


def compare_table(table, store):
    """Compare the area of each cell with the pixels of its label; the number of cells."""
    labels = zarr.open_array(store, mode="r")
    rows = np.genfromtxt(table, delimiter=",", names=True)
    pixels = np.zeros(int(rows["label"].max()) + 1, np.int64)
    for y in range(0, labels.shape[0], 1024):
        pixels += np.bincount(labels[y : y + 1024].ravel(), minlength=len(pixels))
    np.testing.assert_array_equal(pixels[rows["label"].astype(int)], rows["area"])
    assert rows["area"].sum() == labels.shape[0] * labels.shape[1]
    return len(rows)


def compare(seeds, numbers, store, side, windows, rng):
    """Compare windows; the number of pixels."""
    size, tree = min(64, side), cKDTree(seeds)
    labels = zarr.open_array(store, mode="r")
    corners = [(0, 0), (side - size, 0), (0, side - size), (side - size, side - size)]
    columns, rows = (
        np.clip(chunk * rng.integers(1, max(2, side // chunk), windows) - size // 2, 0, side - size)
        for chunk in labels.chunks[::-1]
    )
    places = [*corners, *zip(columns.tolist(), rows.tolist(), strict=True)]
    places += rng.integers(0, side - size + 1, (windows, 2)).tolist()
    for x, y in places:
        expected = direct(seeds, numbers, tree, x, y, size)
        np.testing.assert_array_equal(labels[y : y + size, x : x + size], expected, f"at ({x}, {y})")
    return len(places) * size * size


def make_points(folder, side, count, rng):
    """Write points; their coordinates and labels."""
    seeds = rng.integers(0, side, (count, 2))
    seeds = seeds[np.sort(np.unique(seeds, axis=0, return_index=True)[1])]
    np.save(folder / "seeds.npy", seeds)
    return seeds, np.arange(1, len(seeds) + 1)


def make_mask(folder, side, count, rng):
    """Write a mask of small and long objects in tiles; coordinates of its pixels, and the numbers of their objects."""
    mask = np.zeros((side, side), np.uint8)
    for x, y in rng.integers(0, side, (count, 2)).tolist():
        long, thick = int(rng.integers(1, 40)), int(rng.integers(1, 4))
        mask[y : y + thick, x : x + long] = 1
        mask[y : y + long, x : x + thick] = 1
    for x in rng.integers(0, side, 5).tolist():
        mask[:, x] = 1  # through all bands
    zarr.create_array(folder / "seeds.zarr", data=mask, chunks=(1024, 1024))
    numbers = ndimage.label(mask, np.ones((3, 3)), output=np.int32)[0]
    y, x = np.nonzero(mask)
    return np.stack([x, y], axis=1), numbers[y, x].astype(np.int64)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--side", type=int, default=131072)
    parser.add_argument("--seeds", type=int, default=1_000_000)
    parser.add_argument("--image", action="store_true", help="seeds are objects in a mask")
    parser.add_argument("--table", action="store_true", help="write a table, too, and compare its areas")
    parser.add_argument("--windows", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--folder", type=Path, help="where there is room for some hundreds of megabytes")
    parser.add_argument("options", nargs="*", help="further options of the tool, after --")
    o = parser.parse_args()
    rng = np.random.default_rng(o.seed)
    folder = Path(tempfile.mkdtemp(dir=o.folder))
    try:
        seeds, numbers = (make_mask if o.image else make_points)(folder, o.side, o.seeds, rng)
        source = ["seeds.zarr"] if o.image else ["seeds.npy", "--size", f"{o.side}x{o.side}"]
        seconds, memory = tessellate(folder, source[0], [*source[1:], *o.options])
        size = size_on_disk(folder / "labels.zarr")
        print(f"{o.side} x {o.side} pixels of {len(seeds)} seeds: {seconds:.0f} s, load {os.getloadavg()[0]:.1f}")
        print(f"peak memory {memory / 1e6:.0f} MB, {size / 1e6:.0f} MB on disk", flush=True)
        compared = compare(seeds, numbers, folder / "labels.zarr", o.side, o.windows, rng)
        print(f"{compared} pixels in windows are those of direct computation")
        assert memory < MEMORY, "it takes too much memory"
        if o.table:
            options = [*source[1:], *o.options, "--what", "table"]
            seconds, memory = tessellate(folder, source[0], options, "table.csv")
            cells = compare_table(folder / "table.csv", folder / "labels.zarr")
            print(f"a table of {cells} cells: {seconds:.0f} s, peak memory {memory / 1e6:.0f} MB")
            assert memory < MEMORY, "the table takes too much memory"
    finally:
        shutil.rmtree(folder)


if __name__ == "__main__":
    main()
