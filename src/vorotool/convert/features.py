"""Features as callers hold them: geometry of shapely, geopandas, GeoJSON and WKT, and what these say of it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.convert.tables import index_of, listed
from vorotool.errors import InputError, element, warn
from vorotool.frozen import frozen
from vorotool.numeric.arrays import objects
from vorotool.numeric.checks import LONGEST, index_of_rows
from vorotool.numeric.crs import crs_member, member_of_text, without_number
from vorotool.numeric.numbers import shown_number
from vorotool.products.formats import resolved
from vorotool.types.fields import UP, YAxis, y_axis_member

_WELL_KNOWN = "numeric.curves.well_known"

SIMPLE_TYPES = ("Point", "LineString", "Polygon")
GEOMETRY_TYPES = frozenset({*SIMPLE_TYPES, *(f"Multi{kind}" for kind in SIMPLE_TYPES), "GeometryCollection"})
FEATURE_TYPES = frozenset({"Feature", "FeatureCollection"})
_TYPES = GEOMETRY_TYPES | FEATURE_TYPES

MOST_LEVELS = 100
"""Of brackets in well-known text, as in files."""


@frozen(eq=False)
class HeldFeatures:
    """Features, one geometry each, and what is known of them."""

    # geometry of each: of shapely, a mapping of GeoJSON, or None where there is none
    items: Sequence[Any] | NDArray[np.object_]
    properties: dict[str, list[Any]] = field(default_factory=dict)  # attributes, one value a feature
    ids: list[Any] | None = None  # names of the features
    index: Any = None  # pandas Index, array or sequence: what a series or a data frame calls them
    crs: Any = None  # the `crs` member of GeoJSON
    curves: int = 0  # how many curves of texts were flattened
    y_axis: YAxis = UP
    # features have an index or an id, so that those without geometry are left out
    is_map: bool = False

    @property
    def is_all_shapely(self) -> bool:
        """Whether there are no mappings among the items."""
        return isinstance(self.items, np.ndarray) or all(item is None or is_shapely(item) for item in self.items)

    @property
    def geometry(self) -> NDArray[np.object_]:
        """(n,) the items, if all are of shapely."""
        return self.items if isinstance(self.items, np.ndarray) else objects(self.items)

    def described(self, owners: NDArray[Any]) -> dict[str, Any]:
        """Give the fields of a `PolygonSet` for polygons by the feature of each."""
        own = owners.tolist()
        return {
            "ids": None if self.ids is None else [self.ids[k] for k in own],
            "properties": {name: [values[k] for k in own] for name, values in self.properties.items()},
            "index": index_of_rows(self.index, owners),
            "crs": self.crs,
            "y_axis": self.y_axis,
        }


def held_features(source: Any) -> HeldFeatures | None:
    """Take features apart; None of what has no geometry."""
    held = _held(source)
    return held if held is None else _without_curves(held)


def _held(source: Any) -> HeldFeatures | None:
    if is_shapely(source):
        is_nothing = source.is_empty and source.geom_type in ("Point", "MultiPoint", "GeometryCollection")
        return HeldFeatures([] if is_nothing else [source])
    if isinstance(source, str | bytes):
        return _of_texts([source], is_alone=True)
    if isinstance(source, Mapping):
        return _of_geojson(source)
    if hasattr(source, "crs") and (hasattr(source, "geometry") or _dtype_name(source) == "geometry"):
        return _of_geopandas(source)
    if hasattr(source, "__geo_interface__"):
        return _of_geojson(source.__geo_interface__)
    items = _listed_items(source)
    return None if items is None else _of_items(items, index_of(source))


def report_missing(held: HeldFeatures, owners: NDArray[Any]) -> None:
    """Warn of features that are left out, without a geometry, by their indices."""
    missing = np.setdiff1d(np.arange(len(held.items)), owners).tolist()
    if missing:
        more = f" and {len(missing) - NAMED} more" if len(missing) > NAMED else ""
        noun, has = ("features", "have") if len(missing) > 1 else ("feature", "has")
        warn(f"{noun} at index {', '.join(map(str, missing[:NAMED]))}{more} {has} no geometry: skipped")


NAMED = 10
"""Features that are named in a warning."""


def is_shapely(value: Any) -> bool:
    """Tell whether a value is one geometry of shapely; arrays of geopandas have a type for each."""
    return isinstance(getattr(value, "geom_type", None), str)


def is_geojson(value: Any) -> bool:
    """Tell whether a value is an object of GeoJSON, by its type."""
    return isinstance(value, Mapping) and value.get("type") in _TYPES


def _dtype_name(value: Any) -> str:
    return str(getattr(value, "dtype", ""))


def _listed_items(source: Any) -> list[Any] | None:
    """Give the items of a list, an object array or a series whose first one is geometry in some form."""
    is_array = hasattr(source, "dtype")
    if is_array and not (getattr(source, "ndim", 0) == 1 and _dtype_name(source) in ("object", "str", "string")):
        if getattr(getattr(source, "dtype", None), "kind", "") != "U" or source.ndim != 1:
            return None
    elif not is_array and not isinstance(source, list | tuple):
        return None
    items = listed(source) if is_array else list(source)
    first = next((item for item in items if item is not None), None)
    held = is_shapely(first) or is_geojson(first) or isinstance(first, str) or hasattr(first, "__geo_interface__")
    return items if held else None


# ---- each form -------------------------------------------------------------------------------------
def _of_items(items: list[Any], index: Any) -> HeldFeatures | None:
    held: HeldFeatures | None
    if all(isinstance(item, str | None) for item in items):
        held = _of_texts(items)
    elif all(isinstance(item, Mapping) and item.get("type") == "Feature" for item in items):
        held = _of_geojson({"type": "FeatureCollection", "features": items})
    else:
        plain = [_plain_item(item) for item in items]
        is_map = bool(items) and all(is_geojson(each) for each, _ in plain)
        held = HeldFeatures([each for each, _ in plain], curves=sum(curves for _, curves in plain), is_map=is_map)
    return held if held is None or index is None else replace(held, index=index, is_map=True)


def _plain_item(item: Any) -> tuple[Any, int]:
    """Give the geometry of an item of a mixed list, and its curves; what is none stays as it is."""
    if isinstance(item, str):
        held: Any = _of_texts([item])
    elif is_shapely(item) or not (is_geojson(item) or hasattr(item, "__geo_interface__")):
        return item, 0
    else:
        held = _of_geojson(item if is_geojson(item) else item.__geo_interface__)
    if held is None or len(held.items) == 1:
        return (item, 0) if held is None else (held.items[0], held.curves)
    return {"type": "GeometryCollection", "geometries": [each for each in held.items if each is not None]}, 0


def _of_texts(texts: Sequence[Any], *, is_alone: bool = False) -> HeldFeatures:
    plain = [without_number(text.strip()) if isinstance(text, str) else (text, 0) for text in texts]
    for number, text in enumerate(texts):
        if _is_deep(text):  # shapely would take each level apart in a call of its own
            place = "the text" if is_alone else element("item", number)
            raise InputError(f"brackets of {place} are nested more than {MOST_LEVELS} deep; check the brackets")
    geometry, curves = resolved(f"{_WELL_KNOWN}:geometry_of_texts")([text for text, _ in plain])
    wrong = [k for k, text in enumerate(texts) if text is not None and geometry[k] is None]
    if wrong:
        text = texts[wrong[0]]
        shown = repr(text if len(text) <= LONGEST else text[: LONGEST - 1] + "…")
        if is_alone and isinstance(text, str):
            raise InputError(f"{shown} is not well-known text (WKT); to read a file use vorotool.read(path)")
        raise InputError(f"{element('item', wrong[0])} is {shown}, not well-known text (WKT) such as POINT (3 4)")
    numbers = sorted({number for _, number in plain if number})
    if len(numbers) > 1:
        raise InputError(f"geometry is in EPSG:{numbers[0]} and EPSG:{numbers[1]}: reproject it to one of them")
    crs = crs_member(f"EPSG:{numbers[0]}") if numbers else None
    return HeldFeatures(list(geometry), crs=crs, curves=curves, is_map=True)


def _without_curves(held: HeldFeatures) -> HeldFeatures:
    """Flatten the curves in collections of shapely, and warn once of these and of those of texts."""
    flat = resolved(f"{_WELL_KNOWN}:without_curves")(objects(held.items))
    if flat.curves + held.curves:
        warn(resolved(f"{_WELL_KNOWN}:flattened_note")(flat.curves + held.curves))
    return replace(held, items=flat.geometry) if flat.curves else held


def _is_deep(text: Any) -> bool:
    if text is None or text.count("(" if isinstance(text, str) else b"(") <= MOST_LEVELS:
        return False
    data = np.frombuffer(text.encode() if isinstance(text, str) else text, dtype=np.uint8)
    steps = np.equal(data, ord("(")).astype(np.int32) - np.equal(data, ord(")"))
    return bool(steps.cumsum().max() > MOST_LEVELS)


def _of_geojson(document: Any) -> HeldFeatures | None:
    if not is_geojson(document):
        return None
    if document["type"] in GEOMETRY_TYPES:
        return HeldFeatures([document], crs=document.get("crs"), y_axis=y_axis_member(document, UP), is_map=True)
    features = [document] if document["type"] == "Feature" else document.get("features")
    if isinstance(features, str) or not isinstance(features, Iterable):
        raise InputError('the FeatureCollection has no list of features: add "features": […]')
    features = list(features)
    for number, feature in enumerate(features, 1):
        if not isinstance(feature, Mapping) or feature.get("type") != "Feature":
            raise InputError(f'item {number} of the features is not a Feature: give it "type": "Feature"')
        if not isinstance(feature.get("properties"), Mapping | None):
            raise InputError(f"the properties of feature {number} are not an object: give an object or null")
    rows = [feature.get("properties") or {} for feature in features]
    names = dict.fromkeys(key for row in rows for key in row)
    return HeldFeatures(
        [feature.get("geometry") for feature in features],
        {str(name): [row.get(name) for row in rows] for name in names},
        [feature.get("id") for feature in features] if any("id" in feature for feature in features) else None,
        crs=document.get("crs"),
        y_axis=y_axis_member(document, UP),
        is_map=True,
    )


def _of_geopandas(source: Any) -> HeldFeatures:
    """Take a GeoDataFrame, a GeoSeries or a GeometryArray; missing geometry is None."""
    geometry = source.geometry if hasattr(source, "geometry") else source
    properties = {}
    if hasattr(source, "columns"):
        active = geometry.name
        for place, name in enumerate(source.columns):
            if name != active:
                properties[str(name)] = listed(source.iloc[:, place])
    items = np.array(geometry, dtype=object)
    return HeldFeatures(items, properties, index=index_of(geometry), crs=crs_of(source.crs), is_map=True)


def crs_of(crs: Any) -> Any:
    """Give the ``crs`` member for a system of pyproj: authority and code where it has them, else spelled out."""
    if crs is None or isinstance(crs, str):
        return member_of_text(crs)
    found = crs.to_authority()
    return member_of_text(":".join(found) if found else crs.to_wkt())


def joined_parts(geometry: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
    """Give the simple geometries of an object of GeoJSON in order: the kind of each and its coordinates."""
    pending: list[Any] = [geometry]
    while pending:  # not recursive: collections may be nested as deep as one likes
        each = pending.pop()
        kind = each.get("type") if isinstance(each, Mapping) else None
        member = "geometries" if kind == "GeometryCollection" else "coordinates"
        if kind not in GEOMETRY_TYPES or not isinstance(each.get(member), Sequence | np.ndarray):
            raise InputError(f"a geometry of type {shown_number(kind)} has no {member}: give a GeoJSON geometry")
        if kind == "GeometryCollection":
            pending.extend(reversed(each["geometries"]))
        elif kind.startswith("Multi"):
            yield from ((kind.removeprefix("Multi"), part) for part in each["coordinates"])
        elif len(each["coordinates"]):
            yield kind, each["coordinates"]
