"""Polygons and lines as plain JSON and as GeoJSON."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import accumulate, pairwise
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np

from vorotool.errors import AS_JSON, InputError, option
from vorotool.formats.io.sources import Source
from vorotool.formats.parsing.json import (
    OF_SITES,
    feature_places,
    features_of,
    geometry_of,
    is_table,
    list_of,
    not_a_shape_advice,
    parse_json,
    property_columns,
    read_y_axis,
)
from vorotool.formats.parsing.reader_options import ReadOptions, note_unnamed, position_array, shortened
from vorotool.formats.text.row_writer import Column, RowShape
from vorotool.formats.text.tables import json_bytes, json_text, stated_unit, write_collection
from vorotool.numeric.arrays import Nesting
from vorotool.products.formats import resolved
from vorotool.types.fields import MEMBER as Y_AXIS
from vorotool.types.fields import UNSTATED, UP
from vorotool.types.polygons.polygon_set import HOLE, LINE, SHELL, PolygonSet, set_of_rings
from vorotool.types.polygons.shapely_geometry import closed_ring
from vorotool.types.table import Computed

if TYPE_CHECKING:
    from vorotool.convert.sites import Sites

_AS_GEOJSON = option("--what offset -f geojson", 'fmt="geojson"')

_FORM = '{"polygons": [{"shell": [[x, y], …], "holes": [[[x, y], …], …]}, {"line": [[x, y], …]}, …]}'


def read_json(source: Source, options: ReadOptions) -> PolygonSet:
    """Read ``[[x, y], …]``, a list of such shells, ``{"polygons": […]}``, or GeoJSON where the object has a type."""
    document = parse_json(source)
    _check_type(source.name, document, options)
    if isinstance(document, dict) and "polygons" not in document and "type" in document:
        return read_geojson(source, options)
    items = _items(source.name, document)

    def place(index: int) -> str:
        return f"{source.name}, polygon {index + 1}"

    collector = RingCollector(options, source.name, place, flat_only=True)
    for index, item in enumerate(items):
        _collect(collector, index, item, place(index))
    owners = collector.features
    axis = read_y_axis(source.name, document, UNSTATED) if isinstance(document, dict) else UNSTATED
    described = [item if isinstance(item, dict) else {} for item in items]
    has_ids = options.properties and any("id" in item for item in described)
    polygons = collector.finish(
        ids=[described[i].get("id") for i in owners] if has_ids else None,
        feature=_features(described, owners, place),
        properties=property_columns(source.name, described, owners, "polygons") if options.properties else {},
        y_axis=axis,
    )
    options.note_left_out(source.name, len(items) - len(owners))
    if isinstance(document, list) and len(polygons) > 1 and all(isinstance(item, list) for item in items):
        _note_holes(source.name, polygons, options)
    return polygons


def read_sites(source: Source, options: ReadOptions) -> Sites:
    """Read polygons and lines, or where the object has a type GeoJSON, whose points are sites, too."""
    sites: Sites
    document = parse_json(source)
    if isinstance(document, dict) and document.get("type") == "vorotool.voronoi":
        options.note(f"{source.name} holds a Voronoi map: its sites are read")
        sites = resolved("formats.results.voronoi_files:read_sites")(source, options)
        return sites
    if isinstance(document, dict) and "polygons" not in document and "type" in document:
        return read_geojson_sites(source, options)
    sites = resolved("convert.sites:as_sites")(read_json(source, options))
    return sites


def _note_holes(name: str, polygons: PolygonSet, options: ReadOptions) -> None:
    """Say that a ring inside the first one is a shell of its own here: where GeoJSON has it, it would be a hole."""
    low, high = (bound.reduceat(polygons.xy, polygons.ring_starts[:-1]) for bound in (np.minimum, np.maximum))
    within = np.flatnonzero((low >= low[0]).all(axis=1) & (high <= high[0]).all(axis=1))[1:]
    if not within.size:
        return
    import shapely

    first = shapely.polygons(closed_ring(polygons.ring(0)))
    if not shapely.is_valid(first):
        return
    shapely.prepare(first)
    for ring in within.tolist():
        if shapely.covers(first, shapely.linestrings(closed_ring(polygons.ring(ring)))):
            options.note(
                f"{name}: ring {ring + 1} lies in ring 1, but each ring of a list is a separate polygon: if it is a "
                f"hole, write {_FORM}"
            )
            return


def _check_type(name: str, document: Any, options: ReadOptions) -> None:
    """Refuse curves in whose place the polygons that they are around would be read; say so of a skeleton."""
    kind = document.get("type") if isinstance(document, dict) and "polygons" in document else None
    if kind == "vorotool.offsets":
        raise InputError(
            f"{name} holds offset curves, with arcs: write them as GeoJSON ({_AS_GEOJSON}), which has polygons "
            "instead, or give the file that they were computed from"
        )
    for known, noun in (("vorotool.skeleton", "skeleton"), ("vorotool.voronoi", "Voronoi map")):
        if kind == known:
            options.note(f"{name} holds a {noun}: its polygons are read")


def _items(name: str, document: Any) -> list[Any]:
    if isinstance(document, dict):
        items = document.get("polygons")
        if not isinstance(items, list):
            raise InputError(f"{name}: the object has no list of polygons; write {_FORM}, GeoJSON, or [[x, y], …]")
        return items
    if not isinstance(document, list):
        raise InputError(f"{name}: {shortened(document)} is not a polygon; write [[x, y], …], or {_FORM}")
    if is_table(document):
        fields = ", ".join([*list(document[0])[:4], *["…"] * (len(document[0]) > 4)])
        raise InputError(
            f"{name} holds a table, whose rows have {fields}, not polygons: give the file that it was computed from, "
            f"or write {_FORM}"
        )
    return document if is_list_of_shells(document) else [document] if document else []


def is_list_of_shells(document: Any) -> bool:
    """Whether a list is one of shells, not of pairs: its first item that is not empty begins with a list."""
    first = next((item for item in document if item), None)
    return isinstance(first, dict) or (isinstance(first, list) and isinstance(first[0], list))


def _collect(collector: RingCollector, index: int, item: Any, place: str) -> None:
    if isinstance(item, list):
        collector.add_polygon(index, [item])
    elif isinstance(item, dict) and ("shell" in item) != ("line" in item):
        if "properties" in item and not isinstance(item["properties"], dict | None):
            raise InputError(f"{place}: properties are {shortened(item['properties'])}; write an object or null")
        if "line" in item:
            collector.add_line(index, item["line"])
            return
        holes = item.get("holes")
        if not isinstance(holes, list | None):
            raise InputError(f"{place}: holes are {shortened(holes)}; write [[[x, y], …], …]")
        collector.add_polygon(index, [item["shell"], *(holes or [])])
    else:
        raise InputError(f"{place}: {shortened(item)} is not a polygon; write {_FORM}")


def _features(described: list[dict[str, Any]], owners: list[int], place: Any) -> list[int]:
    """Number the features: a polygon whose ``part`` is one more than that of the one before continues that feature."""
    features: list[int] = []
    before = 0
    for index in owners:
        part = described[index].get("part", 1)
        if type(part) is not int or (part != 1 and part != before + 1):
            raise InputError(
                f"{place(index)}: part is {shortened(part)}; number the parts of each feature 1, 2, … in order"
            )
        features.append((features[-1] if features else -1) + (part == 1))
        before = part
    return features


def write_json(out: BinaryIO, polygons: PolygonSet) -> None:
    """Write ``{"polygons": […]}``, one polygon or line a line of text."""
    out.write(f'{{"{Y_AXIS}":"{polygons.y_axis}",'.encode())
    write_items(out, polygons)
    out.write(b"}\n")


def write_items(out: BinaryIO, polygons: PolygonSet, own: Mapping[str, Sequence[Any]] | None = None) -> None:
    """Write ``"polygons": […]``, a member of an object; each item has further members of its ``own``."""
    part = polygons.part.tolist()
    in_parts = max(part, default=1) > 1
    out.write(b'"polygons":[')
    for index, is_line in enumerate(polygons.is_line):
        item: dict[str, Any] = {}
        if polygons.ids is not None:
            item["id"] = polygons.ids[index]
        if in_parts:
            item["part"] = part[index]
        if polygons.properties:
            item["properties"] = {key: values[index] for key, values in polygons.properties.items()}
        item |= {name: values[index] for name, values in (own or {}).items()}
        rings = [ring.tolist() for ring in polygons.rings_of(index)]
        item |= {"line": rings[0]} if is_line else {"shell": rings[0], "holes": rings[1:]}
        out.write((b",\n" if index else b"\n") + json_bytes(item))
    out.write(b"\n]" if len(polygons) else b"]")


# ---- GeoJSON -------------------------------------------------------------------------------------
def read_geojson(source: Source, options: ReadOptions) -> PolygonSet:
    """Read the polygons and lines of a GeoJSON document with their ``id``, properties and ``crs``."""
    polygons, features = _read(source, options)
    options.note_left_out(source.name, len(features) - len(set(polygons.feature.tolist())))
    return polygons


def read_geojson_sites(source: Source, options: ReadOptions) -> Sites:
    """Read points, lines and polygons, each feature a site; one without a geometry is a site without places."""
    from vorotool.convert.sites import Sites

    polygons, features = _read(source, options, takes_points=True)
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
            _collect_geometry(collector, index, geometry, place(index))
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


def _collect_geometry(collector: RingCollector, feature: int, geometry: Any, place: str) -> None:
    """Take all parts of a geometry; a collection is as deep as the nesting guard lets it be."""
    if not isinstance(geometry, Mapping):
        raise InputError(f"{place}: the geometry is {shortened(geometry)}; write an object with type and coordinates")
    kind = geometry.get("type")
    if kind == "GeometryCollection":
        for each in list_of(geometry, "geometries", place):
            _collect_geometry(collector, feature, each, place)
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
    from vorotool.formats.text.rings import ring_texts

    return ring_texts(polygons.xy, Nesting(polygons.ring_starts, polygons.polygon_starts, starts), style)


def feature_ranges(polygons: PolygonSet) -> list[tuple[int, int]]:
    """Give the first polygon of each feature, and the one after its last."""
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
