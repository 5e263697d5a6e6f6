"""Names, and the looks of pictures."""

from __future__ import annotations

import re
from collections.abc import Callable
from math import isfinite
from typing import TYPE_CHECKING, Any

from vorotool.cli.values import UnexpectedError
from vorotool.errors import meant

if TYPE_CHECKING:
    from vorotool.render.drawing import Scale

SPELLINGS = (("colour", "color"), ("centre", "center"), ("neighbour", "neighbor"))
"""British spellings of what users type, and ours."""


def in_our_spelling(name: str) -> str:
    """Return a name as we spell it."""
    for british, american in SPELLINGS:
        name = name.replace(british, american)
    return name


def names_among(choices: tuple[str, ...]) -> Callable[[str], tuple[str, ...]]:
    """Return what splits a list of names, in both spellings, and refuses what is not among the choices."""

    def split(text: str) -> tuple[str, ...]:
        found = tuple(in_our_spelling(name.strip().lower()) for name in text.split(","))
        for name in found:
            if name not in choices:
                which = f"{name!r} is not" if "," in text else "not"
                raise UnexpectedError(f"{which} one of {', '.join(choices)}{meant(name, choices)}")
        return tuple(dict.fromkeys(found))

    return split


def columns(text: str) -> tuple[str, ...]:
    """Return names of columns."""
    found = tuple(name.strip() for name in text.split(","))
    if not all(found):
        raise UnexpectedError("expected names of columns, separated by commas")
    return found


def crs(text: str) -> str:
    """Return the name of a coordinate reference system."""
    from vorotool.numeric.crs import crs_member

    if crs_member(text) is None:
        instead = f"did you mean EPSG:{text}?" if text.isdecimal() else "write EPSG:3857 or OGC:CRS84, for example"
        raise UnexpectedError(f"not a coordinate reference system; {instead}")
    return text


def folder(text: str) -> str:
    """Refuse an empty name, such as a variable of a shell that is not set leaves: it would stand for this folder."""
    if not text:
        raise UnexpectedError("not a name: name a folder, or . for this one")
    return text


def image(text: str) -> str:
    """Refuse what is rather an option: whoever forgot the image would be told of its value, which is left over."""
    if text.startswith("-") and text != "-":
        raise UnexpectedError(f"not an image: name one, or write ./{text}")
    return text


# ---- pictures ------------------------------------------------------------------------------------
def scale(text: str) -> Scale:
    """Return ``S``, millimeters a unit, or ``1:N``."""
    from vorotool.cli.values.numbers import number_or_nan
    from vorotool.render.drawing import Scale

    one, colon, rest = text.partition(":")
    number = number_or_nan(rest if colon else one)
    if (colon and number_or_nan(one) != 1) or not isfinite(number) or not number > 0:
        raise UnexpectedError("expected millimeters per unit, such as 0.5, or a ratio, such as 1:100; 1:0.5 enlarges")
    return Scale(number, is_ratio=bool(colon))


def color(text: str) -> str:
    """Return a color, ``#rrggbb`` or a name as in CSS, as ``#rrggbb``."""
    from vorotool.render.drawing import color_code

    code = color_code(text)
    if code is None:
        raise UnexpectedError("expected a color such as #aa3344 or navy")
    return code


def color_or_none(text: str) -> str:
    """Return a color, or ``none``."""
    return "none" if text == "none" else color(text)


def _width(text: str) -> float:
    """Return a width in px, or with ``mm``, in px."""
    from vorotool.cli.values.numbers import number_or_nan

    match = re.fullmatch(r"\s*([0-9.]+(?:[eE][-+]?[0-9]+)?)\s*(px|mm)?\s*", text)
    number = number_or_nan(match[1]) if match else -1.0
    if match is None or not 0 <= number < 1e6:
        raise UnexpectedError("expected a width in px such as 0.5, or 0.1mm")
    return number * 96 / 25.4 if match[2] == "mm" else number


def _of_layer(text: str, kind: Callable[[str], Any], example: str) -> tuple[str, Any]:
    layer, sign, rest = text.partition("=")
    if not sign or not layer.strip():
        raise UnexpectedError(f"expected a layer and its value, such as skeleton={example}")
    try:
        return in_our_spelling(layer.strip().lower()), kind(rest)
    except UnexpectedError as error:
        raise UnexpectedError(f"{rest!r}: {error}") from None


def color_of_layer(text: str) -> tuple[str, str]:
    """Return a layer and its color."""
    return _of_layer(text, color, "red")


def width_of_layer(text: str) -> tuple[str, float]:
    """Return a layer and the width of its lines in px."""
    return _of_layer(text, _width, "0.5")
