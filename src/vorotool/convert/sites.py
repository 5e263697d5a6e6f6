"""Sites of Voronoi diagrams from whatever a caller holds: points, lines and polygons, each feature a site."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import field, replace
from math import isnan
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError, UsageError, option, warn
from vorotool.frozen import frozen
from vorotool.numeric.arrays import objects
from vorotool.numeric.checks import index_of_rows, items_of, naming, unexpected
from vorotool.numeric.crs import note_degrees
from vorotool.numeric.lazy import shapely
from vorotool.numeric.numbers import shown_number
from vorotool.products.formats import resolved
from vorotool.products.registry import is_of
from vorotool.types.box import Box, bounds
from vorotool.types.fields import UP
from vorotool.types.identity import check_plain, column_of
from vorotool.types.polygons.polygon_set import LINE, PolygonSet
from vorotool.types.values import counted

if TYPE_CHECKING:
    from vorotool.convert.features import HeldFeatures
    from vorotool.types.pixels import PixelGrid
    from vorotool.types.points.point_set import PointSet

_BY = option("--by", "by")
EXPECTED = (
    "points, lines or polygons of shapely, geopandas, GeoJSON or WKT, an (n, 2) array of points, a list of these, or a "
    "mask or label image"
)


@frozen(eq=False)
class Sites:
    """Sites of a Voronoi diagram, and what the input says of them."""

    polygons: PolygonSet  # polygons, lines, and points, which are lines of one vertex
    site: NDArray[np.int32]  # (p,) int32 array: that each polygon is a part of
    count: int  # sites, those without polygons too
    ids: list[Any] | None = None  # their names: the values that they were joined by, or those of the input
    # further columns of the input, one value a site; of sites that were joined the one that they were joined by
    properties: dict[str, list[Any]] = field(default_factory=dict)
    index: Any = None  # pandas Index, array or sequence: what the input calls them, unless they were joined


def as_sites(source: Any, by: Any = None, name: str = "sites") -> Sites:
    """Give the sites of whatever holds points, lines and polygons."""
    features = _features(source, name)
    if by is None:
        return features
    number, values = _first_appearances(_values(features, by))
    kept = {by: values} if isinstance(by, str) and by != "id" else {}
    return Sites(features.polygons, number[features.site], len(values), values, kept)


def _features(source: Any, name: str) -> Sites:
    source = items_of(source)
    if isinstance(source, PolygonSet | Sites):
        return _of_polygons(source) if isinstance(source, PolygonSet) else source
    from vorotool.convert.features import held_features
    from vorotool.convert.images import is_image
    from vorotool.convert.points import as_points
    from vorotool.convert.polygons import as_polygons, is_ring
    from vorotool.convert.tables import is_table

    if is_of(source, "PointSet", "SeedSet"):
        return _of_points(as_points(source, name))
    if is_image(source, name):
        return _of_image(source, name)
    with naming(name):
        held = held_features(source)
        if held is not None:
            return _of_held(held, name)
        if not isinstance(source, Iterable) or getattr(source, "ndim", 1) == 0:
            raise unexpected(source, EXPECTED)
    if is_ring(source) or is_table(source):
        return _of_points(as_points(source, name))
    return _of_polygons(as_polygons(source, name))


def _of_held(held: HeldFeatures, name: str) -> Sites:
    from vorotool.types.polygons.shapely_geometry import polygons_of_geometry

    items = objects([_shapely_of(item) for item in held.items])
    made = polygons_of_geometry(items, lambda own: {"feature": own, **held.described(own)}, takes_points=True)
    note_degrees(made, name, warn)
    return Sites(made, made.feature, len(items), held.ids, held.properties, held.index)


def _shapely_of(item: Any) -> Any:
    """Geometry of shapely for an object of GeoJSON."""
    from vorotool.convert.features import is_shapely

    if item is None or is_shapely(item):
        return item
    if not isinstance(item, Mapping):
        raise unexpected(item, "a geometry")
    from shapely.geometry import shape

    try:
        return shape(item)
    except (TypeError, ValueError, AttributeError, IndexError, KeyError, shapely.GEOSException) as error:
        raise InputError(
            f"a geometry of type {shown_number(item.get('type'))} has invalid coordinates: {error}"
        ) from None


def _of_points(points: PointSet) -> Sites:
    """Sites that are a point each."""
    count = len(points)
    polygons = PolygonSet(
        points.xy,
        np.arange(count + 1),
        np.full(count, LINE, dtype=np.int8),
        np.arange(count, dtype=np.int32),
        ids=None if points.labels is None else points.labels.tolist(),
        properties=points.properties,
        y_axis=points.y_axis,
        crs=points.crs,
        index=points.index,
    )
    return _of_polygons(polygons)


def _of_image(source: Any, name: str) -> Sites:
    """Sites that are the objects of an image; their ids are the labels."""
    is_labels = is_of(source, "LabelImage")
    image: Any = source if is_labels else resolved("convert.images:as_raster")(source, name)
    outlines: PolygonSet = resolved("engines.label_images.outlines:outlines")(image)
    if image.grid is None or image.grid.transform is None:
        return _of_polygons(outlines)
    first = (image.frame.x, image.frame.y) if is_labels else (0, 0)
    return _of_polygons(_on_map(outlines, image.grid, first))


def _on_map(outlines: PolygonSet, grid: PixelGrid, first: tuple[int, int]) -> PolygonSet:
    """Outlines as they lie on the map, of an image whose first pixel has these coordinates."""
    assert grid.transform is not None
    assert outlines.frame is not None
    a, b, c, d, e, f = grid.transform

    def on_map(xy: NDArray[np.float64]) -> NDArray[np.float64]:
        column, row = (xy - first + 0.5).T
        return np.stack([a * column + b * row + c, d * column + e * row + f], axis=1)

    low, high = bounds(on_map(np.array(outlines.frame.sides).reshape(2, 2)))
    frame = Box(*low.tolist(), *high.tolist()) if grid.is_upright else None
    return replace(outlines, xy=on_map(outlines.xy), y_axis=UP, crs=grid.crs, frame=frame)


def _of_polygons(polygons: PolygonSet) -> Sites:
    """Sites that are the features of polygons; each is described by its first part."""
    feature = polygons.feature
    count = int(feature.max(initial=-1)) + 1
    first = np.searchsorted(feature, np.arange(count))
    row = np.where(feature[first] == np.arange(count), first, -1) if count else first
    rows = row.tolist()

    def chosen(column: Any) -> list[Any]:
        return [column[at] if at >= 0 else None for at in rows]

    properties = {key: chosen(column) for key, column in polygons.properties.items()}
    ids = None if polygons.ids is None else chosen(polygons.ids)
    return Sites(polygons, feature, count, ids, properties, index_of_rows(polygons.index, row))


def _values(features: Sites, by: Any) -> list[Any]:
    """The value of each feature."""
    if isinstance(by, str):
        columns = features.properties if features.ids is None else {"id": features.ids, **features.properties}
        found = column_of(columns, by)
        if found is None:
            names = ", ".join(columns) or "they have none"
            more = option("", ", or one value per feature")
            raise UsageError(f"invalid {_BY} {shown_number(by)}: expected a column of the sites ({names}){more}")
        by = found
    try:
        values = [*resolved("convert.tables:listed")(by)]
    except (TypeError, ValueError, IndexError):  # a closed file is a ValueError, a table with gaps an IndexError
        raise InputError(f"invalid {_BY} {shown_number(by)}: expected a column, or one value per feature") from None
    if len(values) != features.count:
        raise InputError(f"invalid {_BY}: expected one value per feature, {features.count}, but got {len(values)}")
    missing = [k for k, value in enumerate(values) if _is_missing(value)]
    if missing:
        number = option(str(missing[0] + 1), str(missing[0]))
        raise InputError(
            f"invalid {_BY}: feature {number} has no value ({counted(len(missing), 'such feature')}): fill it in"
        )
    return values


def _is_missing(value: Any) -> bool:
    from vorotool.convert.tables import MISSING_TYPES

    return value is None or type(value).__name__ in MISSING_TYPES or (isinstance(value, float) and isnan(value))


def _first_appearances(values: list[Any]) -> tuple[NDArray[np.int32], list[Any]]:
    """The number of each value, and the values in order."""
    numbers: dict[Any, int] = {}
    for value in values:
        try:
            numbers.setdefault(value, len(numbers))
        except TypeError:  # an object or a list
            check_plain([value], _BY)
            raise InputError(f"invalid {_BY}: {shown_number(value)} is not one value of a feature") from None
    return np.array([numbers[value] for value in values], dtype=np.int32), list(numbers)
