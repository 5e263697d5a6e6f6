"""What every reader asks first: is this too large, and does the library that decodes it complain."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Protocol

from vorotool.errors import InputError, LimitError, VorotoolError


class SourceLike(Protocol):
    """A file's name, for messages, and its bytes."""

    @property
    def name(self) -> str:
        """Path, or a word such as ``standard input``."""

    @property
    def data(self) -> bytes:
        """The whole content."""


def check_pixels(name: str, width: int, height: int, max_pixels: int) -> None:
    """Refuse an image that is empty or larger than the limit, from its header alone.

    Raises
    ------
    InputError
        If a side is below 1.
    LimitError
        If there are more than ``max_pixels`` pixels.

    Examples
    --------
    >>> check_pixels("a.png", 640, 480, 10**6)
    """
    if width < 1 or height < 1:
        raise InputError(f"{name} is {width} x {height} pixels: an image needs at least 1 x 1")
    if width * height > max_pixels:
        raise LimitError(
            f"{name} is {width} x {height} = {width * height} pixels, more than --max-pixels {max_pixels}: "
            "raise that if there is memory for it, or crop the image"
        )


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
