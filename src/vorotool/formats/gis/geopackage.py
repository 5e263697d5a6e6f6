"""GeoPackage, read and written by Python's own SQLite, which changes no file and stops where it is told to.

GDAL would write its journal beside the file, and run views for as long as these take.
"""

from __future__ import annotations

import errno
import io
import os
import shutil
import sqlite3
import tempfile
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from contextlib import closing, contextmanager, suppress
from datetime import date, datetime
from itertools import count
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from vorotool.errors import INPUT_FORMAT, OUTPUT, OVERWRITE, InputError, LimitError, OutputError, warn
from vorotool.formats.gis.feature_table import TABLE, Features, checked_geometry, chosen_layer, layer_fault
from vorotool.formats.gis.feature_writer import GdalFeatures, TypedColumn, move_into
from vorotool.formats.io.atomic_output import current_rules, failure
from vorotool.formats.io.sources import Source, check_unpacked, decoding, interruptible, read_source
from vorotool.formats.io.temporaries import committed_together, new_folder
from vorotool.formats.parsing.reader_options import ReadOptions
from vorotool.numeric.crs import member_of_text

MAGIC = b"SQLite format 3\0"
JOURNALS = ("-wal", "-journal")
"""What the names of files end with that hold what is not yet in the database, or no longer."""

_FORMAT_VERSIONS = slice(18, 20)
"""Bytes that say whether the file has a journal ahead (2), which one in memory cannot have."""
_STEP = 10_000
"""Instructions of SQLite after which it asks whether to go on."""
_STEPS, _STEPS_A_BYTE = 20_000_000, 200
"""Instructions that a layer may take: tables take a few for each byte of the file, views may join them."""
_BATCH = 2048
_CELL = 32
"""Bytes of memory that a value takes at least."""
_ENVELOPES = (0, 32, 48, 48, 64)
"""Bytes of the bounds before the geometry, by three bits of its flags."""
_UNDEFINED = (-1, 0, 99999)
"""Numbers of systems that say nothing."""
_ATTRIBUTES = ("attributes", "aspatial")
"""What tables without geometry are registered as; the second by GDAL, before there was the first."""
_AUTHORITIES = ("EPSG", "ESRI", "OGC")
_FEATURE_IDS = ("fid", "ogc_fid")
_GEOMETRY_KINDS = ("GEOMETRY", "POINT", "LINESTRING", "POLYGON", "CURVE", "SURFACE", "CIRCULARSTRING", "COMPOUNDCURVE")


class _Layer(NamedTuple):
    """A table or view of features, the column of its geometry, and the number of its reference system."""

    table: str
    column: str
    system: int
    kind: str


class _Column(NamedTuple):
    """A column by its name and what it is declared as, in capital letters without a width."""

    name: str
    kind: str
    is_key: bool
    is_made: bool


def features_of(source: Source) -> Features:
    """Read a layer: the one that is wanted, or the only one."""
    if not source.data.startswith(MAGIC):
        raise InputError(
            f"{source.name} is not a GeoPackage: its first bytes are those of another format; name its format with "
            f"{INPUT_FORMAT}"
        )
    with decoding(source.name, "GeoPackage"):
        return interruptible(lambda: _read(source))


def layers_of(source: Source) -> list[str]:
    """Give the names of all tables of a GeoPackage that are registered, those without geometry too."""
    with decoding(source.name, "GeoPackage"), _connected(source) as database:
        return list(_registered(database))


def _registered(database: sqlite3.Connection) -> dict[str, str | None]:
    """Give the names of all tables that are registered, and which are tables of attributes."""
    rows = database.execute("SELECT table_name, data_type FROM gpkg_contents ORDER BY rowid")
    return {name: TABLE if kind in _ATTRIBUTES else None for name, kind in rows}


def has_index(path: Path, layer: str) -> bool:
    """Return whether a layer of a GeoPackage that was just written has a spatial index, which is written last."""
    with closing(sqlite3.connect(path)) as database:
        found = database.execute("SELECT count(*) FROM gpkg_extensions WHERE table_name = ?", (layer,)).fetchone()
        return bool(found[0])


def check_layers(path: str, written: Collection[str], *, overwrite: bool = False) -> None:
    """Refuse to replace a GeoPackage that holds more than the layers written, or that is being written to."""
    journal = next((path + ending for ending in JOURNALS if Path(path + ending).exists()), None)
    if journal is not None:
        raise OutputError(
            f"{path} is being written by another program ({journal}): close it there, or choose another name with "
            f"{OUTPUT}"
        )
    if overwrite or not Path(path).is_file():
        return
    with suppress(InputError):  # what is no GeoPackage has no layers
        others = [name for name in layers_of(read_source(path)) if name not in written]
        if others:
            raise OutputError(
                f"{path} holds the layers {', '.join(others)}, which would be lost: choose another name with {OUTPUT}, "
                f"or replace the file with {OVERWRITE}"
            )


def _read(source: Source) -> Features:
    with _connected(source) as database:
        layers = {layer.table: layer for layer in _layers(source, database)}
        kinds: dict[str, str | None] = dict.fromkeys(layers, "geometry")
        kinds |= {name: kind for name, kind in _registered(database).items() if name not in layers}
        chosen = list(kinds)[chosen_layer(source, list(kinds.items()))]
        if chosen in layers:
            return _features(source, database, layers[chosen])
        return _table(source, database, chosen, layer_fault(source, chosen, kinds))


# ---- the database --------------------------------------------------------------------------------
@contextmanager
def _connected(source: Source) -> Iterator[sqlite3.Connection]:
    """Open the bytes of a database in memory; of one that is being written a copy with its journal."""
    beside = [Path(source.name + ending) for ending in JOURNALS] if source.is_file else []
    with tempfile.TemporaryDirectory() as folder:
        if any(each.exists() for each in beside):
            database = sqlite3.connect(_copied(Path(source.name), beside, Path(folder)))
        else:
            database = sqlite3.connect(":memory:")
        with closing(database):
            if not any(each.exists() for each in Path(folder).iterdir()):
                data = bytearray(source.data)
                data[_FORMAT_VERSIONS] = b"\1\1"
                database.deserialize(bytes(data))
            _restrict(database, len(source.data))
            yield database


def _copied(path: Path, beside: Sequence[Path], folder: Path) -> Path:
    """Copy a database and its journals, once more where these change meanwhile."""
    for _ in range(3):
        before = [(each.stat().st_mtime_ns, each.stat().st_size) for each in (path, *beside) if each.exists()]
        for each, ending in zip((path, *beside), ("", *JOURNALS), strict=True):
            if each.exists():
                shutil.copyfile(each, folder / f"copy{ending}")
        if before == [(each.stat().st_mtime_ns, each.stat().st_size) for each in (path, *beside) if each.exists()]:
            break
    return folder / "copy"


def _restrict(database: sqlite3.Connection, size: int) -> None:
    """Let nothing in the file do more than hold values: no functions with effects, no values larger than it is."""
    database.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, min(size + (1 << 20), 2**31 - 1))
    database.setlimit(sqlite3.SQLITE_LIMIT_LIKE_PATTERN_LENGTH, 100)
    database.execute("PRAGMA trusted_schema = OFF")
    database.execute("PRAGMA cell_size_check = ON")
    database.text_factory = lambda data: data.decode("utf-8", "replace")
    left = (_STEPS + _STEPS_A_BYTE * size) // _STEP

    def is_over() -> bool:
        nonlocal left
        left -= 1
        return left < 0

    database.set_progress_handler(is_over, _STEP)


def _layers(source: Source, database: sqlite3.Connection) -> list[_Layer]:
    tables = {
        name.lower() for (name,) in database.execute("SELECT name FROM sqlite_master WHERE type IN ('table', 'view')")
    }
    if not {"gpkg_contents", "gpkg_geometry_columns"} <= tables:
        advice = f"convert it: ogr2ogr {Path(source.name).with_suffix('.gpkg').name} {source.name}"
        if "gpkg_contents" in tables:
            return []
        raise InputError(
            f"{source.name} is a SQLite database, but not a GeoPackage (it has no gpkg_contents): {advice}"
        )
    query = (
        "SELECT c.table_name, g.column_name, g.srs_id, g.geometry_type_name "
        "FROM gpkg_contents c JOIN gpkg_geometry_columns g "
        "ON lower(c.table_name) = lower(g.table_name) WHERE c.data_type = 'features' ORDER BY c.rowid"
    )
    return [_Layer(*row) for row in database.execute(query)]


def _columns_of(database: sqlite3.Connection, table: str) -> list[_Column]:
    rows = database.execute(f"PRAGMA table_xinfo({_quoted(table)})").fetchall()
    return [_Column(row[1], str(row[2]).upper().split("(")[0].strip(), row[5] == 1, row[6] > 1) for row in rows]


def _quoted(name: str) -> str:
    return '"' + name.replace('"', '""') + '"'


# ---- features ------------------------------------------------------------------------------------
def _features(source: Source, database: sqlite3.Connection, layer: _Layer) -> Features:
    columns = _columns_of(database, layer.table)
    geometry = next((each for each in columns if each.name.lower() == str(layer.column).lower()), None)
    if geometry is None:
        raise InputError(f"{source.name}: the layer {layer.table!r} has no geometry column {layer.column!r}")
    ids, attributes, (blobs,) = _attributes(source, database, layer.table, columns, [geometry])
    binary = [None if blob is None else _well_known(source, blob, row) for row, blob in enumerate(blobs, 1)]
    shapes, curves = checked_geometry(source, binary)
    system = _system(database, layer.system)
    return Features(source.name, shapes, attributes, ids, system, curves=curves, kind=str(layer.kind))


def _table(source: Source, database: sqlite3.Connection, table: str, fault: str) -> Features:
    """Read a table without geometry."""
    ids, attributes, _ = _attributes(source, database, table, _columns_of(database, table))
    columns = attributes if ids is None else {"id": ids, **attributes}
    rows = len(next(iter(columns.values()), []))
    return Features(source.name, np.full(rows, None, dtype=object), columns, has_none=fault)


def _attributes(
    source: Source,
    database: sqlite3.Connection,
    table: str,
    columns: Sequence[_Column],
    geometry: Sequence[_Column] = (),
) -> tuple[list[Any] | None, dict[str, list[Any]], list[list[Any]]]:
    """Read the ids of rows, None where these are their numbers; their attributes; and the columns of geometry."""
    key = next((each for each in columns if each.is_key), None)
    key = key or next((each for each in columns if each.name.lower() in _FEATURE_IDS), None)
    kept = [each for each in columns if each not in (*geometry, key) and not _is_binary(each.kind)]
    keys = [key] if key else []
    read = _rows(source, database, table, [*geometry, *keys, *kept])
    ids = read[len(geometry)] if key else []
    named = zip(kept, read[len(geometry) + len(keys) :], strict=True)
    attributes = {column.name: [_converted(column.kind, value) for value in each] for column, each in named}
    return None if ids == list(range(1, len(ids) + 1)) else ids, attributes, read[: len(geometry)]


def _rows(source: Source, database: sqlite3.Connection, table: str, columns: Sequence[_Column]) -> list[list[Any]]:
    """The values of columns; what views and generated columns hold is counted, since the file does not bound it."""
    options = ReadOptions(max_sites=source.max_sites)
    is_stored = not any(column.is_made for column in columns) and _is_table(database, table)
    if is_stored:
        ((count,),) = database.execute(f"SELECT count(*) FROM {_quoted(table)}").fetchall()
        options.check_sites(source.name, count)
    names = ", ".join(_quoted(column.name) for column in columns)
    found: list[list[Any]] = [[] for _ in columns]
    size = 0
    try:
        cursor = database.execute(f"SELECT {names} FROM {_quoted(table)}")
        while batch := cursor.fetchmany(_BATCH):
            for values, taken in zip(found, zip(*batch, strict=True), strict=True):
                values.extend(taken)
            options.check_sites(source.name, len(found[0]))
            if not is_stored:
                size += sum(
                    _CELL + (len(value) if isinstance(value, str | bytes) else 0) for row in batch for value in row
                )
                check_unpacked(source.name, size, len(source.data))
    except sqlite3.OperationalError as error:
        if error.sqlite_errorcode != sqlite3.SQLITE_INTERRUPT:
            raise
        raise LimitError(
            f"{source.name}: the layer {table!r} returns more data than the file holds, as an endless view does: save "
            "its rows as a table"
        ) from None
    return found


def _is_table(database: sqlite3.Connection, table: str) -> bool:
    """Whether something is a table whose rows are in the file, and no view or virtual table."""
    query = "SELECT type, sql FROM sqlite_master WHERE lower(name) = lower(?)"
    return all(
        kind == "table" and not str(sql).upper().lstrip().startswith("CREATE VIRTUAL")
        for kind, sql in database.execute(query, (table,))
        if kind in ("table", "view")
    )


def _well_known(source: Source, blob: Any, row: int) -> bytes:
    """The well-known binary in a geometry, which has a header."""
    if not isinstance(blob, bytes) or len(blob) < 8 or not blob.startswith(b"GP") or blob[3] & 32:
        raise _geometry_error(source, row)
    envelope = blob[3] >> 1 & 7
    if envelope >= len(_ENVELOPES):
        raise _geometry_error(source, row)
    return blob[8 + _ENVELOPES[envelope] :]


def _geometry_error(source: Source, row: int) -> InputError:
    return InputError(f"{source.name}: the geometry of feature {row} cannot be read; is the file damaged?")


def _system(database: sqlite3.Connection, number: int) -> Any:
    """The reference system with a number; None where it says nothing."""
    if number in _UNDEFINED:
        return None
    query = "SELECT organization, organization_coordsys_id, definition FROM gpkg_spatial_ref_sys WHERE srs_id = ?"
    row = database.execute(query, (number,)).fetchone()
    if row is None:
        return None
    authority, code, definition = row
    if str(authority).upper() in _AUTHORITIES:
        return member_of_text(f"{str(authority).upper()}:{code}")
    return None if str(definition).lower() == "undefined" else member_of_text(str(definition))


# ---- attributes ----------------------------------------------------------------------------------
def _is_binary(kind: str) -> bool:
    """Whether a column holds bytes or geometry, which nothing else could hold."""
    return (
        kind == "BLOB"
        or kind.removeprefix("MULTI") in _GEOMETRY_KINDS
        or kind in ("GEOMETRYCOLLECTION", "CURVEPOLYGON")
    )


def _converted(kind: str, value: Any) -> Any:
    """A value as its column is declared; what is something else stays so, since SQLite holds anything anywhere."""
    if value is None or isinstance(value, bytes):
        return None
    if isinstance(value, str):
        convert = _TIMES.get(kind)
        try:
            return value if convert is None else convert(value)
        except ValueError:
            return value
    if kind == "BOOLEAN":
        return bool(value)
    if kind in _FLOATS:
        return float(value)
    return str(value) if kind in _TEXTS else value


_TIMES: dict[str, Callable[[str], Any]] = {"DATE": date.fromisoformat, "DATETIME": datetime.fromisoformat}
_FLOATS = ("FLOAT", "DOUBLE", "REAL")
_TEXTS = ("TEXT",)


# ---- writing -------------------------------------------------------------------------------------
class GeoPackage(GdalFeatures):
    """A layer of a GeoPackage, which is called as the result is."""

    def finish(self) -> None:
        """Write the file, with the layers of results that were written to the same place."""
        columns = self._distinct(self.columns())
        taken = {name.lower() for name in columns}
        options = {
            "FID": next(name for name in ("fid", "ogc_fid", "voro_fid") if name not in taken),
            "GEOMETRY_NAME": next(name for name in ("geom", "geometry", "voro_geom") if name not in taken),
        }
        whole = Path(os.path.realpath(self.path))
        with committed_together() as commit:
            earlier = commit.placements.get(str(whole))
            if earlier is not None and earlier.temporary is not None:
                place = Path(commit.make(whole, new_folder).path) / "layers.gpkg"
                shutil.copyfile(earlier.temporary.path, place)
                self.gdal_write(place, columns, driver="GPKG", layer_options=options)
                if self.is_of_features and not has_index(place, self.what):  # GDAL says nothing of a full disk
                    raise failure(self.path, OSError(errno.ENOSPC, os.strerror(errno.ENOSPC)), current_rules().option)
                move_into(place, self.out)
                return
        out = io.BytesIO()
        self.gdal_write(out, columns, driver="GPKG", layer_options=options)
        self.out.write(out.getbuffer())

    def _distinct(self, columns: Mapping[str, TypedColumn]) -> dict[str, TypedColumn]:
        """Add numbers to names that differ from others by the case of letters alone, which are one in SQL."""
        made: dict[str, TypedColumn] = {}
        taken, renamed = {name.lower() for name in columns}, []
        for name, column in columns.items():
            own = name
            if name.lower() in map(str.lower, made):
                own = next(each for k in count(2) if (each := f"{name}_{k}").lower() not in taken)
                taken.add(own.lower())
                renamed.append(f"{name} is {own}")
            made[own] = column
        if renamed:
            warn(f"{self.path}: names of columns in a GeoPackage differ by more than case: {'; '.join(renamed)}")
        return made
