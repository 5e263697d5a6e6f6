"""Polygons and lines in well-known text."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any, BinaryIO

import numpy as np

from vorotool.convert.sites import Sites
from vorotool.errors import InputError
from vorotool.formats.io.sources import Source, check_nesting
from vorotool.formats.parsing.json import OF_SITES, not_a_shape_advice
from vorotool.formats.parsing.reader_options import ReadOptions, shortened
from vorotool.formats.parsing.reference_systems import crs_of_numbers
from vorotool.formats.points.wkt import geometry_texts
from vorotool.formats.polygons.geojson import feature_ranges, feature_texts
from vorotool.formats.text.row_writer import Column, RowShape, coordinate_text, write_rows
from vorotool.numeric.curves.well_known import geometry_of_texts
from vorotool.types.axis import UP
from vorotool.types.polygons.conversion import polygons_of_geometry
from vorotool.types.polygons.polygon_set import PolygonSet

_COMMENT = re.compile(rb"^\s*#.*$", re.MULTILINE)
_SHAPE = re.compile(rb"POLYGON|LINESTRING|LINEARRING|CIRCULARSTRING|CURVE|SURFACE|TIN|TRIANGLE", re.IGNORECASE)
_POINTS, _SHAPES, _COLLECTION = (0, 4), (1, 2, 3, 5, 6), 7  # type numbers of GEOS


def read_wkt(source: Source, options: ReadOptions) -> PolygonSet:
    """Read (MULTI)POLYGON, (MULTI)LINESTRING and collections of them, one feature a geometry."""
    polygons, geometries = _read(source, options)
    options.note_left_out(source.name, _count_of_empty(geometries))
    return polygons


def read_sites(source: Source, options: ReadOptions) -> Sites:
    """Read points, lines and polygons, each geometry a site; an empty one is a site without places."""
    polygons, geometries = _read(source, options, takes_points=True)
    assert polygons.feature is not None
    options.note_empty(source.name, _count_of_empty(geometries))
    return Sites(polygons, polygons.feature, len(geometries))


def _count_of_empty(geometries: Any) -> int:
    import shapely

    return int(shapely.is_empty(geometries).sum())


def _read(source: Source, options: ReadOptions, *, takes_points: bool = False) -> tuple[PolygonSet, Any]:
    import shapely

    expected = (*_SHAPES, *(_POINTS if takes_points else ()))
    check_nesting(source.data, name=source.name)
    texts, lines, srids = geometry_texts(source)
    crs = crs_of_numbers(source.name, srids, lines.__getitem__)
    geometries, curves = geometry_of_texts(texts, options.flatten)
    for index in np.flatnonzero(~np.isin(shapely.get_type_id(geometries), expected)):
        _check_geometry(geometries[index], texts[index], f"{source.name}, line {lines[index]}", expected)
    options.check_vertices(source.name, int(shapely.get_num_coordinates(geometries).sum()))
    _check_finite(source.name, geometries, texts, lines)
    options.note_curves(source.name, curves)
    if shapely.has_z(geometries).any():
        options.note_heights(source.name)
    polygons = polygons_of_geometry(geometries, takes_points=takes_points)
    return replace(polygons, y_axis=UP, crs=crs), geometries


def holds_shapes(data: bytes) -> bool:
    """Whether a well-known text names a polygon or a line."""
    return _SHAPE.search(_COMMENT.sub(b"", data)) is not None


def _check_geometry(geometry: Any, text: str, place: str, expected: tuple[int, ...]) -> None:
    import shapely

    if geometry is None:
        raise InputError(
            f"{place}: {shortened(text)} is not WKT; write for example POLYGON ((0 0, 4 0, 0 3, 0 0)), each ring closed"
        )
    kind = shapely.get_type_id(geometry)
    if kind == _COLLECTION:
        for part in shapely.get_parts(geometry):
            _check_geometry(part, text, place, expected)
    elif kind not in expected:
        name = geometry.geom_type
        if _POINTS[0] in expected:
            raise InputError(f"{place}: a {name} is not a point, line or polygon; {OF_SITES}")
        raise InputError(f"{place}: a {name} is not a polygon or line; {not_a_shape_advice(name)}")


def _check_finite(name: str, geometries: Any, texts: list[str], lines: list[int]) -> None:
    import shapely

    xy, owners = shapely.get_coordinates(geometries, return_index=True)
    bad = np.flatnonzero(~np.isfinite(xy).all(axis=1))
    if bad.size:
        at = int(bad[0])
        owner = int(owners[at])
        vertex = at - int(np.searchsorted(owners, owner)) + 1
        raise InputError(
            f"{name}, line {lines[owner]}: vertex {vertex} of {shortened(texts[owner])} is ({xy[at, 0]}, {xy[at, 1]}): "
            "coordinates must be finite; correct it"
        )


def write_wkt(out: BinaryIO, polygons: PolygonSet) -> None:
    """Write one geometry a line for each feature; WKT has no place for ids and properties."""
    texts = feature_texts(polygons, "wkt")
    if texts is not None:
        write_rows(out, [Column("", texts)], RowShape(("", "\n")))
        return
    is_line = polygons.is_line
    for first, last in feature_ranges(polygons):
        bodies = [_body(polygons, index) for index in range(first, last)]
        kinds = ["LINESTRING" if line else "POLYGON" for line in is_line[first:last]]
        if len(bodies) == 1:
            text = f"{kinds[0]} {bodies[0]}"
        elif len(set(kinds)) == 1:
            text = f"MULTI{kinds[0]} ({', '.join(bodies)})"
        else:
            parts = ", ".join(f"{kind} {body}" for kind, body in zip(kinds, bodies, strict=True))
            text = f"GEOMETRYCOLLECTION ({parts})"
        out.write(text.encode() + b"\n")


def _body(polygons: PolygonSet, index: int) -> str:
    rings = []
    for ring in polygons.rings_of(index):
        positions = [f"{coordinate_text(x)} {coordinate_text(y)}" for x, y in ring.tolist()]
        if polygons.is_line[index]:  # of a single vertex it would be no line
            return f"({', '.join(positions * 2 if len(positions) == 1 else positions)})"
        rings.append(f"({', '.join(positions + positions[:1] * max(1, 4 - len(positions)))})")
    return f"({', '.join(rings)})"
