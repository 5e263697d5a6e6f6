"""Polygons and lines in GeoJSON."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import accumulate, pairwise
from typing import Any, BinaryIO

import numpy as np

from vorotool import _core
from vorotool.convert.sites import Sites
from vorotool.errors import AS_JSON, InputError
from vorotool.formats.io.sources import Source
from vorotool.formats.parsing.json import (
    OF_SITES,
    feature_places,
    features_of,
    geometry_of,
    list_of,
    not_a_shape_advice,
    parse_json,
    property_columns,
    read_y_axis,
)
from vorotool.formats.parsing.reader_options import ReadOptions, position_array, shortened
from vorotool.formats.parsing.reference_systems import note_unnamed
from vorotool.formats.text.feature_collection import stated_unit, write_collection
from vorotool.formats.text.row_writer import Column, RowShape
from vorotool.formats.text.tables import json_text
from vorotool.types.axis import UP
from vorotool.types.polygons.polygon_set import HOLE, LINE, SHELL, PolygonSet, set_of_rings
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


@dataclass
class RingCollector:
    """Rings of JSON positions, as they were parsed: anything may stand where a position is due."""

    options: ReadOptions
    name: str
    feature_place: Callable[[int], str]  # gives the words for the place of a feature (0-based)
    flat_only: bool = False  # positions must not have more than two numbers
    takes_points: bool = False  # points are wanted, too, as lines of one vertex
    positions: list[Any] = field(default_factory=list)
    sizes: list[int] = field(default_factory=list)
    kinds: list[int] = field(default_factory=list)
    polygons: list[int] = field(default_factory=list)
    features: list[int] = field(default_factory=list)  # of each polygon

    def add_polygon(self, feature: int, rings: Any) -> None:
        """Take a list of a shell and holes; empty ones are left out."""
        self._check_list(rings, feature, "the polygon", "[[[x, y], …], …]")
        if rings and self._add_ring(feature, rings[0], SHELL):
            for hole in rings[1:]:
                self._add_ring(feature, hole, HOLE)
            self.features.append(feature)

    def add_line(self, feature: int, line: Any) -> None:
        """Take the positions of an open line; an empty one is left out."""
        if self._add_ring(feature, line, LINE):
            self.features.append(feature)

    def add_point(self, feature: int, position: Any) -> None:
        """Take the position of a point; an empty one is left out."""
        self.add_line(feature, [position] if position else position)

    def finish(self, **described: Any) -> PolygonSet:
        """Make the polygons, once all are collected."""
        self.options.check_vertices(self.name, len(self.positions))
        longest = max((len(p) for p in self.positions if type(p) is list), default=2)
        if longest > 2 and self.flat_only:
            at = next(i for i, p in enumerate(self.positions) if type(p) is list and len(p) > 2)
            position = self.positions[at]
            raise InputError(f"{self._place(at)}: {shortened(position)} has {len(position)} numbers; write [x, y]")
        xy = position_array(self.positions, self._place)
        if longest > 2:
            self.options.note_heights(self.name)
        return set_of_rings(xy, self.sizes, self.kinds, self.polygons, **{"feature": self.features, **described})

    def _add_ring(self, feature: int, ring: Any, kind: int) -> bool:
        what = ("the shell", "a hole", "the line")[kind]
        self._check_list(ring, feature, what, "[[x, y], …]")
        if ring:
            self.positions.extend(ring)
            self.sizes.append(len(ring))
            self.kinds.append(kind)
            self.polygons.append(len(self.features))
        return bool(ring)

    def _check_list(self, value: Any, feature: int, what: str, form: str) -> None:
        if not isinstance(value, list):
            raise InputError(f"{self.feature_place(feature)}: {what} is {shortened(value)}; write {form}")

    def _place(self, position: int) -> str:
        ends = list(accumulate(self.sizes))
        ring = int(np.searchsorted(ends, position, side="right"))
        polygon = self.polygons[ring]
        feature = self.features[polygon]
        words = [self.feature_place(feature)]
        if self.features.count(feature) > 1:
            words.append(f"part {polygon - self.features.index(feature) + 1}")
        if self.kinds[ring] == HOLE:
            words.append(f"hole {ring - self.polygons.index(polygon)}")
        return ", ".join([*words, f"vertex {position - (ends[ring] - self.sizes[ring]) + 1}"])
