"""Volumes that are open, read some slices at a time or whole; and points of space."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from os import PathLike, fspath
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import INPUT_FORMAT, InputError, UsageError, option
from vorotool.formats.io.arrays import npy_header, npy_values
from vorotool.formats.io.descriptors import STANDARD, stream_kind
from vorotool.formats.io.sources import NPY, STANDARD_INPUT, Source, explained_reading, read_source, reading
from vorotool.formats.parsing.reader_options import ReadOptions, no_note
from vorotool.formats.points.columns import PointRows, parse_columns
from vorotool.formats.points.tables import check_coordinates, npy_labels
from vorotool.formats.recognition import format_of, recognized
from vorotool.formats.volumes.source import NpyVolume, Spool, VolumeSource, ZarrVolume, check_voxels, slabs_of
from vorotool.formats.volumes.tiff_stack import TiffStack
from vorotool.formats.zarr.store import is_folder, is_store
from vorotool.numeric.checks import MAX_PIXELS, checked_threads
from vorotool.products.formats import resolved
from vorotool.products.inputs import INPUTS, NAMES_WITH, SPACE_FORMATS, VOLUME_NAMES, known_input_format
from vorotool.types.points.point_set import VolumePoints
from vorotool.types.volumes.volume import Volume

_LONGEST_HEAD = 8


def open_volume(path: str | PathLike[str], *, input_format: str | None = None) -> VolumeSource:
    """Open a volume, to read it some slices at a time; its header is checked, and nothing is held."""
    said = None if input_format is None else known_input_format(input_format, VOLUME_NAMES)
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
        if said is None and not is_store(name):
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
    found = format_of(head)
    return found if found in ("tiff", "npy") else None


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


_NUMBERS = option("--columns 1,2,z=3", 'columns="1,2,z=3"')


def read_xyz(
    path: str | PathLike[str],
    *,
    input_format: str | None = None,
    columns: str | None = None,
    max_sites: int | None = None,
    properties: bool = True,
    threads: int = 0,
    note: Callable[[str], None] | None = None,
) -> VolumePoints:
    """Read points with a z: a column of this name, the third number of a position, or the column that is named."""
    said = None if input_format is None else known_input_format(input_format, NAMES_WITH["points"])
    options = ReadOptions(
        columns=columns,
        properties=properties,
        max_sites=max_sites,
        threads=checked_threads(threads),
        note=note or no_note,
        axes=3,
    )
    name = fspath(path)
    with reading(name):
        rows = _points(replace(read_source(name), max_sites=max_sites), said, options)
    return VolumePoints(rows.coordinates, rows.labels, rows.properties)


def _points(source: Source, said: str | None, options: ReadOptions) -> PointRows:
    if said == "npy" or (said is None and source.data.startswith(NPY)):
        return _of_array(source, options)
    holds, source = recognized(source, "points", said, options.columns)
    if holds != "points" or source.format not in SPACE_FORMATS:
        what = "an image" if holds == "image" else f"in the format {source.format}"
        known = ", ".join(SPACE_FORMATS)
        raise InputError(f"{source.name} is {what}, but points with a z are expected: give one of {known}, npy")
    read: Callable[[Source, ReadOptions], PointRows] = resolved(INPUTS[source.format].readers["points"])
    return read(source, options)


def _of_array(source: Source, options: ReadOptions) -> PointRows:
    """Read columns of an (n, k) array, which are named by their numbers."""
    header = npy_header(source)
    if header.dtype.kind == "b" or len(header.shape) != 2 or header.shape[1] < 3:
        raise InputError(
            f"{source.name} holds {header.dtype} of shape {header.shape}: points with a z are an (n, 3) array of "
            "numbers, or have more columns"
        )
    if options.columns is None and header.shape[1] > 3:
        raise InputError(
            f"{source.name} holds {header.shape[1]} columns without names: name x, y and z with {_NUMBERS}"
        )
    options.check_sites(source.name, header.shape[0])
    wanted = parse_columns(options.columns or "1,2,z=3", axes=3)
    if wanted.z is None:
        raise UsageError(f"{option('--columns')} names no z: use {_NUMBERS}")
    chosen = [_column_number(source.name, each, header.shape[1]) for each in wanted.all]
    table = npy_values(source, header)
    places = [*chosen[:2], chosen[-1]]
    if len(set(chosen)) < len(chosen):
        raise InputError(f"{source.name}: {option('--columns')} names one column twice")
    xyz: NDArray[np.generic] = table[:, places]
    labels = npy_labels(source.name, table[:, chosen[2]]) if len(chosen) > 3 else None
    return PointRows(check_coordinates(source.name, xyz), labels, {}, {})


def _column_number(name: str, wanted: str, columns: int) -> int:
    if not (wanted.isascii() and wanted.isdecimal() and len(wanted) < 10 and int(wanted) <= columns):
        raise InputError(
            f"{name} has {columns} columns without names: there is no column {wanted!r:.40}; use {_NUMBERS}"
        )
    return int(wanted) - 1
