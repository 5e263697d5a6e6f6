"""The looks of pictures that are chosen: size on paper, ground, colours and widths of layers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

from vorotool.errors import UsageError

if TYPE_CHECKING:
    from vorotool.jobs.options import JobOptions
    from vorotool.render.canvas.layers import Page

MILLIMETRES = {
    **{"nm": 1e-6, "um": 1e-3, "mm": 1.0, "cm": 10.0, "dm": 100.0, "m": 1e3, "km": 1e6},
    **{"in": 25.4, "ft": 304.8, "yd": 914.4},
}
"""Of the units that ``--unit`` has."""


class Scale(NamedTuple):
    """A scale: millimetres of paper a unit, or a ratio, 1 to a number."""

    number: float
    is_ratio: bool


class Looks(NamedTuple):
    """What is chosen of the looks of pictures.

    Parameters
    ----------
    scale : Scale, optional
        Of SVG.
    drawing_unit : str, optional
        Of the input, if it names none.
    background : str, optional
        ``#rrggbb`` or ``none``.
    colours, line_widths : tuple of pairs
        By layers.
    """

    scale: Scale | None = None
    drawing_unit: str | None = None
    background: str | None = None
    colours: tuple[tuple[str, str], ...] = ()
    line_widths: tuple[tuple[str, float], ...] = ()

    def given(self) -> list[str]:
        """Names of the options that are given."""
        names = ("scale", "unit", "background", "color", "line-width")
        return [name for name, value in zip(names, self, strict=True) if value not in (None, ())]


def check_style(
    o: JobOptions, pictures: Sequence[str], layers: Mapping[str, Sequence[str]], *, is_of_lines: bool
) -> None:
    """Refuse what no picture would show.

    Parameters
    ----------
    o : JobOptions
        Of the command line.
    pictures : sequence of str
        Their formats.
    layers : mapping of str to sequence of str
        Layers of each format.
    is_of_lines : bool
        They are made of layers, not of the pixels of an image.

    Raises
    ------
    UsageError
        If an option is not for them.
    """
    looks = o.looks
    given = looks.given()
    for name in given:
        if not pictures:
            raise UsageError(f"--{name} is for pictures: use -f svg or -f png, or leave it out")
        if not is_of_lines:
            raise UsageError(
                f"--{name} is for pictures of lines and areas, not for those of label images: leave it out"
            )
    for name in set(given) & {"scale", "unit"}:
        if "png" in pictures:
            raise UsageError(f"--{name} is for SVG, a PNG has pixels: use -f svg, or leave it out")
        if o.width is not None or o.overlay is not None:
            other = "--width" if o.width is not None else "--overlay"
            raise UsageError(f"a picture to scale has its size: leave out {other} or --{name}")
    if looks.scale is not None and not looks.scale.is_ratio and looks.drawing_unit is not None:
        raise UsageError("--scale S is millimetres a unit: leave out --unit, or use --scale 1:N")
    if looks.background is not None and o.overlay is not None:
        raise UsageError("--overlay is the ground: leave out --background")
    if looks.background == "none" and "png" in pictures:
        raise UsageError("a PNG has a ground: use -f svg, or another --background")
    for option, chosen in (("color", looks.colours), ("line-width", looks.line_widths)):
        for layer, _ in chosen:
            if not any(layer in layers[fmt] for fmt in pictures):
                known = dict.fromkeys(each for fmt in pictures for each in layers[fmt])
                raise UsageError(f"--{option} {layer}: the picture has {', '.join(known)}; choose of these")


def styled_page(page: Page, o: JobOptions, unit: str | None) -> Page:
    """Give the page of a picture as the options say.

    Parameters
    ----------
    page : Page
        As it is if they say nothing.
    o : JobOptions
        Of the command line.
    unit : str, optional
        Of the data.

    Raises
    ------
    UsageError
        If a ratio has no unit to go by.
    """
    from vorotool.render.canvas.palettes import WHITE
    from vorotool.render.canvas.scaled_page import ScaledPage
    from vorotool.render.canvas.styles import PictureStyle

    looks = o.looks
    if looks.scale is not None or looks.drawing_unit is not None:
        page = ScaledPage(page.bounds, y_up=page.y_up, millimetres=_millimetres(looks, unit))
    ground = WHITE if looks.background is None else looks.background
    page.style = PictureStyle(None if ground == "none" else ground, dict(looks.colours), dict(looks.line_widths))
    return page


def _millimetres(looks: Looks, unit: str | None) -> float:
    """Millimetres of paper a unit of the data."""
    if looks.scale is not None and not looks.scale.is_ratio:
        return looks.scale.number
    named = looks.drawing_unit or unit
    if named not in MILLIMETRES:
        raise UsageError(
            f"--scale 1:N needs the unit of the input, which names none: add --unit ({', '.join(MILLIMETRES)}), or use "
            "--scale S, millimetres a unit"
        )
    return MILLIMETRES[named] / (1.0 if looks.scale is None else looks.scale.number)
