"""What benchmarks share: how long a call takes, processes of their own, options."""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
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


def in_own_process(function: Callable[..., Any], *arguments: object) -> Any:
    """What it gives; its memory is its own."""
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        return pool.submit(function, *arguments).result()


def options(what: str, sizes: list[int], runs: int) -> argparse.ArgumentParser:
    """Options of a table beside peers: its sizes, threads and runs."""
    parser = argparse.ArgumentParser()
    parser.add_argument(f"--{what}", type=int, nargs="+", default=sizes)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--runs", type=int, default=runs)
    parser.add_argument("--no-peers", action="store_true")
    return parser
