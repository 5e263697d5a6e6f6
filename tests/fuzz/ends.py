"""Skeletons that are led on to their ends lose no branch: discs with stems, and letters: `--cases 800 --seed 1`."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import shapely

sys.path.insert(0, str(Path(__file__).parents[1]))
from fuzz.runner import run_families
from support.families.stems import disc_with_stems, letter, lines_of, lost, mask_of
from vorotool import VerificationError, extend_ends, outlines, prune, skeleton_exact, verify_extended

SIZES = (24, 60, 150)


def discs(random):
    """Draw a disc with stems."""
    return disc_with_stems(random)


def letters(random):
    """Draw the outlines of a letter at one of three sizes."""
    return letter(random, SIZES[int(random.integers(3))])[1], []


def failure(case: tuple, random: np.random.Generator) -> str | None:
    """What is missing of a polygon or of its mask, if anything."""
    shape, stems = case
    mask, corner = mask_of(shape)
    for name, polygons, origin in (("polygon", shape, 0.0), ("mask", outlines(mask), corner)):
        pruned = prune(skeleton_exact(polygons), scale=1.5)
        extended = extend_ends(pruned)
        try:
            verify_extended(extended, pruned)
        except VerificationError as error:
            return f"{name}: {error}"
        nodes = lost(pruned, extended)
        if nodes:
            return f"{name}: lost at {nodes}"
        before, after = lines_of(pruned), shapely.union_all(extended.to_shapely(flatten=0.01))
        for place, width in stems:
            at = shapely.Point(place - origin)
            if after.distance(at) > max(width / 2, before.distance(at) + 0.02):
                return f"{name}: the stem at {place.tolist()} is lost"
    return None


if __name__ == "__main__":
    sys.exit(run_families([discs, letters], failure, 800))
