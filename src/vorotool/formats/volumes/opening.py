"""Volumes that are open: read some slices at a time, or whole."""

from __future__ import annotations

import os
from collections.abc import Callable
from os import PathLike, fspath
from pathlib import Path

import numpy as np

from vorotool.errors import INPUT_FORMAT, InputError, option
from vorotool.formats.io.arrays import MAGIC
from vorotool.formats.io.descriptors import STANDARD, stream_kind
from vorotool.formats.io.sources import STANDARD_INPUT, explained_reading, reading
from vorotool.formats.volumes.source import NpyVolume, Spool, VolumeSource, ZarrVolume, check_voxels, slabs_of
from vorotool.formats.volumes.tiff_stack import TiffStack
from vorotool.formats.zarr.store import is_folder, is_store
from vorotool.products.inputs import VOLUME_NAMES, known_input_format
from vorotool.types.pixels import MAX_PIXELS
from vorotool.types.volumes.volume import Volume

_HEADS = ((b"II*\x00", "tiff"), (b"MM\x00*", "tiff"), (b"II+\x00", "tiff"), (b"MM\x00+", "tiff"), (MAGIC, "npy"))
_LONGEST_HEAD = 8


def open_volume(path: str | PathLike[str], *, input_format: str | None = None) -> VolumeSource:
    """Open a volume, to read it some slices at a time; its header is checked, and nothing is held."""
    said = known_input_format(input_format, VOLUME_NAMES)
    if not isinstance(path, str | PathLike):
        raise InputError(f"{path!r} is not a path: give the name of a file; pass arrays to functions as they are")
    name = fspath(path)
    with reading(name):
        source = _opened(name, said)
        check_voxels(source.name, source.shape, np.iinfo(np.int64).max)
        return source


def read_volume(
    path: str | PathLike[str],
    *,
    input_format: str | None = None,
    max_voxels: int = MAX_PIXELS,
    note: Callable[[str], None] | None = None,
) -> Volume:
    """Read a whole volume."""
    source = open_volume(path, input_format=input_format)
    with reading(fspath(path)):
        check_voxels(source.name, source.shape, max_voxels)
        if note is not None and source.note:
            note(source.note)
        values = np.empty(source.shape, source.dtype)
        for first, slab in slabs_of(source):
            values[first : first + len(slab)] = slab
    return Volume(values, source.grid)


def _opened(name: str, said: str | None) -> VolumeSource:
    if is_folder(name) and (said in (None, "zarr")):
        if said is None and not is_store(name) and not name.rstrip(os.sep).lower().endswith(".zarr"):
            raise InputError(f"{name} is a directory: name the files in it, for example {name}/*")
        return ZarrVolume(name, str(Path(name).absolute()))
    spool, path = None, name
    with explained_reading(name):
        if name == STANDARD or stream_kind(name) is not None:
            spool = Spool(name)
            path = spool.path
        with Path(path).open("rb") as file:
            head = file.read(_LONGEST_HEAD)
    spoken = STANDARD_INPUT if name == STANDARD else name
    kind = _kind(spoken, head, said)
    place = str(Path(path).absolute())
    return NpyVolume(spoken, place, spool) if kind == "npy" else TiffStack(spoken, place, spool)


def kind_of_head(head: bytes) -> str | None:
    """Tell the format of a volume by its first bytes."""
    return next((kind for start, kind in _HEADS if head.startswith(start)), None)


def _kind(name: str, head: bytes, said: str | None) -> str:
    """Tell the format by the content, which must be what the caller says."""
    found = kind_of_head(head)
    if not head:
        raise InputError(f"{name} is empty, but a volume is expected: check the program that wrote it")
    if said == "zarr":
        raise InputError(f"{name} is a file, but a Zarr store is a folder: leave out {INPUT_FORMAT}")
    if found is None:
        raise InputError(
            f"{name} is not a volume in a supported format: give a TIFF stack, an NPY array of three axes, Zarr or "
            "OME-Zarr"
        )
    if said not in (None, found):
        right = option(f"--input-format {found}", f'input_format="{found}"')
        raise InputError(f"{name} is not a {said} file, it begins as {found}: use {right}")
    return found
