"""NPZ archives of 1-D arrays, such as tables and results are written as; never unpickled."""

from __future__ import annotations

import io
import math
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError
from vorotool.formats.io.limits import decoding
from vorotool.formats.io.sources import Source
from vorotool.formats.parsing.reader_options import ReadOptions

if TYPE_CHECKING:
    import zipfile

NPZ_MAGIC = b"PK\x03\x04"
_SKELETON = frozenset({"arc_source", "vertex_r", "ring_starts"})
_OFFSETS = frozenset({"piece_start_x", "shape_distance", "about"})
_VORONOI = frozenset({"cell_ring_arcs", "cell_starts", "vertex_r", "about"})
_CELLS = frozenset({"cell_starts", "polygon_starts", "ring_starts", "vertex_x", "vertex_y"})


def npz_holds(data: bytes) -> Literal["points", "polygons", "skeleton", "offsets", "voronoi"]:
    """Tell what an archive holds by the names of its arrays: all else is taken for points."""
    try:
        import zipfile

        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            names = {name.removesuffix(".npy") for name in archive.namelist()}
    except Exception:  # who reads it says what is wrong: zipfile raises nearly everything on damaged bytes
        return "points"
    if names >= _VORONOI:
        return "voronoi"
    if names >= _OFFSETS:
        return "offsets"
    return "skeleton" if names >= _SKELETON else "polygons" if names >= _CELLS else "points"


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
