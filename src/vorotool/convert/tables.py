"""Points from data frames, dictionaries and structured arrays; names that mean coordinates."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError, element
from vorotool.numeric.arrays import objects
from vorotool.numeric.checks import column_names, described, is_masked_array
from vorotool.numeric.coordinates import INEXACT, first_inexact, number_array
from vorotool.numeric.crs import LONGITUDE_LATITUDE, crs_member
from vorotool.numeric.numbers import plain_text, shown_number
from vorotool.types.fields import UNSTATED, UP
from vorotool.types.points.point_set import PointSet, labels_of

if TYPE_CHECKING:
    from vorotool.types.points.point_set import VolumePoints

ROWS_FIRST = ("y", "lat", "north", "row", "r", "i")
"""How names begin, or are, of a first column that may be the y of two."""

NO_TABLE = frozenset({"type", "shell", "line", "coordinates"})
"""Members of a mapping that is a geometry."""

MISSING_TYPES = ("NAType", "NaTType")


def is_table(value: Any) -> bool:
    """Tell whether a value has named columns: a data frame, a structured array, a mapping of names to columns."""
    if isinstance(value, Mapping):
        return bool(value) and not value.keys() & NO_TABLE
    return column_names(value) is not None


def points_of_table(table: Any, name: str) -> PointSet:
    """Take coordinates, labels, further columns and the index of a table."""
    names, columns = _columns_of(table)
    texts = [plain_text(each) for each in names]
    chosen = coordinate_columns(texts) or _two_numeric(texts, columns)
    if chosen is None:
        raise _unknown(table, names, columns, name)
    x, y, *_ = chosen
    return PointSet(**_taken(table, texts, columns, chosen), **placed_by(texts[x], texts[y]))


def volume_points_of_table(table: Any) -> VolumePoints:
    """Take coordinates of space, labels, further columns and the index of a table."""
    from vorotool.types.points.point_set import VolumePoints

    names, columns = _columns_of(table)
    texts = [plain_text(each) for each in names]
    chosen = coordinate_columns(texts, axes=3)
    if chosen is None:
        raise InputError(f"expected columns x, y, z, but got {described(table)}; rename the columns")
    taken = _taken(table, texts, columns, chosen, axes=3)
    return VolumePoints(taken.pop("xy"), **taken)


def _columns_of(table: Any) -> tuple[list[Any], list[Any]]:
    """Names and columns of a table."""
    names = list(table) if isinstance(table, Mapping) else column_names(table) or []
    return names, [_column(table, place, each) for place, each in enumerate(names)]


def _taken(table: Any, texts: list[str], columns: list[Any], chosen: list[int], axes: int = 2) -> dict[str, Any]:
    """Coordinates, labels, further columns and the index, by the names that points have for them."""
    for place in chosen:
        if not hasattr(columns[place], "__len__"):
            raise InputError(f"the column {texts[place]} is {described(columns[place])}, not a list of numbers")
    lengths = {len(columns[place]) for place in chosen}
    if len(lengths) > 1:
        *first, last = (texts[place] for place in chosen[:axes])
        raise InputError(f"the columns {', '.join(first)} and {last} differ in length")
    labels = labels_of(_labels(columns[chosen[axes]])) if len(chosen) > axes else None
    used = chosen if labels is not None else chosen[:axes]
    others = [place for place in range(len(texts)) if place not in used]
    return {
        "xy": np.stack([_numbers(columns[place], texts[place]) for place in chosen[:axes]], axis=1),
        "labels": labels,
        "properties": {texts[place]: listed(columns[place]) for place in others},
        "index": index_of(table),
    }


def columns_of_features(
    ids: Sequence[Any] | None, columns: Mapping[str, Sequence[Any]], parts: Sequence[int]
) -> dict[str, Any]:
    """Give ids of features, their columns and, if any has several points, the number of each as columns of points."""
    made: dict[str, Any] = {} if ids is None else {"id": ids}
    for name, values in columns.items():
        made["property_id" if ids is not None and name == "id" else name] = values
    if max(parts, default=1) > 1:
        made["voro_part" if "part" in made else "part"] = parts
    return made


def index_of(value: Any) -> Any:
    """Give the index of a data frame or a series; None of what has none."""
    index = getattr(value, "index", None)
    return None if index is None or callable(index) else index


def listed(column: Any) -> list[Any]:
    """Give the values of a column as objects of Python; None where there is none."""
    for method in ("to_pylist", "tolist", "to_list"):
        if hasattr(column, method):
            values: list[Any] = getattr(column, method)()
            break
    else:
        values = list(column)
    is_missing = getattr(column, "isna", None)
    missing = np.flatnonzero(np.asarray(is_missing())) if callable(is_missing) else ()
    for row in missing:
        values[row] = None
    return values


def _column(table: Any, place: int, name: Any) -> Any:
    """Take a column by its place where that goes: names may come twice."""
    rows = getattr(table, "iloc", None)
    return table[name] if rows is None else rows[:, place]


def _numbers(column: Any, name: str) -> NDArray[Any]:
    """Give the values of a column of coordinates, none of them an integer beyond doubles; NaN where there is none."""
    array = _plain_array(column)
    if array.ndim != 1:
        raise InputError(f"the column {name} has shape {array.shape}, but must be one of numbers")
    numbers = number_array(array, "value", f"the column {name} must hold numbers")
    row = first_inexact(numbers.reshape(-1, 1))
    if row is not None:  # put beside a column of another type it would be rounded
        shown = shown_number(numbers[row : row + 1].tolist()[0])
        raise InputError(f"the column {name} has {shown} in {element('row', row)}: {INEXACT}")
    return numbers


def _plain_array(column: Any) -> NDArray[Any]:
    array = np.ma.asanyarray(column) if is_masked_array(column) else np.asarray(column)
    if is_masked_array(array):
        return np.where(np.ma.getmaskarray(array), np.nan, array.data) if np.ma.is_masked(array) else array.data
    if array.dtype.kind == "O":
        return objects(
            [np.nan if each is None or type(each).__name__ in MISSING_TYPES else each for each in array.tolist()]
        )
    return array


def _labels(column: Any) -> NDArray[Any]:
    return np.asarray(listed(column) if str(getattr(column, "dtype", "")) == "object" else column)


def _two_numeric(names: list[str], columns: list[Any]) -> list[int] | None:
    """Take the only two columns, if they hold numbers and are not called y and x."""
    if len(columns) != 2 or not all(map(_is_numeric, columns)):
        return None
    first = plain_name(names[0])
    return None if first in ROWS_FIRST or first.startswith(ROWS_FIRST[:4]) else [0, 1]


def _is_numeric(column: Any) -> bool:
    kind = getattr(column, "dtype", None)
    numeric = getattr(kind, "_is_numeric", None)  # of the nullable types of pandas
    if isinstance(numeric, bool):
        return numeric
    array = np.asarray(column)
    return array.ndim == 1 and array.dtype.kind in "iuf"


def _unknown(table: Any, names: list[Any], columns: list[Any], name: str) -> InputError:
    numeric = [names[place] for place, column in enumerate(columns) if _is_numeric(column)]
    pair = numeric[:2] if len(numeric) > 1 else ["a", "b"]
    if len(columns) == 2 and len(numeric) == 2:  # they look like y and x
        pair = pair[::-1]
    is_frame = hasattr(table, "iloc")
    how = f"rename the columns, or give {name}[{pair!r}]" if is_frame else "rename the columns"
    return InputError(f"expected columns x, y or lon, lat, but got {described(table)}; {how}")


COORDINATE_NAMES = (
    ("x", "y"),
    ("lon", "lat"),
    ("longitude", "latitude"),
    ("long", "lat"),
    ("easting", "northing"),
    ("e", "n"),
    ("centroid_x", "centroid_y"),
    ("location_center_x", "location_center_y"),  # CellProfiler
    ("position_x", "position_y"),  # TrackMate
    ("centroid x µm", "centroid y µm"),  # QuPath
    ("centroid x px", "centroid y px"),
    ("centroid-1", "centroid-0"),  # scikit-image: row first
    ("axis-1", "axis-0"),  # napari: row first
)
SPACE_NAMES = (
    ("x", "y", "z"),
    ("centroid-2", "centroid-1", "centroid-0"),  # scikit-image: slice first
    ("axis-2", "axis-1", "axis-0"),  # napari: slice first
)
LONGITUDE_LATITUDE_NAMES = (("lon", "lat"), ("long", "lat"), ("longitude", "latitude"))
MAP_NAMES = (*LONGITUDE_LATITUDE_NAMES, ("easting", "northing"), ("e", "n"))
"""Of which the second one grows northwards."""


def coordinate_columns(names: Sequence[str], *, axes: int = 2) -> list[int] | None:
    """Find the columns of a table that are its coordinates, and then the one that is called label."""
    plain = [plain_name(name) for name in names]
    for group in COORDINATE_NAMES if axes == 2 else SPACE_NAMES:
        if all(plain.count(each) == 1 for each in group):
            label = [plain.index("label")] if plain.count("label") == 1 else []
            return [*(plain.index(each) for each in group), *label]
    return None


def plain_name(text: str) -> str:
    """Give the name of a column without blanks around it, in lower case."""
    return text.strip().lower().replace("\u03bc", "µ")


def placed_by(x: str, y: str, *, has_crs: bool = False) -> dict[str, Any]:
    """Give the direction of y and the coordinate reference system of points, which the names of the columns tell."""
    names = plain_name(x), plain_name(y)
    is_geographic = names[0] in _FIRST and names[1] in _SECOND
    return {
        "y_axis": UP if is_geographic or names in MAP_NAMES else UNSTATED,  # on maps y goes up
        "crs": crs_member(LONGITUDE_LATITUDE) if is_geographic and not has_crs else None,
    }


_FIRST, _SECOND = (tuple(pair[k] for pair in LONGITUDE_LATITUDE_NAMES) for k in (0, 1))
