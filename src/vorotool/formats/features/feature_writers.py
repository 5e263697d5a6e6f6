"""Writing results as files of maps: GeoPackage, FlatGeobuf and Shapefile through GDAL, GeoParquet through pyarrow."""

from __future__ import annotations

import errno
import io
import os
import shutil
import warnings
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool.convert.extras import needed
from vorotool.errors import OutputError
from vorotool.formats.features.feature_rows import FeatureRows, TypedColumn
from vorotool.formats.features.geopackage import has_index
from vorotool.formats.features.shapefile_parts import PARTS, check_parts, is_whole, older_parts, removal
from vorotool.formats.io.atomic_output import current_rules, failure, open_output
from vorotool.formats.io.commit import committed_together
from vorotool.formats.io.temporaries import new_folder
from vorotool.numeric.crs import crs_text

_FIXED = {"OGR_CURRENT_DATE": "1970-01-01T00:00:00.000Z"}
"""Options of GDAL that make the same bytes of the same features."""
_UTC = 100  # GDAL's number of the zone


class GeoPackage(FeatureRows):
    """A layer of a GeoPackage, which is called as the result is."""

    def __init__(self, out: BinaryIO, what: str, path: str) -> None:
        super().__init__()
        self._out, self._what, self._path = out, what, path
        self._gdal = needed("pyogrio", "gis", "GeoPackage, FlatGeobuf and Shapefile")

    def finish(self) -> None:
        """Write the file, with the layers of results that were written to the same place."""
        columns = self.columns()
        taken = {name.lower() for name in columns}
        options = {
            "FID": next(name for name in ("fid", "ogc_fid", "voro_fid") if name not in taken),
            "GEOMETRY_NAME": next(name for name in ("geom", "geometry", "voro_geom") if name not in taken),
        }
        whole = Path(os.path.realpath(self._path))
        with committed_together() as commit:
            earlier = commit.pending(whole)
            if earlier is not None:
                place = commit.temporaries.make(whole, new_folder).path / "layers.gpkg"
                shutil.copyfile(earlier, place)
                self._write(place, columns, driver="GPKG", layer_options=options)
                if self.is_of_features and not has_index(place, self._what):  # GDAL says nothing of a full disk
                    raise failure(self._path, OSError(errno.ENOSPC, os.strerror(errno.ENOSPC)), current_rules().option)
                _move(place, self._out)
                return
        out = io.BytesIO()
        self._write(out, columns, driver="GPKG", layer_options=options)
        self._out.write(out.getbuffer())

    def _write(self, out: io.BytesIO | Path, columns: Mapping[str, TypedColumn], **options: Any) -> None:
        import shapely

        geometry = self.geometry
        has_times = {name: np.full(len(each.values), _UTC, np.int32) for name, each in columns.items() if each.is_utc}
        with _settings(self._gdal), _explained(self._gdal, self._path):
            self._gdal.raw.write(
                out,
                shapely.to_wkb(geometry) if self.is_of_features else None,
                [each.values for each in columns.values()],
                list(columns),
                field_mask=[each.missing if each.missing.any() else None for each in columns.values()],
                layer=self._what,
                geometry_type=_kind(geometry),
                crs=crs_text(self.crs),
                gdal_tz_offsets=has_times or None,
                **options,
            )


class FlatGeobuf(GeoPackage):
    """A FlatGeobuf file, whose features are in the order of the result."""

    def finish(self) -> None:
        """Write the file."""
        out = io.BytesIO()
        self._write(out, self.columns(), driver="FlatGeobuf", layer_options={"SPATIAL_INDEX": "NO"})
        self._out.write(out.getbuffer())


class Shapefile(GeoPackage):
    """A Shapefile: what is written is its ``.shp``, and its other files are made beside that."""

    def __init__(self, out: BinaryIO, what: str, path: str) -> None:
        super().__init__(out, what, path)
        check_parts(path, current_rules())

    def finish(self) -> None:
        """Write the files."""
        held = ", ".join(sorted({each.geom_type for each in self.geometry if each is not None}))
        if held and _kind(self.geometry) in ("Unknown", "GeometryCollection"):
            raise OutputError(
                f"{self._path} cannot be written: a Shapefile holds geometry of one kind, but this is {held}; write a "
                "GeoPackage (.gpkg)"
            )
        rules, whole = current_rules(), Path(self._path)
        with committed_together() as commit:
            place = commit.temporaries.make(Path(os.path.realpath(whole)), new_folder).path / "layer.shp"
            self._write(
                place, self.columns(), driver="ESRI Shapefile", layer_options={"DBF_DATE_LAST_UPDATE": "1970-01-01"}
            )
            if not is_whole(place, len(self.geometry)):
                raise failure(self._path, OSError(errno.ENOSPC, os.strerror(errno.ENOSPC)), rules.option)
            written = [extension for extension in PARTS if place.with_suffix(extension).exists()]
            for older in older_parts(whole, written):
                commit.add(removal(older, rules))
            for extension in written[1:]:
                with open_output(whole.with_suffix(extension), binary=True, **rules._asdict()) as out:
                    _move(place.with_suffix(extension), out)
            _move(place, self._out)


def _move(path: Path, out: BinaryIO) -> None:
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


def _kind(geometry: NDArray[np.object_]) -> str:
    """The one kind of all geometry, several of which may be one; Unknown where there is no such."""
    kinds = {each.geom_type for each in geometry if each is not None}
    single = {kind.removeprefix("Multi") for kind in kinds}
    if not single:
        return "Polygon"  # of nothing, since there must be one
    if len(single) != 1:
        return "Unknown"
    return kinds.pop() if len(kinds) == 1 else f"Multi{single.pop()}"


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
