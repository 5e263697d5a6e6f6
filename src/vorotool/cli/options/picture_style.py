"""``--scale``, ``--unit``, ``--background``, ``--color`` and ``--line-width`` of pictures."""

from __future__ import annotations

import re
from math import isfinite
from typing import Any

import click

from vorotool.cli.options.parameter_types import ParameterType
from vorotool.cli.options.shared import Decorator, Rectangle, in_our_spelling, together
from vorotool.cli.options.suggestions import words
from vorotool.jobs.picture_style import DRAWING_UNITS, Scale, color_code

LEAST_ASPECT = 0.001
"""Pictures that are a thousand times stretched show nothing."""


class ScaleType(ParameterType[Scale]):
    """``S``, millimetres a unit, or ``1:N``."""

    name = "S|1:N"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Scale:
        """Parse the number."""
        if isinstance(value, Scale):
            return value
        one, colon, rest = value.partition(":")
        try:
            number = float(rest if colon else one)
            is_wrong = bool(colon) and float(one) != 1
        except ValueError:
            is_wrong, number = True, 0.0
        if is_wrong or not isfinite(number) or not number > 0:
            self.fail(f"{value!r}: expected millimetres a unit, such as 0.5, or a ratio, such as 1:100", param, ctx)
        return Scale(number, is_ratio=bool(colon))


class Color(ParameterType[str]):
    """A color: ``#rrggbb``, or a name as in CSS."""

    name = "COLOR"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> str:
        """Give it as ``#rrggbb``."""
        code = color_code(str(value))
        if code is None:
            self.fail(f"{value!r}: expected a color such as #aa3344 or navy", param, ctx)
        return code


class Ground(Color):
    """A color, or ``none``."""

    name = "none|COLOR"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> str:
        """Give it as ``#rrggbb``, or ``none``."""
        return "none" if value == "none" else super().convert(value, param, ctx)


class OfLayer(ParameterType[tuple[str, Any]]):
    """``LAYER=`` and what it gets."""

    def __init__(self, kind: ParameterType[Any], example: str) -> None:
        self.name, self._kind, self._example = f"LAYER={kind.name}", kind, example

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> tuple[str, Any]:
        """Split, and parse what stands behind the sign."""
        if isinstance(value, tuple):
            return value
        layer, sign, rest = value.partition("=")
        if not sign or not layer.strip():
            self.fail(f"{value!r}: expected {self.name}, such as skeleton={self._example}", param, ctx)
        name = layer.strip().lower()
        return in_our_spelling(name), self._kind.convert(rest, param, ctx)


class Width(ParameterType[float]):
    """A width in px, or with ``mm``."""

    name = "W"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:
        """Give it in px."""
        match = re.fullmatch(r"\s*([0-9.]+(?:[eE][-+]?[0-9]+)?)\s*(px|mm)?\s*", value)
        try:
            number = float(match[1]) if match else -1.0
        except ValueError:
            number = -1.0
        if match is None or not 0 <= number < 1e6:
            self.fail(f"{value!r}: expected a width in px such as 0.5, or 0.1mm", param, ctx)
        return number * 96 / 25.4 if match[2] == "mm" else number


class Aspect(ParameterType[float]):
    """A ratio of heights to widths."""

    name = "RATIO"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:
        """Parse the number."""
        try:
            number = float(value)
        except ValueError:
            number = 0.0
        if not LEAST_ASPECT <= number <= 1 / LEAST_ASPECT:
            self.fail(
                f"{value!r}: expected a number from {LEAST_ASPECT:g} to {1 / LEAST_ASPECT:g}, such as 1", param, ctx
            )
        return number


def page_option() -> Decorator:
    """Add ``--frame`` where it cuts nothing."""
    return click.option(
        "--frame",
        type=Rectangle(),
        help="What pictures show, and the page of SVG to scale; by default all there is, or the page of an SVG input.",
    )


def picture_style_options(*, has_scale: bool = True) -> Decorator:
    """Add the options of the looks of pictures; those of label images have no scale."""
    return together(
        *(_scale_options() if has_scale else ()),
        click.option(
            "--background",
            type=Ground(),
            help="Ground of pictures, none for nothing; by default white.",
            shell_complete=words(("none", "white", "black")),
        ),
        click.option(
            "--color",
            "--colour",
            "colors",
            type=OfLayer(Color(), "red"),
            multiple=True,
            help="Color of a layer of pictures, such as skeleton=#0000ff or seeds=red, of cells that of borders, or "
            "scale-bar=white; may be given again.",
        ),
        click.option(
            "--line-width",
            "line_widths",
            type=OfLayer(Width(), "0.5"),
            multiple=True,
            help="Width of the lines of a layer, in px or with mm, such as skeleton=0.1mm, or cells=0 for no borders; "
            "may be given again.",
        ),
        click.option(
            "--label-by",
            metavar="COLUMN",
            help="Column or property that names objects or sites in pictures, instead of their ids.",
        ),
        click.option("--legend", is_flag=True, help="Draw the names of the layers with their colors in a corner."),
        click.option(
            "--scale-bar",
            is_flag=True,
            help="Draw a length of 1, 2 or 5 times a power of ten, in the unit of --pixel-size or of the input.",
        ),
    )


def _scale_options() -> tuple[Decorator, ...]:
    return (
        click.option(
            "--scale",
            type=ScaleType(),
            help="Draw SVG to scale: S millimetres a unit of the input, or 1:N in its unit.",
        ),
        click.option(
            "--unit",
            "drawing_unit",
            type=click.Choice(DRAWING_UNITS, case_sensitive=False),
            help="Unit of the input, for SVG to scale; by default what it names. Without --scale, 1:1.",
        ),
        click.option(
            "--aspect",
            type=Aspect(),
            help="Height of a unit of y beside the width of one of x; by default 1, of longitude and latitude that in "
            "the middle of the data.",
        ),
        click.option(
            "--extent",
            type=click.Choice(["image", "data"], case_sensitive=False),
            help="What pictures show of an image or a drawing: all of it, as by default, or the data and a margin.",
        ),
    )


def animation_options(grows: str) -> Decorator:
    """Add the options of animations of what grows."""
    return together(
        click.option(
            "--animate",
            is_flag=True,
            help=f"Write an animation of {grows}: GIF, APNG or WebP, as -f or the extension says; by default GIF.",
        ),
        click.option(
            "--frames", type=click.IntRange(2, 10_000), metavar="N", help="Frames of an animation; by default 40."
        ),
        click.option("--fps", type=click.FloatRange(0.1, 100), metavar="N", help="Frames a second; by default 10."),
    )
