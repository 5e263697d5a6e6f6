"""Measure the exact tessellation beside its peers, in one run: `make bench`.

Every figure is the least of several runs, in milliseconds; ratios are what to compare, since machines differ.
`floor` fills the same output past the caches with as many threads: no program can write labels faster.
`ours` writes into an output that exists (`out=`), `fresh` into a new one, beside the floor of touching it first.
Peers: scipy's and scikit-image's exact transforms (other ties), OpenCV's approximate one, `edt`'s distances alone.
"""

from __future__ import annotations

import sys
import warnings
from collections.abc import Callable
from pathlib import Path

import cv2
import edt
import numpy as np
from scipy.ndimage import distance_transform_edt
from skimage.segmentation import expand_labels

sys.path.insert(0, str(Path(__file__).parents[1]))
import vorotool
from benchmarks.timing import options, print_head, timed
from vorotool import _core, _core_testing
from vorotool.engines.tessellation.tessellator import Tessellator
from vorotool.types.pixels import Frame

PEERS: dict[str, Callable[[np.ndarray], object]] = {
    "scipy": lambda image: image[
        tuple(distance_transform_edt(image == 0, return_distances=False, return_indices=True))
    ],
    "skimage": lambda image: expand_labels(image, distance=1e9),
    "opencv": lambda image: cv2.distanceTransformWithLabels(
        (image == 0).astype(np.uint8), cv2.DIST_L2, 5, labelType=cv2.DIST_LABEL_PIXEL
    ),
    "edt": lambda image: edt.edt(image == 0, parallel=2),
}


def best(function: Callable[[], object], runs: int) -> float:
    """Least milliseconds of several runs."""
    return 1e3 * timed(function, runs)[0]


def seed_set(m: int, n: int, *, sub_pixel: bool) -> vorotool.SeedSet:
    """Uniform seeds; on the lattice of 1/256 pixel if they are not on pixels."""
    rng = np.random.default_rng(n + m)
    xy = rng.integers(0, m * 256, (n, 2)) / 256 if sub_pixel else rng.integers(0, m, (n, 2))
    return vorotool.seeds_from_points(vorotool.PointSet(xy.astype(np.float64)))


def seed_image(seeds: vorotool.SeedSet, m: int) -> np.ndarray:
    """The image that the peers start from."""
    image = np.zeros((m, m), np.int32)
    image[seeds.y[::-1], seeds.x[::-1]] = seeds.labels[::-1]
    return image


def measure(m: int, n: int, threads: int, runs: int, *, sub_pixel: bool, peers: bool) -> str:
    """One row of the table."""
    seeds, frame = seed_set(m, n, sub_pixel=sub_pixel), Frame(0, 0, m, m)
    out = np.zeros((m, m), np.int32)
    floor = best(lambda: _core_testing.tessellation.stream_fill(out, threads), runs)
    touch = best(lambda: _core_testing.tessellation.stream_fill(np.empty((m, m), np.int32), threads), runs)
    ours = best(lambda: Tessellator(seeds, frame, threads=threads).labels(out=out), runs)
    sweep = Tessellator(seeds, frame, threads=threads)
    rows = best(lambda: sweep.labels(out=out), runs)
    fresh = best(lambda: sweep.labels(dtype=np.int32), runs)
    row = f"| {m}² | {n:,}{' sub-pixel' if sub_pixel else ''} | {floor:.2f} | {ours:.2f} | {ours / floor:.2f} |"
    row += f" {rows / floor:.2f} | {fresh:.1f} / {touch:.1f} |"
    if not peers or sub_pixel:
        return row + " – |" * len(PEERS)
    image = seed_image(seeds, m)
    for peer in PEERS.values():
        taken = best(lambda run=peer: run(image), 1 if m >= 4096 else 2)
        row += f" {taken:,.0f} ({taken / ours:,.0f} ×) |"
    return row


def main() -> None:
    """Print the table."""
    parser = options("sizes", [512, 2048, 4096, 8192], runs=7)
    parser.add_argument("--seeds", type=int, nargs="+", default=[53, 10_000, 1_000_000])
    arguments = parser.parse_args()
    warnings.simplefilter("ignore")
    cv2.setNumThreads(arguments.threads)
    widest = _core.tessellation.widest_simd()
    print(f"milliseconds, {arguments.threads} threads, {widest}; in brackets: how many times ours\n")
    print_head("image", "seeds", "floor", "ours", "ours / floor", "rows alone / floor", "fresh / its floor", *PEERS)
    for m in arguments.sizes:
        for n in (n for n in arguments.seeds if n <= m * m // 2):
            print(measure(m, n, arguments.threads, arguments.runs, sub_pixel=False, peers=not arguments.no_peers))
        print(measure(m, 10_000, arguments.threads, arguments.runs, sub_pixel=True, peers=False), flush=True)


if __name__ == "__main__":
    main()
