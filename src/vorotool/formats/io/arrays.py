"""NumPy's NPY files, and images and volumes that pass by as bands of rows or slabs of slices; nothing is unpickled."""

from __future__ import annotations

import io
import math
import warnings
from collections.abc import Callable, Iterable, Iterator
from math import prod
from typing import TYPE_CHECKING, Any, BinaryIO, NamedTuple

import numpy as np
from numpy.typing import DTypeLike, NDArray

from vorotool.errors import InputError, LimitError, option
from vorotool.formats.io.sources import Source, decoding
from vorotool.formats.parsing.reader_options import ReadOptions
from vorotool.products.inputs import Holds

if TYPE_CHECKING:
    import zipfile

_LONGEST_HEADER = 65_536


class NpyHeader(NamedTuple):
    """The header of an NPY file."""

    shape: tuple[int, ...]
    dtype: np.dtype[Any]
    fortran_order: bool
    offset: int


def npy_header(source: Source) -> NpyHeader:
    """Read the header alone."""
    stream = io.BytesIO(source.data[:_LONGEST_HEADER])
    try:
        version = np.lib.format.read_magic(stream)  # later ones only serve structured arrays
        read = {(1, 0): np.lib.format.read_array_header_1_0, (2, 0): np.lib.format.read_array_header_2_0}
        if version not in read:
            raise ValueError(f"version {version[0]}.{version[1]}")
        with warnings.catch_warnings():  # a header written by Python 2
            warnings.simplefilter("ignore")
            shape, fortran_order, dtype = read[version](stream)
    except Exception as error:  # a header is a Python literal: many things can be wrong with it
        reason = str(error).splitlines()[0] if str(error) else type(error).__name__
        raise InputError(
            f"{source.name} is not an NPY file of version 1 or 2 ({reason}); save an array of numbers with numpy.save"
        ) from error
    if dtype.hasobject:
        raise InputError(f"{source.name} holds pickled objects, which are never loaded; save it with a number dtype")
    if dtype.kind not in "buif":
        raise InputError(f"{source.name} holds {dtype}, not numbers; save it as integers or floating-point numbers")
    if any(type(side) is not int or side < 0 for side in shape):  # a truth value is taken for a number, too
        raise InputError(f"{source.name} has the shape {shape}; expected integers of 0 or more")
    return NpyHeader(shape, dtype, fortran_order, stream.tell())


def npy_values(source: Source, header: NpyHeader) -> NDArray[Any]:
    """Give the array of a source, as a view of its bytes."""
    items = prod(header.shape)
    needed, present = items * header.dtype.itemsize, len(source.data) - header.offset
    if present < needed:
        raise InputError(
            f"{source.name} is cut off: shape {header.shape} of {header.dtype} needs {needed} bytes, it has {present}; "
            "write the file again"
        )
    flat = np.frombuffer(source.data, header.dtype, items, header.offset)
    return flat.reshape(header.shape, order="F" if header.fortran_order else "C")


def plain_values(values: NDArray[Any]) -> NDArray[Any]:
    """Give values in the order of bytes of this machine; truth values become 0 and 1."""
    if values.dtype == np.bool_:
        return values.astype(np.uint8)
    return values.astype(values.dtype.newbyteorder("="), copy=False)


_WIDER = option("-o labels.tif or .npy", "the path labels.tif or labels.npy")
_SIGNED = option("-o labels.npy", "the path labels.npy")

BLOCK_BYTES = 1 << 20
"""Bytes of a block: its own code tables cost nothing, and it stays in the cache."""


def checked(bands: Iterable[NDArray[Any]], shape: tuple[int, ...]) -> Iterator[NDArray[Any]]:
    """Pass on bands of rows, or slabs of slices, and see that together they have a shape."""
    seen = 0
    for item in bands:
        band = np.asarray(item)
        if band.shape[1:] != shape[1:] or band.ndim != len(shape):
            raise ValueError(f"a band has shape {band.shape}: it must be (rows, {', '.join(map(str, shape[1:]))})")
        seen += len(band)
        if seen > shape[0]:
            break
        yield band
    if seen != shape[0]:
        raise ValueError(f"the bands have {'more than ' * (seen > shape[0])}{min(seen, shape[0])} rows, not {shape[0]}")


def check_fits(band: NDArray[Any], largest: int, target: str) -> None:
    """Refuse values that ``target`` cannot hold: nothing is ever wrapped."""
    if band.size == 0 or band.dtype.kind == "b":
        return
    if np.iinfo(band.dtype).max > largest and (top := int(band.max())) > largest:
        raise LimitError(f"the value {top} does not fit in {target}, which ends at {largest}: use {_WIDER}")
    if band.dtype.kind == "i" and (low := int(band.min())) < 0:
        raise LimitError(f"the value {low} does not fit in {target}, which begins at 0: use {_SIGNED}")


def blocks(
    bands: Iterable[NDArray[Any]],
    shape: tuple[int, ...],
    *,
    columns: int,
    dtype: DTypeLike,
    encode: Callable[[NDArray[Any], NDArray[Any]], None],
    rows: int | None = None,
) -> Iterator[NDArray[Any]]:
    """Regroup bands into blocks, each after the row before it; by default of a size that depends on the shape alone."""
    if rows is None:
        rows = max(1, min(shape[0], BLOCK_BYTES // max(1, columns * np.dtype(dtype).itemsize)))
    block, filled = np.zeros((1 + rows, columns), dtype), 1
    for band in checked(bands, shape):
        start = 0
        while start < len(band):
            take = min(1 + rows - filled, len(band) - start)
            encode(band[start : start + take], block[filled : filled + take])
            start, filled = start + take, filled + take
            if filled > rows:
                last = block[-1]
                yield block
                block, filled = np.empty_like(block), 1
                block[0] = last
    if filled > 1:
        yield block[:filled]


def write_npy(out: BinaryIO, bands: Iterable[NDArray[Any]], shape: tuple[int, ...], *, dtype: DTypeLike) -> None:
    """Write an array, little-endian, from bands of rows or slabs of slices: the header first, then each as it comes."""
    kind = np.dtype(dtype).newbyteorder("<")
    header = {"descr": np.lib.format.dtype_to_descr(kind), "fortran_order": False, "shape": tuple(map(int, shape))}
    np.lib.format.write_array_header_1_0(out, header)
    for band in checked(bands, shape):
        out.write(stored(band, kind).data)


def stored(band: NDArray[Any], dtype: np.dtype[Any]) -> NDArray[Any]:
    """Contiguous rows of the given type; integers that do not fit are refused (LimitError), never wrapped."""
    if dtype.kind in "ui" and not np.can_cast(band.dtype, dtype):
        check_fits(band, int(np.iinfo(dtype).max), f"{dtype.name} pixels")
    return np.ascontiguousarray(band, dtype=dtype)


_HELD: dict[Holds, frozenset[str]] = {
    "voronoi": frozenset({"cell_ring_arcs", "cell_starts", "vertex_r", "about"}),
    "offsets": frozenset({"piece_start_x", "shape_distance", "about"}),
    "skeleton": frozenset({"arc_source", "vertex_r", "ring_starts"}),
    "polygons": frozenset({"cell_starts", "polygon_starts", "ring_starts", "vertex_x", "vertex_y"}),
}
"""Names of arrays that an archive of each has."""


def npz_holds(data: bytes) -> Holds:
    """Tell what an archive holds by the names of its arrays: all else is taken for points."""
    try:
        import zipfile

        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            names = {name.removesuffix(".npy") for name in archive.namelist()}
    except Exception:  # who reads it says what is wrong: zipfile raises nearly everything on damaged bytes
        return "points"
    return next((held for held, own in _HELD.items() if names >= own), "points")


def npz_columns(source: Source, options: ReadOptions) -> dict[str, NDArray[Any]]:
    """Read all arrays, by their names."""
    columns: dict[str, NDArray[Any]] = {}
    import zipfile

    with decoding(source.name, "NPZ"), zipfile.ZipFile(io.BytesIO(source.data)) as archive:
        for entry in archive.infolist():
            columns[entry.filename.removesuffix(".npy")] = _column(source.name, archive, entry, options)
    return columns


def present_values(values: NDArray[Any], missing: NDArray[Any] | None) -> list[Any]:
    """List the values of a column, None where its array of what is missing says so."""
    listed: list[Any] = values.tolist()
    if missing is None or len(missing) != len(listed):
        return listed
    return [None if none else value for value, none in zip(listed, missing.tolist(), strict=True)]


def _column(name: str, archive: zipfile.ZipFile, entry: zipfile.ZipInfo, options: ReadOptions) -> NDArray[Any]:
    """One array, of which no more is read than its header announces and the file holds."""
    if entry.compress_type:  # it is not stored as it is
        raise InputError(f"{name}: {entry.filename} is compressed; save it with numpy.savez, which does not compress")
    with archive.open(entry) as member:
        version = np.lib.format.read_magic(member)
        read = np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
        shape, _, dtype = read(member)
        if len(shape) in (2, 3) and dtype.kind in "biuf":
            raise InputError(
                f"{name}: {entry.filename} has the shape {shape}; save an image or points as NPY, with numpy.save"
            )
        if len(shape) != 1 or dtype.kind not in "biufU" or dtype.itemsize == 0:
            raise InputError(
                f"{name}: {entry.filename} is of type {dtype} and shape {shape}; a table has 1-D columns of numbers or "
                "text"
            )
        options.check_sites(name, shape[0])
        needed = math.prod(shape) * dtype.itemsize
        data = member.read(needed)
    if len(data) < needed:
        raise InputError(f"{name}: {entry.filename} is cut off: it should have {needed} bytes, but has {len(data)}")
    return np.frombuffer(data, dtype)
