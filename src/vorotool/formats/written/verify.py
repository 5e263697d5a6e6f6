"""An independent check of rings as they are written."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import VerificationError

_COARSEST = 2.0**-28
"""Of the extent: the lattice that rings are repaired on is finer."""


def verify_written(made: NDArray[Any], given: NDArray[Any], decimals: int | None, *, is_coverage: bool) -> None:
    """Check features as they are written, by GEOS."""
    import shapely

    bad = np.flatnonzero(~shapely.is_valid(made))
    if bad.size:
        reason = shapely.is_valid_reason(made[bad[0]])
        raise VerificationError(f"feature {bad[0] + 1} is invalid as it is written: {reason}")
    if is_coverage and not shapely.coverage_is_valid(made[~shapely.is_empty(made)]):
        raise VerificationError("cells overlap, or do not share their vertices, as they are written")
    xy = shapely.get_coordinates(made)
    extent = float(np.abs(xy).max(initial=0))
    step = extent * _COARSEST
    if decimals is not None and extent * float(10**decimals) < 2.0**52:
        bad = np.flatnonzero((np.round(xy, decimals) != xy).any(axis=1))
        if bad.size:
            raise VerificationError(f"coordinate {xy[bad[0]].tolist()} has more than {decimals} decimals")
        step = max(step, 1 / float(10**decimals))
    bound = 2 * step * (shapely.length(made) + shapely.length(given)) + 16 * step * step
    far = np.flatnonzero(np.abs(shapely.area(made) - shapely.area(given)) > bound)
    if far.size and not is_coverage:
        areas = shapely.area(given[far[0]]), shapely.area(made[far[0]])
        raise VerificationError(f"feature {far[0] + 1} has the area {areas[0]:g}, but {areas[1]:g} as it is written")
