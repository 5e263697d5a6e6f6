"""What benchmarks share: how long a call takes, memory, processes of their own, a shape, options."""

from __future__ import annotations

import argparse
import resource
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

STATUS = Path("/proc/self/status")


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


def peak() -> int:
    """Most bytes that this process has held, on Linux since the last reset: what `resource` tells may be a parent's."""
    if STATUS.exists():
        return 1024 * int(STATUS.read_text().split("VmHWM:")[1].split()[0])
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024


def reset_peak() -> None:
    """Forget what drawing the input took: the peak becomes what is held now."""
    if STATUS.exists():
        STATUS.with_name("clear_refs").write_text("5")


def peak_of(function: Callable[[], Any]) -> int:
    """Bytes that a call takes at its peak, above those that are held before it."""
    reset_peak()
    before, made = peak(), function()
    after = peak()
    del made
    return after - before


def star(edges: int) -> NDArray[np.float64]:
    """Around the origin, about 2000 wide."""
    angle = 2 * np.pi * np.arange(edges) / edges
    radius = 750 * (1 + 0.3 * np.sin(7 * angle) + 0.1 * np.cos(23 * angle))
    return np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)


def print_head(*cells: str) -> None:
    """Print the names of the columns of a table, and the line below them."""
    print(f"| {' | '.join(cells)} |\n" + "|---" * len(cells) + "|")


def options(what: str, sizes: list[int], runs: int) -> argparse.ArgumentParser:
    """Options of a table beside peers: its sizes, threads and runs."""
    parser = argparse.ArgumentParser()
    parser.add_argument(f"--{what}", type=int, nargs="+", default=sizes)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--runs", type=int, default=runs)
    parser.add_argument("--no-peers", action="store_true")
    return parser
