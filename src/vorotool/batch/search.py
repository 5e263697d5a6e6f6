"""The search for inputs in folders and by patterns; links to folders are followed only on request, never in circles."""

from __future__ import annotations

import fnmatch
import glob
import os
from collections import deque
from collections.abc import Collection, Iterator
from pathlib import Path

from vorotool.errors import InputError
from vorotool.formats.io.descriptors import stream_kind
from vorotool.jobs.inputs import is_searched

MOST_NAMED = 10
"""Names that a note lists."""

ANY = "**"
"""The part of a pattern that stands for any folders, or none."""


class Search:
    """A search of folders, which knows what it left out."""

    def __init__(self, *, follow: bool = False, excluded: str | os.PathLike[str] | None = None) -> None:
        self._follow = follow  # links to folders
        self._excluded = None if excluded is None else os.path.realpath(excluded)
        self._streams: list[str] = []  # pipes, sockets and devices, each with its kind
        self._links: set[str] = set()  # links to folders that were not followed
        self.unknown: list[str] = []  # files in folders that are not in a format that is read

    def notes(self) -> list[str]:
        """Return a line for each kind that was left out, with a count and the first names."""
        lines = [f"{stream}: left out" for stream in self._streams]
        if count := len(self._links):
            kind = "link to a folder" if count == 1 else "links to folders"
            lines.append(f"{count} {kind} not followed (use --follow): {_listed(self._links)}")
        if count := len(self.unknown):
            kind = "file" if count == 1 else "files"
            lines.append(f"{count} {kind} left out, not in a format that is read here: {_listed(self.unknown)}")
        return lines

    def reasons(self) -> str:
        """Return the notes as a part of a message that nothing was found."""
        return "".join(f"; {note}" for note in self.notes())

    def files(self, paths: Collection[Path]) -> list[Path]:
        """Sort paths and leave out streams."""
        kinds = {path: stream_kind(str(path)) for path in sorted(paths)}
        self._streams += [f"{path} is {kind}" for path, kind in kinds.items() if kind is not None]
        return [path for path, kind in kinds.items() if kind is None]

    def matches(self, root: Path, parts: tuple[str, ...]) -> Iterator[Path]:
        """Yield the files and Zarr stores below a folder that match a pattern, once each."""
        waiting, seen = deque([(root, parts)]), set[tuple[str, tuple[str, ...]]]()
        while waiting:
            folder, (part, *rest) = waiting.popleft()
            inner = (ANY, *rest) if part == ANY else tuple(rest)
            here = os.path.realpath(folder)
            if (here, (part, *rest)) in seen or (part == ANY and here == self._excluded and folder != root):
                continue
            seen.add((here, (part, *rest)))
            if part == ANY:
                waiting.appendleft((folder, tuple(rest) or ("*",)))
            for path in _entries(folder, part):
                if not is_searched(path):
                    if not inner:
                        yield path
                elif inner and not (path.is_symlink() and glob.has_magic(part)):
                    waiting.appendleft((path, inner))
                elif inner and self._follow:
                    waiting.append((path, inner))  # after the folders themselves, whose names are the better ones
                elif inner:
                    self._links.add(str(path))


def _entries(folder: Path, part: str) -> list[Path]:
    """Return what a part of a pattern matches in a folder."""
    if not glob.has_magic(part):
        return [folder / part] if os.path.lexists(folder / part) else []
    try:
        names = os.listdir(folder)  # noqa: PTH208, since a path for each name takes time
    except OSError as error:
        if part == ANY and is_searched(folder):
            raise InputError(f"the folder {folder} cannot be read: {error.strerror}; check who owns it") from None
        return []
    shown = [name for name in names if part.startswith(".") or not name.startswith(".")]
    return [folder / name for name in (shown if part == ANY else fnmatch.filter(shown, part))]


def _listed(names: Collection[str]) -> str:
    more = f" and {len(names) - MOST_NAMED} more" if len(names) > MOST_NAMED else ""
    return ", ".join(sorted(names)[:MOST_NAMED]) + more
