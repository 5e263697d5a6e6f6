"""Triangulate points of every family and check the result exactly: `--cases 100000 --seed 1`.

Each case is checked by the shipped checker; small ones also against the definition in rationals, and every one with a
permutation of its points and another number of threads, which must give the same triangles in the same order.
"""

import numpy as np

from fuzz.runner import Cases, Comparison, Verdict
from support.families.point_families import FAMILIES, draw
from support.oracles.delaunay_oracle import delaunay_triangles
from vorotool import VorotoolError, delaunay, verify_triangulation

SMALL = 7
NAMES = list(FAMILIES)


def failure(points: np.ndarray, rng: np.random.Generator) -> str | None:
    """What is wrong with the triangulation of these points, if anything."""
    mesh = delaunay(points, threads=1)
    try:
        verify_triangulation(mesh, threads=1)
    except VorotoolError as error:
        return str(error)
    order = rng.permutation(len(points))
    other = delaunay(points[order], threads=int(rng.integers(1, 6)))
    for name in ("triangles", "neighbors", "hull"):
        ours, theirs = getattr(mesh, name), getattr(other, name)
        if name != "neighbors":
            ours, theirs = points[ours], other.points[theirs]
        if not np.array_equal(ours, theirs):
            return f"a permutation changes {name}"
    if len(points) <= SMALL:
        triangles = {frozenset(map(tuple, points[t].tolist())) for t in mesh.triangles}
        if triangles != {frozenset((float(x), float(y)) for x, y in t) for t in delaunay_triangles(points.tolist())}:
            return "not the triangles of the definition"
    return None


def check(case: int, cases: Cases) -> Verdict:
    """Triangulate some points."""
    rng, name = cases.random(case), NAMES[case % len(NAMES)]
    n = int(rng.integers(0, SMALL + 1)) if rng.random() < 0.5 else int(2 ** rng.uniform(3, 10 if case % 50 else 13))
    points = draw(name, n, cases.seed(case))
    cases.counts["points"] += len(points)
    return name, failure(points, rng), f"{len(points)} points"


COMPARISON = Comparison(10**5, check)
