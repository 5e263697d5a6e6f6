"""Compare alpha shapes of every family with the definition: `--cases 20000 --seed 1`.

Each case is checked by the shipped checker at several radii of its spectrum; small ones also against the definition in
rationals, at critical radii and between them; all with a permutation of the points and another number of threads, which
must give the same radii.
"""

from __future__ import annotations

import sys
from fractions import Fraction
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))
from fuzz.runner import Cases, options
from support.families.point_families import FAMILIES, draw
from support.oracles.alpha_oracle import alpha_edges
from vorotool import VorotoolError, alpha_complex, alpha_shape, verify_alpha_shape
from vorotool.types.alpha.complex import CLASSES, classes_of

SMALL = 9
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
    for rank in rng.integers(0, len(family.spectrum), 3).tolist():
        try:
            verify_alpha_shape(alpha_shape(family, r=family.radius_from(rank)), threads=1)
        except VorotoolError as error:
            return f"rank {rank}: {error}"
        if len(points) <= SMALL:
            square = family.squared_radius(rank)
            last = rank + 1 == len(family.spectrum)
            between = 2 * square if last else (square + family.squared_radius(rank + 1)) / 2
            for value in (square, between):
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


def main() -> int:
    """Run all cases; exit 1 if any failed."""
    cases = Cases(options(20_000).parse_args())
    names, skipped = list(FAMILIES), 0
    for case in cases:
        rng, name = cases.random(case), names[case % len(names)]
        n = (
            int(rng.integers(2, SMALL + 1))
            if rng.random() < 0.7
            else int(2 ** rng.uniform(3, 5 if name in SLOW else 9))
        )
        points = draw(name, n, cases.seed(case))
        if len(np.unique(points, axis=0)) < 2:
            skipped += 1
            continue
        cases.judge(case, name, failure(points, rng), f"{len(points)} points")
    cases.print_families()
    return cases.end(f"cases, {skipped} of a single point")


if __name__ == "__main__":
    sys.exit(main())
