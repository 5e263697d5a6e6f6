"""Well-known binary: a geometry, or several one after the other in lines of hexadecimal digits."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError
from vorotool.formats.features.feature_table import Features
from vorotool.formats.io.sources import Source
from vorotool.formats.parsing.reference_systems import crs_of_numbers
from vorotool.numeric.curves.well_known import geometry_of_binary

_HEXADECIMAL = re.compile(rb"[0-9A-Fa-f\s]*")


def features_of(source: Source) -> Features:
    """Read one geometry, or one a line."""
    import shapely

    if not source.data.strip():
        raise InputError(
            f"{source.name} is empty, but well-known binary (WKB) is expected; check the program that wrote it"
        )
    is_digits = _HEXADECIMAL.fullmatch(source.data) is not None
    written = source.data.split() if is_digits else [source.data]
    geometry, curves = geometry_of_binary([item.decode() for item in written] if is_digits else written, source.flatten)
    bad = np.flatnonzero(shapely.is_missing(geometry))
    if bad.size:
        raise InputError(f"{source.name}: geometry {bad[0] + 1} is not WKB; is the file damaged or cut off?")
    crs = crs_of_geometry(source.name, geometry, lambda row: row + 1)
    return Features(source.name, geometry, {}, None, crs, curves=curves)


def crs_of_geometry(name: str, geometry: NDArray[Any], line_of: Callable[[int], int]) -> Any:
    """Give the ``crs`` member for the numbers (SRID) that geometry of extended well-known binary carries."""
    import shapely

    numbers = [0 if each is None else int(shapely.get_srid(each)) for each in geometry]
    return crs_of_numbers(name, numbers, line_of)
