"""Limits of all readers: sizes are checked first, and complaints of decoding libraries become errors."""

from __future__ import annotations

import threading
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TypeVar

from vorotool.errors import InputError, LimitError, VorotoolError, option
from vorotool.numeric.parallel import start

_MOMENT = 0.05
"""Seconds after which signals are looked for."""

MOST_UNPACKED = 1 << 29
"""Bytes that any file may become, however small it is."""
_MOST_TIMES = 100

Result = TypeVar("Result")


def check_pixels(name: str, width: int, height: int, max_pixels: int) -> None:
    """Refuse an image that is empty or larger than the limit, from its header alone."""
    if width < 1 or height < 1:
        raise InputError(f"{name} is {width} x {height} pixels: an image needs at least 1 x 1")
    if width * height > max_pixels:
        limit = option(f"--max-pixels {max_pixels}")
        raise LimitError(
            f"{name} is {width} x {height} = {width * height} pixels, more than {limit}: "
            "raise that if there is memory for it, or crop the image"
        )


def check_unpacked(name: str, size: int, packed: int) -> None:
    """Refuse what becomes larger than 512 MiB and than 100 times the file that holds it."""
    if size > max(MOST_UNPACKED, _MOST_TIMES * packed):
        raise LimitError(
            f"{name} has {packed} bytes that unpack to at least {size}, more than {_MOST_TIMES} times as many: split "
            "it, or write it without compression"
        )


def interruptible(work: Callable[[], Result]) -> Result:
    """Call what takes long in a library that does not look for signals: in a thread, so that this one sees them."""
    if threading.current_thread() is not threading.main_thread():
        return work()
    from concurrent.futures import Future, wait

    future: Future[Result] = Future()
    start(work, future)
    while not future.done():  # a signal may reach another thread, which does not wake this one
        wait([future], _MOMENT)
    return future.result()


@contextmanager
def decoding(name: str, kind: str) -> Iterator[None]:
    """Turn whatever a decoder raises or warns of on damaged bytes into one InputError that names the file."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield
    except (VorotoolError, MemoryError):
        raise
    except Exception as error:  # decoders raise nearly everything on damaged bytes, IndexError included
        reason = " ".join(str(error).split()) or type(error).__name__
        damage = InputError(f"{name} cannot be read as {kind}: {reason}; is the file damaged or cut off?")
        damage.source = name
        raise damage from error
