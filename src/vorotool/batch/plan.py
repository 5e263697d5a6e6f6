"""The plan of a batch: the outputs of each input, checked before anything is written."""

from __future__ import annotations

import os
import stat
import sys
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path, PurePath

from vorotool.batch.inputs import RECORD_ENDING, Input
from vorotool.batch.pages import path_of
from vorotool.batch.tasks import Task
from vorotool.errors import OutputError, UsageError
from vorotool.formats.io.descriptors import STANDARD, descriptor_of
from vorotool.formats.io.layer_names import file_of
from vorotool.formats.io.sources import without_gz

_NOWHERE = (-1, -1)


def output_paths(name: str, endings: Sequence[str], folder: str | os.PathLike[str]) -> tuple[str, ...]:
    """Paths of the outputs of an input."""
    stem = Path(folder) / PurePath(without_gz(os.path.normpath(name))).with_suffix("")
    return tuple(f"{stem}{ending}" for ending in endings)


def check_outputs(
    tasks: Sequence[Task],
    folder: str | os.PathLike[str],
    *,
    others: Mapping[str, str | None] | None = None,
    read: Mapping[str, str] | None = None,
) -> None:
    """Refuse outputs that would replace an input or one another, or lie outside their folder."""
    written = {option: path for option, path in (others or {}).items() if path is not None and not _is_open(path)}
    _check_collisions(tasks, folder, written)
    _check_inputs(tasks, written, read or {})
    _check_records(folder, written)
    check_inside((path for task in tasks for path in task.outputs), folder)


def _is_open(path: str) -> bool:
    """Whether it is open already, so that it is gone on with and never replaced."""
    return path == STANDARD or descriptor_of(path) is not None


def _check_collisions(tasks: Sequence[Task], folder: str | os.PathLike[str], others: Mapping[str, str]) -> None:
    owner: dict[str, str] = {}
    for task in tasks:
        for path in task.outputs:
            key = _comparable(path)
            if owner.get(key) == task.source:
                raise UsageError(f"{task.source} is given twice: leave one out")
            if key in owner:
                raise UsageError(
                    f"{owner[key]} and {task.source} would both be written to {path}: rename one, "
                    "or name the folder above both, whose folders are mirrored"
                )
            owner[key] = task.source
    for option, path in others.items():
        key = _comparable(str(Path(folder) / os.path.relpath(path, folder or ".")))
        if key in owner:
            raise UsageError(f"{option} {path} is also the output of {owner[key]}: choose another name")


def _comparable(path: str) -> str:
    """A path as it is compared: the usual file systems of macOS take A and a for the same."""
    return path.casefold() if sys.platform == "darwin" else path


def _check_inputs(tasks: Sequence[Task], others: Mapping[str, str], read: Mapping[str, str]) -> None:
    """An output that is there already may be what is read, by a link or by the same name."""
    sources = {_identity(path): f"file of {option}, {path}" for option, path in read.items()}
    sources |= {_identity(path_of(task.source)): f"input {path_of(task.source)}" for task in tasks}
    sources.pop(_NOWHERE, None)
    for path in (path for task in tasks for path in task.outputs):
        if (source := sources.get(_identity(path))) is not None:
            raise UsageError(f"{path} is also the {source}, which is never replaced: choose another --out-dir")
    for option, path in others.items():
        if (source := sources.get(_identity(path))) is not None:
            raise UsageError(f"{option} {path} is also the {source}, which is never replaced: choose another name")


def _check_records(folder: str | os.PathLike[str], others: Mapping[str, str]) -> None:
    """The records of batches in the folder are not written over: `--resume` reads them."""
    for option, path in others.items():
        place = Path(os.path.realpath(path))
        if place.name.endswith(RECORD_ENDING) and folder and place.parent == Path(os.path.realpath(folder)):
            raise UsageError(f"{option} {path} is the name of a record that --resume reads: choose another name")


def _identity(path: str) -> tuple[int, int]:
    """The identity of a file in the file system; nothing for one that is not there, or that is a stream."""
    try:
        found = Path(file_of(path)).stat()
    except (OSError, ValueError):
        return _NOWHERE
    is_held = stat.S_ISREG(found.st_mode) or stat.S_ISDIR(found.st_mode)
    return (found.st_dev, found.st_ino) if is_held else _NOWHERE


def check_inside(paths: Iterable[str | os.PathLike[str]], folder: str | os.PathLike[str]) -> None:
    """Refuse files that would be written outside a folder, through links in it."""
    inside, known = Path(os.path.realpath(folder)), set[Path]()
    for path in map(Path, paths):
        place = path if path.is_symlink() else path.parent
        if place not in known and not Path(os.path.realpath(place)).is_relative_to(inside):
            raise OutputError(f"{path} would lie outside {inside}, through a link: remove the link")
        known.add(place)


def share(inputs: Iterable[Input], part: int, parts: int) -> list[Input]:
    """Return one part of the inputs: every `parts`-th in the order of their names, beginning with number `part`."""
    inputs = list(inputs)
    ranked = sorted(range(len(inputs)), key=lambda i: (PurePath(inputs[i].name).as_posix(), inputs[i].source))
    return [inputs[i] for i in sorted(ranked[part - 1 :: parts])]
