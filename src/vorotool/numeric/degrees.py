"""Longitude and latitude: what is said where they are treated as planar."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import Kind, Message, option
from vorotool.numeric.crs import is_geographic

TO_CRS = option("--crs", "to_crs")


def note_degrees(value: Any, name: str, note: Callable[[str], None]) -> None:
    """Tell where an input is of longitude and latitude that lengths are in degrees, and what to do."""
    if is_geographic(value.crs):
        text = f"{name}: longitude and latitude are treated as planar, lengths are in degrees"
        note(Message(f"{text}; {projected_advice(value.xy)}", Kind.DEGREES, source=name))


def projected_advice(xy: NDArray[np.float64]) -> str:
    """Name the zone of UTM that an input lies in, if it does not spread over more than two."""
    if len(xy):
        (west, south), (east, north) = xy.min(axis=0).tolist(), xy.max(axis=0).tolist()
        if west >= -180 and east <= 180 and south >= -80 and north <= 84 and east - west <= 12:
            zone = min(60, int(((west + east) / 2 + 180) // 6) + 1)
            code = f"EPSG:{(32600 if south + north >= 0 else 32700) + zone}"
            return option(f"--crs {code}", f'to_crs="{code}"') + " works in meters (UTM)"
    return f"{TO_CRS} reprojects them to a projected system"
