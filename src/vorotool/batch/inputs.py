"""The inputs of a batch: names as they are given, what is in folders, what patterns match, lists of names."""

from __future__ import annotations

import glob
import os
import re
from collections.abc import Callable, Collection, Iterable
from pathlib import Path

from vorotool.batch.pages import PageName
from vorotool.batch.search import LeftOut, Search
from vorotool.errors import InputError, UsageError
from vorotool.formats.io.descriptors import stream_kind
from vorotool.formats.io.layer_names import file_of, output_name
from vorotool.jobs.inputs import is_pattern, is_searched
from vorotool.plain import plain

RECORD_ENDING = ".manifest.jsonl"
"""Of the names of manifests, which begin with that of the command."""

STANDARD_INPUT = "-"
HEAD = 2**16
"""Bytes of a text by which data and prose are told apart."""
_NUMBER = re.compile(rb"(?<![\w.])[-+]?(?:\d++(?:\.\d*+)?|\.\d++)(?:[eE][-+]?\d+)?(?![\w.])")


@plain
class Input:
    """One input of a batch."""

    source: str  # its path, beginning as the user wrote it
    name: str  # what its outputs are named after: the path below the folder that was given, or the name of a file


def pages_of(inputs: Iterable[Input]) -> list[Input]:
    """Give each page of the images among inputs as an input, whose outputs are named after it: ``stack-p003``."""
    from vorotool.formats.pages import page_count

    found: list[Input] = []
    for each in inputs:
        count = page_count(each.source)
        if count is None:
            found.append(each)
            continue
        name, digits = Path(each.name), max(3, len(str(count - 1)))
        found += [
            Input(PageName.of(each.source, page), str(name.with_stem(f"{name.stem}-p{page:0{digits}}")))
            for page in range(count)
        ]
    return found


def expand_inputs(
    names: Iterable[str],
    *,
    extensions: Collection[str],
    without: str | os.PathLike[str] | None = None,
    follow: bool = False,
    note: Callable[[str], None] | None = None,
) -> list[Input]:
    """Find the inputs that names stand for, in the order of the names, those of one name sorted."""
    found: list[Input] = []
    excluded = None if without is None else os.path.realpath(without)
    search = Search(LeftOut(), follow, excluded)
    for name in names:
        if is_pattern(name):
            found += _matching(name, search)
        elif name and is_searched(name):
            found += _inside(name, frozenset(extensions), search)
        else:
            _check_file(name)
            found.append(Input(name, output_name(name)))
    if note is not None:
        for text in search.left_out.notes():
            note(text)
    return found


def _check_file(name: str) -> None:
    if name == STANDARD_INPUT:
        raise UsageError("- is standard input, which is one input: name files, or give their list to --files-from")
    if (kind := stream_kind(file_of(name))) is not None:
        raise UsageError(
            f"{name} is {kind}, which this process alone can read: give it as the only input with -o, or write what "
            "comes through it to a file first"
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
        raise InputError(f"the list {path} holds NUL bytes: are names ended by them? then give -0, too")
    if null and b"\0" not in data and b"\n" in data:
        raise InputError(f"the list {path} holds no NUL bytes, by which -0 ends names: leave it out for names on lines")
    return [os.fsdecode(name) for name in names if name]


def _matching(pattern: str, search: Search) -> list[Input]:
    """Files that match, named below the folder that the pattern begins with."""
    parts = Path(pattern).parts
    fixed = Path(*parts[: next(i for i, part in enumerate(parts) if glob.has_magic(part))])
    files = search.left_out.files(path for path in search.matches(pattern) if not is_searched(path))
    if not files:
        raise InputError(
            f"no file matches {pattern}{search.left_out.reasons()}; check the pattern, or name a folder for what is in "
            "it"
        )
    return [Input(str(file), str(file.relative_to(fixed))) for file in files]


def _inside(folder: str, extensions: frozenset[str], search: Search) -> list[Input]:
    """Files in a folder that are in a format that is read; companions of these are not worth a note."""
    files: list[Path] = []
    others: list[Path] = []
    for place, names in search.folders(Path(folder)):
        for path in (place / name for name in names if not name.startswith(".") and not name.endswith(RECORD_ENDING)):
            (files if _is_known(path, extensions) else others).append(path)
    stems = {(path.parent, path.name.partition(".")[0]) for path in files}
    unknown = [path for path in others if (path.parent, path.name.partition(".")[0]) not in stems]
    search.left_out.unknown.extend(map(str, unknown))
    files = search.left_out.files(files)
    if not files:
        known = ", ".join(sorted(extensions))
        raise InputError(
            f"{folder} holds no file that is read here ({known}){search.left_out.reasons()}; for others use a pattern, "
            f"{folder}/*"
        )
    return [Input(str(file), str(file.relative_to(folder))) for file in files]


def _is_known(path: Path, extensions: frozenset[str]) -> bool:
    """Whether a file is in a format that is read, by its extension; text must hold numbers or geometry, too."""
    from vorotool.formats.io.sources import without_gz

    plain = Path(without_gz(path.name))
    extension = plain.suffix.lower().lstrip(".")
    is_plain_text = extension == "txt" and plain.name == path.name and path.is_file()
    return extension in extensions and (not is_plain_text or _is_data(path))


def _is_data(path: Path) -> bool:
    """Whether text looks like points or geometry: a readme does not."""
    try:
        with path.open("rb") as file:
            head = file.read(HEAD)
    except OSError:  # whoever reads it says what is wrong
        return True
    if b"\0" in head:
        return False
    lines = [line for line in head.splitlines() if line.strip() and not line.lstrip().startswith(b"#")]
    rows = sum(len(_NUMBER.findall(line)) >= 2 for line in lines)
    return 2 * rows >= len(lines) or head.lstrip().startswith((b"{", b"["))
