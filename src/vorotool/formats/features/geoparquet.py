"""GeoParquet, whose geometry is well-known binary; and plain Parquet, whose rows are points."""

from __future__ import annotations

import io
from typing import Any

import numpy as np

from vorotool.errors import InputError, LimitError
from vorotool.formats.features.feature_table import Features
from vorotool.formats.io.limits import decoding
from vorotool.formats.io.sources import Source
from vorotool.geometry.crs import LONGITUDE_LATITUDE, crs_member, member_of_text
from vorotool.geometry.curves.well_known import geometry_of_binary
from vorotool.geometry.extras import needed

_TITLE = "Parquet"
_MOST_BYTES = 1 << 35
"""Of what a file unpacks to, as it says itself."""


def features_of(source: Source) -> Features:
    """Read all rows.

    Raises
    ------
    InputError
        If there is no geometry, or in another encoding than well-known binary.
    UsageError
        If pyarrow is not installed.
    """
    with decoding(source.name, _TITLE):
        columns, document = _columns(source)
        if document is None:
            no_geometry = np.full(len(next(iter(columns.values()), [])), None, dtype=object)
            return Features(source.name, no_geometry, columns, is_table=True)
        name = document["primary_column"]
        described = document["columns"][name]
        if described.get("encoding") != "WKB":
            raise InputError(
                f"{source.name}: its geometry is encoded as {described.get('encoding')}, but WKB is read: write it "
                "anew, as geopandas does by default"
            )
        others = [each for each in document["columns"] if each != name]
        geometry, curves = geometry_of_binary(written := columns.pop(name), source.flatten)
        bad = next((row for row, each in enumerate(written) if each is not None and geometry[row] is None), None)
        if bad is not None:
            raise InputError(f"{source.name}: the geometry of row {bad + 1} is not WKB; is the file damaged?")
        kept = {each: values for each, values in columns.items() if each not in others}
        ids = kept.pop("id", None) if document.get("vorotool_ids") else None
    return Features(source.name, geometry, kept, ids, _crs(described), curves=curves)


def _columns(source: Source) -> tuple[dict[str, list[Any]], Any]:
    """The columns as lists, and what the file says of its geometry."""
    import orjson

    parquet = needed("pyarrow.parquet", "gis", f"{_TITLE} files")
    with parquet.ParquetFile(io.BytesIO(source.data)) as file:
        groups = (file.metadata.row_group(index) for index in range(file.metadata.num_row_groups))
        size = sum(group.total_byte_size for group in groups)
        if size > _MOST_BYTES:
            raise LimitError(f"{source.name} unpacks to {size} bytes, more than {_MOST_BYTES}: split it")
        table = file.read()
    said = (table.schema.metadata or {}).get(b"geo")
    columns = {name: column.to_pylist() for name, column in zip(table.column_names, table.columns, strict=True)}
    return columns, None if said is None else orjson.loads(said)


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
