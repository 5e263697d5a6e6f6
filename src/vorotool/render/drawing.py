"""Pictures of values: their looks and their pages; layers, label images and plots, each as SVG or PNG."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from fractions import Fraction
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any, BinaryIO, NamedTuple, Protocol

from vorotool.errors import UsageError
from vorotool.numeric.length_units import METERS
from vorotool.numeric.numbers import shown_number
from vorotool.products.formats import resolved
from vorotool.products.registry import Product, is_of, known_parts, parts_of

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from vorotool.render.canvas.layers import Backdrop, Layer, Page
    from vorotool.render.canvas.styles import PictureStyle, ScaleBar
    from vorotool.types.box import Sides

DRAWING_UNITS = ("nm", "um", "mm", "cm", "dm", "m", "km", "in", "ft", "yd")
"""Those of ``--unit``."""


LARGEST_WIDTH = 1e6
"""Px of a line."""


SCALE_BAR = "scale-bar"
"""What the color of the scale bar is chosen by, as that of a layer."""


class Scale(NamedTuple):
    """A scale: millimeters of paper a unit, or a ratio, 1 to a number."""

    number: float
    is_ratio: bool


class Looks(NamedTuple):
    """What is chosen of the looks of pictures, by the names of the options."""

    scale: Scale | None = None
    drawing_unit: str | None = None  # of the input, if it names none
    background: str | None = None  # `#rrggbb` or `none`
    colors: tuple[tuple[str, str], ...] = ()
    line_widths: tuple[tuple[str, float], ...] = ()
    label_by: str | None = None  # column that names objects
    legend: bool = False  # it is drawn
    scale_bar: bool = False  # it is drawn
    aspect: float | None = None  # px of a unit of y for each of a unit of x
    extent: str | None = None  # what the page of an image's result shows

    def style(self, scale_bar: ScaleBar | None = None) -> PictureStyle:
        """What is chosen, as what draws takes it, with the lengths that a scale bar may have."""
        from vorotool.render.canvas.styles import WHITE, PictureStyle

        ground = WHITE if self.background is None else self.background
        return PictureStyle(
            None if ground == "none" else ground,
            dict(self.colors),
            dict(self.line_widths),
            has_legend=self.legend,
            scale_bar=scale_bar if self.scale_bar else None,
            label_by=self.label_by,
        )


def looks_of(
    *, color: Mapping[str, str] | None, line_width: Mapping[str, float] | None, background: str | None
) -> dict[str, Any]:
    """Give the looks that the library is asked for, by names of options; see `vorotool.write`."""
    from vorotool.numeric.numbers import finite_double

    ground = (
        background
        if background is None or (isinstance(background, str) and background == "none")
        else _color(background, "background")
    )
    colors = tuple((layer, _color(each, f"color of {layer}")) for layer, each in _by_layer(color, "color"))
    widths = tuple(
        (layer, finite_double(each, f"line_width of {layer}")) for layer, each in _by_layer(line_width, "line_width")
    )
    for layer, width in widths:
        if not 0 <= width < LARGEST_WIDTH:
            raise UsageError(f"invalid line_width of {layer} {width}: expected a number of px from 0 on")
    return {"background": ground, "colors": colors, "line_widths": widths}


def _by_layer(given: Any, name: str) -> list[tuple[str, Any]]:
    """Give the layers of a mapping, and what is said of each."""
    from vorotool.numeric.numbers import shown_number

    if given is None:
        return []
    if not isinstance(given, Mapping) or not all(isinstance(layer, str) for layer in given):
        raise UsageError(
            f"invalid {name} {shown_number(given)}: expected a mapping from layers, such as {{'seeds': …}}"
        )
    return list(given.items())


def _color(text: object, what: str) -> str:
    code = color_code(text) if isinstance(text, str) else None
    if code is None:
        raise UsageError(f"invalid {what} {text!r}: expected a color such as '#aa3344' or 'navy'")
    return code


def check_layers(looks: Looks, drawn: Sequence[str]) -> None:
    """Refuse colors and widths of layers that a picture has not."""
    from vorotool.render.canvas.styles import DRAWN_AS

    known = [*dict.fromkeys([*drawn, *(DRAWN_AS[layer] for layer in drawn if layer in DRAWN_AS)])]
    for option, chosen in (("color", looks.colors), ("line_width", looks.line_widths)):
        for layer, _ in chosen:
            if layer not in known:
                raise UsageError(
                    f"invalid {option} of {shown_number(layer)}: expected a layer of the picture, {', '.join(known)}"
                )


class World(NamedTuple):
    """Where what is drawn lies."""

    scale_bar: ScaleBar | None = None  # what lengths are written in
    millimeters: Fraction | None = None  # of 1 in the coordinates of the data, for pictures to scale
    aspect: float = 1.0  # px of a unit of y for each of a unit of x
    frame: Sides | None = None  # what is shown instead of the bounds: the image that the data come from, or --frame
    page: Sides | None = None  # what pictures to scale show instead: --frame, or the page of the drawing
    is_paper: bool = False  # SVG is 1:1 where nothing else says


def _check_places(page: Page, data: Sides) -> None:
    """Refuse a page that is so small beside the data that their places on it are no numbers."""
    import numpy as np

    with np.errstate(over="ignore", invalid="ignore"):
        corners = page.place(np.array(data).reshape(2, 2))
    if not np.isfinite(corners).all():
        raise UsageError("the frame is too small for coordinates of this size: use a larger one")


def styled_page(page: Page, looks: Looks, world: World, fmt: str = "svg") -> Page:
    """Give the page of a picture as the options say."""
    from vorotool.render.canvas.layers import MARGIN, Page

    if page.backdrop is None:
        frame = None if looks.extent == "data" else world.frame
        bounds = page.bounds if frame is None else frame
        aspect = world.aspect if looks.aspect is None else looks.aspect
        margin = MARGIN if frame is None else 0.0
        paper, data = _paper(page.y_up, (bounds, margin), looks, world, fmt), page.bounds
        if paper is not None:
            page = paper
        elif frame is not None or aspect != 1:
            page = Page(bounds, width=page.width, y_up=page.y_up, aspect=aspect, margin=margin)
        _check_places(page, data)
    page.style = looks.style(world.scale_bar)
    return page


def _paper(y_up: bool, shown: tuple[Sides, float], looks: Looks, world: World, fmt: str) -> Page | None:
    """Return the page of a picture to scale: as the options say, else 1:1 of a drawing that fits a page."""
    from vorotool.render.canvas.insets import ScaledPage

    is_chosen = looks.scale is not None or looks.drawing_unit is not None
    if not is_chosen and not (world.is_paper and fmt == "svg"):
        return None
    bounds, margin = (world.page, 0.0) if looks.extent != "data" and world.page is not None else shown
    try:
        return ScaledPage(bounds, y_up=y_up, millimeters=_millimeters(looks, world.millimeters), margin=margin)
    except UsageError:
        if is_chosen:
            raise
    return None


def color_code(text: str) -> str | None:
    """Give a color, ``#rrggbb`` or a name as in CSS, as ``#rrggbb``; None if it is none."""
    from PIL import ImageColor

    try:
        rgb: tuple[int, ...] = ImageColor.getrgb(text.strip().lower())
    except ValueError:
        return None
    return "#" + "".join(f"{channel:02x}" for channel in rgb) if len(rgb) == 3 else None


def _millimeters(looks: Looks, own: Fraction | None) -> float:
    """Millimeters of paper a unit of the data."""
    if looks.scale is not None and not looks.scale.is_ratio:
        return looks.scale.number
    if looks.drawing_unit is not None:
        own = METERS[looks.drawing_unit] * 1000
    if own is None:
        raise UsageError(
            f"--scale 1:N needs the unit of the input, which states none: add --unit ({', '.join(DRAWING_UNITS)}), or "
            "use --scale S, millimeters per unit"
        )
    return float(own if looks.scale is None else own / Fraction(looks.scale.number))


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
