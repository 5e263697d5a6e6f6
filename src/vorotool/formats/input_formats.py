"""The names that ``input_format`` accepts: one registry for all inputs."""

from __future__ import annotations

from vorotool.errors import UsageError

POINT_NAMES = {
    "csv": "csv",
    "tsv": "csv",
    "txt": "csv",
    "node": "node",
    "npy": "npy",
    "geojson": "geojson",
    "wkt": "wkt",
    "json": "json",
}
"""Formats of points by name; csv stands for all delimited text."""

IMAGE_NAMES = {
    "png": "png",
    "tiff": "tiff",
    "tif": "tiff",
    "pnm": "pnm",
    "pbm": "pnm",
    "pgm": "pnm",
    "ppm": "pnm",
    "npy": "npy",
}
"""Formats of images by name; NPY files hold either."""

ALL_NAMES = {**POINT_NAMES, **IMAGE_NAMES}


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
        kind = "points" if names is POINT_NAMES else "images" if names is IMAGE_NAMES else "inputs"
        raise UsageError(f"--input-format {name!r} is no format of {kind}: use one of {', '.join(names)}")
    return names[name.lower()]
