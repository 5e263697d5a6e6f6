"""Compare alpha shapes of every family with the definition: `--cases 20000 --seed 1`.

Each case is checked by the shipped checker at several radii of its spectrum; small ones also against the definition in
rationals, at critical radii and between them; all with a permutation of the points and another number of threads, which
must give the same radii.
"""

from fractions import Fraction

import numpy as np

from fuzz.runner import Cases, Comparison, Verdict
from support.families.point_families import FAMILIES, draw
from support.oracles.alpha_oracle import alpha_edges
from vorotool import VorotoolError, alpha_complex, alpha_shape, verify_alpha_shape
from vorotool.types.alpha.complex import CLASSES, classes_of

SMALL = 9
NAMES = list(FAMILIES)
SLOW = frozenset({"any_double", "extreme"})
"""Families whose radii are decided in long integers: smaller cases."""


def failure(points: np.ndarray, rng: np.random.Generator) -> str | None:
    """What is wrong with the shapes of these points, if anything."""
    family = alpha_complex(points, threads=1)
    order = rng.permutation(len(points))
    other = alpha_complex(points[order], threads=int(rng.integers(2, 5)))
    for name in ("r_min", "r_mid", "r_max", "rank_min", "rank_mid", "rank_max", "spectrum"):
        if not np.array_equal(getattr(family, name), getattr(other, name)):
            return f"a permutation changes {name}"
    squares = [family.squared_radius(rank) for rank in range(len(family.spectrum))]
    if squares != sorted(set(squares)):
        return "radii are not in order"
    try:
        for rank in rng.integers(0, len(squares), 3).tolist():
            verify_alpha_shape(alpha_shape(family, r=family.radius_from(rank)), threads=1)
        verify_alpha_shape(alpha_shape(family, r=np.inf), threads=1)
    except VorotoolError as error:
        return f"rank {rank}: {error}"
    for rank in range(-1, len(squares)) if len(points) <= SMALL else ():
        here = squares[rank] if rank >= 0 else squares[0] / 2
        between = (here + squares[rank + 1]) / 2 if rank + 1 < len(squares) else 2 * here
        for value in (here, between):
            if shape_at(family, rank) != alpha_edges(points.tolist(), value):
                return f"rank {rank}: not the edges of the definition"
    return None


def shape_at(family: object, rank: int) -> dict[frozenset[tuple[Fraction, Fraction]], str]:
    """Singular and boundary edges by their places."""
    classes = classes_of(family, rank + 1, rank + 1)
    found = {}
    for edge in np.flatnonzero((classes == 1) | (classes == 2)):
        ends = family.points[family.edges[edge]].tolist()
        found[frozenset((Fraction(x), Fraction(y)) for x, y in ends)] = CLASSES[classes[edge]]
    return found


def check(case: int, cases: Cases) -> Verdict:
    """Make shapes of some points."""
    rng, name = cases.random(case), NAMES[case % len(NAMES)]
    most = 5 if name in SLOW else 9
    n = int(rng.integers(2, SMALL + 1)) if rng.random() < 0.7 else int(2 ** rng.uniform(3, most))
    points = draw(name, n, cases.seed(case))
    is_one_place = len(np.unique(points, axis=0)) < 2
    return name, None if is_one_place else failure(points, rng), f"{len(points)} points"


COMPARISON = Comparison(20_000, check)
