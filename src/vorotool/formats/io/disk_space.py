"""Room on a disk for an output, which is asked for before it is made."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable
from pathlib import Path

from vorotool.errors import OUTPUT, OutputError
from vorotool.formats.io.descriptors import stream_kind


def check_space(path: str | os.PathLike[str], most: int, expected: Callable[[], int]) -> None:
    """Refuse an output for which there is no room."""
    free = _free(path)
    if free is None or most <= free:
        return
    needed = expected()
    if needed > free:
        raise OutputError(
            f"{os.fspath(path)} takes about {needed / 1e9:.3g} GB, but {free / 1e9:.3g} GB are free: free some space, "
            f"or write elsewhere with {OUTPUT}"
        )


def _free(path: str | os.PathLike[str]) -> int | None:
    """Bytes that are free where a file is, or will be; None where it takes none."""
    if stream_kind(os.fspath(path)) is not None:
        return None
    target = Path(os.path.realpath(path))
    folder = target.parent
    while not folder.exists():
        folder = folder.parent
    return shutil.disk_usage(folder).free
