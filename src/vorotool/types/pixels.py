"""Pixels: the frame of an image, their sides, and what its file says of them: unit, place on a map."""

from __future__ import annotations

from dataclasses import fields, replace
from fractions import Fraction
from math import ceil, floor, gcd, isfinite, lcm, sqrt
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np
from numpy.typing import DTypeLike, NDArray

from vorotool.errors import InputError, LimitError, UsageError, option
from vorotool.frozen import frozen
from vorotool.numeric.length_units import unit_name
from vorotool.numeric.numbers import real_number, shown_number
from vorotool.types.fields import DOWN, UP, YAxis

if TYPE_CHECKING:
    from vorotool.types.box import Box


class Elements:
    """A value that is an image or a volume: what takes an array takes it."""

    def _array(self) -> NDArray[Any]:
        raise NotImplementedError

    def __array__(self, dtype: DTypeLike | None = None, copy: bool | None = None) -> NDArray[Any]:
        return np.array(self._array(), dtype=dtype, copy=copy)

    def __getitem__(self, place: Any) -> Any:
        return self._array()[place]

    @property
    def dtype(self) -> np.dtype[Any]:
        """Type of the pixels or voxels."""
        return self._array().dtype

    @property
    def ndim(self) -> int:
        """Number of axes."""
        return self._array().ndim


Form = Literal["tiff", "imagej", "ome", "map"]
Transform = tuple[float, float, float, float, float, float]

ALIKE = Fraction(1, 10**7)
"""Sides that differ by no more of their length are one: files round them, each by itself."""


@frozen
class GeoKeys:
    """The keys of a GeoTIFF, as they are stored: they go from an input to what is made of it."""

    directory: tuple[int, ...]  # `GeoKeyDirectory`
    doubles: tuple[float, ...] = ()  # `GeoDoubleParams`
    text: str = ""  # `GeoAsciiParams`


@frozen
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
        """Whether both sides are as long as each other, at right angles."""
        return abs(self.width - self.height) <= ALIKE * self.width and self.is_rectangular

    @property
    def is_rectangular(self) -> bool:
        """Whether rows and columns are at right angles; those of a sheared map are not, so that no sides measure it."""
        a, b, _, d, e, _ = self.transform or (1.0, 0.0, 0.0, 0.0, 1.0, 0.0)
        return abs(a * b + d * e) <= ALIKE * self.width * self.height

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


def sides_of_grid(*sides: Fraction) -> PixelSides | None:
    """Return the sides of pixels or voxels, the width last, for exact distances, if their step is coarse enough."""
    width = sides[-1]
    exact = [width if abs(side - width) <= ALIKE * width else side for side in sides]
    for each in (exact, [*map(rounded_side, exact)]):
        try:
            return pixel_sides(each, len(sides))
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


MOST_STEPS = 2**21
"""Steps that a side has at most: those of a seed between pixels are a multiple."""

LARGEST_STEP = 10**140
"""A step, or one divided by it: squares of distances are doubles then."""

_ORDER = {2: "(height, width)", 3: "(depth, height, width)"}


@frozen
class PixelSides:
    """The sides of a pixel or a voxel."""

    # in steps, without a common divisor: (height, width) or (depth, height, width), as arrays are ordered
    units: tuple[int, ...] = (1, 1)
    step: Fraction = Fraction(1)  # the length of a step

    @property
    def x(self) -> int:
        """Width."""
        return self.units[-1]

    @property
    def y(self) -> int:
        """Height."""
        return self.units[-2]

    @property
    def lengths(self) -> tuple[Fraction, ...]:
        """Lengths of the sides, as arrays are ordered."""
        return tuple(units * self.step for units in self.units)

    def text(self) -> str:
        """Words for the lengths, as arrays are ordered."""
        return f"({', '.join(f'{float(side):.10g}' for side in self.lengths)})"


SQUARE = PixelSides()
"""Sides of 1."""


def pixel_sides(spacing: Any, axes: int = 2) -> PixelSides:
    """Return the sides of a pixel from one number for all of them, or from one for each axis, as arrays are ordered."""
    if spacing is None:
        return PixelSides((1,) * axes)
    try:
        is_one = not isinstance(spacing, list | tuple) and np.ndim(spacing) == 0
        given: list[Any] = [spacing] if is_one else list(spacing)
    except (TypeError, ValueError):  # no number and no array
        given = []
    read = [real_number(each, "spacing") for each in given]
    if len(given) not in (1, axes) or not all(0 < side < float("inf") for side in read):
        raise UsageError(
            f"invalid spacing {shown_number(spacing)}: expected a number above 0, or {axes} of them, {_ORDER[axes]}"
        )
    sides = [as_decimal(side) for side in read] * (axes // len(read))
    whole = lcm(*(side.denominator for side in sides))
    steps = [int(side * whole) for side in sides]
    common = gcd(*steps)
    if max(steps) // common > MOST_STEPS:
        raise UsageError(
            f"invalid spacing {shown_number(spacing)}: a side is more than {MOST_STEPS} times the largest common step "
            "of the sides; round the sides to fewer digits, or give them as fractions"
        )
    step = Fraction(common, whole)
    if max(step.numerator, step.denominator) > LARGEST_STEP:
        raise UsageError(f"invalid spacing {shown_number(spacing)}: expected sides from 1e-140 to 1e140")
    return PixelSides(tuple(each // common for each in steps), step)


def distance_as_written(distance: Any, sides: PixelSides) -> Any:
    """Return a distance in the unit of a spacing as the decimal number that it is written as, as the spacing is."""
    is_one = set(sides.units) == {1} and sides.step == 1
    return as_decimal(distance) if isinstance(distance, float) and isfinite(distance) and not is_one else distance


def as_decimal(number: float | Fraction) -> Fraction:
    """Return the shortest decimal number that a float is written as, exactly; a fraction as it is."""
    return number if isinstance(number, Fraction) else Fraction(repr(float(number)))


FARTHEST = 2**44
"""No seed lies farther from the origin (in pixels)."""


@frozen
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

    def mirrored(self) -> Frame:
        """Return the frame of the same pixels where y goes the other way."""
        return replace(self, y=-(self.y + self.height - 1))

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


CELL = {2: "pixel", 3: "voxel"}
"""What frames of so many axes consist of."""

MAX_SIDE = 2**30
"""Pixels a side at most: rows and columns are counted in 32-bit integers."""


MapWindow = tuple[Fraction, Fraction, Fraction, Fraction]

MOST_UNASKED = 2**28
"""Cells that a frame may have which follows from the bounds alone."""


def map_frame(
    low: NDArray[np.float64],
    high: NDArray[np.float64],
    side: Fraction,
    *,
    window: MapWindow | None,
    y_axis: YAxis = UP,
    crs: Any = None,
) -> tuple[Frame, PixelGrid]:
    """Lay cells over what lies between two corners, or over a window; rows go southwards, or down as y does."""
    if window is not None:
        left, bottom = window[:2]
        columns, rows = window[2] / side, window[3] / side
        if columns.denominator != 1 or rows.denominator != 1:
            nearest = ",".join(f"{float(max(1, round(number)) * side):.17g}" for number in (columns, rows))
            raise UsageError(
                f"{option('--window')} is {float(window[2]):.17g} x {float(window[3]):.17g}, not a whole number of "
                f"cells of {float(side):.17g}: the nearest W,H is {nearest}"
            )
        width, height = int(columns), int(rows)
    else:
        first = [floor(Fraction(float(value)) / side) for value in low]
        last = [ceil(Fraction(float(value)) / side) for value in high]
        if max(map(abs, [*first, *last])) > FARTHEST:
            raise InputError(
                f"coordinates are more than 2^44 cells of {float(side):.17g} from 0: use a larger "
                f"{option('--cell-size', 'side')}"
            )
        width, height = (max(1, b - a) for a, b in zip(first, last, strict=True))
        left, bottom = first[0] * side, first[1] * side
        if width * height > MOST_UNASKED:
            raise LimitError(
                f"the input needs {width} x {height} cells of {float(side):.17g}, more than {MOST_UNASKED}: use a "
                f"larger {option('--cell-size', 'side')}, or choose a part with "
                f"{option('--window X,Y,W,H', 'window=(x, y, w, h)')}"
            )
    top = bottom + height * side
    step = float(side)
    down = (step, float(bottom)) if y_axis == DOWN else (-step, float(top))
    return Frame(0, 0, width, height), map_grid((step, 0.0, float(left), 0.0, *down), crs=crs)


def in_cells(xy: NDArray[np.float64], grid: PixelGrid) -> NDArray[np.float64]:
    """Coordinates in cells: (0, 0) is the center of the first one, y goes down."""
    assert grid.transform is not None
    a, _, c, _, e, f = grid.transform
    return (xy - (c, f)) / (a, e) - 0.5
