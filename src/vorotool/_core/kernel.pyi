"""Planar graphs; the exact predicates, and each of their levels alone."""

import numpy
import numpy.typing


class PlanarGraph:
    def __init__(self, points: numpy.typing.NDArray[numpy.int32], segments: numpy.typing.NDArray[numpy.int32], segment_faces: numpy.typing.NDArray[numpy.int32]) -> None: ...

def orient2d(points: numpy.typing.NDArray[numpy.float64], level: str = 'auto') -> numpy.typing.NDArray[numpy.int8]:
    """
    A level is auto, filter, seen (the filter of the triangulation), integers, expansions or wide; the sign is 2 where a level other than auto and wide cannot tell. The points must be finite.
    """

def incircle(points: numpy.typing.NDArray[numpy.float64], level: str = 'auto') -> numpy.typing.NDArray[numpy.int8]:
    """
    A level is auto, filter, seen (the filter of the triangulation), integers, expansions or wide; the sign is 2 where a level other than auto and wide cannot tell. The points must be finite.
    """
