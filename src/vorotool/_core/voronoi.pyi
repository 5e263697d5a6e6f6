"""Borders between sites, which are points, lines and polygons."""

from collections.abc import Callable
from typing import Any

import numpy
import numpy.typing

import vorotool._core.segment_voronoi


def site_borders(diagram: vorotool._core.segment_voronoi.Diagram, element_owner: numpy.typing.NDArray[numpy.int32], face_owner: numpy.typing.NDArray[numpy.int32], threads: int, progress: Callable[[float], object] | None) -> dict[str, Any]:
    """
    Ends, elements, sites, parts and order of borders, and the points that became nodes after vertices.
    """
