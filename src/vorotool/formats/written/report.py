"""What is reported of coordinates that were rounded."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import RepairWarning, warn
from vorotool.numeric.coordinate_grid import current_decimals

_NAMED = 10


def report_emptied(rows: NDArray[np.integer], what: str) -> None:
    """Warn of cells or features that are without area on the grid of the file, counted from 1."""
    if not len(rows):
        return
    named = ", ".join(str(row + 1) for row in rows[:_NAMED].tolist()) + (", ..." if len(rows) > _NAMED else "")
    number = f"{len(rows)} {what} has" if len(rows) == 1 else f"{len(rows)} {what}s have"
    grid = "" if current_decimals() is None else f" with {current_decimals()} decimals"
    warn(f"{number} no area{grid} and {'is' if len(rows) == 1 else 'are'} empty: {named}", RepairWarning)
