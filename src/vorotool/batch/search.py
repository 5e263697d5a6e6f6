"""The search for inputs in folders and by patterns; links to folders are followed only on request, never in circles."""

from __future__ import annotations

import fnmatch
import glob
import os
from collections import deque
from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from vorotool.errors import InputError
from vorotool.formats.io.descriptors import stream_kind
from vorotool.formats.zarr.store import is_folder, is_store
from vorotool.plain import plain

MOST_NAMED = 10
"""Names that a note lists."""


@dataclass
class LeftOut:
    """Names that a search found and left out."""

    streams: list[str] = field(default_factory=list)  # pipes, sockets and devices, each with its kind
    links: list[str] = field(default_factory=list)  # links to folders that were not followed
    unknown: list[str] = field(default_factory=list)  # files in folders that are not in a format that is read

    def notes(self) -> list[str]:
        """Return a line for each kind, with a count and the first names."""
        said = [f"{stream}: left out" for stream in self.streams]
        links = set(self.links)
        if count := len(links):
            kind = "link to a folder" if count == 1 else "links to folders"
            said.append(f"{count} {kind} not followed (use --follow): {_listed(links)}")
        if count := len(self.unknown):
            kind = "file" if count == 1 else "files"
            said.append(f"{count} {kind} left out, not in a format that is read here: {_listed(self.unknown)}")
        return said

    def reasons(self) -> str:
        """Return the notes as a part of a message that nothing was found."""
        return "".join(f"; {note}" for note in self.notes())

    def files(self, paths: Iterable[Path]) -> list[Path]:
        """Sort paths, and leave out streams."""
        found = []
        for path in sorted(set(paths)):
            kind = stream_kind(str(path))
            if kind is None:
                found.append(path)
            else:
                self.streams.append(f"{path} is {kind}")
        return found


def _listed(names: Collection[str]) -> str:
    more = f" and {len(names) - MOST_NAMED} more" if len(names) > MOST_NAMED else ""
    return ", ".join(sorted(names)[:MOST_NAMED]) + more


@plain
class Search:
    """A search of folders."""

    left_out: LeftOut  # takes links that are not followed
    follow: bool = False  # follow links to folders
    excluded: str | None = None  # the real path of a folder that is not searched

    def folders(self, root: Path) -> Iterator[tuple[Path, list[str]]]:
        """Yield a folder and those below it, each with the names of its files and Zarr stores."""

        def fail(error: OSError) -> None:
            raise InputError(f"the folder {error.filename} cannot be read: {error.strerror}; check who owns it")

        seen: set[str] = set()
        waiting = deque([root])
        while waiting:
            for name, folders, files in os.walk(waiting.popleft(), onerror=fail):
                place, here = Path(name), os.path.realpath(name)
                if here in seen or (here == self.excluded and place != root):
                    folders.clear()
                    continue
                seen.add(here)
                inner = [place / each for each in sorted(folders) if not each.startswith(".")]
                stores = [path for path in inner if is_store(path)]
                links = [path for path in inner if path.is_symlink() and path not in stores]
                folders[:] = [path.name for path in inner if path not in stores and path not in links]
                if self.follow:
                    waiting.extend(links)
                else:
                    self.left_out.links.extend(map(str, links))
                yield place, [*files, *(path.name for path in stores)]

    def matches(self, pattern: str) -> Iterator[Path]:
        """Yield the paths that match a pattern of ``*``, ``?``, ``[...]`` and ``**``, which stands for any folders."""
        seen: set[tuple[str, str]] = set()
        for path in self._below(Path(), Path(pattern).parts):
            identity = os.path.realpath(path.parent), path.name
            if identity not in seen:
                seen.add(identity)
                yield path

    def _below(self, base: Path, parts: Sequence[str]) -> Iterator[Path]:
        if not parts:
            yield base
            return
        part, rest = parts[0], parts[1:]
        if part == "**":
            for place, names in self.folders(base):
                shown = [place / name for name in names if not name.startswith(".")]
                yield from self._below(place, rest) if rest else shown
        elif not glob.has_magic(part):
            path = base / part
            if os.path.lexists(path):
                yield from self._below(path, rest)
        else:
            for path in _paths_in(base):
                is_shown = part.startswith(".") or not path.name.startswith(".")
                if is_shown and fnmatch.fnmatch(path.name, part) and (not rest or self._enters(path)):
                    yield from self._below(path, rest)

    def _enters(self, path: Path) -> bool:
        """Whether a match is searched further: a link to a folder only on request, and not to a folder above it."""
        if not is_folder(path) or not path.is_symlink():
            return is_folder(path)
        if not self.follow:
            self.left_out.links.append(str(path))
            return False
        return os.path.realpath(path) not in map(os.path.realpath, path.parents)


def _paths_in(folder: Path) -> list[Path]:
    """Return sorted paths, none of what is no folder or cannot be read."""
    try:
        return sorted(folder.iterdir())
    except OSError:
        return []
