"""Compare tessellations of rectangular pixels with brute force: `make fuzz PIXELS=100000000 SEED=1`.

Every configuration is checked on each instruction set of this machine, with 1 to 5 threads: labels, labels within a
largest distance, squared distances, and where doubles hold their squares distances; a pixel counts once a
configuration. The comparison looks at every seed, in 64-bit integers where they hold the squares, else in Python's.
"""

import os
from fractions import Fraction
from math import gcd, isqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fuzz.runner import of_measured
from support.families.families import random_case
from vorotool import _core
from vorotool.engines.tessellation.frames import SIMD_LEVELS
from vorotool.engines.tessellation.tessellator import Tessellator
from vorotool.types.pixels import Frame, PixelSides
from vorotool.types.points.seed_set import SeedSet

FARTHEST = 2**39
"""Steps from the middle of a frame to a seed; twice as many are refused."""

SMALL = 40
"""Pixels along the sides of small frames."""

KINDS = ("small", "decimal", "thin", "large")


class Case:
    """Seeds, a frame, and the sides of its pixels."""

    def __init__(self, random: np.random.Generator, side: int) -> None:
        self.name, x, y, self.labels, self.scale, self.frame = random_case(random, side)
        farthest = max(int(np.abs(values).max()) for values in (x, y)) + self.scale * (max(map(abs, self.frame)) + side)
        self.x, self.y = x, y
        # Python's integers are slow: they are for small frames
        self.sides = draw_sides(random, FARTHEST // farthest if side <= SMALL else 2**29 // farthest)
        self.is_long = (self.sides.x * farthest) ** 2 + (self.sides.y * farthest) ** 2 >= 2**60

    def nearest(self) -> tuple[NDArray[np.int64], NDArray[Any]]:
        """The smallest label of the nearest seeds of each pixel, and the squared distance."""
        kind = object if self.is_long else np.int64
        order = np.argsort(self.labels, kind="stable")
        fx, fy, width, height = self.frame
        columns = (self.scale * (fx + np.arange(width)))[:, None] - self.x[order]
        across = (columns.astype(kind) * self.sides.x) ** 2
        labels, squares = np.empty((height, width), np.int64), np.empty((height, width), kind)
        for row in range(height):
            down = ((self.scale * (fy + row) - self.y[order]).astype(kind) * self.sides.y) ** 2
            all_squares = across + down
            chosen = all_squares.argmin(axis=1)  # the first of equal ones, hence the smallest label
            labels[row] = self.labels[order][chosen]
            squares[row] = all_squares[np.arange(width), chosen]
        return labels, squares


def draw_sides(random: np.random.Generator, most: int) -> PixelSides:
    """Sides of at most so many steps, without a common divisor."""
    kind = str(random.choice(KINDS))
    if kind == "small":
        height, width = random.integers(1, 10, 2).tolist()
    elif kind == "decimal":
        height, width = random.integers(1, 2000, 2).tolist()
    elif kind == "thin":
        height, width = 1, int(random.integers(2, 5000))
    else:
        height, width = random.integers(1, 2**20, 2).tolist()
    if random.random() < 0.5:
        height, width = width, height
    height, width = (max(1, min(side, most)) for side in (height, width))
    common = gcd(height, width)
    step = Fraction(*random.integers(1, 100, 2).tolist())
    return PixelSides((height // common, width // common), step)


def wrong_of(case: Case, threads: int, limit: int, right: tuple[NDArray[np.int64], NDArray[Any]]) -> NDArray[np.bool_]:
    """Tell which pixels are wrong in any result, of labels within the root of a limit as well."""
    labels, squares = right
    given: dict[str, Any] = {"sides": case.sides, "threads": threads}
    seeds, frame = SeedSet(case.x, case.y, case.labels, scale=case.scale), Frame(*case.frame)
    sweep = Tessellator(seeds, frame, **given)
    wrong = np.asarray(sweep.labels(dtype=np.int32) != labels)
    within = np.where(squares <= limit, labels, 0)
    most = isqrt(limit) * case.sides.step / case.scale
    wrong |= Tessellator(seeds, frame, max_distance=most, **given).labels() != within
    if not case.is_long:
        wrong |= sweep.squared_distances() != squares
    if int(squares.max()) < 2**53:
        square_of_step = float((case.sides.step / case.scale) ** 2)
        wrong |= sweep.distances() != np.sqrt(squares.astype(float) * square_of_step).astype(np.float32)
    return wrong


def check(random: np.random.Generator, side: int) -> tuple[str, int, int]:
    """Check one configuration; give its family, its pixels, and how many of them are wrong anywhere."""
    case = Case(random, side)
    right = case.nearest()
    limit = isqrt(int(random.choice(right[1].ravel()))) ** 2
    wrong = np.zeros(right[0].shape, dtype=bool)
    for level in SIMD_LEVELS[: SIMD_LEVELS.index(_core.tessellation.widest_simd()) + 1]:
        os.environ["VOROTOOL_SIMD"] = level
        wrong |= wrong_of(case, int(random.integers(1, 6)), limit, right)
    return case.name, wrong.size, int(wrong.sum())


COMPARISON = of_measured("pixel", check, lambda case: 600 if case % 8 == 0 else SMALL)
