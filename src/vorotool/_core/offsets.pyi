"""Offset curves, from segment Voronoi diagrams."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy
import numpy.typing


def offset_curves(points: numpy.typing.NDArray[numpy.int32], segments: numpy.typing.NDArray[numpy.int32], vertices: numpy.typing.NDArray[numpy.float64], radius: numpy.typing.NDArray[numpy.float64], edges: numpy.typing.NDArray[numpy.int32], edge_sites: numpy.typing.NDArray[numpy.int32], vertex_start: numpy.typing.NDArray[numpy.int32], vertex_sites: numpy.typing.NDArray[numpy.int32], edge_face: numpy.typing.NDArray[numpy.int32], segment_faces: numpy.typing.NDArray[numpy.int32], face_polygon: numpy.typing.NDArray[numpy.int32], site_polygon: numpy.typing.NDArray[numpy.int32], site_feature: numpy.typing.NDArray[numpy.int32], distances: Sequence[float], origin_x: float, origin_y: float, scale: float, progress: Callable[[float], object] | None) -> list[dict[str, Any]]:
    """Curves at each distance, which is positive outwards."""
