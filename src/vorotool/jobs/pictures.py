"""Pictures made of layers, and the layers of any value that has a picture."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any, BinaryIO, NamedTuple

from vorotool.errors import UsageError
from vorotool.products.formats import resolved
from vorotool.products.registry import parts_of

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from vorotool.render.canvas.layers import Backdrop, Layer, Page


def write_layers(out: BinaryIO, layers: Sequence[Layer], page: Page, *, fmt: str, threads: int = 0) -> None:
    """Draw layers as SVG or PNG."""
    made = _finished(layers, page)
    if fmt == "svg":
        from vorotool.render.canvas.svg import write_layers_svg

        write_layers_svg(out, made.layers, page, insets=made.insets, threads=threads)
    else:
        from vorotool.formats.images.png_writer import write_png
        from vorotool.jobs.georeference import note_page

        note_page(page)
        has_alpha = page.backdrop is None and page.style.ground is None
        shape = page.height, page.width
        write_png(out, picture_bands(layers, page), shape, rgb=True, has_alpha=has_alpha, threads=threads)


def picture_bands(layers: Sequence[Layer], page: Page) -> Iterator[NDArray[np.uint8]]:
    """Give the rows of a picture as PNG has them; see `vorotool.render.canvas.png.layer_bands`."""
    from vorotool.render.canvas.png import layer_bands

    made = _finished(layers, page)
    return layer_bands(made.layers, page, insets=made.insets)


class _Finished(NamedTuple):
    """Layers as they are drawn, and what lies over them in px of the page."""

    layers: Sequence[Layer]
    insets: Sequence[Layer]


def _finished(layers: Sequence[Layer], page: Page) -> _Finished:
    """Give layers the chosen looks, over an image with edges, and make the legend and the scale bar."""
    from vorotool.render.canvas.halos import with_halos
    from vorotool.render.canvas.insets import insets
    from vorotool.render.canvas.scaled_page import styled_layers

    styled = styled_layers(layers, page.style)
    return _Finished(styled if page.backdrop is None else with_halos(styled), insets(styled, page))


# ---- any value -----------------------------------------------------------------------------------
class Drawing(NamedTuple):
    """Layers from below, and the page that they are drawn on."""

    layers: Sequence[Layer]
    page: Page


def drawing_of(
    value: Any,
    *,
    what: str | None = None,
    layers: Sequence[str] | None = None,
    width: int = 1000,
    backdrop: Backdrop | None = None,
    styled: Callable[[Page], Page] | None = None,
) -> Drawing:
    """Make the layers of the picture of a value other than a label image."""
    from vorotool.render.canvas.layers import ImagePage

    drawn = {name: each for name, each in parts_of(value).items() if each.drawn_by}
    if not drawn:
        raise UsageError(f"there is no picture of a {type(value).__name__}: write it as a table")
    chosen = what or next(iter(drawn))
    if chosen not in drawn:
        raise UsageError(f"what={what!r} is no picture of a {type(value).__name__}: use {' or '.join(drawn)}")
    place = next(each.drawn_by for each in drawn.values())
    page = resolved(f"{place}_page")(value, width=width) if backdrop is None else ImagePage(backdrop)
    page = page if styled is None else styled(page)
    usual = [layer for layer in drawn[chosen].usual_layers if backdrop is None or layer != "polygons"]
    shown = list(layers or usual)
    if page.style.label_by is not None and "labels" not in shown:
        shown.append("labels")
    return Drawing(resolved(f"{place}_layers")(value, page, shown), page)
