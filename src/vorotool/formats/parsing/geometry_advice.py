"""What to do with geometry of another kind than the one that is read."""

from __future__ import annotations

from vorotool.errors import option

_TAKERS = (
    option("voronoi and skeleton-exact read", "voronoi and skeleton_exact take"),
    option("tessellate --cell-size rasterizes", "tessellate(..., cell_size=...) rasterizes"),
)
_TAKER_OF_ALL = option("voronoi reads", "voronoi takes")
OF_SITES = "use (Multi)Point, (Multi)LineString or (Multi)Polygon"
"""What to do with geometry that is none of these."""


def not_a_point_advice(kind: str) -> str:
    """Say what to do with a geometry that is no point."""
    lines = kind.lower().removeprefix("multi")
    if lines in ("polygon", "linestring"):
        return f"replace it by its centroid or its vertices ({_TAKERS[0]} polygons and lines, {_TAKERS[1]} them)"
    return "use Point or MultiPoint"


def not_a_shape_advice(kind: str) -> str:
    """Say what to do with a geometry that is neither polygon nor line."""
    if kind.lower().removeprefix("multi") == "point":
        return f"put points into a separate file ({_TAKER_OF_ALL} points, lines and polygons together)"
    return "use (Multi)Polygon or (Multi)LineString"
