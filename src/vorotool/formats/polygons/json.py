"""Polygons and lines as plain JSON."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, BinaryIO

import numpy as np

from vorotool.convert.sites import Sites, as_sites
from vorotool.errors import InputError, option
from vorotool.formats.io.sources import Source
from vorotool.formats.parsing.json import parse_json, property_columns, read_y_axis, refuse_table
from vorotool.formats.parsing.reader_options import ReadOptions, shortened
from vorotool.formats.polygons.geojson import RingCollector, read_geojson
from vorotool.formats.polygons.geojson import read_sites as read_geojson_sites
from vorotool.formats.text.tables import json_bytes
from vorotool.products.formats import resolved
from vorotool.types.axis import MEMBER as Y_AXIS
from vorotool.types.axis import UNSTATED
from vorotool.types.polygons.conversion import closed_ring
from vorotool.types.polygons.polygon_set import PolygonSet

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
    document = parse_json(source)
    if isinstance(document, dict) and document.get("type") == "vorotool.voronoi":
        options.note(f"{source.name} holds a Voronoi map: its sites are read")
        sites: Sites = resolved("formats.results.voronoi_files:read_sites")(source, options)
        return sites
    if isinstance(document, dict) and "polygons" not in document and "type" in document:
        return read_geojson_sites(source, options)
    return as_sites(read_json(source, options))


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
    refuse_table(name, document, f"polygons: give the file that it was computed from, or write {_FORM}")
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
