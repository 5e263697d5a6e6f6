"""Places that are exactly on the straight line between others."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.exact_products import difference, product

Floats = NDArray[np.float64]


def is_straight(a: Floats, b: Floats, c: Floats) -> NDArray[np.bool_]:
    """Tell where b is certainly between a and c: the products compared are exact, where differences are."""
    (ux, uy), (ux_lost, uy_lost) = (part.T for part in difference(b, a))
    (vx, vy), (vx_lost, vy_lost) = (part.T for part in difference(c, b))
    one, lost = product(ux, vy)
    other, other_lost = product(uy, vx)
    is_exact = (ux_lost == 0) & (uy_lost == 0) & (vx_lost == 0) & (vy_lost == 0)
    is_zero = is_exact & (one == other) & (lost == other_lost)
    is_level = ((ux == 0) & (vx == 0)) | ((uy == 0) & (vy == 0))
    return np.asarray((is_zero | is_level) & (ux * vx + uy * vy >= 0))
