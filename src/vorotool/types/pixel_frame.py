"""The rectangle of pixels that a digital diagram covers."""

from __future__ import annotations

from dataclasses import fields
from typing import TYPE_CHECKING, Any, ClassVar

from vorotool.errors import InputError, option
from vorotool.plain import plain

if TYPE_CHECKING:
    from vorotool.types.box import Box

FARTHEST = 2**44
"""No seed lies farther from the origin (in pixels)."""


@plain
class Frame:
    """A window of pixels: pixel (0, 0) of the image has its center at (``x``, ``y``).

    Parameters
    ----------
    x, y : int
        Coordinates of the center of the first pixel.
    width, height : int
        Size in pixels, each at least 1.

    Raises
    ------
    InputError
        If the frame is empty, or begins farther than 2^44 pixels from the origin.
    UsageError
        If a number is not an integer.

    Examples
    --------
    >>> Frame(0, 0, 640, 480).shape
    (480, 640)
    """

    maker: ClassVar[str] = "Frame"

    x: int
    y: int
    width: int
    height: int

    def __post_init__(self) -> None:
        check_frame(self, "pixels", option("--size WxH", "shape=(H, W)"))

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns, as NumPy orders them."""
        return (self.height, self.width)

    @property
    def origin(self) -> tuple[int, int]:
        """Column and row of the first pixel."""
        return (self.x, self.y)

    def part(self, first: int, count: int) -> Frame:
        """Return the frame of some rows."""
        return Frame(self.x, self.y + first, self.width, count)

    @property
    def box(self) -> Box:
        """The rectangle that the pixels cover, with their centers at integers."""
        from vorotool.types.box import Box

        return Box(self.x - 0.5, self.y - 0.5, self.x + self.width - 0.5, self.y + self.height - 0.5)

    @property
    def pixels(self) -> int:
        """Number of pixels."""
        return self.width * self.height


def check_frame(frame: Any, cells: str, instead: str) -> None:
    """Refuse a frame of pixels or voxels that is empty or too far away; its numbers become Python's integers."""
    from vorotool.numeric.numbers import shown_number, whole_number  # imports NumPy, which options need not

    for each in fields(frame):  # NumPy's integers would wrap around in what follows
        object.__setattr__(frame, each.name, whole_number(getattr(frame, each.name), f"{each.name} of the frame"))
    if max(map(abs, frame.origin)) > FARTHEST:
        raise InputError(
            f"the frame begins at {shown_number(frame.origin)}: its coordinates must be at most 2^44; "
            f"use a nearer {option('--window')}"
        )
    if min(frame.shape) < 1:
        size, least = " x ".join(map(shown_number, frame.shape[::-1])), " x ".join("1" * len(frame.shape))
        raise InputError(f"the frame is {size} {cells}: it needs at least {least}, use {instead}")


MAX_PIXELS = 2**31
"""Pixels held in memory at most, unless told otherwise (``--max-pixels``)."""

MAX_SIDE = 2**30
"""Pixels a side at most: rows and columns are counted in 32-bit integers."""
