"""Rectangles, from whatever a caller holds, and the magnitude of coordinates that engines compute with."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError, UsageError
from vorotool.frozen import frozen
from vorotool.numeric.numbers import finite_double, nearest_double, real_number, shown_number

if TYPE_CHECKING:
    from vorotool.types.polygons.polygon_set import PolygonSet

Extent = tuple[float, float, float, float]
"""The smallest corner of a rectangle, its width and its height: a frame digit by digit as it was given."""

Sides = tuple[float, float, float, float]
"""The least x and y of a rectangle, and the largest."""

FRAME_MARGIN = 0.1
"""Of the larger side of the bounds, on each side of the default frame."""

_LARGEST_DOUBLE = float(np.finfo(np.float64).max)


def bounds(points: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
    """Smallest and largest coordinates of points."""
    columns = points.T  # NumPy goes down a column much faster than over many short rows
    return np.array([column.min() for column in columns]), np.array([column.max() for column in columns])


@frozen
class Box:
    """A closed rectangle in the units of the input.

    Parameters
    ----------
    left, bottom, right, top : float
        Its sides: the smallest and largest x and y; finite.

    Raises
    ------
    InputError
        If it has no area or a side is not finite.
    UsageError
        If a side is not a number.

    Examples
    --------
    >>> Box.of_size(10, 20, 4, 3)
    Box(left=10.0, bottom=20.0, right=14.0, top=23.0)
    """

    left: float
    bottom: float
    right: float
    top: float

    def __post_init__(self) -> None:
        for name in ("left", "bottom", "right", "top"):
            side = nearest_double(real_number(getattr(self, name), f"{name} of the frame"))
            object.__setattr__(self, name, side)
        if not all(map(math.isfinite, self.sides)):
            raise InputError(f"the frame is {self.sides}: its sides must be finite")
        if not (self.left < self.right and self.bottom < self.top):
            raise InputError(
                f"the frame extends from ({self.left:g}, {self.bottom:g}) to ({self.right:g}, {self.top:g}): its "
                "width and height must be positive, and large enough for coordinates of this size"
            )

    @property
    def sides(self) -> Sides:
        """Left, bottom, right, top."""
        return (self.left, self.bottom, self.right, self.top)

    @property
    def extent(self) -> Extent:
        """Left, bottom, width, height."""
        return (self.left, self.bottom, self.right - self.left, self.top - self.bottom)

    @staticmethod
    def of_size(x: float, y: float, width: float, height: float) -> Box:
        """Return the box with its smallest corner at (x, y), as ``--frame X,Y,W,H``.

        Raises
        ------
        InputError
            If it has no area or a side is not finite.
        """
        left, bottom, wide, high = (nearest_double(real_number(value, "frame")) for value in (x, y, width, height))
        return Box(left, bottom, left + wide, bottom + high)

    def stretched(self, x: float, y: float) -> Box:
        """Multiply all coordinates; a factor below 0 mirrors the box."""
        left, right = sorted((self.left * x, self.right * x))
        bottom, top = sorted((self.bottom * y, self.top * y))
        return Box(left, bottom, right, top)

    @staticmethod
    def around(points: NDArray[np.float64], margin: float = 0.1) -> Box:
        """Return the bounds of points, widened on all sides by a part of the longer one.

        Points at a single place get a unit square around it, no points that around the origin. Sides beyond the
        largest double are moved to it.

        Examples
        --------
        >>> Box.around(np.array([[0.0, 0.0], [20.0, 10.0]])).sides
        (-2.0, -2.0, 22.0, 12.0)
        """
        margin = finite_double(margin, "margin")
        low, high = bounds(points) if len(points) else (np.zeros(2), np.zeros(2))
        if (low == high).all():
            wide: Any = np.maximum(0.5, np.spacing(np.abs(low) / 2) * 2)
        else:  # the longer side may be beyond the largest double: its tenth is not
            tenth = float((high * margin - low * margin).max())
            wide = np.maximum(tenth, np.spacing(np.maximum(np.abs(low), np.abs(high)) / 2) * 2)
        with np.errstate(over="ignore"):
            left, bottom = np.maximum(low - wide, -_LARGEST_DOUBLE)
            right, top = np.minimum(high + wide, _LARGEST_DOUBLE)
        return Box(left, bottom, right, top)


def default_frame(polygons: PolygonSet, max_distance: float | None = None) -> Extent:
    """Return the box of the image, else the bounds and a tenth of their larger side; around one place a square.

    The margin is larger than `max_distance`, so that the frame holds all places within that distance.
    """
    if polygons.frame is not None:
        return polygons.frame.extent
    if not len(polygons.xy):
        return (-1.0, -1.0, 2.0, 2.0)
    low, high = bounds(polygons.xy)
    margin = FRAME_MARGIN * float((high - low).max()) or 1.0
    margin = max(margin, (1 + FRAME_MARGIN) * (max_distance or 0.0))
    x, y = (low - margin).tolist()
    w, h = (high - low + 2 * margin).tolist()
    return (x, y, w, h)


def widened(frame: Extent) -> Extent:
    """Return a frame three times as large around the same middle."""
    x, y, w, h = frame
    return (x - w, y - h, 3 * w, 3 * h)


def is_extent(frame: Extent) -> bool:
    """Whether four numbers are a rectangle with an area."""
    return bool(np.isfinite(frame).all() and frame[2] > 0 and frame[3] > 0)


def extent_sides(frame: Extent) -> Sides:
    """Return the least and the largest coordinates of a frame."""
    x, y, width, height = frame
    return (x, y, x + width, y + height)


def corners_of(frame: Extent) -> NDArray[np.float64]:
    """Return the corners of a frame, counter-clockwise from the smallest."""
    left, bottom, right, top = extent_sides(frame)
    return np.array([[left, bottom], [right, bottom], [right, top], [left, top]])


LARGEST = 1e70
"""Magnitude of lengths and coordinates: products of four of these, or of parts of them, are floating-point numbers."""


def check_magnitude(xy: NDArray[np.float64]) -> None:
    """Refuse vertices so far away, or so near each other, that products of distances are no numbers."""
    if not len(xy):
        return
    low, high = bounds(xy)
    largest = float(max(-low.min(), high.max()))
    if largest > LARGEST:
        raise InputError(f"a coordinate is {largest:g}, too large to compute with: scale them to {LARGEST:g} at most")
    extent = float((high - low).max())
    if 0 < extent < 1 / LARGEST:
        raise InputError(f"the extent is {extent:g}, too small to compute with: scale it to {1 / LARGEST:g} at least")


def check_lengths(values: Iterable[float], noun: str) -> None:
    """Refuse lengths and coordinates of options that are beyond those of shapes."""
    for value in values:
        if not abs(value) <= LARGEST:
            raise UsageError(f"a {noun} of {value:g} is too large to compute with: use at most {LARGEST:g}")


EXPECTED = "expected a Box or four finite numbers x, y, width, height with width and height above 0"


def as_box(source: Any, name: str) -> Box:
    """Give a box from one, or from four numbers: its smallest corner, its width and its height."""
    if isinstance(source, Box):
        return source
    try:
        return Box.of_size(*as_extent(source, name))
    except UsageError as error:
        raise InputError(error.marked) from None


def as_extent(source: Any, name: str) -> Extent:
    """Give the smallest corner of a rectangle, its width and its height, digit by digit as they were given."""
    if isinstance(source, Box):
        return source.extent
    try:
        x, y, width, height = (finite_double(side, name) for side in source)
    except (TypeError, ValueError):  # a UsageError is one of the latter
        raise UsageError(f"invalid {name} {shown_number(source)}: {EXPECTED}") from None
    return x, y, width, height
