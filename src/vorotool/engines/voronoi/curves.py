"""The curves of borders on the lattice: straight lines and parabolas (paper, section 3.2), circles along a limit."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.voronoi.borders import Borders
from vorotool.plain import plain
from vorotool.types.polygons.planar_graph import PlanarGraph

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]
Place = tuple[float, float]

INFINITY = float("inf")


@plain(eq=False)
class Parabolas:
    """Parabolas, each about a focus, in units of its own: t along the directrix from below the focus."""

    focus: Floats  # (k, 2) float64 array: on the lattice
    way: Floats  # (k, 2) float64 array: unit vector along the directrix, the focus on its left
    height: Floats  # (k,) float64 array: above 0

    def parameter(self, place: Floats, radius: Floats) -> Floats:
        """(k,) t of places; on the steep sides of a sharp parabola the radius tells more than the place."""
        offset = place - self.focus
        t = self.way[:, 0] * offset[:, 0] + self.way[:, 1] * offset[:, 1]
        steep = self.height * radius < np.abs(t) * np.abs(place).sum(axis=1)
        exact = np.copysign(np.sqrt(np.maximum(self.height * (2 * radius - self.height), 0)), t)
        found: Floats = np.where(steep, exact, t)
        return found


def parabolas_of(graph: PlanarGraph, elements: Indices) -> tuple[NDArray[np.bool_], Parabolas]:
    """Tell which pairs of elements have a parabola between them, and give these."""
    count = len(graph.points)
    point, segment = np.sort(elements, axis=1).T
    mixed = np.flatnonzero((point < count) & (segment >= count))
    ends = graph.segments[segment[mixed] - count]
    focus = graph.points[point[mixed]].astype(np.int64)
    a, b = (graph.points[end].astype(np.int64) for end in ends.T)
    along, offset = b - a, focus - a
    height = along[:, 0] * offset[:, 1] - along[:, 1] * offset[:, 0]
    above = height != 0
    along = np.where(height[:, None] < 0, -along, along)[above].astype(np.float64)
    length = np.sqrt((along * along).sum(axis=1))
    is_parabola = np.zeros(len(elements), dtype=bool)
    is_parabola[mixed[above]] = True
    high = np.abs(height[above]).astype(np.float64) / length
    return is_parabola, Parabolas(focus[above].astype(np.float64), along / length[:, None], high)


@plain
class CircularArc:
    """An arc of at most half a circle, counter-clockwise, by t: the tangent of half the angle from its middle."""

    base: Place  # (float, float): the center, on the lattice
    middle: Place  # (float, float): unit vector to the middle of the arc
    radius: float  # on the lattice
    first: float  # from the one t to the other, larger one
    last: float  # from the one t to the other, larger one

    @classmethod
    def between(cls, center: Place, source: Place, target: Place) -> CircularArc:
        """Give the arc from a place to another one."""
        a, b = ((place[0] - center[0], place[1] - center[1]) for place in (source, target))
        x, y = b[1] - a[1], a[0] - b[0]  # across the chord, which tells more than the sum of both ends
        if a[0] * b[0] + a[1] * b[1] > 0:
            x, y = a[0] + b[0], a[1] + b[1]
        radius, length = (float(np.sqrt(u * u + v * v)) for u, v in (a, (x, y)))
        arc = cls(center, (x / length, y / length), radius, 0.0, 0.0)
        return replace(arc, first=arc.parameter(*a), last=arc.parameter(*b))

    @property
    def size(self) -> float:
        """How large its coordinates are beside those of the base."""
        return self.radius

    def parameter(self, x: float, y: float) -> float:
        """The t of a place on the circle, relative to its center."""
        u, v = self.middle
        along, across = u * x + v * y, u * y - v * x
        if along >= 0:
            return across / (self.radius + along)
        return (self.radius - along) / across if across else INFINITY

    def place(self, t: float) -> Place:
        """Where it is at t."""
        (x, y), (u, v) = self.base, self.middle
        square = 1 + t * t
        along, across = self.radius * (1 - t * t) / square, self.radius * 2 * t / square
        return x + along * u - across * v, y + along * v + across * u

    def meets(self, axis: int, value: float) -> list[float]:
        """Where a coordinate has a value, at two t or none."""
        offset = value - self.base[axis]
        if abs(offset) > self.radius:
            return []
        root = float(np.sqrt((self.radius - offset) * (self.radius + offset)))
        return [self.parameter(*((offset, other) if axis == 0 else (other, offset))) for other in (-root, root)]

    def turn(self, axis: int) -> float:
        """Where a coordinate is least or most along it."""
        way = float(np.copysign(self.radius, self.middle[axis]))
        return self.parameter(*((way, 0.0) if axis == 0 else (0.0, way)))


def controls_of(borders: Borders, graph: PlanarGraph) -> Floats:
    """(b, 2) control points of the Bezier curves that the pieces of borders are, on the lattice; NaN of lines."""
    core = _core.kernel.PlanarGraph(graph.points, graph.segments, graph.segment_faces)
    return _core.voronoi.control_points(core, borders.ends, borders.elements, borders.places, borders.radius, 1, None)
