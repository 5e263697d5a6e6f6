"""Options that clean masks, whose values are areas: numbers of pixels or voxels, or of squares or cubes of a unit."""

from __future__ import annotations

import re
from collections.abc import Collection
from fractions import Fraction
from typing import Any

import click

from vorotool.cli.options.parameter_types import ParameterType
from vorotool.cli.options.shared import Decimal, Decorator, together
from vorotool.jobs.units import Measured
from vorotool.numeric.length_units import METRES

_NUMBER = r"[-+]?(?:[0-9]++(?:\.[0-9]*+)?|\.[0-9]++)(?:[eE][-+]?[0-9]+)?"
_AREA = re.compile(rf"({_NUMBER})(?:\s*([^\W\d_]{{1,16}})\^?([23²³]))?")
_LIKE_AREA = re.compile(
    r"-?(?:[0-9]++(?:\.[0-9]++)?|\.[0-9]++)(e[-+]?[0-9]+)?"
    rf"\s*([^\W\d_]{{1,16}}\^?[0-9²³]|{'|'.join(METRES)}|px|pixels?|voxels?)?",
    re.IGNORECASE,
)
"""An argument that is an area, or was to be one; a file whose name has an extension is none."""
_POWERS = {"2": 2, "²": 2, "3": 3, "³": 3}
ALL_HOLES = "all"
"""The value of ``--fill-holes`` that has none."""


class Area(ParameterType[Fraction]):
    """An area, or the volume of an object, kept exactly; 0 only where that is allowed."""

    name = "AREA"

    def __init__(self, *, zero: bool = False) -> None:
        self._zero = zero

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Parse the number and its unit."""
        if isinstance(value, Measured | Fraction):
            return value
        match = _AREA.fullmatch(value)
        if match is None:
            self.fail(f"{value!r}: expected a number of pixels such as 50, or an area such as 5um2", param, ctx)
        number, unit, power = match.groups()
        exact = Decimal().convert(number, param, ctx)
        if exact < 0 or (exact == 0 and not self._zero):
            self.fail(f"{value!r}: expected {'0 or more' if self._zero else 'more than 0'}", param, ctx)
        return exact if unit is None else Measured(value, exact, unit, is_exact=True, power=_POWERS[power])


class HoleArea(Area):
    """The same, or all holes."""

    name = "[AREA]"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Parse the number and its unit, unless it is the word."""
        if isinstance(value, bool) or value == ALL_HOLES:
            return bool(value)
        return super().convert(value, param, ctx)


def with_hole_areas(arguments: list[str], names: Collection[str]) -> list[str]:
    """Return arguments in which the options of a hole's area have a value: the next argument, if it is an area."""
    made: list[str] = []
    for at, argument in enumerate(arguments):
        if made and made[-1] in names:
            is_area = _LIKE_AREA.fullmatch(argument)
            made[-1] += f"={argument if is_area else ALL_HOLES}"
            if is_area:
                continue
        if argument == "--":
            return made + arguments[at:]
        made.append(argument)
    if made and made[-1] in names:
        made[-1] += f"={ALL_HOLES}"
    return made


def cleaning_options() -> Decorator:
    """Add the options that leave out small objects of masks, and fill holes."""
    return together(
        click.option(
            "--min-area",
            type=Area(),
            help="Leave out objects of a mask smaller than AREA: pixels or 5um2, in volumes voxels or 5um3.",
        ),
        click.option(
            "--fill-holes",
            type=HoleArea(),
            default=False,
            help="Fill the holes of the objects of a mask first: all, or those of at most AREA.",
        ),
    )
