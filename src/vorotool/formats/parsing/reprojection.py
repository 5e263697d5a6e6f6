"""Coordinates in another reference system."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.convert.extras import needed
from vorotool.errors import InputError, UsageError
from vorotool.numeric.crs import crs_name, crs_text


def reprojected(xy: NDArray[np.float64], name: str, source: Any, target: Any) -> NDArray[np.float64]:
    """Bring coordinates from one system into another, vertex by vertex: edges stay straight lines between them."""
    pyproj = needed("pyproj", "gis", "other coordinate reference systems")
    systems = [_known(pyproj, each) for each in (source, target)]
    pyproj.network.set_network_enabled(False)  # grids that are not there are not looked for elsewhere
    made = np.stack(pyproj.Transformer.from_crs(*systems, always_xy=True).transform(*xy.T), axis=1)
    bad = np.flatnonzero(~np.isfinite(made).all(axis=1))
    if bad.size:
        x, y = xy[bad[0]].tolist()
        raise InputError(
            f"{name}: ({x}, {y}) in {crs_name(source)} cannot be expressed in {crs_name(target)} ({bad.size} such "
            "vertices): choose a system for this region"
        )
    return made


def _known(pyproj: Any, crs: Any) -> Any:
    try:
        return pyproj.CRS.from_user_input(crs_text(crs))
    except pyproj.exceptions.CRSError:
        raise UsageError(
            f"the coordinate reference system {crs_name(crs)} is unknown: check authority and code, as in EPSG:3857"
        ) from None
