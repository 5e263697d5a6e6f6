"""Lengths as options have them: numbers of pixels, or numbers with a unit, which ``--pixel-size`` tells in pixels."""

from __future__ import annotations

import re
from collections.abc import Sequence
from fractions import Fraction
from math import inf, isfinite
from typing import Any

import click

from vorotool.cli.options.parameter_types import ParameterType
from vorotool.cli.options.shared import Decimal
from vorotool.jobs.units import Measured

_UNIT = re.compile(r"[^\W\d_]{1,16}\Z")
MOST_OF_RANGE = 10_000
"""Distances."""
_WITH_UNIT = re.compile(r"([-+]?(?:[0-9]++(?:\.[0-9]*+)?|\.[0-9]++)(?:[eE][-+]?[0-9]+)?)\s*([^\W\d_]{1,16})")


def measured(text: Any, *, is_exact: bool = False) -> Measured | None:
    """Give a length that has a unit; None of all else."""
    match = _WITH_UNIT.fullmatch(text) if isinstance(text, str) else None
    return None if match is None else Measured(text, Decimal().convert(match[1], None, None), match[2], is_exact)


class ExactLength(Decimal):
    """A decimal number, kept exactly, with a unit or none."""

    name = "D"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Parse the number and its unit."""
        length = value if isinstance(value, Measured) else measured(value, is_exact=True)
        return length or super().convert(value, param, ctx)


class Radius(ExactLength):
    """The same, or infinity."""

    name = "R"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Parse the number and its unit."""
        return inf if value in ("inf", inf) else super().convert(value, param, ctx)


class Length(ParameterType[float]):
    """A finite length with a unit or none, 0 only where that is allowed."""

    name = "LENGTH"

    def __init__(self, *, zero: bool) -> None:
        self._zero = zero

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Parse the number and its unit."""
        length = value if isinstance(value, Measured) else measured(value)
        number: float | Fraction
        try:
            number = float(value) if length is None else length.number
        except ValueError:
            self.fail(f"{value!r}: expected a number such as 0.5", param, ctx)
        is_finite = length is not None or isfinite(number)
        if not is_finite or number < 0 or (number == 0 and not self._zero):
            self.fail(f"{value!r}: expected {'0 or more' if self._zero else 'more than 0'}", param, ctx)
        return number if length is None else length


class FlatteningTolerance(Length):
    """A length above 0, or ``auto``, which is none: each curve by its size."""

    name = "TOLERANCE|auto"

    def __init__(self) -> None:
        super().__init__(zero=False)

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Parse the number and its unit, unless it is the word."""
        return None if value == "auto" else super().convert(value, param, ctx)


class Distances(ParameterType[tuple[float, ...]]):
    """Different finite numbers other than 0, separated by commas, each with a unit or none, or ranges of them."""

    name = "D[,D...]|START:STOP:STEP"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> tuple[Any, ...]:
        """Parse the numbers and their units."""
        if isinstance(value, tuple):
            return value
        try:
            lengths = [length for part in value.split(",") for length in self._parsed(part.strip(), param, ctx)]
        except ValueError:
            self.fail(f"{value!r}: expected numbers such as -2,5, or ranges such as 1:5:0.5", param, ctx)
        from vorotool.engines.offsets.offsets import checked_distances
        from vorotool.errors import UsageError

        try:
            plain = iter(checked_distances([x for x in lengths if not isinstance(x, Measured)] or [1]))
        except UsageError as error:
            self.fail(error.typed, param, ctx)
        if any(isinstance(length, Measured) and not length.number for length in lengths):
            self.fail("a distance is 0: use finite ones, above 0 outwards, below 0 inwards", param, ctx)
        return tuple(length if isinstance(length, Measured) else next(plain) for length in lengths)

    def _parsed(
        self, part: str, param: click.Parameter | None, ctx: click.Context | None
    ) -> Sequence[float | Measured]:
        """Give a number, or those of a range, its end included if it is reached."""
        if ":" not in part:
            length = measured(part)
            return [float(part) if length is None else length]
        unit = _UNIT.search(part)
        texts = part.split(":")
        numbers = [text.strip().removesuffix(unit[0]) if unit else text for text in texts]
        if len(texts) != 3:
            self.fail(f"{part!r}: expected a range START:STOP:STEP, such as 1:5:0.5", param, ctx)
        start, stop, step = (Fraction(Decimal().convert(number.strip(), param, ctx)) for number in numbers)
        if step == 0 or (stop - start) / step < 0:
            self.fail(f"{part!r}: the step {numbers[2]} does not lead from {numbers[0]} to {numbers[1]}", param, ctx)
        count = (stop - start) // step + 1
        if count > MOST_OF_RANGE:
            self.fail(
                f"{part!r}: these are {count} distances, more than {MOST_OF_RANGE}: use a larger step", param, ctx
            )
        found = [start + k * step for k in range(int(count))]
        if unit is None:
            return [float(number) for number in found]
        return [Measured(f"{float(number):g}{unit[0]}", number, unit[0], is_exact=False) for number in found]
