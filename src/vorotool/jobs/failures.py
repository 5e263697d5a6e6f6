"""What is said when a command fails, and its exit code."""

from __future__ import annotations

from vorotool.errors import LimitError, Message, VorotoolError


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
