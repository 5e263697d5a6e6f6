"""``--pixel-size`` and ``--spacing``: the side of a pixel, or its sides, and the unit."""

from __future__ import annotations

import re
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import click

from vorotool.cli.options.parameter_types import ParameterType
from vorotool.cli.options.shared import Decimal, Decorator
from vorotool.jobs.units import AUTO, AUTO_SPACING, PixelSize

if TYPE_CHECKING:
    from vorotool.types.spacing import PixelSides

_SIDE = r"([0-9.]+(?:[eE][-+]?[0-9]+)?)\s*([^\W\d_]{1,16})?"


class PixelSizeType(ParameterType[PixelSize]):
    """A decimal number above 0 and, if it has one, its unit: ``0.325um``; or what the file says."""

    name = "SIZE|auto"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> PixelSize:
        """Parse both."""
        if isinstance(value, PixelSize):
            return value
        if value == "auto":
            return AUTO
        match = re.fullmatch(_SIDE, value)
        if match is None:
            self.fail(f"{value!r}: expected a number and a unit, such as 0.325um, or auto", param, ctx)
        factor = Decimal().convert(match[1], param, ctx)
        if not factor or not 1e-100 < factor < 1e100:
            self.fail(f"{value!r}: expected more than 0, and at most 1e100", param, ctx)
        return PixelSize(factor, match[2])


class SpacingType(ParameterType[PixelSize]):
    """Two decimal numbers above 0, or three, with a unit or none; or what the file says."""

    name = "SX,SY[,SZ]|auto"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> PixelSize:
        """Parse all."""
        if isinstance(value, PixelSize):
            return value
        if value == "auto":
            return AUTO_SPACING
        matches = [re.fullmatch(_SIDE, part.strip()) for part in value.split(",")]
        if len(matches) not in (2, 3) or None in matches:
            self.fail(
                f"{value!r}: expected the sides of a pixel, such as 0.325,0.5um, of a voxel, such as 1,1,2um, or auto",
                param,
                ctx,
            )
        numbers = [Decimal().convert(match[1], param, ctx) for match in matches if match is not None]
        if not all(1e-100 < number < 1e100 for number in numbers):
            self.fail(f"{value!r}: expected sides of more than 0, and at most 1e100", param, ctx)
        units = [match[2] for match in matches if match is not None]
        ratios = _ratios(units)
        if ratios is None:
            self.fail(f"{value!r}: expected one unit for all sides, after the last one or each", param, ctx)
        sides = [number * ratio for number, ratio in zip(numbers, ratios, strict=True)]
        return PixelSize(Fraction(1), units[-1], is_spacing=True, sides=self._sides(value, sides, param, ctx))

    def _sides(self, value: str, sides: list[Fraction], param: Any, ctx: Any) -> PixelSides:
        """Check that there is a common step."""
        from vorotool.errors import UsageError
        from vorotool.types.spacing import MOST_STEPS, pixel_sides

        try:
            return pixel_sides(sides[::-1], len(sides))
        except UsageError:
            self.fail(
                f"{value!r}: expected sides that are at most {MOST_STEPS} times the largest length which divides them "
                "all: round them to fewer digits",
                param,
                ctx,
            )


def _ratios(units: list[str | None]) -> list[Fraction] | None:
    """Give how long the unit of each side is in that of the last one; without a unit all are in this one."""
    from vorotool.numeric.length_units import ratio

    last = units[-1]
    if len({*units, None}) == 1 or not any(units[:-1]) or set(units) == {last}:
        return [Fraction(1)] * len(units)
    known = [None if unit is None or last is None else ratio(unit, last) for unit in units]
    return None if None in known else [Fraction(each) for each in known if each is not None]


def pixel_size_option() -> Decorator:
    """Add ``--pixel-size``."""
    return click.option(
        "--pixel-size",
        type=PixelSizeType(),
        help="Side of a pixel, or unit of the coordinates, such as 0.325um: scales what is written in tables and "
        "vectors, and lengths with a unit, such as --max-distance 5um, where the input states none; auto takes the "
        "unit that the input states.",
    )


def drawn_pixel_size_option() -> Decorator:
    """Add ``--pixel-size`` of pictures."""
    return click.option(
        "--pixel-size",
        type=PixelSizeType(),
        help="Side of a pixel, or unit of the coordinates, such as 0.325um, for --scale-bar and --scale 1:N; auto "
        "takes what the input states.",
    )


def spacing_option() -> Decorator:
    """Add ``--spacing``."""
    return click.option(
        "--spacing",
        type=SpacingType(),
        help="Sides of a pixel, or of a voxel, such as 0.325,0.5um: distances, lengths and results are in their unit; "
        "auto takes what the image says.",
    )
