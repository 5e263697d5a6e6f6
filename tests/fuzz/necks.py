"""Necks against brute force in fractions, and the parts between them: `--cases 1000 --seed 1`."""

import numpy as np
import shapely

from fuzz.runner import of_families
from support.families.skeleton_shapes import FAMILIES
from support.oracles.neck_oracle import disagreement
from vorotool import VorotoolError, necks, parts, skeleton_exact, verify_necks, verify_parts

MOST_VERTICES = 60
"""Brute force is cubic."""


def failure(shape: object, random: np.random.Generator) -> str | None:
    """What is wrong with the necks and the parts of a shape, if anything."""
    skeleton = skeleton_exact(shape, features=("separate", "together")[int(random.integers(2))])
    try:
        found = necks(skeleton, neck=1)
        verify_necks(found)
        wrong = disagreement(found) if 0 < len(skeleton.polygons.xy) <= MOST_VERTICES else None
        if wrong:
            return wrong
        for ratio in (0.5, float(random.random()), 1.0):
            pieces = parts(skeleton, neck=ratio)
            verify_parts(pieces)
            wrong = wrong_parts(pieces, ratio, found)
            if wrong:
                return f"ratio {ratio}: {wrong}"
    except VorotoolError as error:
        return str(error)
    return None


def wrong_parts(pieces, ratio, found):
    """What is wrong with parts, as shapely sees them."""
    shapes = pieces.to_shapely()
    if pieces.polygons.ring_starts.size and (np.diff(pieces.polygons.ring_starts) > 2).all():
        for k in np.flatnonzero(~shapely.is_valid(shapes)).tolist():
            return f"piece {k} is not valid: {shapely.is_valid_reason(shapes[k])}"
    if not np.allclose(shapely.area(shapes), pieces.area):
        return "areas differ"
    if (pieces.necks.ratio > ratio).any() or len(pieces.necks) > (found.ratio <= ratio).sum():
        return "there are cuts at necks that are wider"
    return None


COMPARISON = of_families(1000, FAMILIES, failure)
