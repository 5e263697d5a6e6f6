"""Points from well-known text."""

from __future__ import annotations

from typing import Any

import numpy as np

from vorotool.errors import InputError
from vorotool.formats.io.sources import Source, check_nesting
from vorotool.formats.parsing.json import not_a_point_advice
from vorotool.formats.parsing.reader_options import ReadOptions, no_points, shortened
from vorotool.formats.parsing.reference_systems import crs_of_numbers
from vorotool.formats.points.columns import PointRows, point_set
from vorotool.numeric.crs import without_number
from vorotool.numeric.curves.well_known import geometry_of_texts
from vorotool.types.axis import UP
from vorotool.types.points.conversion import COLLECTION, MULTIPOINT, POINT, part_numbers, single_points
from vorotool.types.points.point_set import PointSet


def read_wkt(source: Source, options: ReadOptions) -> PointSet:
    """Read POINT, MULTIPOINT and collections of them; several points of one geometry are its parts."""
    return point_set(wkt_rows(source, options))


def wkt_rows(source: Source, options: ReadOptions) -> PointRows:
    """Read what `read_wkt` reads, with a z where the options want it."""
    import shapely

    check_nesting(source.data, name=source.name)
    texts, lines, srids = geometry_texts(source)
    crs = crs_of_numbers(source.name, srids, lines.__getitem__)
    geometries, _ = geometry_of_texts(texts)  # of which curves are no points
    for index in np.flatnonzero(shapely.get_type_id(geometries) != POINT):
        _check_geometry(geometries[index], texts[index], f"{source.name}, line {lines[index]}")
    points, owners = single_points(geometries)
    options.check_sites(source.name, len(points))
    options.note_left_out(source.name, len(geometries) - len(np.unique(owners)))
    if not len(points):
        return PointRows(no_points(options.axes), None, {}, {"y_axis": UP, "crs": crs})
    found = shapely.get_coordinates(points, include_z=options.wants_z)
    bad = np.flatnonzero(~np.isfinite(found).all(axis=1))
    if bad.size:
        owner = int(owners[bad[0]])
        place = f"{source.name}, line {lines[owner]}: {texts[owner][:40]!r}"
        if options.wants_z and not shapely.has_z(points[bad[0]]):
            raise InputError(f"{place} has no z; write for example POINT Z (3 4 5)")
        raise InputError(f"{place} is not finite; correct it")
    if not options.wants_z and shapely.has_z(points).any():
        options.note_heights(source.name)
    parts = part_numbers(owners)
    properties = {"part": parts.tolist()} if options.properties and parts.max() > 1 else {}
    return PointRows(found, None, properties, {"y_axis": UP, "crs": crs})


def geometry_texts(source: Source) -> tuple[list[str], list[int], list[int]]:
    """Cut a text into geometries, and give the line and the SRID (or 0) of each: it ends when its brackets close."""
    texts: list[str] = []
    lines: list[int] = []
    srids: list[int] = []
    depth = 0
    for number, line in enumerate(source.data.decode("utf-8", "replace").splitlines(), 1):
        text = line.strip()
        if not text or (depth == 0 and text.startswith("#")):
            continue
        if depth > 0 or (texts and text.startswith("(")):
            texts[-1] += " " + text
        else:
            text, srid = without_number(text)
            texts.append(text)
            lines.append(number)
            srids.append(srid)
        depth = max(0, depth + text.count("(") - text.count(")"))
    return texts, lines, srids


def _check_geometry(geometry: Any, text: str, place: str) -> None:
    import shapely

    if geometry is None:
        raise InputError(f"{place}: {shortened(text)} is not WKT; write for example POINT (3 4)")
    kind = shapely.get_type_id(geometry)
    if kind == COLLECTION:
        for part in shapely.get_parts(geometry):
            _check_geometry(part, text, place)
    elif kind not in (POINT, MULTIPOINT):
        name = geometry.geom_type
        raise InputError(f"{place}: a {name} is not a point; {not_a_point_advice(name)}")
