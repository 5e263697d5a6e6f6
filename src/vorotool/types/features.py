"""What values give to files and frames: rows of columns, and the geometry of each row as plain arrays."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import field, replace
from typing import TYPE_CHECKING, Any, NamedTuple, Union

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import UsageError
from vorotool.frozen import frozen
from vorotool.numeric.arrays import Floats, Nesting
from vorotool.numeric.numbers import Flatten, checked_flatten, shown_number
from vorotool.products.registry import is_of
from vorotool.types.identity import names_of, with_columns_of
from vorotool.types.table import Table

if TYPE_CHECKING:
    from vorotool.types.polygons.polygon_set import PolygonSet

Indices = NDArray[np.integer]


class Corners(NamedTuple):
    """Points, straight lines or triangles by their corners, which rows may have in common."""

    xy: Floats  # (k, 2) places
    corners: Indices  # (n, 1), (n, 2) or (n, 3) places of each row


class Lines(NamedTuple):
    """Polylines; those whose places all are one are no geometry."""

    xy: Floats  # (k, 2) places, line after line
    starts: Indices  # (n + 1,) where each begins


class Areas(NamedTuple):
    """Polygons that share their borders: rounded to the decimals of a file they still do."""

    xy: Floats  # (k, 2) vertices, ring after ring, the first of each not repeated
    nesting: Nesting
    in_box: bool = False  # each is convex, and they fill a box


Geometry = Union[Corners, Lines, Areas, "PolygonSet"]
"""Of rows. Of polygons each is a row; in files all polygons of a feature are, with its id and its properties."""


@frozen(eq=False)
class Rows:
    """Rows of a value, with columns and maybe with geometry."""

    columns: Mapping[str, Any]  # ours
    further: Mapping[str, Any] | None = field(default_factory=dict)  # of the input; None: of the polygon of each row
    source: Any = None  # what the rows come from, whose `crs` and `index` are of the rows, too
    item: Indices | None = None  # (n,) the row of the source that each comes from, -1 for none; None: from several
    geometry: Geometry | NDArray[Any] | None = None  # of label images that of shapely
    ids: Any = None  # of features in GeoJSON, where our columns have no `id`
    is_part: bool = False  # rows are parts of polygons, which have those columns in files that are asked for

    def table(self, *, is_file: bool = False, has_ids: bool = True) -> Table:
        """Return all columns."""
        if isinstance(self.columns, Table) and self.further == {} and (has_ids or "id" not in self.columns):
            return self.columns
        ours = {name: column for name, column in self._stored().items() if has_ids or name != "id"}
        if self.further is None and self.item is not None and is_of(self.source, "PolygonSet"):
            return with_columns_of(ours, self.source, self.item, is_part=is_file and self.is_part)
        return Table(ours).with_properties(self.further) if self.further else Table(ours)

    def with_columns(self, **columns: Any) -> Rows:
        """Add columns of ours."""
        return replace(self, columns={**self._stored(), **columns})

    def _stored(self) -> Mapping[str, Any]:
        """Our columns, of which what is looked up or computed is not so yet."""
        return self.columns.stored() if isinstance(self.columns, Table) else self.columns

    @property
    def names(self) -> Any:
        """The column with the ids of features in GeoJSON; None for none."""
        return self._stored().get("id", self.ids)


class Mixture(NamedTuple):
    """Rows of different geometry and with different columns, one after the other."""

    parts: tuple[Rows, ...]


def of_points(xy: Floats) -> Corners:
    """Return a point a row."""
    return Corners(xy, np.arange(len(xy), dtype=np.int32)[:, None])


def of_segments(ends: Floats) -> Corners:
    """Return a straight line a row, by (n, 2, 2) ends."""
    return Corners(ends.reshape(-1, 2), np.arange(2 * len(ends), dtype=np.int32).reshape(-1, 2))


def point_rows(columns: Mapping[str, Any], source: Any, xy: Floats) -> Rows:
    """Return rows about the points of an input."""
    return Rows(columns, source.properties, source, np.arange(len(xy)), of_points(xy))


def of_polygons(columns: Mapping[str, Any], polygons: PolygonSet, polygon: Indices, **more: Any) -> Rows:
    """Return rows about polygons, or parts of them, which are named."""
    return Rows({**names_of(polygons, polygon), **columns}, None, polygons, polygon, **more)


def of_shapes(shapes: PolygonSet, source: PolygonSet, item: Indices) -> Rows:
    """Return a row a shape that was made of polygons, and has its columns as properties."""
    named = {name: column for name, column in shapes.properties.items() if name in ("label", "part")}
    ids = {} if shapes.ids is None else {"id": list(shapes.ids)}
    return Rows({**named, **ids, **shapes.properties}, {}, source, item, shapes)


def chosen(value: object, what: str | None, parts: Mapping[str, Callable[[], Rows]]) -> Rows:
    """Return the rows of a part, by default of the first one."""
    name = what or next(iter(parts))
    if name not in parts:
        raise UsageError(f"invalid what {shown_number(what)}: expected {', '.join(parts)} of a {type(value).__name__}")
    return parts[name]()


_PLACES = frozenset(["x", "y", "x_a", "y_a", "x_b", "y_b"])


def without_places(table: Table, *places: str) -> dict[str, Any]:
    """Leave out the columns of coordinates that geometry has: by default those of points, and of ends."""
    left_out = frozenset(places) or _PLACES
    return {name: column for name, column in table.stored().items() if name.removeprefix("voro_") not in left_out}


def features_of(value: Any, what: str | None = None, *, flatten: Flatten = None) -> Rows | Mixture:
    """Return the rows of a value with their geometry."""
    if not hasattr(value, "_features"):
        raise UsageError(f"a {type(value).__name__} has no geometry")
    return value._features(what, checked_flatten(flatten))


def rows_of(value: Any, what: str | None = None, *, flatten: Flatten = None) -> Rows:
    """Return the rows of the table of a value: its own, else those that have its geometry."""
    own: Rows | None = value._rows(what) if hasattr(value, "_rows") else None
    if own is not None:
        return own
    if not hasattr(value, "_features"):
        raise UsageError(f"a {type(value).__name__} has no table")
    return value._features(what, checked_flatten(flatten))


def matrix_of(value: Any, what: str | None) -> NDArray[Any]:
    """Return the numbers of a part as one array."""
    return value._matrix(what)


def parts_of(features: Rows | Mixture) -> Iterator[Rows]:
    """Return rows of one kind each."""
    yield from features.parts if isinstance(features, Mixture) else (features,)
