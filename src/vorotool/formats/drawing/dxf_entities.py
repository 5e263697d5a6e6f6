"""The curves of the entities of DXF drawings."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from vorotool.formats.drawing.curves import (
    Affine,
    Bezier,
    Curve,
    Line,
    Piece,
    Point,
    arc_between,
    bulged,
    extent_of,
    turned,
    whole_ellipse,
)
from vorotool.numeric.curves.flatten import CURVE_PART, MOST_PIECES
from vorotool.numeric.curves.inverse_functions import PI, cosine_and_sine, hypotenuse

_SAME = 1e-12
"""Of ways of the unit circle: apart by no more than the digits of files."""

_SPLINE_FRAME = 16
"""Flag of vertices that only control a curve through the others."""


def curves_of(entity: Any, flatten: float | None) -> list[Curve]:
    """Give the curves of an entity in its own coordinates, seen from above."""
    kind = entity.dxftype()
    made = ENTITIES[kind](entity, flatten)
    mirror = Affine(a=-1.0)  # the arbitrary axes of what is seen from below
    if kind in _IN_OWN_PLANE and entity.dxf.extrusion.z < 0:
        return [curve.mapped(mirror) for curve in made]
    return made


def is_flat(entity: Any) -> bool:
    """Whether an entity lies in a plane that is seen from above or from below."""
    if not entity.dxf.hasattr("extrusion"):
        return True
    x, y, z = entity.dxf.extrusion
    return not x and not y and bool(z)


def _xy(vector: Any) -> Point:
    return (float(vector.x), float(vector.y))


def _line(entity: Any, _: float | None) -> list[Curve]:
    return [Curve(_xy(entity.dxf.start), [Line(_xy(entity.dxf.end))])]


def _circle(entity: Any, _: float | None) -> list[Curve]:
    radius = abs(float(entity.dxf.radius))
    return [whole_ellipse(_xy(entity.dxf.center), (radius, 0.0), (0.0, radius))] if radius > 0 else []


def _arc(entity: Any, _: float | None) -> list[Curve]:
    radius = abs(float(entity.dxf.radius))
    ways = [turned(float(angle)) for angle in (entity.dxf.start_angle, entity.dxf.end_angle)]
    return _elliptic(_xy(entity.dxf.center), (radius, 0.0), (0.0, radius), ways)


def _ellipse(entity: Any, _: float | None) -> list[Curve]:
    major, ratio = entity.dxf.major_axis, float(entity.dxf.ratio)
    turn = -1.0 if entity.dxf.extrusion.z < 0 else 1.0  # its axis is given in the coordinates of the drawing
    first, second = (float(major.x), float(major.y)), (-turn * ratio * float(major.y), turn * ratio * float(major.x))
    turns = [float(entity.dxf.start_param) % (2 * PI), float(entity.dxf.end_param) % (2 * PI)]
    ways = [(float(c), float(s)) for c, s in zip(*cosine_and_sine(turns), strict=True)]
    return _elliptic(_xy(entity.dxf.center), first, second, ways)


def _elliptic(center: Point, first: Point, second: Point, ways: Sequence[Point]) -> list[Curve]:
    """An arc between two ways of the unit circle, counter-clockwise; equal ones mean all of it."""
    if first == (0.0, 0.0):
        return []
    (ax, ay), (bx, by) = ways
    if abs(ax - bx) + abs(ay - by) < _SAME:
        return [whole_ellipse(center, first, second)]
    start, end = ((center[0] + c * first[0] + s * second[0], center[1] + c * first[1] + s * second[1]) for c, s in ways)
    return [Curve(start, [arc_between(center, first, second, (ways[0], ways[1]), end)])]


def _lwpolyline(entity: Any, _: float | None) -> list[Curve]:
    vertices = [(float(x), float(y), float(bulge)) for x, y, bulge in entity.get_points("xyb")]
    return _polyline_of(vertices, bool(entity.closed))


def _polyline(entity: Any, _: float | None) -> list[Curve]:
    shown = [vertex for vertex in entity.vertices if not vertex.dxf.flags & _SPLINE_FRAME]
    vertices = [(*_xy(vertex.dxf.location), float(vertex.dxf.get("bulge", 0.0))) for vertex in shown]
    return _polyline_of(vertices, bool(entity.is_closed))


def _polyline_of(vertices: Sequence[tuple[float, float, float]], is_closed: bool) -> list[Curve]:
    places = [(x, y) for x, y, _ in vertices]
    if not places:
        return []
    following = [*places[1:], *places[: 1 if is_closed else 0]]
    pieces: list[Piece] = [
        bulged(place, after, bulge) for place, after, (_, _, bulge) in zip(places, following, vertices, strict=False)
    ]
    return [Curve(places[0], pieces, is_closed and len(places) > 1)]


def _spline(entity: Any, flatten: float | None) -> list[Curve]:
    """Bézier curves of what is no quotient; others are divided."""
    tool = entity.construction_tool()
    is_closed = bool(entity.closed)
    knots, order = tool.knots(), tool.order
    if not tool.is_rational and len(set(knots[:order])) == len(set(knots[-order:])) == 1:
        parts = [[_xy(point) for point in control] for control in tool.bezier_decomposition()]
        if not parts:
            return []
        return [Curve(parts[0][0], [Bezier(tuple(part[1:])) for part in parts], is_closed)]
    control = [_xy(point) for point in tool.control_points]
    extent = extent_of([Curve(control[0], [Line(point) for point in control[1:]])])
    tolerance = flatten or CURVE_PART / 4 * extent
    inner = sorted(set(knots[order - 1 : len(knots) - order + 1]))
    places = [_xy(tool.point(inner[0]))]
    for begin, end in itertools.pairwise(inner):
        places += _along(tool, begin, end, tolerance)
    return [Curve(places[0], [Line(place) for place in places[1:]], is_closed)]


def _along(tool: Any, begin: float, end: float, tolerance: float) -> list[Point]:
    """Places between two knots, and at the second: twice as many until those between are near the chords."""
    count = 4
    while True:
        places = [_xy(point) for point in tool.points([begin + (end - begin) * k / count for k in range(count + 1)])]
        x, y = np.array(places).T
        apart = hypotenuse((x[:-2:2] + x[2::2]) / 2 - x[1:-1:2], (y[:-2:2] + y[2::2]) / 2 - y[1:-1:2])
        if count >= MOST_PIECES or float(apart.max()) <= 2 * tolerance:  # chords half as long are off by a quarter
            return places[1:]
        count *= 2


def _solid(entity: Any, _: float | None) -> list[Curve]:
    """Triangles and quadrangles, whose last two corners are exchanged."""
    corners = [_xy(corner) for corner in (entity.dxf.vtx0, entity.dxf.vtx1, entity.dxf.vtx3, entity.dxf.vtx2)]
    return [Curve(corners[0], [Line(corner) for corner in corners[1:]], is_closed=True)]


ENTITIES: dict[str, Callable[[Any, float | None], list[Curve]]] = {
    "LINE": _line,
    "CIRCLE": _circle,
    "ARC": _arc,
    "ELLIPSE": _ellipse,
    "LWPOLYLINE": _lwpolyline,
    "POLYLINE": _polyline,
    "SPLINE": _spline,
    "SOLID": _solid,
    "TRACE": _solid,
}
"""What makes the curves of each type of entity that is read."""
_IN_OWN_PLANE = frozenset({"CIRCLE", "ARC", "LWPOLYLINE", "POLYLINE", "SOLID", "TRACE"})
