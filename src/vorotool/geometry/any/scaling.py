"""Results in other units: coordinates and lengths times a factor, areas times its square; and placed on a map."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np

from vorotool.errors import UsageError
from vorotool.geometry.alpha.complex import AlphaComplex
from vorotool.geometry.alpha.hull import AlphaHull
from vorotool.geometry.alpha.shape import AlphaShape
from vorotool.geometry.box import Box
from vorotool.geometry.mesh.cells import CellSet
from vorotool.geometry.mesh.digital_triangulation import DigitalTriangulation
from vorotool.geometry.mesh.proximity import ProximityGraph
from vorotool.geometry.mesh.triangulation import Triangulation
from vorotool.geometry.polygons.polygon_set import PolygonSet
from vorotool.geometry.skeleton.centerline import Centerlines
from vorotool.geometry.skeleton.discs import Discs
from vorotool.geometry.skeleton.extended import ExtendedSkeleton
from vorotool.geometry.skeleton.necks import Necks
from vorotool.geometry.skeleton.offsets import Offsets
from vorotool.geometry.skeleton.parts import Parts
from vorotool.geometry.skeleton.points_along import SkeletonPoints
from vorotool.geometry.skeleton.skeleton import SiteTable, Skeleton
from vorotool.geometry.skeleton.smooth_lines import SmoothLines
from vorotool.geometry.skeleton.thickness import ThicknessImage
from vorotool.geometry.table import Table
from vorotool.geometry.voronoi.voronoi_map import VoronoiMap

Place = tuple[float, float] | None

LENGTHS = frozenset(
    {
        *("x", "y", "perimeter", "nearest_distance", "max_distance", "bbox_x", "bbox_y", "bbox_w", "bbox_h"),
        *("border_length", "centroid_distance", "voronoi_length", "r", "length"),
        *("birth", "death", "persistence"),
    }
)
AREAS = frozenset({"area", "object_area"})
"""Columns of tables that are lengths, coordinates included, and areas; the others are numbers, labels and names."""


_LENGTHS_OF = {
    PolygonSet: "xy",
    Triangulation: "points",
    DigitalTriangulation: "points",
    ProximityGraph: "mesh",
    CellSet: "sites coordinates frame",
    AlphaComplex: "mesh r_min r_mid r_max spectrum",
    AlphaShape: "family r polygons",
    AlphaHull: "shape start end centre",
    SiteTable: "ends",
    Skeleton: "polygons site_table frame vertices radius control length error_bound gap",
    Centerlines: "path ends",
    ExtendedSkeleton: "path ends",
    SmoothLines: "lines control error",
    SkeletonPoints: "skeleton along xy radius feet",
    Discs: "polygons site_table xy radius feet within",
    Necks: "skeleton xy width feet beside",
    Parts: "polygons radius centre necks",
    Offsets: "polygons site_table start end centre distance",
    ThicknessImage: "values",
    VoronoiMap: "polygons clip enclosures vertices radius control center frame max_distance",
}
"""What of each type is a length, or has lengths; all else stays."""

_DISTANCES = frozenset(
    {
        *("r", "r_min", "r_mid", "r_max", "spectrum", "radius", "length"),
        *("error_bound", "error", "gap", "along", "distance", "max_distance", "values", "width", "beside"),
    }
)
"""What of these is a length, and no place."""


def scaled(
    value: Any, factor: Fraction, origin: Place = None, *, unit: str | None = None, of_steps: bool = False
) -> Any:
    """Give a result in units of which one is ``1 / factor`` of the old."""
    if type(value) not in _LENGTHS_OF:
        raise UsageError(f"a {type(value).__name__} is not scaled")
    parts = {
        name: _scaled(getattr(value, name), factor, None if name in _DISTANCES else origin, unit, of_steps=of_steps)
        for name in _LENGTHS_OF[type(value)].split()
    }
    if not isinstance(value, PolygonSet):
        return replace(value, **parts)
    made = replace(value, **parts, unit=unit)
    if value.as_given is value:
        return made
    as_given = _scaled(value.as_given.xy, factor, origin, unit, of_steps=of_steps)
    return replace(made, xy=as_given).moved(made.xy)


def _scale(factor: Fraction, *, of_steps: bool) -> tuple[float, float]:
    """What numbers are multiplied by, and then divided by."""
    return (float(factor.numerator), float(factor.denominator)) if of_steps else (float(factor), 1.0)


def _scaled(part: Any, factor: Fraction, origin: Place, unit: str | None, *, of_steps: bool) -> Any:
    if type(part) in _LENGTHS_OF:
        return scaled(part, factor, origin, unit=unit, of_steps=of_steps)
    times, over = _scale(factor, of_steps=of_steps)
    if isinstance(part, Box):
        sides = (side * times / over for side in part.sides)
        return Box(
            *(sides if origin is None else (side + shift for side, shift in zip(sides, 2 * origin, strict=True)))
        )
    if isinstance(part, tuple):  # a frame: x, y, width, height
        shifts = (*(origin or (0.0, 0.0)), 0.0, 0.0)
        return tuple(side * times / over + shift for side, shift in zip(part, shifts, strict=True))
    if part is None:
        return None
    made = part * factor if isinstance(part, Fraction) else part * times / over
    return made if origin is None else made + np.asarray(origin)


def scaled_table(
    table: Table,
    factor: Fraction,
    *,
    properties: Collection[str] = (),
    origin: Place = None,
    y_up: bool = False,
    pixel: tuple[float, float] = (1.0, 1.0),
    of_steps: bool = False,
) -> Table:
    """Give a table of tessellations, triangulations or alpha shapes in other units."""
    columns = table.stored()
    scale = {LENGTHS: _scale(factor, of_steps=of_steps), AREAS: _scale(factor * factor, of_steps=of_steps)}
    made = {name: _scaled_column(name, column, scale, properties) for name, column in columns.items()}
    if origin is not None:
        made |= _placed_columns(columns, scale[LENGTHS], origin, pixel, y_up=y_up, properties=properties)
    return Table(made)


def _placed_columns(
    columns: Mapping[str, Any],
    scale: tuple[float, float],
    origin: tuple[float, float],
    pixel: tuple[float, float],
    *,
    y_up: bool,
    properties: Collection[str],
) -> dict[str, Any]:
    """Coordinates on the map: of sites, and of the left and the lower side of boxes."""
    own = {"" if name in properties else name.removeprefix("voro_"): name for name in columns}
    x, y, left, top, high = (
        np.ma.asanyarray(columns[own[name]]) if name in own else None
        for name in ("x", "y", "bbox_x", "bbox_y", "bbox_h")
    )
    made: dict[str, Any] = {}
    (across, down), (times, over) = (pixel[0] / 2, pixel[1] / 2), scale
    if x is not None and y is not None:
        made[own["x"]] = x * times / over + origin[0]
        made[own["y"]] = (-y if y_up else y) * times / over + origin[1]
    if left is not None and top is not None and high is not None:
        made[own["bbox_x"]] = (left - across) * times / over + origin[0]
        made[own["bbox_y"]] = (-(top + high - down) if y_up else top - down) * times / over + origin[1]
    return made


def _scaled_column(
    name: str, column: Any, scale: Mapping[frozenset[str], tuple[float, float]], properties: Collection[str]
) -> Any:
    ours = "" if name in properties else name.removeprefix("voro_")
    if ours not in LENGTHS | AREAS:
        return column
    times, over = scale[LENGTHS if ours in LENGTHS else AREAS]
    values = column if isinstance(column, np.ndarray) else np.ma.asanyarray(column)
    return values * times / over
