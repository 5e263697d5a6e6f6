"""Pruned skeletons against brute force, and as parts of each other: `--cases 1000 --seed 1`."""

import numpy as np

from fuzz.runner import of_families
from support.families.skeleton_shapes import FAMILIES
from support.oracles.pruning_oracle import disagreement, thresholds
from vorotool import VorotoolError, critical_values, prune, skeleton_exact, verify_pruning
from vorotool.types.skeleton.skeleton import CRITERIA

MOST_ARCS = 150
"""Brute force is quadratic."""


def failure(shape: object, random: np.random.Generator) -> str | None:
    """What is wrong with the pruned skeletons of a shape, if anything."""
    for side in ("interior", "both"):
        skeleton = skeleton_exact(shape, side=side)
        for criterion in CRITERIA:
            least, most = sorted([*thresholds(critical_values(skeleton, criterion), random), 1.1, 2.0])[:2]
            try:
                left = prune(skeleton, **{criterion: least})
                verify_pruning(left, skeleton)
                verify_pruning(prune(skeleton, **{criterion: most}), left)
            except VorotoolError as error:
                return f"{side}, {criterion} {least} and {most}: {error}"
        if 0 < len(skeleton) <= MOST_ARCS:
            wrong = disagreement(skeleton, random)
            if wrong:
                return f"{side}, {wrong}"
    return None


COMPARISON = of_families(1000, FAMILIES, failure)
