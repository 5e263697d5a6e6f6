"""Voronoi cells and local insertion of points of every family: `--cases 20000 --seed 1`.

Cells in frames of every kind are checked by the shipped checker, small ones also vertex by vertex against the frame cut
along every bisector in rationals. Some of the points are inserted into the triangulation of the others, which must give
the arrays of the triangulation of all.
"""

from collections import Counter

import numpy as np

from fuzz.runner import Cases, Comparison, Verdict
from support.families.point_families import FAMILIES, draw
from support.oracles.cells_oracle import exact_cells, nearest_double
from vorotool import Box, VorotoolError, _core, delaunay, verify_cells, voronoi_cells
from vorotool.engines.delaunay.delaunay import core_mesh

SMALL = 8
NAMES = list(FAMILIES)


def a_frame(points: np.ndarray, rng: np.random.Generator) -> Box | None:
    """The default frame, or one through or near to what it may meet."""
    low, high = points.min(axis=0), points.max(axis=0)
    reach = float(np.max(high / 2 - low / 2)) or 1.0
    corner = points[rng.integers(len(points))] if rng.random() < 0.5 else low + rng.random(2) * (high / 2 - low / 2)
    size = reach * rng.choice([0.25, 0.5, 1.0, 2.0, 3.0], 2)
    sides = [*corner, *(corner + size)]
    usable = np.isfinite(sides).all() and sides[0] < sides[2] and sides[1] < sides[3]
    return Box(*sides) if usable and rng.random() < 0.8 else None


def wrong_cells(points: np.ndarray, rng: np.random.Generator) -> str | None:
    """What is wrong with the cells of these points, if anything."""
    cells = voronoi_cells(points, frame=a_frame(points, rng), threads=int(rng.integers(1, 4)))
    try:
        verify_cells(cells, threads=1)
    except VorotoolError as error:
        return str(error)
    if len(points) > SMALL:
        return None
    for i, right in enumerate(exact_cells(points.tolist(), cells.frame.sides)):
        ours = list(map(tuple, cells.coordinates[cells.starts[i] : cells.starts[i + 1]].tolist()))
        try:
            corners = [(nearest_double(x), nearest_double(y)) for x, y in right]
        except OverflowError:
            return None
        corners = [p for k, p in enumerate(corners) if p != corners[k - 1]]
        if not ours:  # a cell without area, as rounded if not before
            if any(_core.kernel.orient2d(np.array([[*corners[0], *corners[1], *p]]))[0] for p in corners[2:]):
                return f"cell {i} in {cells.frame} should not be empty"
            continue
        start = corners.index(min(corners)) if corners else 0
        if [p for p in ours if p in corners] != corners[start:] + corners[:start] or not corners:
            return f"cell {i} in {cells.frame} has other corners"
    return None


def wrong_insertion(points: np.ndarray, rng: np.random.Generator, local: Counter[str]) -> str | None:
    """What differs between points inserted and triangulated at once, if anything."""
    outermost = np.unique([f(points[:, axis]) for axis in (0, 1) for f in (np.argmin, np.argmax)])
    points = np.concatenate([points[outermost], np.delete(points, outermost, axis=0)])
    count = int(rng.integers(min(len(outermost), len(points)), len(points) + 1))
    mesh, right = delaunay(points[:count], threads=1), delaunay(points, threads=1)
    hints = rng.integers(0, count, len(points) - count if rng.random() < 0.3 else 0).astype(np.int32)
    made = _core.delaunay.insert_points(core_mesh(mesh), points, hints, 1, None)
    local["inserted" if made is not None else "made anew"] += 1
    if made is None:
        return None
    for name, array in made.items():
        if not np.array_equal(array, getattr(right, name)):
            return f"insertion after {count} points gives other {name}"
    return None


def check(case: int, cases: Cases) -> Verdict:
    """Make the cells of some points, and insert some of them."""
    rng, name = cases.random(case), NAMES[case % len(NAMES)]
    most = 5 if name == "any_double" else 9  # there exact arithmetic takes thousands of bits
    n = int(rng.integers(1, SMALL + 1)) if rng.random() < 0.5 else int(2 ** rng.uniform(3, most))
    points = draw(name, n, cases.seed(case))
    cases.counts["points"] += len(points)
    wrong = filter(None, (wrong_cells(points, rng), wrong_insertion(points, rng, cases.counts)))
    return name, "; ".join(wrong) or None, f"{len(points)} points"


COMPARISON = Comparison(20_000, check)
