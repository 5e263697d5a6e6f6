"""Text for people: characters that would drive a terminal are escaped; messages of failures and their exit codes."""

from __future__ import annotations

import re
import sys
from typing import TextIO

from vorotool.errors import LimitError, Message, VorotoolError

_UNPRINTABLE = "[\x00-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069]"
"""Control characters, ends of lines, and what changes the direction of text."""


def escaped(text: str) -> str:
    """Write characters that a terminal acts upon as escapes."""
    return re.sub(_UNPRINTABLE, lambda match: repr(match[0])[1:-1], text)


def tell(line: str) -> None:
    """Print one line on standard error, with escapes."""
    print_text(f"{escaped(line)}\n", sys.stderr)


def print_text(text: str, stream: TextIO | None = None) -> None:
    """Print text on standard output or another stream; characters that its encoding lacks become escapes."""
    stream = sys.stdout if stream is None else stream
    encoding = stream.encoding or "utf-8"
    stream.write(text.encode(encoding, "backslashreplace").decode(encoding))
    stream.flush()


def explained(error: Exception) -> tuple[Message, int]:
    """Return the message and the exit code of an error; print the traceback of an internal error."""
    if isinstance(error, VorotoolError):
        return error.typed, error.exit_code
    if isinstance(error, MemoryError):
        text = "out of memory: use a smaller frame, or an output that is streamed, such as TIFF or Zarr"
        return Message(text), LimitError.exit_code
    import traceback

    traceback.print_exception(error)
    text = f"internal error in vorotool: {error}; please report it with the lines above"
    return Message(text), VorotoolError.exit_code
