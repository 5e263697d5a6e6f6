"""Parts of some work that are independent: done on several threads, and their arrays put together."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor, wait
from itertools import accumulate
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from vorotool.geometry.progress import Progress

Result = TypeVar("Result")

POLL_INTERVAL = 0.1
"""Seconds between two looks at how far others are."""


def in_threads(tasks: Sequence[Callable[[Progress], Result]], threads: int, progress: Progress) -> list[Result]:
    """Do tasks, and give their results in order.

    Parameters
    ----------
    tasks : sequence of callables
        Called with what they are to call as their progress: it raises when the others have stopped.
    threads : int
        At least 1.
    progress : callable, optional
        Called with the fraction done.

    Examples
    --------
    >>> in_threads([lambda _: 1, lambda _: 2], 2, None)
    [1, 2]
    """
    if len(tasks) == 1:
        return [tasks[0](progress)]
    stop = threading.Event()
    done = [0.0] * len(tasks)

    def progress_of(k: int) -> Progress:
        def poll(fraction: float) -> None:
            if stop.is_set():
                raise KeyboardInterrupt
            done[k] = fraction

        return poll

    def report() -> None:
        if progress is not None:
            progress(
                sum(1 if future.done() else share for future, share in zip(futures, done, strict=True)) / len(tasks)
            )

    with ThreadPoolExecutor(threads) as pool:
        futures = [pool.submit(task, progress_of(k)) for k, task in enumerate(tasks)]
        try:
            for future in futures:
                while wait([future], POLL_INTERVAL).not_done:
                    report()
                future.result()
                report()
        except BaseException:
            stop.set()
            pool.shutdown(cancel_futures=True)
            raise
    return [future.result() for future in futures]


def stacked(arrays: Sequence[NDArray[Any]], shifts: Sequence[int] | None = None) -> NDArray[Any]:
    """Arrays one after the other, each with a number of its own added.

    Examples
    --------
    >>> stacked([np.array([0, 1]), np.array([0])], [0, 2]).tolist()
    [0, 1, 2]
    """
    if shifts is None:
        return np.concatenate(arrays)
    made = np.empty((sum(map(len, arrays)), *arrays[0].shape[1:]), arrays[0].dtype)
    for array, begin, shift in zip(arrays, starts_of([len(array) for array in arrays]), shifts, strict=True):
        np.add(array, shift, out=made[begin : begin + len(array)])
    return made


def starts_of(counts: Sequence[int]) -> list[int]:
    """How many come before each.

    Examples
    --------
    >>> starts_of([3, 1, 2])
    [0, 3, 4]
    """
    return [0, *accumulate(counts[:-1])]
