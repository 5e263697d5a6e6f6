"""Names of columns that hold coordinates, as tables of all kinds have them."""

from __future__ import annotations

from collections.abc import Sequence

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


def coordinate_columns(names: Sequence[str]) -> list[int] | None:
    """Find the columns of a table that are its coordinates, and then the one that is called label."""
    return _known_columns(names, COORDINATE_NAMES)


def space_columns(names: Sequence[str]) -> list[int] | None:
    """Find the columns of a table that are coordinates of space; as `coordinate_columns` with a z."""
    return _known_columns(names, SPACE_NAMES)


def _known_columns(names: Sequence[str], known: Sequence[tuple[str, ...]]) -> list[int] | None:
    plain = [plain_name(name) for name in names]
    for group in known:
        if all(plain.count(each) == 1 for each in group):
            label = [plain.index("label")] if plain.count("label") == 1 else []
            return [*(plain.index(each) for each in group), *label]
    return None


def plain_name(text: str) -> str:
    """Give the name of a column without blanks around it, in lower case."""
    return text.strip().lower().replace("\u03bc", "µ")


def is_longitude_latitude(x: str, y: str) -> bool:
    """Tell whether columns are longitude and latitude by their names."""
    return plain_name(x) in _FIRST and plain_name(y) in _SECOND


def is_map(x: str, y: str) -> bool:
    """Tell whether columns are places on a map by their names, so that pictures have y upwards."""
    return is_longitude_latitude(x, y) or (plain_name(x), plain_name(y)) in MAP_NAMES


_FIRST, _SECOND = (tuple(pair[k] for pair in LONGITUDE_LATITUDE_NAMES) for k in (0, 1))
