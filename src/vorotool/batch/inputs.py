"""The inputs of a batch: files, the contents of folders, matches of patterns, lists of names, pages of stacks."""

from __future__ import annotations

import fnmatch
import glob
import os
import re
import zlib
from collections import deque
from collections.abc import Callable, Collection, Iterable, Iterator
from pathlib import Path

from vorotool.batch.records import RECORD_ENDING
from vorotool.errors import InputError, UsageError
from vorotool.formats.io.descriptors import STANDARD, stream_kind
from vorotool.formats.io.sources import GZIP, file_of, output_name, without_gz
from vorotool.frozen import frozen
from vorotool.jobs.inputs import is_pattern, is_searched

MOST_NAMED = 10
"""Names that a note lists."""

ANY = "**"
"""The part of a pattern that stands for any folders, or none."""

HEAD = 2**16
"""Bytes of a text by which data and prose are told apart."""
_NUMBER = re.compile(rb"(?<![\w.])[-+]?(?:\d++(?:\.\d*+)?|\.\d++)(?:[eE][-+]?\d+)?(?![\w.])")


@frozen
class Input:
    """One input of a batch."""

    source: str  # what messages and tables call it: its path, beginning as the user wrote it, or a page of it
    name: str  # what its outputs are named after: the path below the folder that was named, or the name of a file
    path: str = ""  # the file, where `source` is more than that
    page: int | None = None


def pages_of(inputs: Iterable[Input]) -> list[Input]:
    """Return each page of the images among inputs as an input, whose outputs are named after it: ``stack-p003``."""
    from vorotool.formats.images.image_header import page_count

    pages: list[Input] = []
    for each in inputs:
        count = page_count(file_of(each.source))
        if count is None:
            pages.append(each)
            continue
        name, digits = Path(without_gz(each.name)), max(3, len(str(count - 1)))
        for page in range(count):
            page_name = str(name.with_stem(f"{name.stem}-p{page:0{digits}}"))
            pages.append(Input(f"{each.source}, page {page}", page_name, each.source, page))
    return pages


def expand_inputs(
    names: Iterable[str],
    *,
    extensions: Collection[str],
    without: str | os.PathLike[str] | None = None,
    follow: bool = False,
    note: Callable[[str], None] = lambda _: None,
) -> list[Input]:
    """Find the inputs that names stand for, in the order of the names, those of one name sorted."""
    inputs: list[Input] = []
    search = Search(follow=follow, excluded=without)
    for name in names:
        if is_pattern(name):
            inputs += _matching(name, search)
        elif name and is_searched(name):
            inputs += _inside(name, frozenset(extensions), search)
        else:
            _check_file(name)
            inputs.append(Input(name, output_name(name)))
    for text in search.notes():
        note(text)
    return inputs


def _check_file(name: str) -> None:
    """Refuse what is not a file that any process can read."""
    if not name:
        raise UsageError("the name of an input is empty: name a file, or a folder")
    if name == STANDARD:
        raise UsageError("- is standard input, a single input: name files, or give their list to --files-from")
    if (kind := stream_kind(file_of(name))) is not None:
        raise UsageError(
            f"{name} is {kind}, which only this process can read: give it as the only input with -o, or save its data "
            "to a file first"
        )


def read_names(path: str, *, null: bool = False) -> list[str]:
    """Read a list of names, one a line, or each ended by a NUL byte; empty ones are left out."""
    from vorotool.formats.io.sources import read_bytes

    try:
        data = read_bytes(path)
    except (OSError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        reason = getattr(error, "strerror", None) or error
        raise InputError(f"the list {path or repr(path)} cannot be read: {reason}; check its name") from None
    names = data.split(b"\0") if null else [line.removesuffix(b"\r") for line in data.split(b"\n")]
    if not null and b"\0" in data:
        raise InputError(f"the list {path} holds NUL bytes: if names end with them, give -0, too")
    if null and b"\0" not in data and b"\n" in data:
        raise InputError(
            f"the list {path} holds no NUL bytes, which end names with -0: leave -0 out if each line is a name"
        )
    return [os.fsdecode(name) for name in names if name]


def _matching(pattern: str, search: Search) -> list[Input]:
    """Return the files that match, named below the folder that the pattern begins with."""
    parts = Path(pattern).parts
    fixed = next(i for i, part in enumerate(parts) if glob.has_magic(part))
    root = Path(*parts[:fixed])
    files = search.files({*search.matches(root, parts[fixed:])})
    if not files:
        raise InputError(
            f"no file matches {pattern}{search.reasons()}; check the pattern, or name a folder for what is in it"
        )
    return [Input(str(file), str(file.relative_to(root))) for file in files]


def _inside(folder: str, extensions: frozenset[str], search: Search) -> list[Input]:
    """Return the files in a folder that are in a format that is read; companions of these are not worth a note."""
    _refuse_geodatabase(folder)
    paths = [path for path in search.matches(Path(folder), (ANY,)) if not path.name.endswith(RECORD_ENDING)]
    known = {path for path in paths if _is_known(path, extensions)}
    stems = {(path.parent, path.name.partition(".")[0]) for path in known}
    unknown = (path for path in paths if path not in known)
    search.unknown += [str(path) for path in unknown if (path.parent, path.name.partition(".")[0]) not in stems]
    files = search.files(known)
    if not files:
        raise InputError(
            f"{folder} holds no file in a supported format ({', '.join(sorted(extensions))}){search.reasons()}; for "
            f"others use a pattern, {folder}/*"
        )
    return [Input(str(file), str(file.relative_to(folder))) for file in files]


def _is_known(path: Path, extensions: frozenset[str]) -> bool:
    """Return whether a file is in a format that is read, by its extension; text must hold numbers or geometry, too."""
    extension = Path(without_gz(path.name)).suffix.lower().lstrip(".")
    return extension in extensions and (extension != "txt" or not path.is_file() or _is_data(path))


def _is_data(path: Path) -> bool:
    """Return whether text looks like points or geometry: a readme does not."""
    try:
        with path.open("rb") as file:
            head = file.read(HEAD)
        if head.startswith(GZIP):
            head = zlib.decompressobj(31).decompress(head, HEAD)
    except (OSError, zlib.error):  # whoever reads it says what is wrong
        return True
    if b"\0" in head:
        return False
    lines = [line for line in head.splitlines() if line.strip() and not line.lstrip().startswith(b"#")]
    rows = sum(len(_NUMBER.findall(line)) >= 2 for line in lines)
    return 2 * rows >= len(lines) or head.lstrip().startswith((b"{", b"["))


# ---- the search, in which links to folders are followed only on request, and never in circles --------------------
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
        lines = [f"{stream}: skipped" for stream in self._streams]
        if count := len(self._links):
            kind = "link to a folder" if count == 1 else "links to folders"
            lines.append(f"{count} {kind} not followed (use --follow): {_listed(self._links)}")
        if count := len(self.unknown):
            kind = "file" if count == 1 else "files"
            lines.append(f"{count} {kind} skipped, not in a supported format: {_listed(self.unknown)}")
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


def _refuse_geodatabase(folder: str) -> None:
    """Refuse a file geodatabase, which is a folder."""
    if Path(folder).suffix.lower() == ".gdb":
        target = Path(folder).with_suffix(".gpkg")
        raise InputError(f"{folder}: file geodatabases are not supported; convert it: ogr2ogr {target} {folder}")
