"""Temporary files and folders beside outputs: whose they are, and who may remove those of the dead.

An output is written beside its place under a temporary name and moved in when it is whole. A process that is killed
leaves its temporary behind. The next process that writes in the folder removes it, but never one that is still being
written, by whatever process of whatever machine. Two things together tell:

- The name, ``.vorotool-HOST-TAG-RANDOM.tmp``: HOST is a digest of this boot of the system and one of the machine.
- An advisory lock (``flock``) that the owner holds on the temporary itself, file or folder, from before anything is
  written until it has its final name. The system releases it at death, also by ``kill -9`` or a loss of power.

An owner is dead if HOST says that it ran on this machine and its lock can be taken. All locks of one kernel are seen
by all its processes, in containers, too, and on network file systems whose locks are not shared. Of other machines a
lock proves nothing there, and neither does a process number, so that their temporaries are never removed: they stay
until something is written in the folder from that machine, or somebody removes them who knows that nothing runs there.
Process numbers and times of start would tell no more on this machine, and less where containers count their own.

Where a file system or a system has no such locks, names have no HOST, and nothing but the end of the batch that they
are tagged with removes them; so it is with names of version 0.1.0.
"""

from __future__ import annotations

import os
import re
import stat
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager, suppress
from contextvars import ContextVar
from functools import cache
from typing import BinaryIO, NamedTuple
from zlib import crc32

from vorotool.numeric.parallel import scoped

try:
    import fcntl
except ImportError:  # on Windows
    fcntl = None  # type: ignore[assignment]

_TAG: ContextVar[str] = ContextVar("tag", default="")
"""In the names of temporaries."""

_NAME = r"\.vorotool-(?:([0-9a-f]{12})([0-9a-f]{12})-)?((?:[A-Za-z0-9]+-)*)[0-9a-f]{16}\.(?:tmp|aside)"
"""Boot, machine and tag."""

ASIDE = ".aside"
"""Ends the names of folders that hold what is moved out of the way, under its own name: it must not be lost."""

_UNKNOWN = "0" * 12


class Temporary(NamedTuple):
    """A file or folder that is being written, and is ours."""

    path: str  # its name for now
    descriptor: int  # holds the lock; -1 of what is not held open

    def opened(self) -> BinaryIO:
        """Open a file for writing; closing this does not give the lock back."""
        return open(self.path, "r+b") if self.descriptor < 0 else os.fdopen(os.dup(self.descriptor), "w+b")

    def is_at(self, path: str) -> bool:
        """Return whether it has a name by now."""
        if self.descriptor < 0:
            return not os.path.lexists(self.path)
        try:
            return os.path.samestat(os.lstat(path), os.fstat(self.descriptor))
        except FileNotFoundError:
            return False


@contextmanager
def temporary_beside(
    target: str | os.PathLike[str], make: Callable[[str], int], *, ending: str = ".tmp"
) -> Iterator[Temporary]:
    """Make a temporary file or folder, and remove what is left of it at the end, whatever happens."""
    commit = Commit()
    try:
        yield commit.make(target, make, ending=ending)
    finally:
        _insist(commit.close)


def new_file(path: str, like: str = "") -> int:
    """Make an empty file with the permissions of another one, else those of the umask; its descriptor, or -1."""
    descriptor = os.open(path, os.O_RDWR | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0), 0o666)
    if like:
        with suppress(OSError):  # no older file, or a file system without permissions
            os.chmod(path, stat.S_IMODE(os.stat(like).st_mode))
    if sys.platform == "win32":  # there a file that is open cannot be renamed
        os.close(descriptor)
        return -1
    return descriptor


def new_folder(path: str) -> int:
    """Make an empty folder; its descriptor, or -1 where folders cannot be opened, or it is gone already."""
    os.mkdir(path)
    if not hasattr(os, "O_DIRECTORY"):
        return -1
    with suppress(FileNotFoundError):
        return os.open(path, os.O_RDONLY | os.O_DIRECTORY)
    return -1


def tagged_temporaries(tag: str) -> AbstractContextManager[None]:
    """Put a tag in the names of temporaries that are made within."""
    return scoped(_TAG, tag)


def remove_left(folders: Iterable[str | os.PathLike[str]], tag: str = "") -> None:
    """Remove temporaries whose owners are proved dead; with a tag all that have it, whoever made them, anywhere."""
    boot, machine = _host()
    for folder in folders:
        names: list[str] = []
        with suppress(OSError), os.scandir(folder) as entries:  # a folder that cannot be listed has none
            names = [entry.name for entry in entries if entry.name.startswith(".vorotool-")]
        for name in names:
            path, found = os.path.join(folder, name), re.fullmatch(_NAME, name)
            if found is None:
                continue
            if tag:
                if found[3].startswith(tag):
                    _discard(path)
            elif (found[1] == boot != _UNKNOWN) or (found[2] == machine != _UNKNOWN):
                _remove_unless_held(path)


def remove(path: str) -> None:
    """Remove a file or a folder with all that is in it, as far as it is there and can be removed."""
    if os.path.isdir(path) and not os.path.islink(path):
        import shutil  # it brings compressors

        shutil.rmtree(path, ignore_errors=True)
    else:
        with suppress(OSError):
            os.unlink(path)


_SEEN: set[tuple[str, str]] = set()
"""Folders, with tags of batches, from which this process has removed what the dead have left."""


def _remove_unless_held(path: str) -> None:
    """Remove a temporary of this machine if its lock can be taken, which is held meanwhile."""
    if fcntl is None:
        return
    with suppress(OSError):  # such as that somebody holds the lock
        kind = os.lstat(path).st_mode
        if not (stat.S_ISREG(kind) or stat.S_ISDIR(kind)):
            return
        access = os.O_RDONLY | os.O_DIRECTORY if stat.S_ISDIR(kind) else os.O_RDWR  # which network locks ask for
        descriptor = os.open(path, access | os.O_NOFOLLOW | os.O_NONBLOCK)
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
            if Temporary(path, descriptor).is_at(path):
                _discard(path)
        finally:
            os.close(descriptor)


def _discard(path: str) -> None:
    """Remove a temporary; what was moved aside goes back where nothing has taken its place."""
    if path.endswith(ASIDE):
        try:
            for name in os.listdir(path):
                place = os.path.join(os.path.dirname(path), name)
                if not os.path.lexists(place):
                    os.rename(os.path.join(path, name), place)
        except OSError:  # what is in it may be all that there is
            return
    remove(path)


@cache
def _host() -> tuple[str, str]:
    """Digests of this boot of the system and of this machine, as far as they can be known."""
    texts = []
    for path in ("/proc/sys/kernel/random/boot_id", "/etc/machine-id"):
        try:
            with open(path, encoding="utf-8", errors="replace") as file:
                texts.append(file.read().strip())
        except OSError:
            texts.append("")
    boot, machine = texts
    if not machine and sys.platform == "darwin":
        import uuid

        machine = f"{uuid.getnode():x}"
    name = os.uname().nodename if hasattr(os, "uname") else ""  # which tells machines with copied disks apart
    known = (text.encode() for text in (boot, machine and f"{machine} {name}"))
    # 48 bits of each: hashlib would bring OpenSSL, at the start of every run
    one, other = (f"{crc32(data):08x}{crc32(data[::-1]) & 0xFFFF:04x}" if data else _UNKNOWN for data in known)
    return one, other


class Placement(NamedTuple):
    """An output that is complete, and goes to a place."""

    temporary: Temporary | None  # without one the file at the place is removed
    # makes a context that turns an `OSError` into an error that names the output
    explained: Callable[[], AbstractContextManager[None]]
    check: Callable[[], None] | None = None  # raises if what is there must stay


class Commit:
    """Outputs that are being written and will take their places together."""

    def __init__(self) -> None:
        self.placements: dict[str, Placement] = {}
        """What is complete, by its place, links followed."""
        self._names: list[str] = []  # of temporaries
        self._descriptors: list[int] = []
        self._asides: dict[str, str] = {}

    def make(self, target: str | os.PathLike[str], make: Callable[[str], int], *, ending: str = ".tmp") -> Temporary:
        """Make a temporary file or folder beside a place, and lock it."""
        folder, tag = os.path.dirname(target) or ".", _TAG.get()
        if (folder, tag.partition("-")[0]) not in _SEEN:
            _SEEN.add((folder, tag.partition("-")[0]))
            remove_left([folder])
        host = "".join(_host()) + "-"
        if fcntl is None or host == f"{_UNKNOWN}{_UNKNOWN}-":
            host = ""
        while True:
            path = os.path.join(folder, f".vorotool-{host}{tag}{os.urandom(8).hex()}{ending}")
            self._names.append(path)
            made = Temporary(path, make(path))
            if made.descriptor >= 0:
                self._descriptors.append(made.descriptor)
            if not host:
                return made
            try:
                if made.descriptor >= 0:
                    fcntl.flock(made.descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
                    if made.is_at(path):
                        return made
            except BlockingIOError:  # whoever takes it for that of a dead process removes it
                continue
            except OSError:  # no such locks here
                host = ""

    def close(self) -> None:
        """Remove what is left of temporaries, and give the locks back."""
        for path in self._names:  # 64 random bits are nobody else's, so that whatever has such a name is ours
            if os.path.lexists(path):
                _discard(path)
        while self._descriptors:
            os.close(self._descriptors.pop())

    def run(self) -> None:
        """Put all outputs in their places; on any exception put back what was there."""
        for each in self.placements.values():
            if each.check is not None:
                with each.explained():
                    each.check()
        if len(self.placements) == 1:  # in one step, where the system has one
            ((target, (temporary, explained, _)),) = self.placements.items()
            if temporary is not None and not (os.path.isdir(target) and os.path.isdir(temporary.path)):
                with explained():
                    os.replace(temporary.path, target)
                return
            if temporary is not None and _exchange(temporary.path, target):
                return
        begun: list[str] = []
        try:
            for target, each in self.placements.items():
                begun.append(target)
                with each.explained():
                    self._put(target, each.temporary)
        except BaseException:
            _insist(lambda: self._undo(begun))
            raise
        _insist(self._forget)

    def _put(self, target: str, temporary: Temporary | None) -> None:
        """Set aside what is at a place, and put an output there."""
        is_folder = temporary is not None and os.path.isdir(temporary.path)
        # a folder goes for a folder only
        if os.path.lexists(target) and (is_folder or not os.path.isdir(target)):
            kept = os.path.join(self._aside(os.path.dirname(target)), os.path.basename(target))
            if not os.path.lexists(kept):
                _set_aside(target, kept, by_link=temporary is not None and not os.path.isdir(target))
        if temporary is not None:
            os.replace(temporary.path, target)

    def _aside(self, folder: str) -> str:
        """Return a folder for what is set aside of another; a killed process's is emptied by the next one there."""
        if folder not in self._asides:
            self._asides[folder] = self.make(os.path.join(folder, "aside"), new_folder, ending=ASIDE).path
        return self._asides[folder]

    def _undo(self, begun: Sequence[str]) -> None:
        """Put back what was there, the last first; what fails does not keep others from it."""
        for target in reversed(begun):
            with suppress(OSError):
                folder, name = os.path.split(target)
                kept = os.path.join(self._asides.get(folder, os.devnull), name)
                temporary = self.placements[target].temporary
                is_ours = temporary is not None and temporary.is_at(target)
                if is_ours and (os.path.isdir(target) or not os.path.lexists(kept)):
                    remove(target)
                if os.path.lexists(kept):
                    os.replace(kept, target)

    def _forget(self) -> None:
        """Remove what was set aside, so that none of it is put back."""
        for folder in self._asides.values():
            for name in os.listdir(folder):
                remove(os.path.join(folder, name))


_CURRENT: ContextVar[Commit | None] = ContextVar("commit", default=None)


@contextmanager
def committed_together() -> Iterator[Commit]:
    """Put all outputs that are written within in their places at the end, or none on an exception."""
    current = _CURRENT.get()
    if current is not None:
        yield current
        return
    commit = Commit()
    try:
        _CURRENT.set(commit)
        try:
            yield commit
        finally:
            _CURRENT.set(None)
        commit.run()
    finally:
        _insist(commit.close)


def _set_aside(target: str, kept: str, *, by_link: bool) -> None:
    """Move a file or folder, or link a file so that it is never away."""
    if by_link:
        with suppress(OSError):  # a file system without hard links, or somebody else's file
            os.link(target, kept)
            return
    os.rename(target, kept)


def _exchange(one: str, other: str) -> bool:
    """Exchange two folders at once, or return False where the system or the file system cannot."""
    if sys.platform != "linux":
        return False
    import ctypes

    here, exchange = -100, 2  # AT_FDCWD, RENAME_EXCHANGE
    try:
        rename = ctypes.CDLL(None).renameat2
    except (OSError, AttributeError):
        return False
    return bool(rename(here, os.fsencode(one), here, os.fsencode(other), exchange) == 0)


def _insist(act: Callable[[], None]) -> None:
    """Do something that can be done again; an interrupt that comes meanwhile has to wait."""
    try:
        act()
    except BaseException:
        act()
        raise
