"""Delaunay triangulations of space, and their exact predicates."""

from collections.abc import Callable
from typing import Any

import numpy
import numpy.typing


class TooManyTetrahedraError(ValueError):
    pass

def triangulate(points: numpy.typing.NDArray[numpy.float64], threads: int, progress: Callable[[float], object] | None) -> dict[str, Any]:
    """
    dimension, that of the points, -1 of none: below 3 there are no tetrahedra; tetrahedra, positive, and the neighbors opposite to their vertices, -1 outside; first, for each point the first one at its place; duplicates, how many points have an earlier one.
    """

def find_fault(points: numpy.typing.NDArray[numpy.float64], tetrahedra: numpy.typing.NDArray[numpy.int32], neighbors: numpy.typing.NDArray[numpy.int32], first: numpy.typing.NDArray[numpy.int32], threads: int, progress: Callable[[float], object] | None) -> str | None: ...

def spheres(points: numpy.typing.NDArray[numpy.float64], tetrahedra: numpy.typing.NDArray[numpy.int32], threads: int, progress: Callable[[float], object] | None) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
    """
    The ways from the first corners of tetrahedra to the centers of their spheres, within 2^-43 of their lengths, and the volumes of the tetrahedra.
    """

def point_table(points: numpy.typing.NDArray[numpy.float64], tetrahedra: numpy.typing.NDArray[numpy.int32], neighbors: numpy.typing.NDArray[numpy.int32], labels: numpy.typing.NDArray[numpy.int64], threads: int, progress: Callable[[float], object] | None) -> dict[str, Any]:
    """
    Of each point of a Delaunay triangulation: neighbors, how many; cell_volume within 2^-40 of itself, infinite on the hull; nearest, the nearest other point, of several that of the smallest label, or -1; on_hull.
    """

def nearest_corners(points: numpy.typing.NDArray[numpy.float64], simplices: numpy.typing.NDArray[numpy.int32], labels: numpy.typing.NDArray[numpy.int64], threads: int, progress: Callable[[float], object] | None) -> numpy.typing.NDArray[numpy.int32]:
    """
    Of each point the nearest other corner of the edges or triangles that have it, as in point_table.
    """

def orient3d(points: numpy.typing.NDArray[numpy.float64], level: str = 'auto') -> numpy.typing.NDArray[numpy.int8]:
    """
    A level is auto, filter, integers or wide; the sign is 2 where the filter cannot tell. The points must be finite.
    """

def in_sphere(points: numpy.typing.NDArray[numpy.float64], level: str = 'auto') -> numpy.typing.NDArray[numpy.int8]:
    """As orient3d; the level ties breaks ties as the triangulation does."""

def set_signs(points: numpy.typing.NDArray[numpy.float64], tuples: numpy.typing.NDArray[numpy.int32], on_integers: bool) -> numpy.typing.NDArray[numpy.int8]:
    """
    Signs of orient3d of rows of four points of a set, or of in_sphere of five with ties broken, by the filters of the set; moved to integers first, if they can be.
    """
