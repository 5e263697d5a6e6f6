"""Offset curves, from segment Voronoi diagrams."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy
import numpy.typing

import vorotool._core.segment_voronoi


def offset_curves(diagram: vorotool._core.segment_voronoi.Diagram, edge_face: numpy.typing.NDArray[numpy.int32], face_polygon: numpy.typing.NDArray[numpy.int32], site_polygon: numpy.typing.NDArray[numpy.int32], site_feature: numpy.typing.NDArray[numpy.int32], distances: Sequence[float], origin_x: float, origin_y: float, scale: float, progress: Callable[[float], object] | None) -> list[dict[str, Any]]:
    """Curves at each distance, which is positive outwards."""

def level_crossings(diagram: vorotool._core.segment_voronoi.Diagram, edge_face: numpy.typing.NDArray[numpy.int32], face_polygon: numpy.typing.NDArray[numpy.int32], level: float, progress: Callable[[float], object] | None) -> dict[str, Any]:
    """
    Where curves at a distance from all sites, in lattice units, cross edges of their diagram, and how they go on from there.
    """
