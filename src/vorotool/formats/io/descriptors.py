"""Names of what is open already, or passes by once: descriptors of this process, pipes, sockets, devices.

``/dev/stdin``, ``/dev/stdout``, ``/dev/stderr``, ``/dev/fd/N``, ``/proc/self/fd/N``, links to them, and what a shell
puts in the place of ``<(...)`` and ``>(...)`` are *descriptors*: they are duplicated, so that reading and writing go on
where they stand, and never opened by name, which would begin a file again or replace it. A *stream* is a descriptor, or
whatever else is neither a file nor a folder: it is opened once, and read or written from its beginning to its end.
"""

from __future__ import annotations

import errno
import io
import os
import re
import select
import stat
import sys
from collections.abc import Callable, Hashable
from typing import Any, BinaryIO

from vorotool.errors import OUTPUT, OutputError

try:
    import fcntl
except ImportError:  # on Windows
    fcntl = None  # type: ignore[assignment]

STANDARD = "-"
"""Standard input where something is read, standard output where something is written."""

MOST_LINKS = 40
"""As many links as Linux follows in a path."""

READ_BYTES = 1 << 20
"""That are asked for at a time."""

_OF_A_PROCESS = "/proc/([0-9]+)(?:/task/[0-9]+)?/fd"

_KINDS = (
    (stat.S_ISFIFO, "a pipe"),
    (stat.S_ISSOCK, "a socket"),
    (stat.S_ISCHR, "a device"),
    (stat.S_ISBLK, "a device"),
)


def descriptor_of(name: str, *, of_others: bool = False) -> int | None:
    """Return the number of the open descriptor of this process, or of another one, that a path stands for, if any."""
    path = name
    try:
        for _ in range(MOST_LINKS):
            folder, last = os.path.split(path)
            folder = os.path.realpath(folder or ".")
            match = re.fullmatch(_OF_A_PROCESS, folder) if folder.startswith("/proc/") else None
            if match or folder == "/dev/fd":  # its own link is never followed
                is_other = match is not None and int(match[1]) != os.getpid()
                return int(last) if is_other == of_others and re.fullmatch("[0-9]{1,9}", last) else None
            path = str(os.path.join(folder, os.readlink(os.path.join(folder, last))))
    except (OSError, ValueError):  # no link any more, or no path
        pass
    return None


def stream_kind(name: str) -> str | None:
    """The kind of a stream, in words; None for a file, a folder and what is not there. Nothing is opened."""
    if name == STANDARD or descriptor_of(name) is not None:
        return "an open descriptor"
    try:
        mode = os.stat(name).st_mode
    except (OSError, ValueError):
        return None
    return next((kind for is_kind, kind in _KINDS if is_kind(mode)), None)


def input_identity(name: str) -> Hashable | None:
    """An identity that two names of one stream share; None for files, and for devices, which start anew."""
    number = 0 if name == STANDARD else descriptor_of(name)
    try:
        found = os.stat(name) if number is None else os.fstat(number)
    except (OSError, ValueError):
        return number
    if stat.S_ISFIFO(found.st_mode) or stat.S_ISSOCK(found.st_mode):
        return found.st_dev, found.st_ino
    return number


def is_same_output(one: str, other: str) -> bool:
    """Whether two names of outputs are one descriptor, pipe or file, there already or yet to be written."""
    numbers = [1 if name == STANDARD else descriptor_of(name) for name in (one, other)]
    if None not in numbers and numbers[0] == numbers[1]:
        return True
    try:
        a, b = (
            os.stat(name) if number is None else os.fstat(number)
            for name, number in zip((one, other), numbers, strict=True)
        )
    except (OSError, ValueError):
        return numbers == [None, None] and os.path.realpath(one) == os.path.realpath(other)
    if None not in numbers:  # both are written where they stand, whatever they are
        return False
    return os.path.samestat(a, b) and (stat.S_ISREG(a.st_mode) or stat.S_ISFIFO(a.st_mode))


def open_input(descriptor: int) -> BinaryIO:
    """Open what a descriptor reads, from where it stands."""
    _check_mode(descriptor, os.O_RDONLY)
    return io.BufferedReader(_PatientReader(os.dup(descriptor), "rb"))


def open_output_descriptor(descriptor: int) -> BinaryIO:
    """Open what a descriptor writes, from where it stands, or from the end of what is appended to."""
    check_writable(descriptor)
    for stream in (sys.stdout, sys.stderr):  # what was said before comes first
        if number_of(stream) == descriptor:
            stream.flush()
    return io.BufferedWriter(_OnwardOnly(os.dup(descriptor), "wb"))


def open_onward(path: str | os.PathLike[str]) -> BinaryIO:
    """Open a pipe or a device, which is written in order: some devices say that they can be sought, and cannot."""
    return io.BufferedWriter(_OnwardOnly(path, "wb"))


def check_writable(descriptor: int) -> None:
    """Refuse a descriptor that is closed, or open for reading only (OSError)."""
    _check_mode(descriptor, os.O_WRONLY)


def _check_mode(descriptor: int, wanted: int) -> None:
    # a standard stream that was closed from the start stays so, whatever has got its number since
    was_closed = descriptor < 3 and (sys.__stdin__, sys.__stdout__, sys.__stderr__)[descriptor] is None
    try:
        if not was_closed and _mode(descriptor) in (None, wanted, os.O_RDWR):
            return
    except (OSError, OverflowError):  # no descriptor of this process
        pass
    purpose = "writing" if wanted == os.O_RDONLY else "reading"
    raise OSError(errno.EBADF, f"{os.strerror(errno.EBADF)}: it is closed, or open for {purpose} only")


def _mode(descriptor: int) -> int | None:
    """What a descriptor is open for; None where the system does not say so before it is read or written."""
    if fcntl is None:
        os.fstat(descriptor)  # raises for one that is closed
        return None
    return fcntl.fcntl(descriptor, fcntl.F_GETFL) & os.O_ACCMODE


def number_of(stream: object) -> int | None:
    """Return the number of the descriptor of a stream; None where it has none, or is closed."""
    try:
        return int(stream.fileno())  # type: ignore[attr-defined]  # what has none is no stream of the system
    except (AttributeError, OSError, ValueError):
        return None


class _PatientReader(io.FileIO):
    """Waits for what is yet to come where the system would not, as others may have asked of what they share with us."""

    def readinto(self, buffer: Any) -> int:
        while (count := super().readinto(buffer)) is None:
            select.select([self], [], [])
        return count

    def readall(self) -> bytes:
        parts = []
        while (part := self.read(READ_BYTES)) != b"":
            if part is None:
                select.select([self], [], [])
            else:
                parts.append(part)
        return b"".join(parts)


class _OnwardOnly(io.FileIO):
    """Written in order, like a pipe, whatever it is; waits for room where the system would not."""

    def write(self, data: Any) -> int:
        while (written := super().write(data)) is None:
            select.select([], [self], [])
        return written

    def seekable(self) -> bool:
        return False

    def seek(self, *_: object) -> int:
        raise io.UnsupportedOperation("what is open already is written in order")

    def tell(self) -> int:
        raise io.UnsupportedOperation("what is open already has no position of ours")


# ---- room on a disk ------------------------------------------------------------------------------
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
    folder = os.path.dirname(os.path.realpath(path))
    while not os.path.exists(folder):
        folder = os.path.dirname(folder)
    return _free_on_disk(folder)


def _free_on_disk(folder: str) -> int:
    """Bytes that are free: by shutil, which loads bz2 and lzma, only on Windows."""
    if sys.platform == "win32":
        from shutil import disk_usage

        return disk_usage(folder).free
    disk = os.statvfs(folder)
    return disk.f_bavail * disk.f_frsize
