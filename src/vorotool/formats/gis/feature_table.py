"""Features of files of maps, whatever their format, and the points, polygons and lines that are made of them."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import field
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from vorotool.convert.sites import Sites
from vorotool.convert.tables import columns_of_features
from vorotool.errors import InputError, UsageError, option
from vorotool.formats.io.sources import STANDARD_INPUT, Source, check_nesting
from vorotool.formats.parsing.json import OF_SITES, check_cells, not_a_point_advice, not_a_shape_advice
from vorotool.formats.parsing.reader_options import ReadOptions, crs_of_numbers, no_points, shortened
from vorotool.formats.points.columns import PointRows
from vorotool.formats.points.delimited import GEOMETRY_COLUMNS, DelimitedText, delimited_text, geometry_column
from vorotool.formats.points.tables import rows_of_columns
from vorotool.frozen import frozen
from vorotool.numeric.crs import without_number
from vorotool.numeric.curves.well_known import geometry_of_binary, geometry_of_texts
from vorotool.products.formats import resolved
from vorotool.products.inputs import INPUTS
from vorotool.types.fields import UP
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.polygons.shapely_geometry import part_numbers, polygons_of_geometry, single_points

_POINTS, _SHAPES, _COLLECTION = (0, 4), (1, 2, 3, 5, 6), 7  # type numbers of GEOS


@frozen
class Features:
    """The features of one layer."""

    name: str  # the input, for messages
    geometry: NDArray[np.object_]  # (n,) object array: shapely geometry; None where a feature has none
    # attributes, one value a feature: numbers, truth values, texts, dates; None where there is none
    columns: Mapping[str, Sequence[Any]] = field(default_factory=dict)
    ids: Sequence[Any] | None = None  # the file's own names of its features
    crs: Any = None  # the `crs` member of GeoJSON
    place: Callable[[int], str] | None = None  # gives the words for a feature (0-based), for messages
    has_none: str = ""  # of a table, whose coordinates are among the columns, if anywhere: that there is no geometry
    curves: int = 0  # how many curves were flattened
    texts: Sequence[str] | None = None  # well-known text of each
    kind: str = ""  # of geometry, as the layer declares it, such as MULTIPOLYGON

    @property
    def is_table(self) -> bool:
        """Whether there is no geometry at all."""
        return bool(self.has_none)

    @property
    def holds_shapes(self) -> bool:
        """Whether the first geometry that is not empty is a polygon or a line, or a collection that begins with one.

        Where there is no such geometry, what the layer declares decides.
        """
        parts = self.geometry[~shapely.is_missing(self.geometry) & ~shapely.is_empty(self.geometry)][:1]
        while len(parts) and shapely.get_type_id(parts[0]) == _COLLECTION:
            parts = shapely.get_parts(parts)
            parts = parts[~shapely.is_empty(parts)]
        if not len(parts):
            return _SHAPE.search(self.kind.encode()) is not None
        return int(shapely.get_type_id(parts[0])) in _SHAPES

    def where(self, index: int) -> str:
        """Give the words for a feature (0-based)."""
        return f"{self.name}, feature {index + 1}" if self.place is None else self.place(index)

    def shown(self, index: int) -> str:
        """Give the words for a feature (0-based), with its text if it is one."""
        return self.where(index) + ("" if self.texts is None else f": {shortened(self.texts[index])}")


def read_polygons(source: Source, options: ReadOptions) -> PolygonSet:
    """Read polygons and lines with their attributes; features without a geometry are left out."""
    features = features_of(source)
    if features.is_table and features.columns:
        raise InputError(f"{features.has_none}; polygons or lines are expected, columns x, y are read as points")
    kept = _kept(features)
    options.note_left_out(features.name, len(features.geometry) - len(kept))
    _check_kinds(features, kept, _SHAPES, "not a polygon or line", not_a_shape_advice)
    return _shapes_of(features, kept, options)


def read_sites(source: Source, options: ReadOptions) -> Sites:
    """Read points, lines and polygons, each feature a site; one without a geometry is a site without places."""
    features = features_of(source)
    kept = _kept(features)
    options.note_empty(features.name, len(features.geometry) - len(kept))
    expected = (*_POINTS, *_SHAPES)
    _check_kinds(features, kept, expected, "not a point, line or polygon", lambda _: OF_SITES)
    polygons = _shapes_of(features, kept, options)
    known: dict[str, Any] = {}
    if options.properties:
        known["ids"] = None if features.ids is None else list(features.ids)
        known["properties"] = {name: list(values) for name, values in features.columns.items()}
    return Sites(polygons, polygons.feature, len(features.geometry), **known)


def _shapes_of(features: Features, kept: NDArray[np.int64], options: ReadOptions) -> PolygonSet:
    """Polygons, lines and points of some of the features."""
    geometry = features.geometry[kept]
    options.note_curves(features.name, features.curves)
    if shapely.has_z(geometry).any():
        options.note_heights(features.name)
    options.check_vertices(features.name, int(shapely.get_num_coordinates(geometry).sum()))

    def described(items: NDArray[np.int64]) -> dict[str, Any]:
        owners = kept[items].astype(np.int32)
        fields = {"feature": owners, "y_axis": UP, "crs": features.crs}
        if not options.properties:
            return fields
        check_cells(features.name, len(features.columns), len(owners), "polygons")
        columns = {name: _taken(values, owners) for name, values in features.columns.items()}
        ids = None if features.ids is None else _taken(features.ids, owners)
        return {**fields, "ids": ids, "properties": columns}

    try:
        return polygons_of_geometry(geometry, described, takes_points=True)
    except InputError:
        _check_finite(features, geometry, kept)
        raise


def _points(features: Features, options: ReadOptions) -> PointRows:
    """Give the points of features, those of several in one as its parts; those without a geometry are left out."""
    kept = _kept(features)
    options.note_left_out(features.name, len(features.geometry) - len(kept))
    geometry = features.geometry[kept]
    if options.axes == 2 and shapely.has_z(geometry).any():
        options.note_heights(features.name)
    _check_kinds(features, kept, _POINTS, "not a point", not_a_point_advice)
    points, items = single_points(geometry)
    owners = kept[items]
    options.check_sites(features.name, len(points))
    columns = _point_columns(features, owners) if options.properties else {}
    if not len(points):
        return PointRows(no_points(options.axes), None, columns, {"y_axis": UP, "crs": features.crs})
    _check_finite(features, geometry, kept)
    found = shapely.get_coordinates(points, include_z=options.axes == 3)
    if options.axes == 3 and not np.isfinite(found[:, 2]).all():
        owner = int(owners[int(np.argmin(np.isfinite(found[:, 2])))])
        raise InputError(f"{features.shown(owner)} has no finite z; give all points one, such as POINT Z (3 4 5)")
    return PointRows(found, None, columns, {"y_axis": UP, "crs": features.crs})


def _point_columns(features: Features, owners: NDArray[np.int64]) -> dict[str, list[Any]]:
    """The id, if there are any, the attributes, and the number of a point within its feature, if any has several."""
    check_cells(features.name, len(features.columns), len(owners), "points")
    ids = None if features.ids is None else _taken(features.ids, owners)
    columns = {name: _taken(values, owners) for name, values in features.columns.items()}
    return columns_of_features(ids, columns, part_numbers(owners).tolist())


def _taken(values: Sequence[Any], index: NDArray[np.integer]) -> list[Any]:
    return [values[i] for i in index.tolist()]


def _kept(features: Features) -> NDArray[np.int64]:
    """Features that have a geometry, which is not empty."""
    return np.flatnonzero(~shapely.is_missing(features.geometry) & ~shapely.is_empty(features.geometry))


def _check_kinds(
    features: Features,
    kept: NDArray[np.int64],
    expected: tuple[int, ...],
    is_not: str,
    advice: Callable[[str], str],
) -> None:
    """Refuse geometry of another kind; collections may hold what is expected, at any depth."""
    parts, owners = features.geometry[kept], kept
    if features.texts is not None:  # which names a kind for empty geometry, too
        parts, owners = features.geometry, np.arange(len(features.geometry))
    while len(parts):
        kinds = shapely.get_type_id(parts)
        bad = np.flatnonzero(~np.isin(kinds, (*expected, _COLLECTION)))
        if bad.size:
            kind = parts[bad[0]].geom_type
            raise InputError(f"{features.where(int(owners[bad[0]]))}: a {kind} is {is_not}; {advice(kind)}")
        nested = kinds == _COLLECTION
        parts, index = shapely.get_parts(parts[nested], return_index=True)
        owners = owners[nested][index]


def _check_finite(features: Features, geometry: NDArray[np.object_], kept: NDArray[np.int64]) -> None:
    xy, owners = shapely.get_coordinates(geometry, return_index=True)
    bad = np.flatnonzero(~np.isfinite(xy).all(axis=1))
    if bad.size:
        at = int(bad[0])
        vertex = at - int(np.searchsorted(owners, owners[at])) + 1
        owner = int(kept[owners[at]])
        raise InputError(
            f"{features.shown(owner)}: vertex {vertex} is ({xy[at, 0]}, {xy[at, 1]}): coordinates must be finite; "
            "correct it"
        )


TABLE = "table"
"""The kind of a layer without geometry whose columns can be read."""


def layer_fault(source: Source, layer: str, layers: Mapping[str, str | None]) -> str:
    """Say that a layer has no geometry, or does not exist, and which layers there are."""
    fault = "has no geometry" if layer in layers else "does not exist"
    named = [name for name, kind in layers.items() if kind not in (None, TABLE)]
    tables = [name for name, kind in layers.items() if kind == TABLE]
    held = ", ".join(named) or "none"
    others = f", those without are {', '.join(tables)}" if tables else ""
    return f"the layer {layer!r} of {source.name} {fault}: the layers with geometry are {held}{others}"


def checked_geometry(
    source: Source,
    written: Sequence[Any],
    fault: str = "{}: the geometry of feature {} cannot be read; is the file damaged?",
) -> tuple[NDArray[np.object_], int]:
    """Give the geometry of well-known binary, and how many curves were flattened; what is none is refused."""
    geometry, curves = geometry_of_binary(written, source.flatten)
    bad = next((row for row, each in enumerate(written) if each is not None and geometry[row] is None), None)
    if bad is not None:
        raise InputError(fault.format(source.name, bad + 1))
    return geometry, curves


def chosen_layer(source: Source, layers: Sequence[tuple[str, str | None]]) -> int:
    """Give the number of the layer that is wanted, or of the only one that has geometry, or else is a table."""
    numbers = {name: number for number, (name, kind) in enumerate(layers) if kind is not None}
    named = {name: number for name, number in numbers.items() if layers[number][1] != TABLE}
    if source.layer is not None:
        if source.layer not in numbers:
            raise InputError(layer_fault(source, source.layer, dict(layers)))
        return numbers[source.layer]
    named = named or numbers
    if not named:
        raise InputError(f"{source.name} holds no layer with geometry: name another file")
    if len(named) > 1:
        how = f"as {source.name}:{next(iter(named))}"
        if source.name == STANDARD_INPUT:
            how = f"by {option('--input-layer', 'layer=...')}, or save it and name it as FILE:LAYER"
        raise InputError(f"{source.name} holds {len(named)} layers: choose one of {', '.join(named)}, {how}")
    return next(iter(named.values()))


def features_of(source: Source) -> Features:
    """Give the features of a source; those that were read to tell what it holds come with it."""
    if isinstance(source.document, Features):
        return source.document
    return resolved(INPUTS[source.format].features)(source)


def read_points(source: Source, options: ReadOptions) -> PointRows:
    """Read points with their attributes; where there is no geometry, as tables have them."""
    features = features_of(source)
    if options.columns is not None and not features.is_table:
        raise UsageError(
            f"{option('--columns')} applies to tables, but the points of {source.name} have geometry: leave it out"
        )
    if features.is_table:
        return rows_of_columns(source.name, {name: list(values) for name, values in features.columns.items()}, options)
    return _points(features, options)


_COMMENT = re.compile(rb"^\s*#.*$", re.MULTILINE)
_SHAPE = re.compile(rb"POLYGON|LINESTRING|LINEARRING|CIRCULARSTRING|CURVE|SURFACE|TIN|TRIANGLE", re.IGNORECASE)
_BINARY = re.compile(r"(00|01)([0-9A-Fa-f]{2}){8,}")


def features_of_texts(source: Source) -> Features:
    """Read geometries of well-known text: each begins a line, and ends when its brackets close."""
    check_nesting(source.data, name=source.name)
    texts: list[str] = []
    lines: list[int] = []
    srids: list[int] = []
    depth = 0
    for number, line in enumerate(source.data.decode("utf-8", "replace").splitlines(), 1):
        text = line.strip()
        if not text or (depth == 0 and text.startswith("#")):
            continue
        if depth > 0 or (texts and text.startswith("(")):
            texts[-1] += " " + text
        else:
            text, srid = without_number(text)
            texts.append(text)
            lines.append(number)
            srids.append(srid)
        depth = max(0, depth + text.count("(") - text.count(")"))
    crs = crs_of_numbers(source.name, srids, lines.__getitem__)
    geometry, curves = geometry_of_texts(texts, source.flatten)
    bad = next((row for row, each in enumerate(geometry) if each is None), None)
    if bad is not None:
        raise InputError(
            f"{source.name}, line {lines[bad]}: {shortened(texts[bad])} is not WKT; write for example POINT (3 4) or "
            "POLYGON ((0 0, 4 0, 0 3, 0 0)), each ring closed"
        )

    def place(feature: int) -> str:
        return f"{source.name}, line {lines[feature]}"

    return Features(source.name, geometry, {}, None, crs, place, texts=texts, curves=curves)


def names_shapes(data: bytes) -> bool:
    """Return whether a well-known text names a polygon or a line."""
    return _SHAPE.search(_COMMENT.sub(b"", data)) is not None


def features_of_rows(source: Source) -> Features:
    """Read all rows; an empty field is no geometry."""
    text = delimited_text(source)
    column = geometry_column(text.fields)
    if column is None:
        raise InputError(
            f"{source.name}: no column has the name of a geometry column ({', '.join(GEOMETRY_COLUMNS)}); rename the "
            "column of geometry"
        )
    columns = text.columns()
    written = columns.pop(list(columns)[column])
    check_nesting("\n".join(written), name=source.name)
    geometry, crs, curves = _parsed(text, written, source.flatten)

    def place(feature: int) -> str:
        return f"{source.name}, line {text.line_of(feature)}"

    return Features(source.name, geometry, columns, None, crs, place, curves=curves)


def _parsed(text: DelimitedText, written: Sequence[str], flatten: float | None) -> tuple[NDArray[np.object_], Any, int]:
    """The geometry, its reference system, and how many curves were flattened."""
    fields = [field.strip() for field in written]
    kept = [row for row, field in enumerate(fields) if field]
    geometry = np.full(len(fields), None, dtype=object)
    if all(_BINARY.fullmatch(fields[row]) for row in kept) and kept:
        geometry[kept], curves = geometry_of_binary([fields[row] for row in kept], flatten)
        crs = crs_of_geometry(text.name, geometry[kept], lambda index: text.line_of(kept[index]))
    else:
        cut = [without_number(fields[row]) for row in kept]
        geometry[kept], curves = geometry_of_texts([wkt for wkt, _ in cut], flatten)
        crs = crs_of_numbers(text.name, [number for _, number in cut], lambda index: text.line_of(kept[index]))
    bad = next((row for row in kept if geometry[row] is None), None)
    if bad is not None:
        raise InputError(
            f"{text.name}, line {text.line_of(bad)}: {shortened(fields[bad])} is neither WKT nor WKB; write for "
            "example POINT (3 4)"
        )
    return geometry, crs, curves


# ---- well-known binary ---------------------------------------------------------------------------
_HEXADECIMAL = re.compile(rb"[0-9A-Fa-f\s]*")


def features_of_binary(source: Source) -> Features:
    """Read one geometry, or one a line."""
    if not source.data.strip():
        raise InputError(
            f"{source.name} is empty, but well-known binary (WKB) is expected; check the program that wrote it"
        )
    is_digits = _HEXADECIMAL.fullmatch(source.data) is not None
    written = source.data.split() if is_digits else [source.data]
    items = [item.decode() for item in written] if is_digits else written
    fault = "{}: geometry {} is not WKB; is the file damaged or cut off?"
    geometry, curves = checked_geometry(source, items, fault)
    crs = crs_of_geometry(source.name, geometry, lambda row: row + 1)
    return Features(source.name, geometry, {}, None, crs, curves=curves)


def crs_of_geometry(name: str, geometry: NDArray[Any], line_of: Callable[[int], int]) -> Any:
    """Give the ``crs`` member for the numbers (SRID) that geometry of extended well-known binary carries."""
    numbers = [0 if each is None else int(shapely.get_srid(each)) for each in geometry]
    return crs_of_numbers(name, numbers, line_of)
