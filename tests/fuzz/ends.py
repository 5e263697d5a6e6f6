"""Ends of skeletons and centerlines: `--cases 1000 --seed 1`.

Skeletons of discs with stems and of letters lose no branch when they are extended; centerlines of strips of 5 to 2,000
vertices end where their axes do.
"""

import numpy as np
import shapely

from fuzz.runner import of_families
from support.families.stems import disc_with_stems, letter, lines_of, lost, mask_of
from support.families.strips import Strip, strip
from vorotool import VerificationError, centerline, extend_ends, outlines, prune, skeleton_exact, verify_extended

SIZES = (24, 60, 150)


def discs(random):
    """Draw a disc with stems."""
    return disc_with_stems(random)


def letters(random):
    """Draw the outlines of a letter at one of three sizes."""
    return letter(random, SIZES[int(random.integers(3))])[1], []


def strips(random):
    """Draw a strip with a known axis; some drawings are none."""
    return strip(random)


def failure(case: tuple | Strip | None, random: np.random.Generator) -> str | None:
    """What is missing of a polygon or of its mask, or wrong with the ends of a strip, if anything."""
    if not isinstance(case, tuple):
        return case and strip_failure(case)
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


def strip_failure(made: Strip) -> str | None:
    """What is wrong with the ends of a strip, if anything."""
    whole = skeleton_exact(made.ring)
    for name, skeleton in (("whole", whole), ("pruned", prune(whole, scale=1.3))):
        ends = centerline(skeleton).ends[0]
        off = max(np.hypot(*(ends - end).T).min() for end in made.axis[[0, -1]]) / made.width
        if not off < 0.01:
            return f"{name}: an end is {off:.3f} widths off"
    return None


COMPARISON = of_families(1000, [discs, letters, strips], failure)
