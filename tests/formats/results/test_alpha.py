"""GeoJSON and WKT of alpha shapes."""

from __future__ import annotations

import json

import numpy as np
import pytest
import shapely

from support.readers.written import written
from vorotool import alpha_hull, alpha_shape


def test_a_hull_with_a_hole():
    grid = np.stack(np.meshgrid(np.arange(9), np.arange(9)), axis=-1).reshape(-1, 2).astype(float)
    points = np.concatenate([grid[abs(grid - 4).max(axis=1) > 1], [[20.0, 20]]])
    hull = alpha_hull(alpha_shape(points, r=0.8))
    features = json.loads(written(hull, "geojson"))["features"]
    (polygon,), (point,) = ([f for f in features if f["geometry"]["type"] == kind] for kind in ("Polygon", "Point"))
    shape = shapely.geometry.shape(polygon["geometry"])
    assert shape.is_valid
    assert len(shape.interiors) == 1
    assert shapely.is_ccw(shape.exterior)
    # the corners of the gap are cut off by triangles of their own
    right = 64 - 14 - 40 * segment(1, 0.8) - 4 * segment(2**0.5, 0.8)
    assert shape.area == pytest.approx(right, rel=1e-3)
    assert (point["geometry"]["coordinates"], point["properties"]["label"]) == ([20, 20], len(points))


def segment(chord, radius):
    """Area between a circle and a chord of it."""
    half = np.arcsin(chord / 2 / radius)
    return radius**2 * (half - np.sin(half) * np.cos(half))
