"""Points of space: lists of points whose files have a z."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from os import PathLike, fspath

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError, UsageError, option
from vorotool.formats.io.arrays import MAGIC, npy_header, npy_values
from vorotool.formats.io.sources import Source, read_source, reading
from vorotool.formats.opening import recognized
from vorotool.formats.parsing.reader_options import ReadOptions, no_note
from vorotool.formats.points.columns import PointRows, parse_columns
from vorotool.formats.points.tables import check_coordinates, npy_labels
from vorotool.numeric.checks import checked_threads
from vorotool.products.formats import resolved
from vorotool.products.inputs import INPUTS, NAMES_WITH, SPACE_FORMATS, known_input_format
from vorotool.types.volumes.volume_points import VolumePoints

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
    said = known_input_format(input_format, NAMES_WITH["points"])
    options = ReadOptions(
        columns=columns,
        properties=properties,
        max_sites=max_sites,
        threads=checked_threads(threads),
        note=note or no_note,
        wants_z=True,
    )
    name = fspath(path)
    with reading(name):
        rows = _rows(replace(read_source(name), max_sites=max_sites), said, options)
    return VolumePoints(rows.coordinates, rows.labels, rows.properties)


def _rows(source: Source, said: str | None, options: ReadOptions) -> PointRows:
    if said == "npy" or (said is None and source.data.startswith(MAGIC)):
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
    if options.columns is None:
        raise InputError(
            f"{source.name} holds an array, whose third column is read as the label: name it as z with {_NUMBERS}"
        )
    options.check_sites(source.name, header.shape[0])
    wanted = parse_columns(options.columns, wants_z=True)
    if wanted.z is None:
        raise UsageError(f"{option('--columns')} names no z: use {_NUMBERS}")
    chosen = [_column(source.name, each, header.shape[1]) for each in wanted.all]
    table = npy_values(source, header)
    places = [*chosen[:2], chosen[-1]]
    if len(set(chosen)) < len(chosen):
        raise InputError(f"{source.name}: {option('--columns')} names one column twice")
    xyz: NDArray[np.generic] = table[:, places]
    labels = npy_labels(source.name, table[:, chosen[2]]) if len(chosen) > 3 else None
    return PointRows(check_coordinates(source.name, xyz), labels, {}, {})


def _column(name: str, wanted: str, columns: int) -> int:
    if not (wanted.isascii() and wanted.isdecimal() and len(wanted) < 10 and int(wanted) <= columns):
        raise InputError(
            f"{name} has {columns} columns without names: there is no column {wanted!r:.40}; use {_NUMBERS}"
        )
    return int(wanted) - 1
