"""Files of maps, as GDAL reads them through pyogrio: FlatGeobuf, Shapefile, KML, GPX.

Only what has been told to be one of these is passed on, in memory: other formats of GDAL open further files, or a
network. Features are read one by one and not as batches of Arrow, whose offsets GDAL 3.12 has wrong for FlatGeobuf
without geometry (it then crashes); for a million polygons of nine vertices that takes 1.6 s instead of 1.3.
"""

from __future__ import annotations

import errno
import io
import os
import struct
import zipfile
from collections.abc import Collection, Mapping, Sequence
from contextlib import suppress
from datetime import date, datetime
from functools import partial
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool.convert.extras import needed
from vorotool.errors import INPUT_FORMAT, InputError, LimitError, OutputError, UsageError, option, warn
from vorotool.formats.gis.feature_table import Features, checked_geometry, chosen_layer
from vorotool.formats.gis.feature_writer import GdalFeatures, TypedColumn, common_kind, move_into
from vorotool.formats.io.atomic_output import (
    Rules,
    check_output,
    current_rules,
    explained,
    failure,
    followed,
    open_output,
)
from vorotool.formats.io.descriptors import stream_kind
from vorotool.formats.io.sources import Source, check_unpacked, decoding, interruptible
from vorotool.formats.io.temporaries import Placement, committed_together, new_folder
from vorotool.formats.parsing.reader_options import ReadOptions
from vorotool.formats.recognition import format_of
from vorotool.numeric.crs import member_of_text

TITLES = {"fgb": "FlatGeobuf", "shp": "Shapefile", "kml": "KML", "gpx": "GPX"}
"""Formats and what they are called."""

_TIMES = {"OFTDate": date, "OFTDateTime": datetime}
_BYTES = "OFTBinary"
_COUNT_FIELD, _SMALLEST = 8, 8
"""Which field of the header of a FlatGeobuf counts its features, and bytes that each has at least."""


def features_of(source: Source) -> Features:
    """Read a layer: the one that is wanted, or the only one."""
    title = TITLES[source.format]
    # GDAL takes a file for what it begins as, whatever it is called, and some formats name others
    if format_of(source.data) not in (source.format, "npz" if source.format == "shp" else source.format):
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
    geometry, curves = checked_geometry(source, wkb.tolist())
    crs, kind = member_of_text(meta["crs"]), str(meta["geometry_type"])
    return Features(source.name, geometry, columns, None, crs, curves=curves, kind=kind)


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


PARTS = (".shp", ".shx", ".dbf", ".prj", ".cpg")
"""Extensions of the files, the one that is named first: geometry, index, attributes, reference system, encoding."""

_OF_OLDER = {*PARTS, ".sbn", ".sbx", ".fbn", ".fbx", ".ain", ".aih", ".idm", ".ind", ".qix", ".qpj"}
"""Extensions of files that hold for one content of a Shapefile: the parts, and indexes that other programs make."""

ZIP_MAGIC = b"PK\x03\x04"
_RECORD, _HEADER = 8, 100
"""Bytes of an entry of the index, and of what is before the first one."""

_MOST_LAYERS = 100
"""Shapefiles in an archive: all of them are opened to tell which there are."""


def archive_of(source: Source) -> bytes:
    """Give a ZIP archive of a Shapefile: what is beside the ``.shp`` that is named, or the archive that is."""
    if source.data.startswith(ZIP_MAGIC):
        with zipfile.ZipFile(io.BytesIO(source.data)) as archive:
            entries = [entry for entry in archive.infolist() if Path(entry.filename).suffix.lower() in PARTS]
            entries = [entry for entry in entries if Path(entry.filename).stem == source.layer] or entries
            layers = sum(entry.filename.lower().endswith(".shp") for entry in entries)
            if layers > _MOST_LAYERS:
                raise LimitError(
                    f"{source.name} holds {layers} Shapefiles, more than {_MOST_LAYERS}: unpack it and name one of "
                    f"them, or choose one by {option('--input-layer', 'layer=...')}"
                )
            size = sum(entry.file_size for entry in entries)
            check_unpacked(source.name, size, len(source.data))
            return _archived(source, {Path(entry.filename).name: archive.read(entry) for entry in entries})
    if not source.is_file:
        raise InputError(
            f"{source.name} is the .shp of a Shapefile, which is several files: name it as a file, or give all of them "
            "as one .zip"
        )
    path = Path(source.name)
    beside = {f"{path.stem}{extension}": part.read_bytes() for extension, part in _beside(path).items()}
    return _archived(source, {f"{path.stem}.shp": source.data, **beside})


def _archived(source: Source, parts: Mapping[str, bytes]) -> bytes:
    """Give an archive of nothing but these: GDAL looks at all that is in one."""
    for stem in dict.fromkeys(Path(name).stem for name in parts):
        own = {Path(name).suffix.lower(): data for name, data in parts.items() if Path(name).stem == stem}
        _check_sizes(source, own)
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_STORED) as archive:
        for name, data in parts.items():
            archive.writestr(name, data)
    return out.getvalue()


def _check_sizes(source: Source, parts: Mapping[str, bytes]) -> None:
    """Refuse an index of shapes, or a table, that announces more than its file holds."""
    index, table = parts.get(".shx", b""), parts.get(".dbf", b"")
    count = max(len(index) - _HEADER, 0) // _RECORD
    ReadOptions(max_sites=source.max_sites).check_sites(source.name, count)
    entries = np.frombuffer(index, ">u4", 2 * count, _HEADER) if count else np.empty(0, np.uint32)
    shapes = 2 * int(entries[1::2].sum(dtype=np.int64))
    rows, before, width = struct.unpack_from("<IHH", table, 4) if len(table) >= 12 else (0, 0, 0)
    if shapes > len(parts.get(".shp", b"")) or before + rows * width > len(table) + _HEADER:
        raise InputError(
            f"{source.name}: its index or its table states more records than the file holds; is it damaged or cut off?"
        )


def _beside(path: Path) -> dict[str, Path]:
    """The other parts, whose extensions may be in any case."""
    found = {each.suffix.lower(): each for each in path.parent.iterdir() if each.stem == path.stem and each != path}
    parts = {extension: found[extension] for extension in PARTS[1:] if extension in found}
    missing = [extension for extension in (".shx", ".dbf") if extension not in parts]
    if missing:
        raise InputError(
            f"{path} is a part of a Shapefile, whose {' and '.join(missing)} {'are' if len(missing) > 1 else 'is'} not "
            "beside it: copy all of its files together"
        )
    return parts


def holds_shapefile(data: bytes) -> bool:
    """Whether data is a ZIP archive in which there is a ``.shp``."""
    if not data.startswith(ZIP_MAGIC):
        return False
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            return any(name.lower().endswith(".shp") for name in archive.namelist())
    except Exception:  # who reads it says what is wrong: zipfile raises nearly everything on damaged bytes
        return False


def check_parts(path: str, rules: Rules, *, makes_folder: bool = False) -> None:
    """Find out before any work whether the other files of a Shapefile can be written and older ones replaced."""
    whole = Path(path)
    for name in (path, *(str(whole.with_suffix(extension)) for extension in PARTS[1:])):
        if stream_kind(name) is not None:
            raise UsageError(
                f"a Shapefile is several files, which the stream {name} cannot hold: name a file with {rules.option}, "
                "or write a GeoPackage (.gpkg)"
            )
    target = Path(followed(path))
    for extension in PARTS[1:]:
        part, real = whole.with_suffix(extension), target.with_suffix(extension)
        check_output(part, binary=True, makes_folder=makes_folder, **rules._asdict())
        if whole.is_symlink() and real.exists() and followed(str(part)) != str(real):
            raise OutputError(
                f"{path} is a link to a Shapefile whose {real.name} would not be replaced: give {rules.option} {target}"
            )
    for older in older_parts(whole, ()):
        rules.check(str(older))


def older_parts(path: Path, written: Collection[str]) -> list[Path]:
    """Files of an older Shapefile, besides those whose extensions are written; extensions may be in any case."""
    with suppress(OSError):
        names = {f"{path.stem}{extension}" for extension in written}
        beside = [each for each in path.parent.iterdir() if each.stem == path.stem and each.suffix.lower() in _OF_OLDER]
        return sorted(each for each in beside if each.name not in names and not each.is_dir())
    return []


def is_whole(path: Path, count: int) -> bool:
    """Return whether all parts of a Shapefile have the sizes that follow from their headers."""
    shp, shx, dbf, prj, cpg = map(path.with_suffix, PARTS)
    if not all(part.exists() and part.stat().st_size >= 100 for part in (shp, shx)):
        return False
    with shp.open("rb") as file:
        words = int.from_bytes(file.read(28)[24:], "big")
    with dbf.open("rb") as file:
        header = file.read(12)
    rows, start, width = (int.from_bytes(header[a:b], "little") for a, b in ((4, 8), (8, 10), (10, 12)))
    sizes = {shp: 2 * words, shx: 100 + 8 * count}
    return (
        all(part.stat().st_size == size for part, size in sizes.items())
        and len(header) == 12
        and rows == count
        and dbf.stat().st_size >= start + rows * width
        and all(part.stat().st_size > 0 for part in (prj, cpg) if part.exists())
        and (not prj.exists() or prj.read_bytes().rstrip().endswith(b"]"))
    )


class Shapefile(GdalFeatures):
    """A Shapefile: what is written is its ``.shp``, and its other files are made beside that."""

    def __init__(self, out: BinaryIO, what: str, path: str) -> None:
        super().__init__(out, what, path)
        check_parts(path, current_rules())

    def finish(self) -> None:
        """Write the files."""
        held = ", ".join(sorted({each.geom_type for each in self.geometry if each is not None}))
        if held and common_kind(self.geometry) in ("Unknown", "GeometryCollection"):
            raise OutputError(
                f"{self.path} cannot be written: a Shapefile holds geometry of one kind, but this is {held}; write a "
                "GeoPackage (.gpkg)"
            )
        rules, whole = current_rules(), Path(self.path)
        with committed_together() as commit:
            place = Path(commit.make(os.path.realpath(whole), new_folder).path) / "layer.shp"
            columns, options = self.columns(), {"DBF_DATE_LAST_UPDATE": "1970-01-01"}
            self.gdal_write(place, columns, driver="ESRI Shapefile", layer_options=options)
            if not is_whole(place, len(self.geometry)):
                raise failure(self.path, OSError(errno.ENOSPC, os.strerror(errno.ENOSPC)), rules.option)
            self._warn_of_losses(place, columns)
            written = [extension for extension in PARTS if place.with_suffix(extension).exists()]
            for older in older_parts(whole, written):
                target = os.path.join(os.path.realpath(older.parent), older.name)  # noqa: PTH118, as commits have it
                explain, check = partial(explained, str(older), rules.option), partial(rules.check, str(older))
                commit.placements[target] = Placement(None, explain, check)
            for extension in written[1:]:
                with open_output(whole.with_suffix(extension), binary=True, **rules._asdict()) as out:
                    move_into(place.with_suffix(extension), out)
            move_into(place, self.out)

    def _warn_of_losses(self, place: Path, columns: Mapping[str, TypedColumn]) -> None:
        """Warn of names and values that a Shapefile cannot hold, by reading those that it holds."""
        if not columns:
            return
        names, values = self._attributes(place)
        shortened = [f"{name} is {short}" for name, short in zip(columns, names, strict=True) if name != short]
        pairs = zip(columns.items(), values, strict=True)
        changed = [name for (name, column), held in pairs if _differs(column, held)]
        if shortened or changed:
            losses = [*shortened, *([f"values of {', '.join(changed)} differ"] if changed else [])]
            warn(
                f"{self.path}: a Shapefile has names of 10 bytes, texts of 254 and numbers of at most 15 decimals: "
                f"{'; '.join(losses)}; a GeoPackage (.gpkg) keeps them"
            )

    def _attributes(self, place: Path) -> tuple[list[str], list[NDArray[Any]]]:
        meta, _, _, values = self._gdal.raw.read(place, read_geometry=False)
        return list(meta["fields"]), values


MOST_LOSS = 1e-9
"""Part of a number that a Shapefile may change without a warning."""


def _differs(column: TypedColumn, held: NDArray[Any]) -> bool:
    """Tell whether a column is another one after it is read back; times are text in a Shapefile."""
    is_there = ~column.missing if column.values.dtype.kind != "O" else ~column.missing & (column.values != "")
    own, held = column.values[is_there], held[is_there]
    if own.dtype.kind == "M":
        return False
    if own.dtype.kind == "f":
        is_number = np.isfinite(own)
        own, held = own[is_number], held[is_number].astype(np.float64)
        return bool((np.abs(own - held) > MOST_LOSS * np.abs(own)).any())
    return not np.array_equal(own, held.astype(own.dtype))
