"""Skeletons of rotated shapes beside those of the shapes: `--cases 1000 --seed 1`. See rotation_oracle.py.

A third of the rotated shapes is rounded to 2^-20 of the extent too, so that vertices move by more than the placement.
"""

from typing import Any

import numpy as np
from scipy.ndimage import gaussian_filter

from fuzz.runner import Cases, Comparison, Verdict
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


def check(case: int, cases: Cases) -> Verdict:
    """Rotate a shape; the largest moves of what is pruned by an angle are multiples of the placement."""
    worst: dict[int, float] = {}
    wrong = failure(case, cases.random(case), worst)
    for angle, move in worst.items():
        name = f"largest move at {angle} degrees"
        cases.counts[name] = max(cases.counts[name], move)
    cases.counts["repaired"] += wrong == "repaired"
    return FAMILIES[case % len(FAMILIES)].__name__, None if wrong == "repaired" else wrong, ""


COMPARISON = Comparison(1000, check)
