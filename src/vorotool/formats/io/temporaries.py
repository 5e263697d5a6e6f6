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

import errno
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


class Temporary:
    """A file or folder that is being written, and is ours."""

    def __init__(self, path: str, descriptor: int) -> None:
        self.path = path  # its name for now
        self.descriptor = descriptor  # holds the lock; -1 where there are no locks

    def opened(self) -> BinaryIO:
        """Open a file for writing; closing this does not give the lock back."""
        if sys.platform != "win32":
            return os.fdopen(os.dup(self.descriptor), "w+b")
        descriptor, self.descriptor = self.descriptor, -1  # there a file that is open cannot be renamed
        return os.fdopen(descriptor, "w+b")

    def check(self) -> None:
        """Raise an `OSError` if it is not there any more: somebody has removed it, or the folder."""
        if self.descriptor >= 0 and not _is_at(self.path, self.descriptor):
            raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), self.path)

    def is_at(self, path: str) -> bool:
        """Return whether it has a name by now."""
        return _is_at(path, self.descriptor) if self.descriptor >= 0 else not os.path.lexists(self.path)

    def move_to(self, target: str) -> None:
        """Give it its final name, in the place of an older file."""
        self.check()
        os.replace(self.path, target)


@contextmanager
def temporary_beside(
    target: str | os.PathLike[str], make: Callable[[str], int], *, ending: str = ".tmp"
) -> Iterator[Temporary]:
    """Make a temporary file or folder, and remove what is left of it at the end, whatever happens."""
    commit = Commit()
    try:
        yield commit.make(target, make, ending=ending)
    finally:
        commit.close()


def new_file(path: str, like: str = "") -> int:
    """Make an empty file with the permissions of another one, else those of the umask; its descriptor."""
    descriptor = os.open(path, os.O_RDWR | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0), 0o666)
    if like:
        with suppress(OSError):  # no older file, or a file system without permissions
            os.chmod(path, stat.S_IMODE(os.stat(like).st_mode))
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


def remove_tagged(folders: Iterable[str | os.PathLike[str]], tag: str) -> None:
    """Remove temporaries with a tag that nobody needs any more, of dead and living processes of all machines."""
    for folder in folders:
        for path, found in _temporaries(folder):
            if found[3].startswith(tag):
                _discard(path)


def remove_dead(folder: str | os.PathLike[str]) -> None:
    """Remove temporaries whose owners are proved dead; the folder is listed once."""
    boot, machine = _host()
    for path, found in _temporaries(folder):
        if (found[1] == boot != _UNKNOWN) or (found[2] == machine != _UNKNOWN):
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


def _lock(descriptor: int) -> bool:
    """Take the lock, or say that somebody else has it."""
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True


def _is_at(path: str, descriptor: int) -> bool:
    try:
        return os.path.samestat(os.lstat(path), os.fstat(descriptor))
    except FileNotFoundError:
        return False


def _temporaries(folder: str | os.PathLike[str]) -> list[tuple[str, re.Match[str]]]:
    """Temporaries in a folder and the parts of their names; none if it cannot be listed."""
    with suppress(OSError), os.scandir(folder) as entries:
        names = [entry.name for entry in entries if entry.name.startswith(".vorotool-")]
        return [(os.path.join(folder, name), found) for name in names if (found := re.fullmatch(_NAME, name))]
    return []


def _remove_unless_held(path: str) -> None:
    """Remove a temporary of this machine if its lock can be taken, which is held meanwhile."""
    if fcntl is None:
        return
    with suppress(OSError):
        kind = os.lstat(path).st_mode
        if not (stat.S_ISREG(kind) or stat.S_ISDIR(kind)):
            return
        access = os.O_RDONLY | os.O_DIRECTORY if stat.S_ISDIR(kind) else os.O_RDWR  # which network locks ask for
        descriptor = os.open(path, access | os.O_NOFOLLOW | os.O_NONBLOCK)
        try:
            if _lock(descriptor) and _is_at(path, descriptor):
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
    """An output that is complete, and the place where it goes."""

    target: str  # the place, links followed
    temporary: Temporary | None  # the output; without one the file at the place is removed
    # makes a context that turns an `OSError` into an error that names the output
    explained: Callable[[], AbstractContextManager[None]]
    check: Callable[[], None] | None = None  # raises if what is there must stay


class Commit:
    """Outputs that are being written and will take their places together."""

    def __init__(self) -> None:
        self._names: list[str] = []  # of temporaries
        self._made: list[Temporary] = []
        self._placements: list[Placement] = []
        self._asides: dict[str, str] = {}

    def make(self, target: str | os.PathLike[str], make: Callable[[str], int], *, ending: str = ".tmp") -> Temporary:
        """Make a temporary file or folder beside a place, and lock it."""
        folder, tag = os.path.dirname(target) or ".", _TAG.get()
        if (folder, tag.partition("-")[0]) not in _SEEN:
            _SEEN.add((folder, tag.partition("-")[0]))
            remove_dead(folder)
        host = "".join(_host()) + "-"
        if fcntl is None or host == f"{_UNKNOWN}{_UNKNOWN}-":
            host = ""
        while True:
            self._names.append(os.path.join(folder, f".vorotool-{host}{tag}{os.urandom(8).hex()}{ending}"))
            made = Temporary(self._names[-1], make(self._names[-1]))
            try:
                if not host or (made.descriptor >= 0 and _lock(made.descriptor) and _is_at(made.path, made.descriptor)):
                    self._made.append(made)
                    return made
            except OSError:  # no such locks here
                host = ""
            if made.descriptor >= 0:
                os.close(made.descriptor)

    def close(self) -> None:
        """Remove what is left of temporaries, whatever happens, and give the locks back."""
        try:
            _insist(self._discard_left)
        finally:
            for each in self._made:
                if each.descriptor >= 0:
                    os.close(each.descriptor)

    def _discard_left(self) -> None:
        """Remove what has such a name: 64 random bits are nobody else's, so that whatever has it is ours."""
        for path in self._names:
            if os.path.lexists(path):
                _discard(path)

    def add(self, placement: Placement) -> None:
        """Put an output in its place when all others are complete, too; a later one goes there instead."""
        self._placements = [each for each in self._placements if each.target != placement.target]
        self._placements.append(placement)

    def pending(self, target: str) -> str | None:
        """Return the file that will take a place, if one is complete."""
        found = (each.temporary for each in self._placements if each.target == target)
        return next((each.path for each in found if each is not None), None)

    def run(self) -> None:
        """Put all outputs in their places; on any exception put back what was there."""
        for each in self._placements:
            with each.explained():
                if each.check is not None:
                    each.check()
                if each.temporary is not None:
                    each.temporary.check()
        if len(self._placements) == 1:  # in one step, where the system has one
            target, temporary, explained, _ = self._placements[0]
            if temporary is not None and not (os.path.isdir(target) and _is_folder(temporary)):
                with explained():
                    temporary.move_to(target)
                return
            if temporary is not None and _exchange(temporary.path, target):
                return
        begun: list[Placement] = []
        try:
            for each in self._placements:
                begun.append(each)
                with each.explained():
                    self._put(each)
        except BaseException:
            _insist(lambda: self._undo(begun))
            raise
        _insist(self._forget)

    def _put(self, placement: Placement) -> None:
        """Set aside what is at a place, and put an output there."""
        target, temporary = placement.target, placement.temporary
        # a folder goes for a folder only
        if os.path.lexists(target) and (_is_folder(temporary) or not os.path.isdir(target)):
            kept = os.path.join(self._aside(os.path.dirname(target)), os.path.basename(target))
            if not os.path.lexists(kept):
                _set_aside(target, kept, by_link=temporary is not None and not os.path.isdir(target))
        if temporary is not None:
            temporary.move_to(target)

    def _aside(self, folder: str) -> str:
        """Return a folder for what is set aside of another; a killed process's is emptied by the next one there."""
        if folder not in self._asides:
            self._asides[folder] = self.make(os.path.join(folder, "aside"), new_folder, ending=ASIDE).path
        return self._asides[folder]

    def _undo(self, begun: Sequence[Placement]) -> None:
        """Put back what was there, the last first; what fails does not keep others from it."""
        for each in reversed(begun):
            with suppress(OSError):
                folder, name = os.path.split(each.target)
                kept = os.path.join(self._asides.get(folder, os.devnull), name)
                is_ours = each.temporary is not None and each.temporary.is_at(each.target)
                if is_ours and (os.path.isdir(each.target) or not os.path.lexists(kept)):
                    remove(each.target)
                if os.path.lexists(kept):
                    os.replace(kept, each.target)

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
        commit.close()


def _is_folder(temporary: Temporary | None) -> bool:
    return temporary is not None and os.path.isdir(temporary.path)


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
