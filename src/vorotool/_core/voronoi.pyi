"""Borders between sites, which are points, lines and polygons."""

from collections.abc import Callable
from typing import Any

import numpy
import numpy.typing

import vorotool._core.kernel
import vorotool._core.segment_voronoi


def site_borders(diagram: vorotool._core.segment_voronoi.Diagram, element_owner: numpy.typing.NDArray[numpy.int32], face_owner: numpy.typing.NDArray[numpy.int32], limits: tuple[numpy.typing.NDArray[numpy.uint8], numpy.typing.NDArray[numpy.int32]] | None, threads: int, progress: Callable[[float], object] | None) -> dict[str, Any]:
    """
    Ends, elements, sites, parts and order of borders, and the points that became nodes after vertices.
    """

def edge_faces(diagram: vorotool._core.segment_voronoi.Diagram, threads: int, progress: Callable[[float], object] | None) -> tuple[numpy.typing.NDArray[numpy.int32], numpy.typing.NDArray[numpy.uint8], numpy.typing.NDArray[numpy.int32]]:
    """
    In which face each edge begins and ends; whether it is between a segment and its own end; of points the segment that has their cell.
    """

def ranks_around(diagram: vorotool._core.segment_voronoi.Diagram, vertex: numpy.typing.NDArray[numpy.int64], site: numpy.typing.NDArray[numpy.int64]) -> numpy.typing.NDArray[numpy.int64]:
    """The places of sites among those around vertices."""

def owners_at_points(segments: numpy.typing.NDArray[numpy.int32], owner: numpy.typing.NDArray[numpy.int32], points: int) -> tuple[numpy.typing.NDArray[numpy.int32], numpy.typing.NDArray[numpy.int32]]:
    """
    The smallest and the largest owner of the segments that end at each point.
    """

def control_points(graph: vorotool._core.kernel.PlanarGraph, ends: numpy.typing.NDArray[numpy.int64], elements: numpy.typing.NDArray[numpy.int64], places: numpy.typing.NDArray[numpy.float64], radius: numpy.typing.NDArray[numpy.float64], threads: int, progress: Callable[[float], object] | None) -> numpy.typing.NDArray[numpy.float64]:
    """Of the Bezier curves that borders are; NaN of straight lines."""
