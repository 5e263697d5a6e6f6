"""Compare alpha shapes of points in space with the definition: `--cases 10000 --seed 1`.

Small sets are compared with empty balls through the corners of every simplex, in rationals: all three radii, and the
order of the spectrum. All are checked by the shipped checker at several radii, and a permutation of the points with
another number of threads must give the same radii.
"""

from __future__ import annotations

from math import inf

import numpy as np

from fuzz.runner import Cases, Comparison, Verdict
from support.families.space_points import FAMILIES
from support.oracles.space_alpha_oracle import radii
from vorotool import VorotoolError, alpha_complex, alpha_shape, verify_alpha_shape
from vorotool.types.alpha.space import SIMPLICES

SMALL = 8
NAMES = list(FAMILIES)


def failure(points: np.ndarray, rng: np.random.Generator) -> str | None:
    """What is wrong with the shapes of these points, if anything."""
    family = alpha_complex(points, threads=1)
    order = rng.permutation(len(points))
    other = alpha_complex(points[order], threads=int(rng.integers(2, 5)))
    for name in ("tetrahedron_rank", "facet", "triangle_min", "edge_min", "edge_mid", "edge_max", "spectrum"):
        if len(family) and not np.array_equal(getattr(family, name), getattr(other, name)):
            return f"a permutation changes {name}"
    squares = [family.squared_radius(rank) for rank in range(len(family.spectrum))]
    if squares != sorted(set(squares)):
        return "radii are not in order"
    try:
        for rank in rng.integers(0, len(squares), 3).tolist():
            verify_alpha_shape(alpha_shape(family, r=family.radius_from(rank)), threads=1)
        verify_alpha_shape(alpha_shape(family, r=inf), threads=1)
    except VorotoolError as error:
        return f"rank {rank}: {error}"
    if len(points) > SMALL:
        return None
    distinct, squares = family.points[~family.mesh.is_duplicate].tolist(), [*squares, inf]
    for what in SIMPLICES[1:]:
        corners = family.points[family.simplices(what)].tolist()
        expected = radii(distinct, [[distinct.index(corner) for corner in each] for each in corners])
        found = [tuple(squares[rank] for rank in ranks) for ranks in family.ranks(what).tolist()]
        if found != expected:
            return f"{what}: not the radii of the definition"
    return None


def check(case: int, cases: Cases) -> Verdict:
    """Make shapes of some points."""
    rng, name = cases.random(case), NAMES[case % len(NAMES)]
    n = int(rng.integers(2, SMALL + 1)) if rng.random() < 0.7 else int(2 ** rng.uniform(3, 7))
    points = FAMILIES[name](rng, n)
    is_one_place = len(np.unique(points, axis=0)) < 2
    return name, None if is_one_place else failure(points, rng), f"{len(points)} points"


COMPARISON = Comparison(10_000, check)
