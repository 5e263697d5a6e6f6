"""The bisectors that borders run along, on the lattice: straight lines, and parabolas (paper, section 3.2)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.voronoi.borders import Borders
from vorotool.geometry.polygons.planar_graph import PlanarGraph

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Parabolas:
    """Parabolas, each about a focus, in units of its own: t along the directrix from below the focus.

    The distance from focus and directrix is (t^2 + h^2) / (2 h), with h that of the focus from the directrix.

    Parameters
    ----------
    focus : (k, 2) float64 array
        On the lattice.
    way : (k, 2) float64 array
        Unit vector along the directrix, the focus on its left.
    height : (k,) float64 array
        Above 0.
    """

    focus: Floats
    way: Floats
    height: Floats

    def parameter(self, place: Floats, radius: Floats) -> Floats:
        """(k,) t of places; on the steep sides of a sharp parabola the radius tells more than the place."""
        offset = place - self.focus
        t = self.way[:, 0] * offset[:, 0] + self.way[:, 1] * offset[:, 1]
        steep = self.height * radius < np.abs(t) * np.abs(place).sum(axis=1)
        exact = np.copysign(np.sqrt(np.maximum(self.height * (2 * radius - self.height), 0)), t)
        found: Floats = np.where(steep, exact, t)
        return found

    def control(self, source: Floats, target: Floats, from_to: tuple[Floats, Floats]) -> Floats:
        """(k, 2) where the tangents at two places meet, whose parameters are known."""
        step = from_to[1] - from_to[0]
        below = (step * step / (4 * self.height))[:, None]
        across = np.stack([self.way[:, 1], -self.way[:, 0]], axis=1)
        control: Floats = (source + target) / 2 + below * across
        return control


def parabolas_of(graph: PlanarGraph, elements: Indices) -> tuple[NDArray[np.bool_], Parabolas]:
    """Tell which pairs of elements have a parabola between them, and give these.

    It is between a point and a segment of which the point is no end.

    Parameters
    ----------
    graph : PlanarGraph
        Of the elements.
    elements : (k, 2) int64 array
        Pairs of points and segments.
    """
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


def controls_of(borders: Borders, graph: PlanarGraph) -> Floats:
    """(b, 2) control points of the Bezier curves that the pieces of borders are, on the lattice; NaN of lines."""
    control = np.full((len(borders.ends), 2), np.nan)
    is_parabola, parabolas = parabolas_of(graph, borders.elements)
    source, target = borders.ends[is_parabola].T
    a, b = borders.places[source], borders.places[target]
    t = parabolas.parameter(a, borders.radius[source]), parabolas.parameter(b, borders.radius[target])
    control[is_parabola] = parabolas.control(a, b, t)
    return control
