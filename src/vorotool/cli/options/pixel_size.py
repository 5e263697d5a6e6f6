"""``--pixel-size``: the side of a pixel, and its unit."""

from __future__ import annotations

import re
from typing import Any

import click

from vorotool.cli.options.parameter_types import ParameterType
from vorotool.cli.options.shared import Decimal, Decorator
from vorotool.jobs.units import AUTO, PixelSize


class PixelSizeType(ParameterType[PixelSize]):
    """A decimal number above 0 and, if it has one, its unit: ``0.325um``; or what the file says."""

    name = "SIZE|auto"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> PixelSize:
        """Parse both."""
        if isinstance(value, PixelSize):
            return value
        if value == "auto":
            return AUTO
        match = re.fullmatch(r"([0-9.]+(?:[eE][-+]?[0-9]+)?)\s*([^\W\d_]{1,16})?", value)
        if match is None:
            self.fail(f"{value!r}: expected a number and a unit, such as 0.325um, or auto", param, ctx)
        factor = Decimal().convert(match[1], param, ctx)
        if not factor or not 1e-100 < factor < 1e100:
            self.fail(f"{value!r}: expected more than 0, and at most 1e100", param, ctx)
        return PixelSize(factor, match[2])


def pixel_size_option() -> Decorator:
    """Add ``--pixel-size``."""
    return click.option(
        "--pixel-size",
        type=PixelSizeType(),
        help="Side of a pixel (or unit of the input), such as 0.325um: scales what is written in tables and vectors, "
        "and tells how long options with a unit are, such as --max-distance 5um; auto takes what the image says.",
    )
