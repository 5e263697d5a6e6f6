"""The polygons of results: written as they were given, and read as the result was computed from them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from vorotool import _core
from vorotool.types.polygons.polygon_set import PolygonSet

LATTICE_STEP = "lattice_step"
"""The member that says that coordinates were rounded to multiples of this for the result."""


def as_written(polygons: PolygonSet) -> tuple[PolygonSet, float]:
    """Return polygons as they were given, and the step of their lattice, 0 for none."""
    given = polygons.as_given
    if given is polygons:
        return polygons, 0.0
    placed, step = _placed(given)
    return (given, step) if np.array_equal(placed, polygons.xy) else (polygons, 0.0)


def as_read(polygons: PolygonSet, document: Mapping[str, Any]) -> PolygonSet:
    """Move the vertices of polygons to their lattice, if the document says that a result was computed there."""
    return polygons.moved(_placed(polygons)[0]) if document.get(LATTICE_STEP) and len(polygons) else polygons


def _placed(polygons: PolygonSet) -> tuple[Any, float]:
    """Where the lattice has the vertices, and its step."""
    vertices, origin, exponent, _ = _core.arrangement.place_on_lattice(polygons.xy, 0, None)
    step = math.ldexp(1.0, exponent)
    return np.asarray(origin) + step * vertices.astype(np.float64), step
