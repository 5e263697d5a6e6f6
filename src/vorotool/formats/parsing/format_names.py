"""The names that ``input_format`` accepts: one registry for all inputs."""

from __future__ import annotations

from vorotool.errors import UsageError

POINT_NAMES = {
    "csv": "csv",
    "tsv": "csv",
    "txt": "csv",
    "node": "node",
    "npy": "npy",
    "npz": "npz",
    "geojson": "geojson",
    "wkt": "wkt",
    "json": "json",
}
"""Formats of points by name; csv stands for all delimited text."""

POLYGON_NAMES = {"json": "json", "geojson": "geojson", "wkt": "wkt", "poly": "poly"}
"""Formats of polygons and lines by name."""

IMAGE_NAMES = {
    "png": "png",
    "tiff": "tiff",
    "tif": "tiff",
    "pnm": "pnm",
    "pbm": "pnm",
    "pgm": "pnm",
    "ppm": "pnm",
    "npy": "npy",
    "zarr": "zarr",
    "jpeg": "jpeg",
    "jpg": "jpeg",
    "bmp": "bmp",
    "gif": "gif",
    "webp": "webp",
    "avif": "avif",
}
"""Formats of images by name; NPY files hold either."""

ALL_NAMES = {**POINT_NAMES, **POLYGON_NAMES, **IMAGE_NAMES}
NAMES_WITH = {"points": {**POINT_NAMES, **IMAGE_NAMES}, "polygons": {**POLYGON_NAMES, **IMAGE_NAMES}, None: ALL_NAMES}
"""Formats of inputs that hold an image or such geometry."""
DRAWN_NAMES = {**IMAGE_NAMES, **POLYGON_NAMES}
"""Formats of what is drawn again: label images, skeletons, offset curves, polygons and lines."""

_KINDS = ((POINT_NAMES, "points"), (POLYGON_NAMES, "polygons"), (IMAGE_NAMES, "images"))


def known_input_format(name: str | None, names: dict[str, str] = ALL_NAMES) -> str | None:
    """Return the format that a name stands for, in any case; None stays None.

    Raises
    ------
    UsageError
        If it stands for none; the names are listed.

    Examples
    --------
    >>> known_input_format("TIF"), known_input_format("tsv")
    ('tiff', 'csv')
    """
    if name is None:
        return None
    if name.lower() not in names:
        kind = next((kind for known, kind in _KINDS if names is known), "inputs")
        raise UsageError(f"--input-format {name!r} is no format of {kind}: use one of {', '.join(names)}")
    return names[name.lower()]
