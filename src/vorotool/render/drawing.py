"""Pictures of values: layers on a page, label images and plots, each as SVG or PNG."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any, BinaryIO, NamedTuple, Protocol

from vorotool.errors import UsageError
from vorotool.numeric.numbers import shown_number
from vorotool.products.formats import resolved
from vorotool.products.registry import Product, is_of, known_parts, parts_of
from vorotool.render.looks import Looks, World, styled_page

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from vorotool.render.canvas.layers import Backdrop, Layer, Page


class Wanted(NamedTuple):
    """What is wanted of a picture."""

    looks: Looks = Looks()
    world: World = World()  # where it lies
    layers: Sequence[str] | None = None  # None: the usual ones
    width: int = 1000  # px
    backdrop: Backdrop | None = None  # the image that it is drawn over

    def shown(self, usual: Sequence[str]) -> list[str]:
        """Give its layers: over an image the shapes are seen already, and a column of names is shown in any case."""
        chosen = self.layers or [name for name in usual if self.backdrop is None or name != "polygons"]
        named = self.looks.label_by is not None and "labels" not in chosen
        return [*chosen, "labels"] if named else list(chosen)


class Picture(Protocol):
    """What draws a value."""

    @property
    def page(self) -> Page | None:
        """Where its layers are drawn, if it has any."""

    @property
    def names(self) -> Sequence[str]:
        """Names of the layers."""

    def check(self, max_pixels: int) -> None:
        """Refuse a PNG of too many pixels."""

    def write(self, out: BinaryIO, fmt: str) -> None:
        """Draw it as SVG or PNG."""


class Drawing:
    """Layers from below, made when they are asked for, and the page that they are drawn on."""

    def __init__(self, page: Page, value: Any, layers_of: Callable[[Any], Sequence[Layer]]) -> None:
        self.page, self._value, self._layers_of = page, value, layers_of

    def of(self, value: Any) -> Drawing:
        """Prepare a picture of another value on the same page."""
        return Drawing(self.page, value, self._layers_of)

    @cached_property
    def layers(self) -> Sequence[Layer]:
        """What is drawn."""
        return self._layers_of(self._value)

    @property
    def names(self) -> list[str]:
        """Names of the layers."""
        return [layer.name for layer in self.layers]

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns of a PNG."""
        return self.page.height, self.page.width

    def check(self, max_pixels: int) -> None:
        """Refuse a PNG of too many pixels."""
        from vorotool.render.canvas.png import check_picture_size

        check_picture_size(self.page, max_pixels)

    def write(self, out: BinaryIO, fmt: str) -> None:
        """Draw it as SVG or PNG."""
        if fmt == "svg":
            from vorotool.render.canvas.svg import write_layers_svg

            layers, insets = self._finished()
            write_layers_svg(out, layers, self.page, insets=insets)
            return
        from vorotool.formats.images.png_writer import write_png

        has_alpha = self.page.backdrop is None and self.page.style.ground is None
        write_png(out, self._bands(), self.shape, rgb=True, has_alpha=has_alpha)

    def pixels(self) -> NDArray[np.uint8]:
        """(H, W, 3) red, green and blue of the PNG."""
        import numpy as np

        return np.concatenate(list(self._bands())).reshape(*self.shape, -1)[:, :, :3]

    def _bands(self) -> Iterator[NDArray[np.uint8]]:
        from vorotool.render.canvas.png import layer_bands

        layers, insets = self._finished()
        return layer_bands(layers, self.page, insets=insets)

    def _finished(self) -> tuple[Sequence[Layer], Sequence[Layer]]:
        """Give layers in the chosen looks, over an image with edges, and what lies over them: legend and scale bar."""
        from vorotool.render.canvas.insets import insets, styled_layers
        from vorotool.render.canvas.layers import with_halos

        styled = styled_layers(self.layers, self.page.style)
        return styled if self.page.backdrop is None else with_halos(styled), insets(styled, self.page)


class Plot:
    """A picture without layers or a page."""

    page: Page | None = None
    names: Sequence[str] = ()

    def __init__(self, draw: Callable[[BinaryIO], None]) -> None:
        self._draw = draw

    def check(self, max_pixels: int) -> None:
        """Nothing: its size is known."""

    def write(self, out: BinaryIO, fmt: str) -> None:
        """Draw it."""
        self._draw(out)


def drawing_of(
    value: Any,
    product: Product,
    wanted: Wanted,
    fmt: str = "svg",
    *,
    page: Page | None = None,
    **more: Any,
) -> Drawing:
    """Prepare the picture of a value: on its own page, with more that its layers show."""
    from vorotool.render.canvas.layers import ImagePage, page_of

    is_own = not product.types or is_of(value, *product.types)
    place = product.drawn_by if is_own else next(each.drawn_by for each in parts_of(value).values() if each.drawn_by)
    if page is None and wanted.backdrop is not None:
        page = ImagePage(wanted.backdrop)
    elif page is None:
        page = page_of(value, width=wanted.width)
    page = styled_page(page, wanted.looks, wanted.world, fmt)
    layers_of = partial(resolved(f"{place}_layers"), page=page, layers=wanted.shown(product.usual_layers), **more)
    return Drawing(page, value, layers_of)


def drawn_part(value: Any, what: str | None) -> Product:
    """Choose the result that the picture of a value shows."""
    drawn = {name: each for name, each in known_parts(value).items() if each.drawn_by}
    if not drawn:
        raise UsageError(f"a {type(value).__name__} has no picture: write it as a table")
    chosen = what or next(iter(drawn))
    if chosen not in drawn:
        raise UsageError(
            f"what={shown_number(what)} is not a picture of a {type(value).__name__}: use {' or '.join(drawn)}"
        )
    return drawn[chosen]
