"""What the file of an image says of its pixels: their sides, the unit, and where they lie on a map."""

from __future__ import annotations

from fractions import Fraction
from math import sqrt
from typing import Any, Literal

from vorotool.errors import UsageError
from vorotool.numeric.length_units import unit_name
from vorotool.plain import plain
from vorotool.types.spacing import PixelSides, pixel_sides

Form = Literal["tiff", "imagej", "ome", "map"]
Transform = tuple[float, float, float, float, float, float]

ALIKE = Fraction(1, 10**7)
"""Sides that differ by no more of their length are one: files round them, each by itself."""


@plain
class GeoKeys:
    """The keys of a GeoTIFF, as they are stored: they go from an input to what is made of it."""

    directory: tuple[int, ...]  # `GeoKeyDirectory`
    doubles: tuple[float, ...] = ()  # `GeoDoubleParams`
    text: str = ""  # `GeoAsciiParams`


@plain
class PixelGrid:
    """The grid of the pixels of an image, in units of the world.

    Parameters
    ----------
    width, height : Fraction
        Sides of a pixel, more than 0.
    unit : str, optional
        Of both.
    form : {"tiff", "imagej", "ome", "map"}
        How the file says it, which is how outputs say it again. Of a plain TIFF with the unit inch it is the resolution
        of print, and no size.
    transform : tuple of 6 floats, optional
        Of a map: the corner in column c and row r, (0, 0) for the outer corner of the first pixel, is at
        ``x = t[0] * c + t[1] * r + t[2]`` and ``y = t[3] * c + t[4] * r + t[5]``.
    crs : object, optional
        Of a map: the coordinate reference system, as the ``crs`` member of GeoJSON.
    keys : GeoKeys, optional
        Of a GeoTIFF.

    Examples
    --------
    >>> grid = PixelGrid(Fraction(30), Fraction(30), "m", "map", (30, 0, 2600000, 0, -30, 1200000))
    >>> grid.is_square, grid.is_upright, grid.center
    (True, True, (2600015.0, 1199985.0))
    """

    width: Fraction
    height: Fraction
    unit: str | None = None
    form: Form = "tiff"
    transform: Transform | None = None
    crs: Any = None
    keys: GeoKeys | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "unit", None if self.unit is None else unit_name(self.unit))

    @property
    def is_square(self) -> bool:
        """Whether both sides are as long as each other."""
        return abs(self.width - self.height) <= ALIKE * self.width

    def has(self, sides: PixelSides) -> bool:
        """Whether these are the sides of its pixels.

        Examples
        --------
        >>> PixelGrid(Fraction(1, 4), Fraction(3, 4), "um").has(PixelSides((3, 1), Fraction(1, 4)))
        True
        """
        pairs = zip((self.height, self.width), sides.lengths, strict=True)
        return all(abs(own - other) <= ALIKE * own for own, other in pairs)

    @property
    def is_size(self) -> bool:
        """Whether it is a size: dots an inch are for print."""
        is_of_print = self.unit == "inch" and self.form == "tiff"
        return self.transform is not None or (self.unit not in (None, "deg") and not is_of_print)

    @property
    def is_upright(self) -> bool:
        """Whether rows of a map run from west to east; columns may run either way."""
        t = self.transform
        return t is not None and t[0] > 0 and t[1] == 0 == t[3] and t[4] != 0

    @property
    def is_north_up(self) -> bool:
        """Whether the first row of a map is its northernmost."""
        return self.transform is not None and self.transform[4] < 0

    @property
    def center(self) -> tuple[float, float]:
        """Where on the map the center of the first pixel is."""
        assert self.transform is not None
        a, b, c, d, e, f = self.transform
        return (c + (a + b) / 2, f + (d + e) / 2)

    def size_text(self) -> str:
        """Words for the size of a pixel: ``0.325 µm``, or both sides where they differ.

        Examples
        --------
        >>> PixelGrid(Fraction(1, 4), Fraction(1, 4), "um").size_text()
        '0.25 µm'
        >>> PixelGrid(Fraction(1, 4), Fraction(1, 2), "um").size_text()
        '0.25 x 0.5 µm'
        """
        sides = [self.width] if self.is_square else [self.width, self.height]
        return " ".join([" x ".join(f"{float(side):.10g}" for side in sides), *([self.unit] if self.unit else [])])


def sides_of_grid(grid: PixelGrid) -> PixelSides | None:
    """Return the sides of the pixels of a grid for exact distances, if their common step is coarse enough."""
    height = grid.width if grid.is_square else grid.height
    for sides in ((height, grid.width), (rounded_side(height), rounded_side(grid.width))):
        try:
            return pixel_sides(sides)
        except UsageError:
            continue
    return None


def rounded_side(side: Fraction) -> Fraction:
    """Return the shortest decimal number that is alike."""
    numbers = (Fraction(f"{float(side):.{digits}g}") for digits in range(1, 18))
    return next(number for number in numbers if abs(number - side) <= ALIKE * side)


def map_grid(
    transform: Transform,
    *,
    unit: str | None = None,
    crs: Any = None,
    keys: GeoKeys | None = None,
) -> PixelGrid:
    """Return the grid of a map; sides are the lengths of what one column and one row go on."""
    a, b, _, d, e, _ = transform
    width, height = (Fraction(abs(p) if q == 0 else sqrt(p * p + q * q)) for p, q in ((a, d), (e, b)))
    return PixelGrid(width, height, unit, "map", transform, crs, keys)
