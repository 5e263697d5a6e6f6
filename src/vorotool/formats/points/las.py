"""Points from LAS and LAZ (ASPRS LAS 1.0 to 1.4): their fields, and the coordinate reference system."""

from __future__ import annotations

import re
import struct
import subprocess
import sys
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vorotool.convert.extras import needed
from vorotool.errors import InputError
from vorotool.formats.io.sources import Source, check_unpacked, decoding
from vorotool.formats.parsing.reader_options import ReadOptions
from vorotool.formats.points.clouds import Arrays, rows_of_arrays
from vorotool.formats.points.columns import PointRows
from vorotool.numeric.crs import crs_member, member_of_text
from vorotool.types.fields import UP

_LAZ = "LAZ files"
_SMALLEST_HEADER = 227
_FORMATS = range(11)

_OLD = {"intensity": (12, "<u2"), "return_number": (14, "u1"), "classification": (15, "u1")}
_NEW = {"intensity": (12, "<u2"), "return_number": (14, "u1"), "classification": (16, "u1")}
_BITS = {("return_number", True): 7, ("return_number", False): 15, ("classification", True): 31}
"""Of a byte, those that a field has in old formats (up to 5) and in new ones."""
_GPS_TIME = {1: 20, 3: 20, 4: 20, 5: 20, 6: 22, 7: 22, 8: 22, 9: 22, 10: 22}
_COLORS = {2: 20, 3: 28, 5: 28, 7: 30, 8: 30, 10: 30}
"""Where these fields begin, by the format of points."""


class _Header(NamedTuple):
    """What is said of the points."""

    begin: int  # of the points
    records: int  # of variable length, before them
    size: int  # of the header
    format: int
    is_packed: bool
    length: int  # of a point
    points: int
    scales: tuple[float, ...]
    offsets: tuple[float, ...]


def read_las(source: Source, options: ReadOptions) -> PointRows:
    """Read the points of a LAS or LAZ file; intensity, return, class, time and color are columns."""
    with decoding(source.name, "LAS"):
        header = _header(source)
        options.check_sites(source.name, header.points)
        records = list(_records(source.data, header))
        data = _unpacked(source, header, records) if header.is_packed else source.data[header.begin :]
        columns = _columns(data, header, with_fields=options.properties)
        system = _system(records)
    return rows_of_arrays(source.name, columns, options, {"y_axis": UP, "crs": system})


def _header(source: Source) -> _Header:
    data = source.data
    if not data.startswith(b"LASF") or len(data) < _SMALLEST_HEADER:
        raise InputError(f"{source.name} is not a LAS file: it begins with LASF and a header")
    size, begin, records, kind, length, points = struct.unpack_from("<HIIBHI", data, 94)
    if data[24:26] >= b"\1\4" and size >= 255:
        (points,) = struct.unpack_from("<Q", data, 247)
    header = _Header(
        *(begin, records, size, kind & 63, kind > 63, length, points),
        struct.unpack_from("<3d", data, 131),
        struct.unpack_from("<3d", data, 155),
    )
    kind = header.format
    least = max(20 if kind < 6 else 30, _GPS_TIME.get(kind, 0) + 8, _COLORS.get(kind, 0) + 6)
    if kind not in _FORMATS or length < least:
        raise InputError(f"{source.name}: its points are in format {kind}, of {length} bytes: 0 to 10 are read")
    whole = max(len(data) - begin, 0) // length
    if whole < points and not header.is_packed:
        raise InputError(f"{source.name} states {points} points, but holds {whole}; is the file damaged or cut off?")
    return header


def _records(data: bytes, header: _Header) -> Iterator[tuple[bytes, int, bytes]]:
    """Yield the owner, the number and the content of each record of variable length."""
    place = header.size
    for _ in range(header.records):
        if place + 54 > min(header.begin, len(data)):
            return
        owner, number, length = struct.unpack_from("<2x16sHH", data, place)
        yield owner.rstrip(b"\0"), number, data[place + 54 : place + 54 + length]
        place += 54 + length


def _columns(data: bytes, header: _Header, *, with_fields: bool) -> Arrays:
    """Give x, y and z, and the other fields of the points."""
    kind, is_old = header.format, header.format < 6

    def field(place: int, dtype: str) -> NDArray[Any]:
        row = np.dtype({"names": ["a"], "formats": [dtype], "offsets": [place], "itemsize": header.length})
        return np.frombuffer(data, row, header.points)["a"]

    scaled = zip("xyz", (0, 4, 8), header.scales, header.offsets, strict=True)
    columns: dict[str, NDArray[Any]] = {axis: field(at, "<i4") * scale + shift for axis, at, scale, shift in scaled}
    if not with_fields:
        return columns
    for name, (place, dtype) in (_OLD if is_old else _NEW).items():
        bits = _BITS.get((name, is_old))
        columns[name] = field(place, dtype) if bits is None else field(place, dtype) & bits
    if kind in _GPS_TIME:
        columns["gps_time"] = field(_GPS_TIME[kind], "<f8")
    if kind in _COLORS:
        colors = zip(("red", "green", "blue"), (0, 2, 4), strict=True)
        columns |= {name: field(_COLORS[kind] + at, "<u2") for name, at in colors}
    return columns


# ---- LAZ -----------------------------------------------------------------------------------------
_WORK = """
import io, sys, lazrs
begin, size = map(int, sys.argv[1:])
record, file = sys.stdin.buffer.read(int(sys.stdin.buffer.readline())), io.BytesIO(sys.stdin.buffer.read())
file.seek(begin)
points = bytearray(size)
lazrs.LasZipDecompressor(file, record).decompress_many(points)
sys.stdout.buffer.write(points)
"""
_LEAST_SECONDS, _BYTES_A_SECOND = 10, 10**6


def _unpacked(source: Source, header: _Header, records: list[tuple[bytes, int, bytes]]) -> bytes:
    """Decompress points in another process: on damaged files lazrs ends the one in which it runs."""
    needed("lazrs", "clouds", _LAZ)
    size = header.points * header.length
    check_unpacked(source.name, size, len(source.data))
    record = next((content for owner, number, content in records if (owner, number) == (b"laszip encoded", 22204)), b"")
    try:
        done = subprocess.run(
            [sys.executable, "-c", _WORK, str(header.begin), str(size)],
            input=b"%d\n%b%b" % (len(record), record, source.data),
            capture_output=True,
            timeout=_LEAST_SECONDS + size / _BYTES_A_SECOND,
            check=False,
        )
    except subprocess.TimeoutExpired:
        raise InputError(f"{source.name}: its points cannot be unpacked in time; is the file damaged?") from None
    if done.returncode or len(done.stdout) != size:
        raise InputError(f"{source.name}: its points cannot be unpacked; is the file damaged or cut off?")
    return done.stdout


# ---- coordinate reference systems ----------------------------------------------------------------
_PROJECTED, _GEOGRAPHIC = 3072, 2048
_CODES = range(1024, 32767)
"""Of EPSG, as keys of GeoTIFF have them."""
_OWN_CODE = re.compile(r'(?:ID|AUTHORITY)\["EPSG",\s*"?([0-9]+)"?\]\s*\]$')
"""The last member of well-known text, which is about all of it."""


def _system(records: list[tuple[bytes, int, bytes]]) -> Any:
    """Give the coordinate reference system that is stated as well-known text or by keys of GeoTIFF."""
    found = {number: content for owner, number, content in records if owner == b"LASF_Projection"}
    text = found.get(2112, b"").split(b"\0")[0].decode("utf-8", "replace").strip()
    if text:
        return _plane(text)
    keys = found.get(34735, b"")
    shorts = struct.unpack(f"<{len(keys) // 2}H", keys[: len(keys) // 2 * 2])
    stated = {shorts[k]: shorts[k + 3] for k in range(4, len(shorts) - 3, 4) if shorts[k + 1] == 0}
    code = stated.get(_PROJECTED, stated.get(_GEOGRAPHIC, 0))
    return crs_member(f"EPSG:{code}") if code in _CODES else None


def _plane(text: str) -> Any:
    """Give the system of x and y: of a compound one the first, for which pyproj is needed."""
    if not text.upper().startswith(("COMPD_CS", "COMPOUNDCRS")):
        code = _OWN_CODE.search(text)
        return member_of_text(f"EPSG:{code[1]}" if code else text)
    pyproj = needed("pyproj", "gis", "coordinate reference systems with heights")
    system = pyproj.CRS.from_user_input(text).sub_crs_list[0]
    name = system.to_authority()
    return member_of_text(":".join(name) if name else system.to_wkt())
