"""Files that are mapped into memory: the system reads what is looked at, and may drop it again."""

from __future__ import annotations

import mmap
import os
import tempfile
import weakref
from pathlib import Path
from typing import cast

from vorotool.formats.io.sources import copy_stream


def mapped(path: str) -> bytes:
    """Give the content of a file, as something that can be sliced like bytes."""
    with Path(path).open("rb") as file:
        return cast("bytes", memoryview(mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)))


class Spool:
    """A temporary file with all that comes through a stream; it is removed with this object, or when Python ends."""

    def __init__(self, name: str) -> None:
        descriptor, self.path = tempfile.mkstemp(prefix="vorotool-")
        self._remove = weakref.finalize(self, _remove, self.path)
        with os.fdopen(descriptor, "wb") as out:
            copy_stream(name, out)


def _remove(path: str) -> None:
    Path(path).unlink(missing_ok=True)
