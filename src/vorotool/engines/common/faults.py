"""Faults, as checkers raise them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import VerificationError


def fail(message: str) -> None:
    """Raise VerificationError."""
    raise VerificationError(message)


def first_wrong(wrong: NDArray[np.bool_]) -> int | None:
    """Where the first of some faults is, if any."""
    at = np.flatnonzero(wrong)
    return int(at[0]) if at.size else None
