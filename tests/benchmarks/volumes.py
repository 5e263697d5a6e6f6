"""Measure volumes beside their peers, in one run: `make bench`.

Every figure is the least of several runs, in nanoseconds a voxel; ratios are what to compare, since machines differ.
`floor` fills the same output past the caches with as many threads: no program can write labels faster. `ours` prepares
the seeds and writes labels into an output that exists (`out=`). Memory is that beside the seeds and the output, of a
process of its own. Peers: scipy's exact transform (other ties), `edt`'s distances alone, scikit-image's expand_labels;
they take a volume of `--peers-side`, with as many voxels a seed, which ours takes beside them, too.
"""

from __future__ import annotations

import sys
import warnings
from collections.abc import Callable
from pathlib import Path

import edt
import numpy as np
from scipy.ndimage import distance_transform_edt
from skimage.segmentation import expand_labels

sys.path.insert(0, str(Path(__file__).parents[1]))
from benchmarks.timing import best, in_own_process, options, peak_of, print_head
from vorotool import _core_testing
from vorotool.engines.tessellation.tessellator import Tessellator
from vorotool.types.volumes.volume import VolumeSeeds, VoxelFrame

PEERS: dict[str, Callable[[np.ndarray], object]] = {
    "scipy": lambda volume: volume[
        tuple(distance_transform_edt(volume == 0, return_distances=False, return_indices=True))
    ],
    "edt": lambda volume: edt.edt(volume == 0, parallel=2),
    "skimage": lambda volume: expand_labels(volume, distance=1e9),
}


def seeds_in(side: int, count: int) -> VolumeSeeds:
    """Uniform seeds, of which several may be at one place."""
    places = np.random.default_rng(count).integers(0, side, (count, 3))
    return VolumeSeeds(places, np.arange(1, count + 1))


def output(side: int, count: int) -> np.ndarray:
    """A volume that is there, of the narrowest type."""
    return np.full((side,) * 3, 1, np.uint16 if count < 2**16 else np.uint32)


def labelled(seeds: VolumeSeeds, threads: int, out: np.ndarray) -> np.ndarray:
    """Labels, from the seeds on."""
    depth, height, width = out.shape
    return Tessellator(seeds, VoxelFrame(0, 0, 0, width, height, depth), threads=threads).labels(out=out)


def memory(side: int, count: int, threads: int) -> int:
    """Bytes beside the seeds and the output: the most that the process had, less what it had before."""
    warnings.simplefilter("ignore")
    out, seeds = output(side, count), seeds_in(side, count)
    labelled(seeds_in(8, 8), threads, output(8, 8))
    return peak_of(lambda: labelled(seeds, threads, out))


def ours(side: int, count: int, threads: int, runs: int) -> tuple[float, float]:
    """Nanoseconds a voxel to fill the output, and to label it."""
    out, seeds = output(side, count), seeds_in(side, count)
    floor = best(lambda: _core_testing.tessellation.stream_fill(out.reshape(-1, side), threads), runs)
    taken = best(lambda: labelled(seeds, threads, out), runs)
    return 1e9 * floor / out.size, 1e9 * taken / out.size


def peers(side: int, count: int, threads: int, runs: int) -> str:
    """Columns of the peers: nanoseconds a voxel, and how many times ours beside them."""
    seeds = seeds_in(side, count)
    volume = np.zeros((side,) * 3, np.int32)
    volume[seeds.z[::-1], seeds.y[::-1], seeds.x[::-1]] = seeds.labels[::-1]
    _, beside = ours(side, count, threads, runs)
    row = f" {beside:.3f} |"
    for peer in PEERS.values():
        taken = 1e9 * best(lambda run=peer: run(volume), 1) / volume.size
        row += f" {taken:,.0f} ({taken / beside:,.0f} ×) |"
    return row


def main() -> None:
    """Print the table."""
    parser = options("seeds", [100, 10_000, 1_000_000], 3)
    warnings.simplefilter("ignore")  # of seeds at one place
    parser.add_argument("--side", type=int, default=512)
    parser.add_argument("--peers-side", type=int, default=256)
    arguments = parser.parse_args()
    side, small, threads = arguments.side, arguments.peers_side, arguments.threads
    print(f"{side}³ voxels, {threads} threads; peers {small}³")
    print_head("seeds", "floor", "ours", "of floor", "MB", f"ours, {small}³", *PEERS)
    for count in arguments.seeds:
        floor, taken = ours(side, count, threads, arguments.runs)
        beside = in_own_process(memory, side, count, threads)
        row = f"| {count:,} | {floor:.3f} | {taken:.3f} | {taken / floor:.1f} | {beside / 1e6:.0f} |"
        few = max(1, round(count * (small / side) ** 3))
        print(row + (" – |" * (1 + len(PEERS)) if arguments.no_peers else peers(small, few, threads, arguments.runs)))


if __name__ == "__main__":
    main()
