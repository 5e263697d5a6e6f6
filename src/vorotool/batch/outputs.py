"""The outputs of a batch: named after the inputs, and checked before anything is written."""

from __future__ import annotations

import os
import stat
import sys
from collections.abc import Hashable, Iterable, Mapping, Sequence
from pathlib import Path, PurePath

from vorotool.batch.inputs import RECORD_ENDING
from vorotool.batch.tasks import Task
from vorotool.errors import OutputError, UsageError
from vorotool.formats.io.descriptors import STANDARD, descriptor_of, is_same_output
from vorotool.formats.io.layer_names import file_of
from vorotool.formats.io.sources import without_gz


def output_paths(name: str, endings: Sequence[str], folder: str | os.PathLike[str]) -> tuple[str, ...]:
    """Return the paths of the outputs of an input."""
    stem = Path(folder) / PurePath(without_gz(os.path.normpath(name))).with_suffix("")
    return tuple(f"{stem}{ending}" for ending in endings)


def check_outputs(
    tasks: Sequence[Task],
    folder: str | None,
    *,
    others: Mapping[str, str | None] | None = None,
    read: Mapping[str, str] | None = None,
) -> None:
    """Refuse outputs that would replace an input or one another, or lie outside their folder, if they have one.

    `others` are further files that are written, `read` files that are read with all inputs, by their options.
    """
    owners = _owners(tasks)
    options = {option: path for option, path in (others or {}).items() if path is not None}
    for option, path in options.items():
        before = list(options.items())[: list(options).index(option)]
        roles = [f"{each} {other}" for each, other in before if is_same_output(path, other)]
        if (owner := _owner(path, owners, folder)) is not None:
            roles.append(f"the output of {owner}")
        if roles:
            raise UsageError(f"{option} {path} is also {roles[0]}: choose another name")
    _check_inputs(tasks, options, read or {}, "name" if folder is None else "--out-dir")
    if folder is not None:
        _check_records(folder, options)
        check_inside((path for task in tasks for path in task.outputs), folder)


def _owners(tasks: Sequence[Task]) -> dict[str, str]:
    """Return the input of each output; no two inputs may have the same one."""
    owners: dict[str, str] = {}
    for task in tasks:
        for path in dict.fromkeys(task.outputs):  # results may be layers of one file
            owner = owners.get(_comparable(path))
            if owner == task.source:
                raise UsageError(f"{task.source} is given twice: leave one out")
            if owner is not None:
                raise UsageError(
                    f"{owner} and {task.source} would both be written to {path}: rename one, or name the folder above "
                    "both, whose folders are mirrored"
                )
            owners[_comparable(path)] = task.source
    return owners


def _owner(path: str, owners: Mapping[str, str], folder: str | None) -> str | None:
    """Return the input whose output has a path."""
    if folder is None:
        return next((source for each, source in owners.items() if is_same_output(path, each)), None)
    return owners.get(_comparable(str(Path(folder) / os.path.relpath(path, folder or "."))))


def _comparable(path: str) -> str:
    """Return a path as it is compared: the usual file systems of macOS take A and a for the same."""
    return path.casefold() if sys.platform == "darwin" else path


def _check_inputs(tasks: Sequence[Task], options: Mapping[str, str], read: Mapping[str, str], other: str) -> None:
    """Refuse outputs that are there already and are read, by a link or by the same name."""
    sources: dict[Hashable, str] = {_identity(path): f"file of {option}, {path}" for option, path in read.items()}
    sources |= {_identity(task.file): f"input {task.file}" for task in tasks}
    sources.pop(None, None)
    outputs = [(path, path, other) for task in tasks for path in task.outputs if path != STANDARD]
    is_open = {path: path == STANDARD or descriptor_of(path) is not None for path in options.values()}
    outputs += [(path, f"{option} {path}", "name") for option, path in options.items() if not is_open[path]]
    for path, label, instead in outputs:
        if (role := sources.get(_identity(path))) is not None:
            raise UsageError(f"{label} is also the {role}, which is never replaced: choose another {instead}")


def _check_records(folder: str, options: Mapping[str, str]) -> None:
    """Refuse to write over the records of batches in the folder: `--resume` reads them."""
    for option, path in options.items():
        place = Path(os.path.realpath(path))
        if place.name.endswith(RECORD_ENDING) and place.parent == Path(os.path.realpath(folder)):
            raise UsageError(f"{option} {path} is the name of a record that --resume reads: choose another name")


def _identity(path: str) -> tuple[int, int] | None:
    """Return the identity of a file or folder; None for what is not there, and for streams."""
    try:
        found = os.fstat(0) if path == STANDARD else Path(file_of(path)).stat()
    except (OSError, ValueError):
        return None
    is_held = stat.S_ISREG(found.st_mode) or stat.S_ISDIR(found.st_mode)
    return (found.st_dev, found.st_ino) if is_held else None


def check_inside(paths: Iterable[str | os.PathLike[str]], folder: str | os.PathLike[str]) -> None:
    """Refuse files that would be written outside a folder, through links in it."""
    inside, known = Path(os.path.realpath(folder)), set[Path]()
    for path in map(Path, paths):
        place = path if path.is_symlink() else path.parent
        if place not in known and not Path(os.path.realpath(place)).is_relative_to(inside):
            raise OutputError(f"{path} would lie outside {inside}, through a link: remove the link")
        known.add(place)
