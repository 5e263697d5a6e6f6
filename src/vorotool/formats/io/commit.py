"""Outputs that belong together take their places together, or none of them does.

Each output is complete under a temporary name before the first takes its place. An older file is set aside by then, as
a link where the file system has such, and put back when a later output cannot take its place. Only a process that is
killed between two renames parts outputs; of a single output the rename is one step.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager, suppress
from contextvars import ContextVar
from dataclasses import dataclass, field
from pathlib import Path

from vorotool.formats.io.temporaries import ASIDE, Temporaries, Temporary, new_folder, remove
from vorotool.plain import plain


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
