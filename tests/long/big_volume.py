"""Tessellates a volume far beyond memory into a Zarr store, in little memory, and compares windows of it.

The tool runs as a process of its own, whose peak of resident memory is measured. Windows at random places, at the
corners and across the borders of chunks are computed once more by brute force.
"""

import argparse
import os
import shutil
import tempfile
from pathlib import Path

import numpy as np
import zarr
from big_tessellation import size_on_disk, tessellate
from scipy.spatial import cKDTree

MEMORY = 4e9
"""Bytes that are allowed."""

SPACING = (2, 2, 5)
"""Sides of a voxel along x, y and z."""


def direct(seeds, tree, first, size):
    """Labels of a window by brute force among the seeds that may be near: distances are whole numbers."""
    axes = [np.arange(start, start + count) for start, count in zip(first, size, strict=True)]
    voxels = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3) * SPACING
    middle = (np.array(first) + np.array(size) / 2) * SPACING
    reach = np.linalg.norm(np.array(size) * SPACING)
    near = np.sort(tree.query_ball_point(middle, tree.query(middle)[0] + reach + 1))
    squares = ((voxels[:, None] - seeds[near] * SPACING) ** 2).sum(axis=-1)
    labels = near[squares.argmin(axis=1)] + 1  # the first of several: the smallest label
    return labels.reshape(size).transpose(2, 1, 0)


def compare(seeds, store, shape, windows, rng):
    """Compare windows; the number of voxels."""
    tree, labels = cKDTree(seeds * SPACING), zarr.open_array(store, mode="r")
    assert labels.shape == shape[::-1]
    size = tuple(min(16, side) for side in shape)
    room = np.array(shape) - size
    chunks = np.array(labels.chunks[::-1])
    places = [np.where([k & 1, k & 2, k & 4], room, 0) for k in range(8)]
    borders = chunks * rng.integers(1, np.maximum(2, np.array(shape) // chunks), (windows, 3)) - np.array(size) // 2
    places += list(np.clip(borders, 0, room)) + list(rng.integers(0, room + 1, (windows, 3)))
    for first in places:
        (x, y, z), (w, h, d) = first, size
        expected = direct(seeds, tree, first, size)
        np.testing.assert_array_equal(labels[z : z + d, y : y + h, x : x + w], expected, f"at {first}")
    return len(places) * int(np.prod(size))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--side", type=int, default=4096, help="width and height; it is a quarter as deep")
    parser.add_argument("--seeds", type=int, default=60_000)
    parser.add_argument("--windows", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--folder", type=Path, help="where there is room for some gigabytes")
    parser.add_argument("options", nargs="*", help="further options of the tool, after --")
    o = parser.parse_args()
    rng = np.random.default_rng(o.seed)
    folder = Path(tempfile.mkdtemp(dir=o.folder))
    try:
        shape = (o.side, o.side, max(1, o.side // 4))
        seeds = rng.integers(0, shape, (o.seeds, 3))
        seeds = seeds[np.sort(np.unique(seeds, axis=0, return_index=True)[1])]
        np.save(folder / "seeds.npy", seeds)
        frame = ["--columns", "1,2,z=3", "--size", "x".join(map(str, shape))]
        spacing = ["--spacing", ",".join(map(str, SPACING))]
        seconds, memory = tessellate(folder, "seeds.npy", [*frame, *spacing, *o.options])
        size = size_on_disk(folder / "labels.zarr")
        print(
            f"{' x '.join(map(str, shape))} voxels of {len(seeds)} seeds: {seconds:.0f} s, "
            f"load {os.getloadavg()[0]:.1f}"
        )
        print(f"peak memory {memory / 1e6:.0f} MB, {size / 1e6:.0f} MB on disk", flush=True)
        compared = compare(seeds, folder / "labels.zarr", shape, o.windows, rng)
        print(f"{compared} voxels in windows are those of direct computation")
        assert memory < MEMORY, "it takes too much memory"
    finally:
        shutil.rmtree(folder)


if __name__ == "__main__":
    main()
