"""Zarr stores as files are: what they are, and outputs of this kind, which appear whole or not at all."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from functools import partial
from typing import TYPE_CHECKING

from vorotool.errors import OUTPUT, InputError, OutputError, UsageError
from vorotool.formats.io.atomic_output import check_folder, clobber_error, explained, followed, is_same_file
from vorotool.formats.io.descriptors import STANDARD, stream_kind
from vorotool.formats.io.temporaries import Placement, committed_together, new_folder

if TYPE_CHECKING:
    from pathlib import Path

_METADATA = ("zarr.json", ".zarray", ".zgroup")
is_folder = os.path.isdir
"""Whether a path is a folder; what must not be looked at is none, and who opens it says why."""


def is_store(path: str | os.PathLike[str]) -> bool:
    """Whether a path is a folder that holds a Zarr array or group, or should by its name."""
    name = os.fspath(path)
    is_named = is_folder(name) and name.rstrip(os.sep).lower().endswith(".zarr")
    return is_named or any(os.path.isfile(os.path.join(name, each)) for each in _METADATA)


def is_array(path: str | os.PathLike[str]) -> bool:
    """Whether a path is a folder that holds a Zarr array, and not a group of them."""
    return os.path.isfile(os.path.join(path, ".zarray")) or _node_type(path) == "array"


def is_group(path: str | os.PathLike[str]) -> bool:
    """Whether a path is a folder that holds a group of Zarr arrays."""
    return os.path.isfile(os.path.join(path, ".zgroup")) or _node_type(path) == "group"


def _node_type(path: str | os.PathLike[str]) -> object:
    """The metadata of format 3, if they can be read."""
    from vorotool.formats.zarr.metadata import read_metadata

    try:
        return (read_metadata(path) or {}).get("node_type")
    except (OSError, InputError):
        return None


def check_store(
    path: str | os.PathLike[str],
    *,
    no_clobber: bool = False,
    inputs: Iterable[str | os.PathLike[str]] = (),
    makes_folder: bool = False,
) -> str:
    """Refuse a store that `open_store` would not write."""
    name = os.fspath(path)
    if (kind := stream_kind(name)) is not None:
        place = "standard output" if name == STANDARD else f"{name}, {kind}"
        raise UsageError(f"a Zarr store is a folder and cannot be written to {place}: name it with {OUTPUT}")
    with explained(name):
        target = followed(name)
        exists = os.path.exists(target)
    if exists and not _may_be_replaced(target):
        raise _other_error(name)
    for each in inputs:
        within = os.path.realpath(each).startswith(os.path.join(target, ""))
        if exists and (within or is_same_file(target, os.fspath(each))):
            raise UsageError(f"{name} is also an input, which is never replaced: choose another name with {OUTPUT}")
    if exists and no_clobber:
        raise clobber_error(name)
    check_folder(name, os.path.dirname(target), makes_folder=makes_folder)
    return target


def _may_be_replaced(target: str) -> bool:
    """Whether a folder is an image that could have been written here: an array, or an OME-Zarr group of one."""
    from pathlib import Path

    from vorotool.formats.zarr.reader import is_single_image

    return is_array(target) or is_single_image(Path(target))


def _other_error(name: str) -> OutputError:
    return OutputError(f"{name!r} exists and is not a Zarr array, so it is not replaced: choose another name")


@contextmanager
def open_store(
    path: str | os.PathLike[str], *, no_clobber: bool = False, inputs: Iterable[str | os.PathLike[str]] = ()
) -> Iterator[Path]:
    """Give a folder to write a store in; it takes its place when all of it has been written."""
    from pathlib import Path

    name = os.fspath(path)
    target = check_store(name, no_clobber=no_clobber, inputs=inputs)

    def check() -> None:
        if not os.path.exists(target):
            return
        if no_clobber:
            raise clobber_error(target)
        if not _may_be_replaced(target):
            raise _other_error(target)

    with explained(name), committed_together() as commit:
        temporary = commit.make(target, new_folder)
        yield Path(temporary.path)
        commit.placements[target] = Placement(temporary, partial(explained, name), check)
