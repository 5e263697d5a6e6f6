"""The names of features in results: the label of each, from 1, its id, and the other columns of the input."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError, UsageError, option
from vorotool.numeric.checks import described
from vorotool.numeric.coordinates import current_written
from vorotool.numeric.numbers import shown_number
from vorotool.types.points.point_set import LABEL, labels_of
from vorotool.types.table import Lookup, Table

if TYPE_CHECKING:
    from vorotool.types.polygons.polygon_set import PolygonSet

Rows = NDArray[np.integer]


def feature_labels(feature: Rows, properties: Mapping[str, Any]) -> NDArray[np.int64]:
    """Return the label of each feature, given by its parts: an integer from 1 that no other feature has.

    It is what the column label holds; where that holds anything else, features are numbered from 1.
    """
    number = np.asarray(feature, dtype=np.int64) + 1
    found = labels_of(properties[LABEL]) if LABEL in properties else None
    if found is None or not len(number):
        return number
    pairs = np.unique(np.stack([number, found]), axis=1)
    is_named = all(len(np.unique(side)) == pairs.shape[1] for side in pairs)
    return found if is_named else number


def other_columns(properties: Mapping[str, Any], labels: NDArray[np.int64]) -> dict[str, Any]:
    """Return the columns of the input without the one that holds the labels."""
    held = labels_of(properties[LABEL]) if LABEL in properties else None
    is_label = held is not None and np.array_equal(held, labels)
    return {name: column for name, column in properties.items() if not (is_label and name == LABEL)}


def ids_of(polygons: PolygonSet, polygon: Rows) -> Lookup:
    """Return the column of the input's ids of polygons; -1 has none."""
    return _looked_up([None] * len(polygons) if polygons.feature_ids is None else polygons.feature_ids, polygon)


def _looked_up(values: Sequence[Any], polygon: Rows) -> Lookup:
    return Lookup([*values, None], np.where(polygon < 0, len(values), polygon).astype(np.int32))


def place_columns(places: NDArray[np.float64], suffix: str = "") -> dict[str, NDArray[np.float64]]:
    """Return the columns of coordinates, ``x`` and ``y`` with a suffix."""
    return {f"{axis}{suffix}": places[:, k].copy() for k, axis in enumerate("xy")}


def names_of(polygons: PolygonSet, polygon: Rows) -> dict[str, Any]:
    """Return the columns that name the polygon of each row: ``label``, ``part`` where features have several, ``id``.

    A row in no polygon, -1, has none.
    """
    columns: dict[str, Any] = {LABEL: _taken(polygons.labels, polygon)}
    if polygons.part.max(initial=1) > 1:
        columns["part"] = _taken(polygons.part, polygon)
    return {**columns, "id": ids_of(polygons, polygon)}


def with_columns_of(columns: Mapping[str, Any], polygons: PolygonSet, polygon: Rows, *, is_part: bool = False) -> Table:
    """Return columns with those of the polygon of each row: of what is a part of it, those that are wanted."""
    further = wanted(polygons.properties, polygons.other_columns) if is_part else polygons.other_columns
    return Table(columns).with_properties({name: _looked_up(values, polygon) for name, values in further.items()})


def part_table(columns: Mapping[str, Any], polygons: PolygonSet, polygon: Rows) -> Table:
    """Return the table of parts of polygons, with the columns that are wanted of these."""
    return with_columns_of(columns, polygons, polygon, is_part=True)


def with_ends(columns: Mapping[str, Any], properties: Mapping[str, Any], ends: Mapping[str, Rows]) -> Table:
    """Return columns with those that are wanted of the site at each end: ``NAME_a`` and ``NAME_b``."""
    table, further = Table(columns), wanted(properties).items()
    own = {f"{name}_{end}": _looked_up(values, rows) for name, values in further for end, rows in ends.items()}
    return table.with_properties(own) if own else table


def ends_of_regions(columns: Mapping[str, Any], sites: Any) -> Table:
    """Return a table of pairs of labels of sites with the columns that are wanted of both."""
    labels = np.zeros(0, np.int64) if sites.site_labels is None else sites.site_labels
    ends = {end: np.searchsorted(labels, np.asarray(columns[f"label_{end}"])) for end in "ab"}
    return with_ends(columns, sites.properties, ends)


def wanted(properties: Mapping[str, Any], further: Mapping[str, Any] | None = None) -> dict[str, Any]:
    """Return the columns that are wanted, except those that name features anyway."""
    asked = current_written().how.columns
    names = [name for name in asked if further is None or name in further or name not in properties]
    return {name: chosen_column(properties, name, option("--with", "with_columns")) for name in names}


def described_shapes(own: Mapping[str, Any], polygons: PolygonSet, polygon: Rows) -> dict[str, Any]:
    """Return ids and properties of shapes that were made of polygons: what names these, our columns, and theirs."""
    names = names_of(polygons, polygon)
    ids = names.pop("id")[:].tolist()
    columns = with_columns_of({**names, **own}, polygons, polygon)
    properties = {name: column.tolist() for name, column in columns.items()}
    return {"ids": None if polygons.feature_ids is None else ids, "properties": properties}


def _taken(values: NDArray[np.integer], polygon: Rows) -> NDArray[np.int64]:
    """Return the values of polygons; those of none are masked."""
    taken, is_none = np.append(values, 0).astype(np.int64)[polygon], polygon < 0
    return np.ma.array(taken, mask=is_none) if is_none.any() else taken


def column_of(columns: Mapping[str, Any], name: str) -> Any:
    """Return a column by its name, or what a path with dots leads to in the objects of one; None if there is none."""
    if name in columns:
        return columns[name]
    parts = name.split(".")
    for used in range(len(parts) - 1, 0, -1):
        column = columns.get(".".join(parts[:used]))
        inner = None if column is None else [_within(value, parts[used:]) for value in column]
        if inner is not None and any(value is not None for value in inner):
            return inner
    return None


def _within(value: Any, path: Sequence[str]) -> Any:
    """Follow a path of names into an object; None where it does not lead anywhere."""
    for name in path:
        value = value.get(name) if isinstance(value, Mapping) else None
    return value


def chosen_column(columns: Mapping[str, Any], name: str, option: str) -> Any:
    """Return a column that an option names; see `column_of`."""
    found = column_of(columns, name)
    if found is not None:
        return found
    if not columns:
        raise UsageError(f"invalid {option} {name!r}: the input has no columns; leave it out")
    raise UsageError(f"invalid {option} {name!r}: expected a column of the input, {', '.join(columns)}")


def check_plain(values: Iterable[Any], option: str) -> None:
    """Refuse a column that holds objects or lists where texts or numbers are expected."""
    for value in values:
        if isinstance(value, Mapping | list | tuple | set):
            raise InputError(
                f"invalid {option}: {shown_number(value)} is {described(value)}, not text or a number; name a member "
                "of an object with a dot, such as column.name"
            )
