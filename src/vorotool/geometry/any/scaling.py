"""Results in other units: coordinates and lengths times a factor, areas times its square."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace
from fractions import Fraction
from functools import singledispatch
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


@singledispatch
def scaled(value: Any, factor: Fraction) -> Any:
    """Give a result in units of which one is ``1 / factor`` of the old.

    What was decided in the old units stays: edges, ranks, classes, ties. Each number is rounded once.

    Parameters
    ----------
    value : PolygonSet, Triangulation, DigitalTriangulation, CellSet, AlphaComplex, AlphaShape, AlphaHull, Skeleton,
        SkeletonPoints, Offsets or Centerlines
        What to scale; for a table see `scaled_table`.
    factor : Fraction
        More than 0.

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
    raise UsageError(f"a {type(value).__name__} is not scaled")


@scaled.register
def _(value: PolygonSet, factor: Fraction) -> PolygonSet:
    return replace(value, xy=value.xy * float(factor))


@scaled.register
def _(value: Triangulation, factor: Fraction) -> Triangulation:
    return replace(value, points=value.points * float(factor))


@scaled.register
def _(value: DigitalTriangulation, factor: Fraction) -> DigitalTriangulation:
    return replace(value, points=value.points * float(factor))


@scaled.register
def _(value: CellSet, factor: Fraction) -> CellSet:
    by = float(factor)
    frame = Box(*(side * by for side in value.frame.sides))
    return replace(value, sites=value.sites * by, coordinates=value.coordinates * by, frame=frame)


@scaled.register
def _(value: AlphaComplex, factor: Fraction) -> AlphaComplex:
    radii = {name: getattr(value, name) * float(factor) for name in ("r_min", "r_mid", "r_max", "spectrum")}
    return replace(value, mesh=scaled(value.mesh, factor), **radii)


@scaled.register
def _(value: AlphaShape, factor: Fraction) -> AlphaShape:
    r = value.r * factor if isinstance(value.r, Fraction) else value.r * float(factor)
    return replace(value, family=scaled(value.family, factor), r=r, polygons=scaled(value.polygons, factor))


@scaled.register
def _(value: AlphaHull, factor: Fraction) -> AlphaHull:
    places = {name: getattr(value, name) * float(factor) for name in ("start", "end", "centre")}
    return replace(value, shape=scaled(value.shape, factor), **places)


@scaled.register
def _(value: Skeleton, factor: Fraction) -> Skeleton:
    names = ("vertices", "radius", "control", "length", "error_bound", "gap")
    x, y, w, h = value.frame or (0.0, 0.0, 0.0, 0.0)
    by = float(factor)
    return replace(
        value,
        polygons=scaled(value.polygons, factor),
        site_table=_scaled_sites(value.site_table, by),
        frame=value.frame and (x * by, y * by, w * by, h * by),
        **{name: getattr(value, name) * by for name in names},
    )


@scaled.register
def _(value: Centerlines, factor: Fraction) -> Centerlines:
    return replace(value, path=scaled(value.path, factor), ends=value.ends * float(factor))


@scaled.register
def _(value: SkeletonPoints, factor: Fraction) -> SkeletonPoints:
    lengths = {name: getattr(value, name) * float(factor) for name in ("along", "xy", "radius", "feet")}
    return replace(value, skeleton=scaled(value.skeleton, factor), **lengths)


@scaled.register
def _(value: Offsets, factor: Fraction) -> Offsets:
    lengths = {name: getattr(value, name) * float(factor) for name in ("start", "end", "centre", "distance")}
    sites = _scaled_sites(value.site_table, float(factor))
    return replace(value, polygons=scaled(value.polygons, factor), site_table=sites, **lengths)


def _scaled_sites(table: SiteTable, by: float) -> SiteTable:
    return table if table.ends is None else replace(table, ends=table.ends * by)


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
