"""Skeletons of rotated shapes beside those of the shapes: `--cases 1000 --seed 1`. See rotation_oracle.py.

A third of the rotated shapes is rounded to 2^-20 of the extent too, so that vertices move by more than the placement.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np
from scipy.ndimage import gaussian_filter

sys.path.insert(0, str(Path(__file__).parents[1]))
from fuzz.runner import Cases, options
from support.families.skeleton_shapes import holed, several, star, valid
from support.oracles.rotation_oracle import Pair, Rotation, fault
from vorotool import InputError, outlines
from vorotool.convert.polygons import as_polygons


def mask(rng: np.random.Generator) -> Any:
    """Outlines of pixels."""
    image = gaussian_filter(rng.standard_normal((24, 24)), 2) > 0.02
    return outlines(image, connectivity=4)


FAMILIES = (valid, star, holed, mask, several)


def failure(case: int, random: np.random.Generator, worst: dict[int, float]) -> str | None:
    """What is wrong with a case, if anything; ``repaired`` if edges meet, so that there is nothing to compare."""
    shape = as_polygons(FAMILIES[case % len(FAMILIES)](random))
    step = 0.0 if case % 3 or not len(shape.xy) else float(np.ptp(shape.xy, axis=0).max()) * 2.0**-20
    try:
        pair = Pair(shape, Rotation(float(random.uniform(0, 360))), step)
    except InputError:
        return "repaired"
    return fault(pair, worst) if len(pair.first) else "repaired"


def main() -> int:
    """Run all cases; exit 1 if any failed."""
    cases = Cases(options(1000).parse_args())
    repaired, worst = 0, dict[int, float]()
    for case in cases:
        wrong = failure(case, cases.random(case), worst)
        repaired += wrong == "repaired"
        cases.judge(case, FAMILIES[case % len(FAMILIES)].__name__, None if wrong == "repaired" else wrong)
    moves = ", ".join(f"{angle} degrees: {move:.3f}" for angle, move in sorted(worst.items()))
    print(f"largest moves of what is pruned by an angle, as multiples of the placement: {moves}")
    return cases.end(f"shapes, {repaired} of them repaired")


if __name__ == "__main__":
    sys.exit(main())
