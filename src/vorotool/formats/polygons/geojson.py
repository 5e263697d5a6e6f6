"""Polygons and lines in GeoJSON."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any, BinaryIO

import numpy as np

from vorotool import _core
from vorotool.convert.sites import Sites
from vorotool.errors import AS_JSON, InputError
from vorotool.formats.io.sources import Source
from vorotool.formats.parsing.geojson import (
    feature_places,
    features_of,
    geometry_of,
    list_of,
    parse_json,
    property_columns,
    read_y_axis,
)
from vorotool.formats.parsing.geometry_advice import OF_SITES, not_a_shape_advice
from vorotool.formats.parsing.reader_options import ReadOptions, shortened
from vorotool.formats.parsing.reference_systems import note_unnamed
from vorotool.formats.polygons.ring_collector import RingCollector
from vorotool.formats.text.feature_collection import stated_unit, write_collection
from vorotool.formats.text.row_writer import Column, RowShape
from vorotool.formats.text.tables import json_text
from vorotool.types.axis import UP
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.table import Computed


def read_geojson(source: Source, options: ReadOptions) -> PolygonSet:
    """Read the polygons and lines of a GeoJSON document with their ``id``, properties and ``crs``."""
    polygons, features = _read(source, options)
    assert polygons.feature is not None
    options.note_left_out(source.name, len(features) - len(set(polygons.feature.tolist())))
    return polygons


def read_sites(source: Source, options: ReadOptions) -> Sites:
    """Read points, lines and polygons, each feature a site; one without a geometry is a site without places."""
    polygons, features = _read(source, options, takes_points=True)
    assert polygons.feature is not None
    options.note_empty(source.name, len(features) - len(set(polygons.feature.tolist())))
    known = _described(source.name, features, range(len(features)), options)
    return Sites(polygons, polygons.feature, len(features), known["ids"], known["properties"])


def _read(source: Source, options: ReadOptions, *, takes_points: bool = False) -> tuple[PolygonSet, list[Any]]:
    """Read a document, and give its features as well."""
    document = parse_json(source)
    if not isinstance(document, dict):
        raise InputError(f"{source.name}: GeoJSON is an object with a type; use {AS_JSON} for [[x, y], …]")
    features = features_of(source.name, document)
    place = feature_places(source.name, document)
    collector = RingCollector(options, source.name, place, takes_points=takes_points)
    for index, feature in enumerate(features):
        geometry = geometry_of(feature, place(index))
        if geometry is not None:
            _collect(collector, index, geometry, place(index))
    crs, unit = document.get("crs"), stated_unit(document)
    known = _described(source.name, features, collector.features, options)
    polygons = collector.finish(**known, y_axis=read_y_axis(source.name, document, UP), crs=crs, unit=unit)
    if crs is unit is None and options.crs is None:
        note_unnamed(source.name, polygons.xy, options.note)
    return polygons, features


def _described(name: str, features: list[Any], owners: Sequence[int], options: ReadOptions) -> dict[str, Any]:
    """Ids and properties of the features of some rows."""
    if not options.properties:
        return {"ids": None, "properties": {}}
    ids = [features[i].get("id") for i in owners] if any("id" in feature for feature in features) else None
    return {"ids": ids, "properties": property_columns(name, features, owners, "polygons")}


def _collect(collector: RingCollector, feature: int, geometry: Any, place: str) -> None:
    """Take all parts of a geometry; a collection is as deep as the nesting guard lets it be."""
    if not isinstance(geometry, Mapping):
        raise InputError(f"{place}: the geometry is {shortened(geometry)}; write an object with type and coordinates")
    kind = geometry.get("type")
    if kind == "GeometryCollection":
        for each in list_of(geometry, "geometries", place):
            _collect(collector, feature, each, place)
    elif kind in ("Polygon", "MultiPolygon"):
        coordinates = list_of(geometry, "coordinates", place)
        for rings in coordinates if kind == "MultiPolygon" else [coordinates]:
            collector.add_polygon(feature, rings)
    elif kind in ("LineString", "MultiLineString"):
        coordinates = list_of(geometry, "coordinates", place)
        for line in coordinates if kind == "MultiLineString" else [coordinates]:
            collector.add_line(feature, line)
    elif kind in ("Point", "MultiPoint") and collector.takes_points:
        coordinates = list_of(geometry, "coordinates", place)
        for position in coordinates if kind == "MultiPoint" else [coordinates]:
            collector.add_point(feature, position)
    elif collector.takes_points:
        raise InputError(f"{place}: {shortened(kind)} is not a point, line or polygon; {OF_SITES}")
    else:
        raise InputError(f"{place}: {shortened(kind)} is not a polygon or line; {not_a_shape_advice(str(kind))}")


def write_geojson(out: BinaryIO, polygons: PolygonSet) -> None:
    """Write one feature for each feature of the input, with its id and properties."""
    write_collection(out, [feature_columns(polygons)], crs=polygons.crs, y_axis=polygons.y_axis)


def feature_columns(polygons: PolygonSet) -> tuple[list[Column], RowShape]:
    """Return the columns of features, and the text around them."""
    ranges = feature_ranges(polygons)
    openings = [_opening(polygons, first) for first, _ in ranges]
    texts: Computed | list[str] | None = feature_texts(polygons, "geojson")
    if texts is None:
        texts = [json_text(_joined([_geometry(polygons, i) for i in range(*each)])) for each in ranges]
    return [Column("", openings), Column("", texts)], RowShape(("", ',"geometry":', "}"), ",\n")


def _opening(polygons: PolygonSet, index: int) -> str:
    """Return the text of a feature before its geometry."""
    feature: dict[str, Any] = {"type": "Feature"}
    if polygons.ids is not None and polygons.ids[index] is not None:
        feature["id"] = polygons.ids[index]
    feature["properties"] = {key: values[index] for key, values in polygons.properties.items()}
    return json_text(feature).removesuffix("}")


def feature_texts(polygons: PolygonSet, style: str) -> Computed | None:
    """Return the geometry of features as text, made in the core; None where there are lines or few vertices."""
    if not len(polygons) or polygons.is_line.any() or (np.diff(polygons.ring_starts) < 3).any():
        return None
    starts = np.array([first for first, _ in feature_ranges(polygons)] + [len(polygons)], dtype=np.int64)
    rings, parts = polygons.ring_starts, polygons.polygon_starts

    def texts(part: slice) -> Any:
        begin, end, _ = part.indices(len(starts) - 1)
        own = _core.text.PolygonStyle[style]
        return _core.text.PolygonTexts(polygons.xy, rings, parts, starts[begin : end + 1], own)

    return Computed(texts, len(starts) - 1)


def feature_ranges(polygons: PolygonSet) -> list[tuple[int, int]]:
    """Give the first polygon of each feature, and the one after its last."""
    assert polygons.feature is not None
    starts = np.flatnonzero(np.diff(polygons.feature, prepend=-1)).tolist()
    return list(pairwise([*starts, len(polygons)]))


def _geometry(polygons: PolygonSet, index: int) -> dict[str, Any]:
    rings = [ring.tolist() for ring in polygons.rings_of(index)]
    if polygons.is_line[index]:
        return {"type": "LineString", "coordinates": rings[0]}
    return {"type": "Polygon", "coordinates": [[*ring, ring[0]] for ring in rings]}


def _joined(parts: list[dict[str, Any]]) -> dict[str, Any]:
    """Give one geometry for the parts of a feature."""
    kinds = {part["type"] for part in parts}
    if len(parts) == 1:
        return parts[0]
    if len(kinds) == 1:
        return {"type": f"Multi{kinds.pop()}", "coordinates": [part["coordinates"] for part in parts]}
    return {"type": "GeometryCollection", "geometries": parts}
