"""The bisectors that borders run along, on the lattice: straight lines, and parabolas (paper, section 3.2)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
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
    core = _core.kernel.PlanarGraph(graph.points, graph.segments, graph.segment_faces)
    return _core.voronoi.control_points(core, borders.ends, borders.elements, borders.places, borders.radius, 0, None)
