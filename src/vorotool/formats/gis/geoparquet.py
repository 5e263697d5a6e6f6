"""GeoParquet, whose geometry is well-known binary; and plain Parquet, whose rows are points."""

from __future__ import annotations

import io
from typing import Any, BinaryIO

import numpy as np

from vorotool.convert.extras import needed
from vorotool.errors import InputError
from vorotool.formats.gis.feature_table import Features, checked_geometry
from vorotool.formats.gis.feature_writer import FeatureRows, TypedColumn
from vorotool.formats.io.sources import Source, check_unpacked, decoding
from vorotool.formats.parsing.reader_options import ReadOptions
from vorotool.numeric.crs import LONGITUDE_LATITUDE, crs_member, crs_text, member_of_text

_TITLE = "Parquet"
_BATCH = 4096
_CELL = 32
"""Bytes of memory that a value takes at least."""


def features_of(source: Source) -> Features:
    """Read all rows."""
    with decoding(source.name, _TITLE):
        columns, document = _columns(source)
        if document is None:
            no_geometry = np.full(len(next(iter(columns.values()), [])), None, dtype=object)
            return Features(source.name, no_geometry, columns, has_none=f"{source.name} has no geometry")
        name = document["primary_column"]
        described = document["columns"][name]
        if described.get("encoding") != "WKB":
            raise InputError(
                f"{source.name}: its geometry is encoded as {described.get('encoding')}, but only WKB is supported: "
                "write the file again with WKB, the default of geopandas"
            )
        others = [each for each in document["columns"] if each != name]
        fault = "{}: the geometry of row {} is not WKB; is the file damaged?"
        geometry, curves = checked_geometry(source, columns.pop(name), fault)
        kept = {each: values for each, values in columns.items() if each not in others}
        ids = kept.pop("id", None) if document.get("vorotool_ids") else None
    return Features(source.name, geometry, kept, ids, _crs(described), curves=curves)


def _columns(source: Source) -> tuple[dict[str, list[Any]], Any]:
    """The columns as lists, and what the file says of its geometry; values are counted before they are made."""
    import orjson

    parquet = needed("pyarrow.parquet", "gis", f"{_TITLE} files")
    with parquet.ParquetFile(io.BytesIO(source.data)) as file:
        about, schema, repeated = file.metadata, file.schema_arrow, _repeated(file.schema)
    ReadOptions(max_sites=source.max_sites).check_sites(source.name, about.num_rows)
    groups = [about.row_group(index) for index in range(about.num_row_groups)]
    cells = _CELL * about.num_rows * max(about.num_columns, 1)
    check_unpacked(source.name, cells + sum(group.total_byte_size for group in groups), len(source.data))
    found: list[list[Any]] = [[] for _ in schema.names]
    size = 0
    with parquet.ParquetFile(io.BytesIO(source.data), read_dictionary=repeated) as file:
        for batch in file.iter_batches(_BATCH):
            size += sum(map(_size, batch.columns))
            check_unpacked(source.name, size, len(source.data))
            for values, column in zip(found, batch.columns, strict=True):
                values.extend(column.to_pylist())
    said = (schema.metadata or {}).get(b"geo")
    return dict(zip(schema.names, found, strict=True)), None if said is None else orjson.loads(said)


def _repeated(schema: Any) -> list[str]:
    """Return the columns of bytes, of which a value may stand for many rows: they stay so until they are counted."""
    columns = (schema.column(index) for index in range(len(schema)))
    return [column.path for column in columns if column.physical_type == "BYTE_ARRAY"]


def _size(array: Any) -> int:
    """Bytes that an array of Arrow becomes as a list."""
    arrow = needed("pyarrow", "gis", f"{_TITLE} files")
    if arrow.types.is_dictionary(array.type):
        compute = needed("pyarrow.compute", "gis", f"{_TITLE} files")
        lengths = compute.binary_length(array.dictionary).take(array.indices)
        return _CELL * len(array) + int(compute.sum(lengths).as_py() or 0)
    if arrow.types.is_list(array.type) or arrow.types.is_large_list(array.type):
        return _CELL * len(array) + _size(array.flatten())
    if arrow.types.is_struct(array.type):
        return _CELL * len(array) + sum(map(_size, array.flatten()))
    return _CELL * len(array) + int(array.nbytes)


def _crs(described: dict[str, Any]) -> Any:
    """The reference system: longitude and latitude where nothing is said, none where null is."""
    if "crs" not in described:
        return crs_member(LONGITUDE_LATITUDE)
    crs = described["crs"]
    if crs is None:
        return None
    if isinstance(crs, dict) and isinstance(crs.get("id"), dict):
        return crs_member(f"{crs['id'].get('authority')}:{crs['id'].get('code')}")
    pyproj = needed("pyproj", "gis", "coordinate reference systems of Parquet files")
    return member_of_text(pyproj.CRS.from_user_input(crs).to_wkt())


class GeoParquet(FeatureRows):
    """A Parquet file; with geometry, as GeoParquet 1.1 has it."""

    def __init__(self, out: BinaryIO, what: str, path: str) -> None:
        super().__init__()
        self._out = out
        self._parquet = needed("pyarrow.parquet", "gis", "Parquet files")
        self._arrow = needed("pyarrow", "gis", "Parquet files")

    def finish(self) -> None:
        """Write the file."""
        import orjson
        import shapely

        columns = self.columns()
        arrays = {name: self._array(each) for name, each in columns.items()}
        metadata = {}
        if self.is_of_features:
            name = next(name for name in ("geometry", "geom", "voro_geometry") if name not in columns)
            arrays[name] = self._arrow.array(shapely.to_wkb(self.geometry).tolist(), self._arrow.binary())
            metadata = {"geo": orjson.dumps(self._geo(name))}
        table = self._arrow.table(arrays).replace_schema_metadata(metadata)
        out = io.BytesIO()
        self._parquet.write_table(table, out, compression="zstd")
        self._out.write(out.getbuffer())

    def _array(self, column: TypedColumn) -> Any:
        zone = {"type": self._arrow.timestamp("ms", "UTC")} if column.is_utc else {}
        values = column.values.astype(object) if column.values.dtype.kind == "O" else column.values
        return self._arrow.array(values, mask=column.missing, **zone)

    def _geo(self, name: str) -> dict[str, Any]:
        kinds = sorted({each.geom_type for each in self.geometry if each is not None})
        described = {"encoding": "WKB", "geometry_types": kinds, "crs": self._crs()}
        return {"version": "1.1.0", "primary_column": name, "columns": {name: described}}

    def _crs(self) -> Any:
        text = crs_text(self.crs)
        if text is None:
            return None
        pyproj = needed("pyproj", "gis", "coordinate reference systems of Parquet files")
        return pyproj.CRS.from_user_input(text).to_json_dict()
