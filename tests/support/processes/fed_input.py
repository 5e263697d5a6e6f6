"""Standard input of this process, fed through a pipe."""

import os
import sys
import threading
from contextlib import contextmanager, suppress

import pytest


@contextmanager
def fed_input(data):
    """Let a pipe that gives these bytes be standard input, its descriptor as well."""
    reading, writing = os.pipe()
    kept = os.dup(0)
    os.dup2(reading, 0)
    os.close(reading)
    feeder = threading.Thread(target=_feed, args=(writing, data))
    feeder.start()
    try:
        with pytest.MonkeyPatch.context() as patched, open(0, closefd=False, encoding="utf-8") as stdin:
            patched.setattr(sys, "stdin", stdin)
            yield
    finally:
        os.dup2(kept, 0)
        os.close(kept)
        feeder.join()


def _feed(writing, data):
    with suppress(BrokenPipeError), open(writing, "wb") as pipe:  # noqa: PTH123
        pipe.write(data)
