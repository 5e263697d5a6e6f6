"""Long arrays that are filled a chunk at a time, on several threads."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

from vorotool.geometry.checks import available_threads, checked_threads

CHUNK = 1 << 15
"""Rows that are taken at a time: what is made of them stays in the cache."""


def in_chunks(count: int, fill: Callable[[slice], None], *, threads: int = 1) -> None:
    """Call a function for chunks of rows: what it makes of one must not depend on the others.

    Parameters
    ----------
    count : int
        Of rows.
    fill : callable
        Called with each chunk.
    threads : int
        0 uses all.

    Examples
    --------
    >>> squares = [0, 1, 2, 3]
    >>> def square(rows):
    ...     squares[rows] = [k * k for k in squares[rows]]
    >>> in_chunks(4, square)
    >>> squares
    [0, 1, 4, 9]
    """
    chunks = [slice(begin, begin + CHUNK) for begin in range(0, count, CHUNK)]
    threads = min(checked_threads(threads) or available_threads(), len(chunks))
    if threads < 2:
        for chunk in chunks:
            fill(chunk)
        return
    with ThreadPoolExecutor(threads) as pool:
        try:
            for _ in pool.map(fill, chunks):
                pass
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise
