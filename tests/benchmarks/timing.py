"""How long a call takes: the least of several runs."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import numpy as np


def timed(function: Callable[[], Any], runs: int) -> tuple[float, Any]:
    """Least seconds of several runs, and what the last one gave; no result is held while another run is timed."""
    least, made = np.inf, None
    for _ in range(runs):
        made = None
        begin = time.perf_counter()
        made = function()
        least = min(least, time.perf_counter() - begin)
    return least, made


def best(function: Callable[[], Any], runs: int) -> float:
    """Least seconds of several runs."""
    return timed(function, runs)[0]
