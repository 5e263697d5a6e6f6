"""Results in other units: coordinates and lengths times a factor, areas times its square."""

from __future__ import annotations

from collections.abc import Collection
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
from vorotool.geometry.mesh.triangulation import Triangulation
from vorotool.geometry.polygons.polygon_set import PolygonSet
from vorotool.geometry.skeleton.centerline import Centerlines
from vorotool.geometry.skeleton.offsets import Offsets
from vorotool.geometry.skeleton.points_along import SkeletonPoints
from vorotool.geometry.skeleton.skeleton import SiteTable, Skeleton
from vorotool.geometry.table import Table

LENGTHS = frozenset(
    {
        *("x", "y", "perimeter", "nearest_distance", "max_distance", "bbox_x", "bbox_y", "bbox_w", "bbox_h"),
        *("border_length", "centroid_distance", "voronoi_length", "r", "length"),
    }
)
AREAS = frozenset({"area", "object_area"})
"""Columns of tables that are lengths, coordinates included, and areas; the others are numbers, labels and names."""


_LENGTHS_OF = {
    PolygonSet: "xy",
    Triangulation: "points",
    DigitalTriangulation: "points",
    CellSet: "sites coordinates frame",
    AlphaComplex: "mesh r_min r_mid r_max spectrum",
    AlphaShape: "family r polygons",
    AlphaHull: "shape start end centre",
    SiteTable: "ends",
    Skeleton: "polygons site_table frame vertices radius control length error_bound gap",
    Centerlines: "path ends",
    SkeletonPoints: "skeleton along xy radius feet",
    Offsets: "polygons site_table start end centre distance",
}
"""What of each type is a length, or has lengths; all else stays."""


def scaled(value: Any, factor: Fraction, *, unit: str | None = None) -> Any:
    """Give a result in units of which one is ``1 / factor`` of the old.

    What was decided in the old units stays: edges, ranks, classes, ties. Each number is rounded once.

    Parameters
    ----------
    value : PolygonSet, Triangulation, DigitalTriangulation, CellSet, AlphaComplex, AlphaShape, AlphaHull, Skeleton,
        SkeletonPoints, Offsets or Centerlines
        What to scale; for a table see `scaled_table`.
    factor : Fraction
        More than 0.
    unit : str, optional
        Of the result.

    Raises
    ------
    UsageError
        If it is of another type.

    Examples
    --------
    >>> from vorotool import delaunay
    >>> scaled(delaunay([[0, 0], [4, 0], [0, 3]]), Fraction(1, 2)).edge_lengths().tolist()
    [1.5, 2.0, 2.5]
    """
    if type(value) not in _LENGTHS_OF:
        raise UsageError(f"a {type(value).__name__} is not scaled")
    parts = {name: _scaled(getattr(value, name), factor, unit) for name in _LENGTHS_OF[type(value)].split()}
    return replace(value, **parts, unit=unit) if isinstance(value, PolygonSet) else replace(value, **parts)


def _scaled(part: Any, factor: Fraction, unit: str | None) -> Any:
    if type(part) in _LENGTHS_OF:
        return scaled(part, factor, unit=unit)
    if isinstance(part, Box):
        return Box(*_scaled(part.sides, factor, unit))
    if isinstance(part, tuple):
        return tuple(side * float(factor) for side in part)
    return None if part is None else part * (factor if isinstance(part, Fraction) else float(factor))


def scaled_table(table: Table, factor: Fraction, *, properties: Collection[str] = ()) -> Table:
    """Give a table of tessellations, triangulations or alpha shapes in other units.

    Parameters
    ----------
    table : Table
        Its columns with a name in `LENGTHS` or `AREAS` are scaled.
    factor : Fraction
        More than 0.
    properties : collection of str
        Names of the input's own columns, which are not.

    Examples
    --------
    >>> table = scaled_table(Table({"label": [1], "area": [8], "perimeter": [12]}), Fraction(1, 2))
    >>> table["label"], table["area"].tolist(), table["perimeter"].tolist()
    ([1], [2.0], [6.0])
    """
    return Table({name: _scaled_column(name, column, factor, properties) for name, column in table.stored().items()})


def _scaled_column(name: str, column: Any, factor: Fraction, properties: Collection[str]) -> Any:
    ours = "" if name in properties else name.removeprefix("voro_")
    if ours in LENGTHS:
        return np.ma.asanyarray(column) * float(factor)
    return np.ma.asanyarray(column) * float(factor * factor) if ours in AREAS else column
