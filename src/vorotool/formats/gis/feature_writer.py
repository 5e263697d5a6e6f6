"""Features, or rows of a table, collected from the JSON that writers make: geometry, and columns with their types."""

from __future__ import annotations

import errno
import io
import os
import re
import warnings
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from datetime import UTC, date, datetime
from pathlib import Path
from typing import Any, BinaryIO, NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray

from vorotool.convert.extras import needed
from vorotool.formats.io.atomic_output import current_rules, failure
from vorotool.formats.text.row_writer import Column
from vorotool.formats.text.tables import JsonItems, json_text
from vorotool.numeric.coordinates import current_written
from vorotool.numeric.crs import crs_text
from vorotool.types.table import Lookup

_DATE = re.compile(r"\d{4}-\d\d-\d\d")
_INTEGERS = range(-(2**63), 2**63)


class TypedColumn(NamedTuple):
    """Values of one type: int64, float64, bool, datetime64, or text as objects; and which of them are missing."""

    values: NDArray[Any]
    missing: NDArray[np.bool_]
    is_utc: bool = False
    """Of times: they are in coordinated universal time, and not of an unknown zone."""


class FeatureRows(JsonItems):
    """A file that takes a list in JSON or a collection in GeoJSON, and keeps what is in it."""

    def __init__(self) -> None:
        super().__init__()
        self._geometry: list[NDArray[np.object_]] = []
        self._rows: list[dict[str, Any]] = []
        self._ids: list[Any] = []
        self._names: dict[str, None] = {}  # of the columns of a table, which may have no rows
        self._measured: set[str] = set()  # names of columns of floating-point numbers

    def announce(self, columns: Sequence[Column]) -> None:
        """Learn which columns hold floating-point numbers, which may all be whole."""
        for column in columns:
            self._names[column.name] = None
            values = column.values.values if isinstance(column.values, Lookup) else column.values
            if isinstance(values, np.ndarray) and values.dtype.kind == "f":
                self._measured.add(column.name)

    def take(self, items: bytes) -> None:
        """Keep some features or rows."""
        import orjson

        lines = items.splitlines()
        parsed = [orjson.loads(line) for line in lines]
        if not self.is_of_features:
            self._rows.extend(parsed)
            return
        self._rows.extend(each["properties"] or {} for each in parsed)
        self._ids.extend(each.get("id") for each in parsed)
        self._geometry.append(_geometries(lines, [each["geometry"] for each in parsed]))

    @property
    def is_of_features(self) -> bool:
        """Whether what comes is a collection, and not a table."""
        return (self._opening or b"").startswith(b"{")

    @property
    def geometry(self) -> NDArray[np.object_]:
        """(n,) shapely geometry, None where a feature has none."""
        return np.concatenate([np.empty(0, dtype=object), *self._geometry])

    def columns(self) -> dict[str, TypedColumn]:
        """Give the columns in the order in which they came first; the ids too, where nothing else tells them."""
        own = {} if self.is_of_features else self._names
        names = own | dict.fromkeys(name for row in self._rows for name in row)
        listed = {name: [row.get(name) for row in self._rows] for name in names}
        numbered = [list(range(1, len(self._rows) + 1)), [None] * len(self._ids)]
        if self.is_of_features and self._ids not in [*listed.values(), *numbered]:
            listed = {"feature_id" if "id" in listed else "id": self._ids} | listed
        unit = current_written().how.unit if self.is_of_features else None
        if unit is not None:
            listed["voro_unit" if "unit" in listed else "unit"] = [unit] * len(self._ids)
        return {name: _typed(values, is_measured=name in self._measured) for name, values in listed.items()}


def _geometries(lines: Sequence[bytes], members: Sequence[Any]) -> NDArray[np.object_]:
    made = np.full(len(lines), None, dtype=object)
    there = [row for row, member in enumerate(members) if member is not None]
    if there:
        made[there] = shapely.from_geojson([lines[row].decode() for row in there], on_invalid="ignore")
    for row in there:
        if made[row] is None:  # a line of one position, which is none to GEOS
            made[row] = shapely.linestrings(members[row]["coordinates"] * 2)
    return made


# ---- types ---------------------------------------------------------------------------------------
def _typed(values: list[Any], *, is_measured: bool) -> TypedColumn:
    """Find the one type that all values have; text in the form of dates and times holds such, as in GeoJSON."""
    missing = np.array([value is None for value in values], dtype=bool)
    kinds = {type(value) for value in values if value is not None}
    if kinds == {int} and not is_measured and all(value is None or value in _INTEGERS for value in values):
        return TypedColumn(np.array([value or 0 for value in values], dtype=np.int64), missing)
    if is_measured or (kinds and kinds <= {int, float}):
        return TypedColumn(np.array([np.nan if value is None else value for value in values], np.float64), missing)
    if kinds == {bool}:
        return TypedColumn(np.array([bool(value) for value in values]), missing)
    times = _times(values) if kinds == {str} else None
    if times is not None:
        return TypedColumn(times[0], missing, times[1])
    texts = [value if value is None or isinstance(value, str) else json_text(value) for value in values]
    return TypedColumn(np.array([*texts, None], dtype=object)[:-1], missing)


def _times(values: Sequence[str | None]) -> tuple[NDArray[Any], bool] | None:
    """Dates, or times of which all name their zone or none does; None if a text is neither."""
    texts = [value for value in values if value is not None]
    try:
        if all(_DATE.fullmatch(text) for text in texts):
            made = [None if value is None else date.fromisoformat(value) for value in values]
            return np.array(made, dtype="datetime64[D]"), False
        if not all(_DATE.match(text) and text[10:11] == "T" for text in texts):
            return None
        times = [None if value is None else datetime.fromisoformat(value) for value in values]
    except ValueError:
        return None
    zones = {time.tzinfo is not None for time in times if time is not None}
    if len(zones) > 1:
        return None
    if zones == {True}:
        times = [None if time is None else time.astimezone(UTC).replace(tzinfo=None) for time in times]
    return np.array(times, dtype="datetime64[ms]"), zones == {True}


# ---- GDAL ----------------------------------------------------------------------------------------
_FIXED = {"OGR_CURRENT_DATE": "1970-01-01T00:00:00.000Z"}
"""Options of GDAL that make the same bytes of the same features."""
_UTC = 100  # GDAL's number of the zone


class GdalFeatures(FeatureRows):
    """A layer that GDAL writes."""

    def __init__(self, out: BinaryIO, what: str, path: str) -> None:
        super().__init__()
        self.out, self.what, self.path = out, what, path
        self._gdal = needed("pyogrio", "gis", "GeoPackage, FlatGeobuf and Shapefile")

    def gdal_write(self, out: io.BytesIO | Path, columns: Mapping[str, TypedColumn], **options: Any) -> None:
        """Write a file of a driver of GDAL."""
        geometry = self.geometry
        has_times = {name: np.full(len(each.values), _UTC, np.int32) for name, each in columns.items() if each.is_utc}
        with _settings(self._gdal), _explained(self._gdal, self.path):
            self._gdal.raw.write(
                out,
                shapely.to_wkb(geometry) if self.is_of_features else None,
                [each.values for each in columns.values()],
                list(columns),
                field_mask=[each.missing if each.missing.any() else None for each in columns.values()],
                layer=self.what,
                geometry_type=common_kind(geometry),
                crs=crs_text(self.crs),
                gdal_tz_offsets=has_times or None,
                **options,
            )


def move_into(path: Path, out: BinaryIO) -> None:
    """Write the bytes of a file, and remove it."""
    out.write(path.read_bytes())
    path.unlink()


@contextmanager
def _explained(gdal: Any, path: str) -> Iterator[None]:
    """Turn what GDAL says of a disk, or of what a format does not hold, into an `OutputError` that names the output."""
    kinds = (gdal.errors.DataSourceError, gdal.errors.DataLayerError, gdal.errors.FeatureError)
    try:
        yield
    except kinds as error:
        is_full = os.strerror(errno.ENOSPC) in str(error)
        raise failure(path, OSError(errno.ENOSPC if is_full else 0, str(error)), current_rules().option) from error


@contextmanager
def _settings(gdal: Any) -> Iterator[None]:
    """Make the bytes depend on nothing but the features; what GDAL says of names that it shortens is not passed on."""
    before = {name: gdal.get_gdal_config_option(name) for name in _FIXED}
    gdal.set_gdal_config_options(_FIXED)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield
    finally:
        gdal.set_gdal_config_options(before)


def common_kind(geometry: NDArray[np.object_]) -> str:
    """Give the one kind of all geometry, several of which may be one; Unknown where there is no such."""
    kinds = {each.geom_type for each in geometry if each is not None}
    single = {kind.removeprefix("Multi") for kind in kinds}
    if not single:
        return "Polygon"  # of nothing, since there must be one
    if len(single) != 1:
        return "Unknown"
    return kinds.pop() if len(kinds) == 1 else f"Multi{single.pop()}"
