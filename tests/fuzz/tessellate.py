"""Compare the exact engine with brute force for a number of pixels: `make fuzz PIXELS=100000000 SEED=1`.

Every configuration is checked on each instruction set of this machine, with 1 to 5 threads and two types of label;
a pixel counts once a configuration.
"""

import os

import numpy as np

from fuzz.runner import of_measured
from support.families.families import fine_case, random_case
from support.oracles.oracles import nearest_labels, nearest_labels_of_fine_seeds
from vorotool import _core
from vorotool.engines.tessellation.frames import SIMD_LEVELS
from vorotool.engines.tessellation.tessellator import SeedBands, Tessellator
from vorotool.types.pixels import SQUARE, Frame
from vorotool.types.points.seed_set import SeedSet


def check(rng: np.random.Generator, side: int) -> tuple[str, int, int]:
    """Check one configuration; give its family, its pixels, and how many of them are wrong anywhere."""
    sides = SQUARE
    if rng.random() < 0.5:
        name, x, y, labels, scale, frame, sides = fine_case(rng, min(side, 100))
        right = nearest_labels_of_fine_seeds(x, y, labels, frame, scale, sides.units)
    else:
        name, x, y, labels, scale, frame = random_case(rng, side)
        right = nearest_labels(x, y, labels, frame, scale)
    seeds, whole = SeedSet(x, y, labels, scale=scale), Frame(*frame)
    wrong = np.zeros(right.shape, dtype=bool)
    for level in SIMD_LEVELS[: SIMD_LEVELS.index(_core.tessellation.widest_simd()) + 1]:
        os.environ["VOROTOOL_SIMD"] = level
        sweep = Tessellator(seeds, whole, sides=sides, threads=int(rng.integers(1, 6)))
        for dtype in (None, np.int32):
            wrong |= sweep.labels(dtype=dtype) != right
    first = int(rng.integers(whole.height))  # a band by itself, as files and clusters compute it
    rows = int(rng.integers(1, whole.height - first + 1))
    apart = SeedBands(seeds, whole).band("labels", np.dtype(np.uint32), first, rows, sides=sides)
    wrong[first : first + rows] |= apart.rows() != right[first : first + rows]
    return name, right.size, int(wrong.sum())


COMPARISON = of_measured("pixel", check, lambda case: 1000 if case % 8 == 0 else 40)
