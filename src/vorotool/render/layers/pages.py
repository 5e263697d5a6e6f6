"""What the pages of pictures show."""

from __future__ import annotations

from typing import Any

from vorotool.products.formats import resolved
from vorotool.products.registry import is_of
from vorotool.render.canvas.layers import Page, bounds_of
from vorotool.types.fields import is_up


def page_of(value: Any, *, width: int = 1000, bounds: tuple[float, float, float, float] | None = None) -> Page:
    """Make the page of a picture: with all that is drawn of a value, or with other bounds."""
    is_in_space = is_of(value, "Tetrahedralization", "SpaceAlphaShape")
    if bounds is None:
        places = [resolved("render.layers.space:seen")(value.points)] if is_in_space else value._shown_places()
        bounds = bounds_of(*places)
    return Page(bounds, width=width, y_up=is_up(value) or is_in_space)
