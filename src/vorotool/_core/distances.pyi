"""
The largest and the smallest distances between points, segments and polygons.
"""

from collections.abc import Callable

import numpy
import numpy.typing


class Shape:
    def __init__(self, elements: numpy.typing.NDArray[numpy.float64], ring_of: numpy.typing.NDArray[numpy.int32], rings: numpy.typing.NDArray[numpy.int32], progress: Callable[[float], object] | None) -> None: ...

    def contained(self, places: numpy.typing.NDArray[numpy.float64], threads: int, progress: Callable[[float], object] | None) -> numpy.typing.NDArray[numpy.uint8]:
        """Of each place whether it is inside a polygon or on its outline."""

    def reached(self, places: numpy.typing.NDArray[numpy.float64], threads: int, progress: Callable[[float], object] | None) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
        """Of each place the distance, and the nearest place of the shape."""

def farthest_place(of: Shape, to: Shape, threads: int, progress: Callable[[float], object] | None) -> tuple[float, tuple[float, float], tuple[float, float]]:
    """
    The largest distance, -1 if there is none, the place, and the nearest one of the other shape.
    """

def may_go_farther_inside(of: Shape, to: Shape, least: float, progress: Callable[[float], object] | None) -> bool:
    """
    False if no place inside the polygons of the first shape is farther from the second.
    """

def closest_places(a: Shape, b: Shape, threads: int, progress: Callable[[float], object] | None) -> tuple[float, tuple[float, float], tuple[float, float]]:
    """The smallest distance, -1 if there is none, and a place of each."""
