"""Voronoi cells and local insertion of points of every family: `--cases 20000 --seed 1`.

Cells in frames of every kind are checked by the shipped checker, small ones also vertex by vertex against the frame cut
along every bisector in rationals. Some of the points are inserted into the triangulation of the others, which must give
the arrays of the triangulation of all.
"""

from __future__ import annotations

import sys
from collections import Counter
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))
from fuzz.runner import Cases, options
from support.families.point_families import FAMILIES, draw
from support.oracles.cells_oracle import exact_cells, nearest_double
from vorotool import Box, VorotoolError, _core, delaunay, verify_cells, voronoi_cells
from vorotool.engines.delaunay.delaunay import core_mesh

SMALL = 8


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
    for i, ring in enumerate(exact_cells(points.tolist(), cells.frame.sides)):
        ours = set(map(tuple, cells.coordinates[cells.starts[i] : cells.starts[i + 1]].tolist()))
        if ours and not ours >= {(nearest_double(x), nearest_double(y)) for x, y in ring}:
            return f"cell {i} in {cells.frame} lacks a corner"
        if not ring and ours:
            return f"cell {i} in {cells.frame} should be empty"
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


def main() -> int:
    """Run all cases; exit 1 if any failed."""
    cases = Cases(options(20_000).parse_args())
    names = list(FAMILIES)
    local: Counter[str] = Counter()
    points_seen = 0
    for case in cases:
        rng, name = cases.random(case), names[case % len(names)]
        most = 5 if name == "any_double" else 9  # there exact arithmetic takes thousands of bits
        n = int(rng.integers(1, SMALL + 1)) if rng.random() < 0.5 else int(2 ** rng.uniform(3, most))
        points = draw(name, n, cases.seed(case))
        wrong = filter(None, (wrong_cells(points, rng), wrong_insertion(points, rng, local)))
        cases.judge(case, name, "; ".join(wrong) or None, f"{len(points)} points")
        points_seen += len(points)
    return cases.end(f"cases, {points_seen:,} points, {dict(local)}")


if __name__ == "__main__":
    sys.exit(main())
