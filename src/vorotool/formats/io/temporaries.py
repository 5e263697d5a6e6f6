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
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import BinaryIO
from zlib import crc32

from vorotool.plain import plain, scoped

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


@dataclass
class Temporary:
    """A file or folder that is being written, and is ours."""

    path: Path  # its name for now
    descriptor: int  # holds the lock; -1 where there are no locks

    def opened(self) -> BinaryIO:
        """Open a file for writing; closing this does not give the lock back."""
        if sys.platform != "win32":
            return os.fdopen(os.dup(self.descriptor), "w+b")
        descriptor, self.descriptor = self.descriptor, -1  # there a file that is open cannot be renamed
        return os.fdopen(descriptor, "w+b")

    def check(self) -> None:
        """Raise an `OSError` if it is not there any more: somebody has removed it, or the folder."""
        if self.descriptor >= 0 and not _is_at(self.path, self.descriptor):
            raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), os.fspath(self.path))

    def is_at(self, path: Path) -> bool:
        """Return whether it has a name by now."""
        return _is_at(path, self.descriptor) if self.descriptor >= 0 else not os.path.lexists(self.path)

    def move_to(self, target: Path) -> None:
        """Give it its final name, in the place of an older file."""
        self.check()
        self.path.replace(target)


class Temporaries:
    """Temporary files and folders, whose rest is removed at the end, whatever happens."""

    def __init__(self) -> None:
        self._names: list[Path] = []
        self._made: list[Temporary] = []

    def make(self, target: Path, make: Callable[[Path], int], *, ending: str = ".tmp") -> Temporary:
        """Make one beside a place."""
        _remove_dead_once(target.parent)
        temporary = Temporary(target, _make_ours(target.parent, make, ending, self._names))
        temporary.path = self._names[-1]
        self._made.append(temporary)
        return temporary

    def __enter__(self) -> Temporaries:
        """Make some."""
        return self

    def __exit__(self, *_: object) -> None:
        """Remove what is left of them, and give the locks back."""
        try:
            _discard_ours(self._names)
        finally:
            for each in self._made:
                if each.descriptor >= 0:
                    os.close(each.descriptor)


@contextmanager
def temporary_beside(target: Path, make: Callable[[Path], int], *, ending: str = ".tmp") -> Iterator[Temporary]:
    """Make a temporary file or folder, and remove what is left of it at the end, whatever happens."""
    with Temporaries() as temporaries:
        yield temporaries.make(target, make, ending=ending)


def new_file(path: Path) -> int:
    """Make an empty file with the permissions of the umask; its descriptor."""
    return os.open(path, os.O_RDWR | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0), 0o666)


def new_folder(path: Path) -> int:
    """Make an empty folder; its descriptor, or -1 where folders cannot be opened, or it is gone already."""
    path.mkdir()
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


def remove(path: Path) -> None:
    """Remove a file or a folder with all that is in it, as far as it is there and can be removed."""
    if path.is_dir() and not path.is_symlink():
        import shutil  # it brings compressors

        shutil.rmtree(path, ignore_errors=True)
    else:
        with suppress(OSError):
            path.unlink()


_SEEN: set[tuple[str, str]] = set()
"""Folders, with tags of batches, from which this process has removed what the dead have left."""


def _remove_dead_once(folder: Path) -> None:
    key = (os.fspath(folder), _TAG.get().partition("-")[0])
    if key not in _SEEN:
        _SEEN.add(key)
        remove_dead(folder)


def _discard_ours(names: Sequence[Path]) -> None:
    """Remove what is left under names: 64 random bits are nobody else's, so that whatever happens they are ours."""

    def discard() -> None:
        for path in names:
            _discard(path)

    _insist(discard)


def _make_ours(folder: Path, make: Callable[[Path], int], ending: str, names: list[Path]) -> int:
    """Make a temporary, the last of the names, and lock it."""
    host = "".join(_host()) + "-"
    if fcntl is None or host == f"{_UNKNOWN}{_UNKNOWN}-":
        host = ""
    while True:
        names.append(folder / f".vorotool-{host}{_TAG.get()}{os.urandom(8).hex()}{ending}")
        descriptor = make(names[-1])
        if not host:
            return descriptor
        if descriptor < 0:
            continue
        try:
            if _lock(descriptor) and _is_at(names[-1], descriptor):
                return descriptor
        except OSError:  # no such locks here
            host = ""
        os.close(descriptor)


def _lock(descriptor: int) -> bool:
    """Take the lock, or say that somebody else has it."""
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True


def _is_at(path: Path, descriptor: int) -> bool:
    try:
        return os.path.samestat(path.lstat(), os.fstat(descriptor))
    except FileNotFoundError:
        return False


def _temporaries(folder: str | os.PathLike[str]) -> list[tuple[Path, re.Match[str]]]:
    """Temporaries in a folder and the parts of their names; none if it cannot be listed."""
    with suppress(OSError), os.scandir(folder) as entries:
        names = [entry.name for entry in entries if entry.name.startswith(".vorotool-")]
        return [(Path(folder) / name, found) for name in names if (found := re.fullmatch(_NAME, name))]
    return []


def _remove_unless_held(path: Path) -> None:
    """Remove a temporary of this machine if its lock can be taken, which is held meanwhile."""
    if fcntl is None:
        return
    with suppress(OSError):
        kind = path.lstat().st_mode
        if not (stat.S_ISREG(kind) or stat.S_ISDIR(kind)):
            return
        access = os.O_RDONLY | os.O_DIRECTORY if stat.S_ISDIR(kind) else os.O_RDWR  # which network locks ask for
        descriptor = os.open(path, access | os.O_NOFOLLOW | os.O_NONBLOCK)
        try:
            if _lock(descriptor) and _is_at(path, descriptor):
                _discard(path)
        finally:
            os.close(descriptor)


def _discard(path: Path) -> None:
    """Remove a temporary; what was moved aside goes back where nothing has taken its place."""
    if path.suffix == ASIDE:
        try:
            for each in path.iterdir():
                if not os.path.lexists(path.with_name(each.name)):
                    each.rename(path.with_name(each.name))
        except OSError:  # what is in it may be all that there is
            return
    remove(path)


@cache
def _host() -> tuple[str, str]:
    """Digests of this boot of the system and of this machine, as far as they can be known."""
    boot, machine = (_text(Path(name)) for name in ("/proc/sys/kernel/random/boot_id", "/etc/machine-id"))
    if not machine and sys.platform == "darwin":
        import uuid

        machine = f"{uuid.getnode():x}"
    name = os.uname().nodename if hasattr(os, "uname") else ""  # which tells machines with copied disks apart
    return _digest(boot), _digest(machine and f"{machine} {name}")


def _digest(text: str) -> str:
    """Return 48 bits of a text; hashlib would bring OpenSSL, at the start of every run."""
    data = text.encode()
    return f"{crc32(data):08x}{crc32(data[::-1]) & 0xFFFF:04x}" if text else _UNKNOWN


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8", errors="replace").strip()
    except OSError:
        return ""


@plain
class Placement:
    """An output that is complete, and the place where it goes."""

    target: Path  # the place, links followed
    temporary: Temporary | None  # the output; without one the file at the place is removed
    check: Callable[[], None]  # raises if what is there must stay
    # makes a context that turns an `OSError` into an error that names the output
    explained: Callable[[], AbstractContextManager[None]]


@dataclass
class Commit:
    """Outputs that are being written and will take their places together."""

    temporaries: Temporaries  # makes what is written, and removes it at the end
    _placements: list[Placement] = field(default_factory=list)
    _asides: dict[Path, Path] = field(default_factory=dict)

    def add(self, placement: Placement) -> None:
        """Put an output in its place when all others are complete, too; a later one goes there instead."""
        self._placements = [each for each in self._placements if each.target != placement.target]
        self._placements.append(placement)

    def pending(self, target: Path) -> Path | None:
        """Return the file that will take a place, if one is complete."""
        found = (each.temporary for each in self._placements if each.target == target)
        return next((each.path for each in found if each is not None), None)

    def run(self) -> None:
        """Put all outputs in their places; on any exception put back what was there."""
        for each in self._placements:
            with each.explained():
                each.check()
                if each.temporary is not None:
                    each.temporary.check()
        if len(self._placements) == 1 and _put_at_once(self._placements[0]):
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
        if _may_be_set_aside(target, temporary):
            kept = self._aside(target.parent) / target.name
            if not os.path.lexists(kept):
                _set_aside(target, kept, by_link=temporary is not None and not target.is_dir())
        if temporary is not None:
            temporary.move_to(target)

    def _aside(self, folder: Path) -> Path:
        """Return a folder for what is set aside of another; a killed process's is emptied by the next one there."""
        if folder not in self._asides:
            self._asides[folder] = self.temporaries.make(folder / "aside", new_folder, ending=ASIDE).path
        return self._asides[folder]

    def _undo(self, begun: Sequence[Placement]) -> None:
        """Put back what was there, the last first; what fails does not keep others from it."""
        for each in reversed(begun):
            with suppress(OSError):
                kept = self._asides.get(each.target.parent, Path(os.devnull)) / each.target.name
                is_ours = each.temporary is not None and each.temporary.is_at(each.target)
                if is_ours and (each.target.is_dir() or not os.path.lexists(kept)):
                    remove(each.target)
                if os.path.lexists(kept):
                    kept.replace(each.target)

    def _forget(self) -> None:
        """Remove what was set aside, so that none of it is put back."""
        for folder in self._asides.values():
            for kept in folder.iterdir():
                remove(kept)


_CURRENT: ContextVar[Commit | None] = ContextVar("commit", default=None)


@contextmanager
def committed_together() -> Iterator[Commit]:
    """Put all outputs that are written within in their places at the end, or none on an exception."""
    current = _CURRENT.get()
    if current is not None:
        yield current
        return
    with Temporaries() as temporaries:
        commit = Commit(temporaries)
        _CURRENT.set(commit)
        try:
            yield commit
        finally:
            _CURRENT.set(None)
        commit.run()


def _put_at_once(placement: Placement) -> bool:
    """Put an output in its place in one step, or return False where the system has none."""
    target, temporary = placement.target, placement.temporary
    if temporary is None or (target.is_dir() and _is_folder(temporary)):
        return temporary is not None and _exchange(temporary.path, target)
    with placement.explained():
        temporary.move_to(target)
    return True


def _may_be_set_aside(target: Path, temporary: Temporary | None) -> bool:
    """Return whether what is at a place may go: a folder goes for a folder only."""
    return os.path.lexists(target) and (_is_folder(temporary) or not target.is_dir())


def _is_folder(temporary: Temporary | None) -> bool:
    return temporary is not None and temporary.path.is_dir()


def _set_aside(target: Path, kept: Path, *, by_link: bool) -> None:
    """Move a file or folder, or link a file so that it is never away."""
    if by_link:
        with suppress(OSError):  # a file system without hard links, or somebody else's file
            kept.hardlink_to(target)
            return
    target.rename(kept)


def _exchange(one: Path, other: Path) -> bool:
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
