"""Files of maps, as GDAL reads them through pyogrio: FlatGeobuf, Shapefile, KML, GPX.

Only what has been told to be one of these is passed on, in memory: other formats of GDAL open further files, or a
network. Features are read one by one and not as batches of Arrow, whose offsets GDAL 3.12 has wrong for FlatGeobuf
without geometry (it then crashes); for a million polygons of nine vertices that takes 1.6 s instead of 1.3.
"""

from __future__ import annotations

import io
import re
import struct
from collections.abc import Sequence
from datetime import date, datetime
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.convert.extras import needed
from vorotool.errors import INPUT_FORMAT, InputError
from vorotool.formats.gis.feature_table import Features, chosen_layer
from vorotool.formats.gis.feature_writer import GdalFeatures
from vorotool.formats.gis.shapefile import archive_of
from vorotool.formats.io.limits import decoding, interruptible
from vorotool.formats.io.sources import Source
from vorotool.formats.parsing.reader_options import ReadOptions
from vorotool.numeric.crs import member_of_text
from vorotool.numeric.curves.well_known import geometry_of_binary

TITLES = {"fgb": "FlatGeobuf", "shp": "Shapefile", "kml": "KML", "gpx": "GPX"}
"""Formats and what they are called."""

_MARKUP = rb"(?:\xef\xbb\xbf)?\s*(?:<[?!][^>]*>\s*)*<%b[\s>]"
_BEGINNINGS = {
    "fgb": re.compile(rb"fgb\x03fgb"),
    "shp": re.compile(rb"\0\0\x27\x0a|PK\x03\x04"),
    "kml": re.compile(_MARKUP % b"kml"),
    "gpx": re.compile(_MARKUP % b"gpx"),
}
"""Of each format: GDAL takes a file for what it begins as, whatever it is called, and some formats name others."""
_TIMES = {"OFTDate": date, "OFTDateTime": datetime}
_BYTES = "OFTBinary"
_COUNT_FIELD, _SMALLEST = 8, 8
"""Which field of the header of a FlatGeobuf counts its features, and bytes that each has at least."""


def features_of(source: Source) -> Features:
    """Read a layer: the one that is wanted, or the only one."""
    title = TITLES[source.format]
    if not _BEGINNINGS[source.format].match(source.data):
        raise InputError(
            f"{source.name} is not a {title} file: its first bytes are those of another format; name its format with "
            f"{INPUT_FORMAT}"
        )
    pyogrio = needed("pyogrio", "gis", f"{title} files")
    try:
        with decoding(source.name, title):
            if source.format == "fgb":
                _check_count(source)
            return _read(pyogrio, archive_of(source) if source.format == "shp" else source.data, source)
    except InputError as error:
        if error.__cause__ is None:
            raise
        # what GDAL says is of drivers and of the place in memory that the file had
        raise InputError(f"{source.name} cannot be read as {title}; is it damaged or cut off?") from error


def _check_count(source: Source) -> None:
    """Refuse a FlatGeobuf whose header announces more features than there is room for: GDAL believes it."""
    root = 12 + struct.unpack_from("<I", source.data, 12)[0]
    fields = root - struct.unpack_from("<i", source.data, root)[0]
    place = fields + 4 + 2 * _COUNT_FIELD
    if fields < 0 or place + 2 > fields + struct.unpack_from("<H", source.data, fields)[0]:
        return
    at = struct.unpack_from("<H", source.data, place)[0]
    count = struct.unpack_from("<Q", source.data, root + at)[0] if at else 0
    if count > len(source.data) // _SMALLEST:
        raise InputError(
            f"{source.name} states {count} features, more than its {len(source.data)} bytes can hold; is it damaged?"
        )
    ReadOptions(max_sites=source.max_sites).check_sites(source.name, count)


def _read(pyogrio: Any, data: bytes, source: Source) -> Features:
    layers = pyogrio.list_layers(data).tolist()
    options = {"layer": chosen_layer(source, layers), "datetime_as_string": True}
    # what is made in another thread is slower to read: GDAL alone works there
    meta, _, wkb, values = interruptible(lambda: pyogrio.raw.read(data, **options))
    columns = _columns(meta, values)
    lossy = [name for name in columns if _has_lost_digits(meta, name, values)]
    if lossy:
        exact = pyogrio.read_arrow(data, columns=lossy, read_geometry=False, **options)[1].to_pydict()
        columns |= {name: exact[name] for name in lossy}
    geometry, curves = geometry_of_binary(wkb.tolist(), source.flatten)
    bad = next((k for k, each in enumerate(wkb) if each is not None and geometry[k] is None), None)
    if bad is not None:
        raise InputError(f"{source.name}: the geometry of feature {bad + 1} cannot be read; is the file damaged?")
    return Features(source.name, geometry, columns, None, member_of_text(meta["crs"]), curves=curves)


def _columns(meta: dict[str, Any], values: Sequence[NDArray[Any]]) -> dict[str, list[Any]]:
    """The attributes with their types; bytes are none that anything else could hold."""
    kinds = zip(meta["fields"].tolist(), meta["ogr_types"], meta["dtypes"].tolist(), values, strict=True)
    return {name: _plain(kind, dtype, column) for name, kind, dtype, column in kinds if kind != _BYTES}


def _plain(kind: str, dtype: str, column: NDArray[Any]) -> list[Any]:
    listed: list[Any] = column.tolist()
    if kind in _TIMES:
        return [None if text is None else _TIMES[kind].fromisoformat(text) for text in listed]
    if column.dtype.kind == "f":
        whole = int if dtype.startswith(("int", "uint")) else bool if dtype == "bool" else float
        return [None if missing else whole(value) for value, missing in zip(listed, np.isnan(column), strict=True)]
    return [value.tolist() if isinstance(value, np.ndarray) else value for value in listed]


def _has_lost_digits(meta: dict[str, Any], name: str, values: Sequence[NDArray[Any]]) -> bool:
    """Whether whole numbers came as floating-point ones, as they do beside missing ones, and are too large for it."""
    index = meta["fields"].tolist().index(name)
    column = values[index]
    is_whole = meta["dtypes"][index].startswith(("int", "uint")) and column.dtype.kind == "f"
    return is_whole and bool((np.abs(column) >= 2.0**53).any())


class FlatGeobuf(GdalFeatures):
    """A FlatGeobuf file, whose features are in the order of the result."""

    def finish(self) -> None:
        """Write the file."""
        out = io.BytesIO()
        self.gdal_write(out, self.columns(), driver="FlatGeobuf", layer_options={"SPATIAL_INDEX": "NO"})
        self.out.write(out.getbuffer())
