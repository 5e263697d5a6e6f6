"""Compare volumes with all distances for a number of voxels: `make fuzz VOXELS=100000000 SEED=1`.

Every configuration is checked both ways, on each instruction set of this machine, with 1 to 5 threads, whole and from
some slice on, with a largest distance, as squared distances and as distances; a voxel counts once a configuration. The
comparison takes the least of a distance and a label axis by axis, or seed by seed where seeds are not on voxels, in
64-bit integers and in NumPy alone.
"""

from math import isqrt
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from fuzz.runner import of_measured
from vorotool import _core
from vorotool.engines.tessellation.frames import SIMD_LEVELS

LABEL_BITS = 20
FAR = np.int64(2**62)
SQUARE_OF_STEP = 0.1
WAYS = ("rows", "bricks", "quicker")
FAMILIES = ("uniform", "dense", "clustered", "lattice", "sphere", "plane", "line", "far", "between", "crowded")


class Case(NamedTuple):
    """Seeds on a lattice of 1/scale voxels, slices first, and a volume."""

    family: str
    places: NDArray[np.int64]
    labels: NDArray[np.uint32]
    shape: tuple[int, int, int]
    scale: int
    units: tuple[int, int, int]


def draw_places(family: str, random: np.random.Generator, shape: NDArray[np.int64], scale: int) -> NDArray[np.int64]:
    """Seeds of a family."""
    count = int(random.choice([1, 2, 5, 30, 200, 1500]))
    extent = shape * scale
    if family == "dense":
        count = int(np.prod(shape) * random.uniform(0.005, 0.3)) + 1
    elif family in ("far", "between"):
        count = min(count, 200)
    places = random.integers(0, extent, (count, 3))
    middle = extent // 2
    if family == "clustered":
        spread = random.normal(0, random.uniform(0.5, 6), (count, 3))
        places = np.rint(random.integers(0, extent, (5, 3))[random.integers(0, 5, count)] + spread).astype(np.int64)
        places = np.clip(places, 0, extent - 1)
    elif family == "lattice":
        places -= places % random.integers(1, 9, 3)
    elif family == "sphere":
        way = random.normal(size=(count, 3))
        radius = random.uniform(0, extent.max() / 2)
        places = np.rint(middle + radius * way / np.linalg.norm(way, axis=1)[:, None]).astype(np.int64)
        places = np.clip(places, 0, extent - 1)
    elif family in ("plane", "line"):
        for axis in random.permutation(3)[: 1 if family == "plane" else 2]:
            places[:, axis] = random.integers(0, extent[axis])
    elif family == "far":
        places = random.integers(-9 * extent, 10 * extent, (count, 3))
    elif family == "crowded":
        places = middle + random.integers(-1, 2, (count, 3))
        places = np.clip(places, 0, extent - 1)
    return places


def draw_case(random: np.random.Generator, side: int) -> Case:
    """Draw a configuration whose sides are at most so long."""
    family = str(random.choice(FAMILIES))
    shape = random.integers(1, side + 1, 3)
    if random.random() < 0.1:
        shape[random.integers(3)] = 1
    scale = int(random.choice([2, 4, 16])) if family == "between" else 1
    places = draw_places(family, random, shape, scale)
    labels = random.integers(1, random.choice([2, len(places) + 1, 2**LABEL_BITS]), len(places))
    units = tuple(random.integers(1, 10, 3).tolist()) if random.random() < 0.5 else (1, 1, 1)
    depth, height, width = shape.tolist()
    return Case(family, places, labels.astype(np.uint32), (depth, height, width), scale, units)


def spread(keys: NDArray[np.int64], axis: int, unit: int) -> NDArray[np.int64]:
    """Let each voxel know of those in its line: the least key with the square of the way added."""
    lines = np.moveaxis(keys, axis, 0)
    least = lines.copy()
    for way in range(1, len(lines)):
        square = np.int64(unit * way) ** 2 << LABEL_BITS
        np.minimum(least[way:], lines[:-way] + square, out=least[way:])
        np.minimum(least[:-way], lines[way:] + square, out=least[:-way])
    return np.moveaxis(least, 0, axis)


def all_keys(case: Case) -> NDArray[np.int64]:
    """The squared distance to the nearest seed of each voxel, and in the lowest bits the smallest label there."""
    keys = np.full(case.shape, FAR)
    inside = np.all((case.places >= 0) & (case.places < case.shape), axis=1)
    if case.scale == 1 and inside.all():
        np.minimum.at(keys, tuple(case.places.T), case.labels.astype(np.int64))
        for axis, unit in enumerate(case.units):
            keys = spread(keys, axis, unit)
        return keys
    axes = [unit * case.scale * np.arange(side) for unit, side in zip(case.units, case.shape, strict=True)]
    for place, label in zip(case.places, case.labels.astype(np.int64), strict=True):
        z, y, x = ((axis - unit * at) ** 2 for axis, unit, at in zip(axes, case.units, place, strict=True))
        np.minimum(keys, (z[:, None, None] + y[:, None] + x) << LABEL_BITS | label, out=keys)
    return keys


def engine(case: Case, level: str, way: str, threads: int) -> Any:
    """Prepare the engine for a configuration."""
    z, y, x = (np.ascontiguousarray(axis) for axis in case.places.T)
    return _core.volumes.VolumeTessellation(
        x, y, z, case.labels, (0, 0, 0), case.shape[::-1], case.scale, case.units[::-1], level, way, threads
    )


def check(random: np.random.Generator, side: int) -> tuple[str, int, int]:
    """Check one configuration; give its family, its voxels, and how many of them are wrong anywhere."""
    case = draw_case(random, side)
    keys = all_keys(case)
    labels, squares = (keys & (2**LABEL_BITS - 1)).astype(np.uint32), (keys >> LABEL_BITS).astype(np.uint64)
    limit = isqrt(int(random.choice(squares.ravel()))) ** 2
    within = np.where(squares <= limit, labels, 0)
    first = int(random.integers(case.shape[0]))
    some = slice(first, first + int(random.integers(1, case.shape[0] - first + 1)))
    wrong = np.zeros(case.shape, dtype=bool)
    for level in SIMD_LEVELS[: SIMD_LEVELS.index(_core.tessellation.widest_simd()) + 1]:
        for way in WAYS:
            threads = int(random.integers(1, 6))
            made = engine(case, level, way, threads)
            out, some_out, distances = (np.empty(right.shape, right.dtype) for right in (labels, labels[some], squares))
            made.labels(out, 0, None, threads, None)
            wrong |= out != labels
            made.labels(out, 0, (0, limit), threads, None)
            wrong |= out != within
            made.labels(some_out, first, None, threads, None)
            wrong[some] |= some_out != labels[some]
            made.squared_distances(distances, 0, threads, None)
            wrong |= distances != squares
            roots = np.empty(case.shape, np.float32)
            made.distances(roots, 0, SQUARE_OF_STEP, threads, None)
            wrong |= roots != np.sqrt(squares * SQUARE_OF_STEP).astype(np.float32)
    return case.family, wrong.size, int(wrong.sum())


COMPARISON = of_measured("voxel", check, lambda case: 150 if case % 4 == 0 else 40)
