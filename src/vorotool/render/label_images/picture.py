"""Pictures of label images, as SVG and PNG."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.label_images.regions import name_places, outermost_pixels, seed_objects, voronoi_diagram
from vorotool.formats.images.png_writer import write_png
from vorotool.frozen import frozen
from vorotool.numeric.arrays import ranges
from vorotool.numeric.coordinates import current_written
from vorotool.render.canvas.insets import insets
from vorotool.render.canvas.layers import Backdrop, ImagePage, Layer, Lines, Page, Points, Polygons, column_texts
from vorotool.render.canvas.png import grown, layer_bands, text_cells
from vorotool.render.canvas.styles import CELLS, EDGE, LINE, SEED, PicturePalette, PictureStyle, picture_palette
from vorotool.render.label_images.svg import Names, aspect_of, disc_radius, has_numbers, write_label_svg
from vorotool.types.images import LabelImage
from vorotool.types.pixels import Frame

if TYPE_CHECKING:
    from vorotool.products.registry import Product
    from vorotool.render.drawing import Wanted
    from vorotool.types.points.seed_set import SeedSet
    from vorotool.types.volumes.volume import VolumeSeeds

BAND_ROWS = 256
"""Rows of a picture that are composed at a time."""

_Below = list[tuple[int, NDArray[np.bool_]]]
"""Entries of the palette, and the pixels that have each, beneath lines and letters."""

LARGEST_TABLE = 1 << 20
"""Entries that a table of colors by label may have in any case; beyond, it must be mostly used."""

LEAST_SPACING = 6.0
"""Pixels between the middles of cells, below which borders in PNG would hide them."""


@frozen(eq=False)
class LabelPicture:
    """A label image, and how it is drawn."""

    image: LabelImage  # with seeds, if these are drawn
    # pair of (k,) integer arrays: the labels that occur, increasing, and the color class of each: what
    # `region_colors` gives
    colors: tuple[NDArray[Any], NDArray[Any]]
    layers: Sequence[str]  # of cells, diagram (PNG), objects, seeds and labels
    style: PictureStyle  # ground, colors and widths of lines
    width: int = 1000  # pixels across an SVG
    y_up: bool = False  # draw the last row on top
    backdrop: Backdrop | None = None  # the image, whose size the picture has
    # written on regions instead of their labels; on those that are not in it nothing is
    texts: Mapping[int, str] | None = None

    @property
    def page(self) -> None:
        """It has none."""

    @property
    def names(self) -> Sequence[str]:
        """Names of the layers."""
        return self.layers

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns of a PNG."""
        return self.image.shape

    def check(self, max_pixels: int) -> None:
        """Nothing: it has the size of the image."""

    def write(self, out: BinaryIO, fmt: str) -> None:
        """Draw it as SVG, or as a palette PNG of its own size, or over an image."""
        draw = _write_svg if fmt == "svg" else _write_png
        draw(out, self._placed())

    def pixels(self) -> NDArray[np.uint8]:
        """(H, W, 3) red, green and blue of the PNG."""
        picture = self._placed()
        return _pixels(picture, _Marks(picture))

    def _placed(self) -> LabelPicture:
        """Return the picture from top to bottom."""
        return replace(self, image=self.image.flipped(), y_up=False) if self.y_up else self

    @property
    def shows_borders(self) -> bool:
        """Whether cells are wide enough for borders of a pixel."""
        labeled = int(np.count_nonzero(self.image.labels))
        return labeled >= LEAST_SPACING**2 * len(self.colors[0])


def label_picture(
    image: LabelImage,
    colors: tuple[NDArray[Any], NDArray[Any]],
    product: Product,
    wanted: Wanted,
    *,
    y_up: bool = False,
    sites: SeedSet | VolumeSeeds | None = None,
) -> LabelPicture:
    """Prepare the picture of a label image, whose seeds are those of the sites: numbers in the pixels of small ones."""
    left_out = {"labels": not has_numbers(image.shape), "seeds": image.seeds is None}
    usual = [layer for layer in product.usual_layers if not left_out.get(layer)]
    sites, column, texts = image.seeds if sites is None else sites, wanted.looks.label_by, None
    if sites is not None and column is not None:
        texts = dict(zip(sites.site_labels.tolist(), column_texts(sites.properties, column, ()), strict=True))
    style = wanted.looks.style(wanted.world.scale_bar)
    shown, own = wanted.shown(usual), (wanted.width, y_up, wanted.backdrop, texts)
    return LabelPicture(image, colors, shown, style, *own)


def _names(picture: LabelPicture) -> Names | None:
    """Names of regions, deep inside their objects or themselves."""
    if "labels" not in picture.layers:
        return None
    labels, places = name_places(picture.image, threads=current_written().how.threads)
    if picture.texts is None:
        return Names([str(label) for label in labels.tolist()], places)
    texts = [picture.texts.get(label, "") for label in labels.tolist()]
    named = [k for k, text in enumerate(texts) if text]
    return Names([texts[k] for k in named], places[named])


def _objects(picture: LabelPicture) -> LabelImage | None:
    """The objects that are the seeds, if they are drawn."""
    if not {"objects", "seeds"} & set(picture.layers):
        return None
    return seed_objects(picture.image)


def _write_svg(out: BinaryIO, picture: LabelPicture) -> None:
    is_numbered = "labels" in picture.layers and has_numbers(picture.image.shape) and picture.texts is None
    objects = None if is_numbered else _objects(picture)
    insets = _insets(picture, _page(picture), has_outlines=objects is not None)
    write_label_svg(out, picture, names=None if is_numbered else _names(picture), objects=objects, insets=insets)


def _page(picture: LabelPicture) -> Page:
    """Where pixels are on an SVG."""
    if picture.backdrop is not None:
        return ImagePage(picture.backdrop)
    rows, columns = picture.image.shape
    bounds = (0.0, 0.0, float(columns), float(rows))
    return Page(bounds, width=picture.width, y_up=False, aspect=aspect_of(picture.image))


def _insets(picture: LabelPicture, page: Page, *, has_outlines: bool) -> list[Layer]:
    """The legend and the scale bar, if they are asked for."""
    page.style = picture.style
    nowhere, none = np.empty((0, 2)), np.empty((0, 2), np.int32)
    corners, rings = np.empty(0, np.int32), np.zeros(1, np.int64)

    def color(layer: str, usual: str) -> str:
        return picture.style.of(layer)[0] or usual

    seeds = color("seeds", SEED)
    made: dict[str, Layer] = {
        "cells": Polygons("cells", nowhere, corners, rings, colors=CELLS[:1], edge=color("cells", EDGE)),
        "diagram": Lines("diagram", nowhere, none, color("diagram", LINE)),
        "objects": Polygons("objects", nowhere, corners, rings, colors=[color("objects", seeds)]),
        "seeds": Lines("seeds", nowhere, none, seeds) if has_outlines else Points("seeds", nowhere, seeds),
    }
    return insets([layer for name, layer in made.items() if name in picture.layers], page)


def _write_png(out: BinaryIO, picture: LabelPicture) -> None:
    marks = _Marks(picture)
    if picture.backdrop is not None or picture.style.has_insets:
        pixels = _pixels(picture, marks)
        write_png(out, [pixels.reshape(len(pixels), -1)], pixels.shape[:2], rgb=True)
        return
    palette, has_alpha = marks.palette, picture.style.ground is None
    bands, depth = index_bands(picture, marks, picture.layers, marks.below), palette.bit_depth
    write_png(out, bands, picture.image.shape, bit_depth=depth, palette=palette.colors, has_alpha=has_alpha)


def index_bands(
    picture: LabelPicture, marks: _Marks, layers: Sequence[str], below: _Below
) -> Iterator[NDArray[np.uint8]]:
    """Compose rows of palette indices from top to bottom: cells below, lines over them, seeds and names on top."""
    image, palette = picture.image, marks.palette
    number, color_of_number = _numbering(*picture.colors)
    classes = color_of_number.astype(np.uint8)
    has_discs = image.seeds and marks.outlines is None and "seeds" in layers
    discs = _Discs(image.seeds, image.frame) if image.seeds and has_discs else None
    letters = _Letters(marks.names, palette) if marks.names is not None and "labels" in layers else None
    for top in range(0, image.shape[0], BAND_ROWS):
        band = slice(top, top + BAND_ROWS)
        labels = number(image.labels[band])
        made = classes[labels] if "cells" in layers else np.zeros(labels.shape, np.uint8)
        for value, pixels in below:
            made[pixels[band]] = value
        if marks.diagram is not None and "diagram" in layers:
            made[marks.diagram[band]] = palette.line
        if marks.outlines is not None and "seeds" in layers:
            made[marks.outlines[band]] = palette.seed
        if discs is not None:
            if palette.has_halos:
                discs.draw(made, top, palette.halo, wider=1.0)
            discs.draw(made, top, palette.seed)
        if letters is not None:
            letters.draw(made, top)
        yield made


def _pixels(picture: LabelPicture, marks: _Marks) -> NDArray[np.uint8]:
    """(H, W, 3) red, green and blue, with the image beneath, and a legend and a scale bar over them."""
    passes: list[tuple[Sequence[str], _Below]] = [(picture.layers, marks.below)]
    if picture.backdrop is None:
        pixels: NDArray[np.uint8] = marks.palette.colors[np.concatenate(list(index_bands(picture, marks, *passes[0])))]
    else:
        pixels = picture.backdrop.pixels
        if {"cells", "objects"} <= set(picture.layers):  # cells are seen through objects, as the image is through both
            others = [each for each in picture.layers if each != "cells"]
            passes = [(["cells"], marks.borders), (others, marks.below[len(marks.borders) :])]
        for each in passes:
            pixels = over_image(index_bands(picture, marks, *each), pixels, marks.palette, picture.image.frame)
    if not picture.style.has_insets:
        return pixels
    page = ImagePage(Backdrop(pixels, bytes))
    over = _insets(picture, page, has_outlines=marks.outlines is not None)
    drawn: NDArray[np.uint8] = np.concatenate(list(layer_bands([], page, insets=over)))
    return drawn.reshape(pixels.shape)


def over_image(
    bands: Iterable[NDArray[np.uint8]], pixels: NDArray[np.uint8], palette: PicturePalette, frame: Frame
) -> NDArray[np.uint8]:
    """Draw a picture over an image: areas half see-through, lines and seeds not."""
    made = pixels.copy()
    height, width = made.shape[:2]
    left, right = (min(max(x, 0), width) for x in (frame.x, frame.x + frame.width))
    row = frame.y
    for band in bands:
        top, bottom = (min(max(y, 0), height) for y in (row, row + len(band)))
        index = band[top - row : bottom - row, left - frame.x : right - frame.x]
        beneath = made[top:bottom, left:right]
        color = palette.colors[index]
        mixed = ((beneath.astype(np.uint16) + color + 1) // 2).astype(np.uint8)
        is_line = np.isin(index, palette.opaque)
        beneath[...] = np.where(is_line[..., None], color, np.where(index[..., None] > 0, mixed, beneath))
        row += len(band)
    return made


def widened(lines: NDArray[np.bool_], width: float) -> NDArray[np.bool_]:
    """Make lines of a pixel so many pixels wide, to the nearest whole number; of none there is nothing."""
    if width == 0:
        return np.zeros_like(lines)
    made = lines
    for number in range(1, max(1, round(width))):  # to the left and above first, then to the right and below
        made = grown(made, back=number % 2 == 1, on=number % 2 == 0)
    return made


class _Marks:
    """What is drawn over the cells of a PNG, pixel by pixel, and in which colors."""

    def __init__(self, picture: LabelPicture) -> None:
        layers, style, over = picture.layers, picture.style, picture.backdrop is not None
        objects, self.names = _objects(picture), _names(picture)
        borders = _borders(picture)
        self.diagram = _lines(picture, style.width_of("diagram")) if "diagram" in layers else None
        self.outlines: NDArray[np.bool_] | None = None
        if objects is not None and "seeds" in layers:
            self.outlines = widened(outermost_pixels(objects), style.width_of("seeds"))
        lines = [each for each in (self.diagram, self.outlines) if each is not None]
        drawn = np.logical_or.reduce(lines) if over and lines else None
        chosen = {layer: color for layer, color in style.colors.items() if layer in layers}
        if style.ground is not None:
            chosen["ground"] = style.ground
        self.palette = picture_palette(
            int(picture.colors[1].max(initial=0)),
            has_halo=over or self.names is not None or borders is not None,
            has_halos=over,
            chosen=chosen,
        )
        self.borders = [] if borders is None else [(self.palette.border, borders)]
        self.below = [*self.borders]
        if objects is not None and "objects" in layers:
            self.below.append((self.palette.object, objects.labels != 0))
        if drawn is not None:  # an edge that shows lines on any ground
            self.below.append((self.palette.halo, grown(drawn) & ~drawn))


def _borders(picture: LabelPicture) -> NDArray[np.bool_] | None:
    """Borders between cells: a pixel wide, if cells are not too small for that, or as is chosen."""
    chosen = picture.style.of("cells")[1]
    if "cells" not in picture.layers or chosen == 0 or not len(picture.colors[0]):
        return None
    return None if chosen is None and not picture.shows_borders else _lines(picture, 1.0 if chosen is None else chosen)


def _lines(picture: LabelPicture, width: float) -> NDArray[np.bool_]:
    """Draw the lines between cells."""
    return widened(voronoi_diagram(picture.image, threads=current_written().how.threads).view(bool), width)


def _numbering(
    labels: NDArray[Any], classes: NDArray[Any]
) -> tuple[Callable[[NDArray[Any]], NDArray[Any]], NDArray[Any]]:
    """Numbers that a table of colors is indexed by: the labels, or their ranks from 1 where labels are sparse."""
    largest = int(labels.max(initial=0))
    if largest > 4 * len(labels) + LARGEST_TABLE:
        known = np.append(0, labels)
        return lambda band: np.searchsorted(known, band), np.append(0, classes)
    by_label = np.zeros(largest + 1, classes.dtype)
    by_label[labels] = classes
    return np.asarray, by_label


class _Letters:
    """Pixels of names, sorted by row, so that each band looks at its own only; halos come before letters."""

    def __init__(self, names: Names, palette: PicturePalette) -> None:
        owner, cells, is_ink = text_cells(names.texts)
        x, y = (names.places[owner] + cells).T
        order = np.lexsort((is_ink, y))
        self.x, self.y = x[order], y[order]
        self.value = np.where(is_ink[order], palette.ink, palette.letter_edge).astype(np.uint8)

    def draw(self, picture: NDArray[np.uint8], top: int) -> None:
        """Set the pixels of a band; what is outside is left out."""
        rows, width = picture.shape
        part = slice(*np.searchsorted(self.y, [top, top + rows]))
        x, y, value = self.x[part], self.y[part] - top, self.value[part]
        inside = (x >= 0) & (x < width)
        picture[y[inside], x[inside]] = value[inside]


class _Discs:
    """Discs around seeds, sorted by row, so that each band looks at its own only."""

    def __init__(self, seeds: SeedSet, frame: Frame) -> None:
        x, y = seeds.x / seeds.scale - frame.x, seeds.y / seeds.scale - frame.y
        self.radius = disc_radius(frame.shape, len(seeds))
        order = np.argsort(y, kind="stable")
        self.x, self.y = x[order], y[order]

    def draw(self, picture: NDArray[np.uint8], top: int, value: int, *, wider: float = 0.0) -> None:
        """Set the pixels whose centers lie in a disc; the smallest discs still mark the nearest pixel."""
        rows, width = picture.shape
        radius = self.radius + wider
        reach = math.ceil(radius) + 1
        first, last = np.searchsorted(self.y, [top - reach, top + rows + reach])
        x, y = self.x[first:last], self.y[first:last]
        self._set(picture, np.floor(x + 0.5), np.floor(x + 0.5), np.floor(y + 0.5) - top, value)
        for offset in range(-reach, reach + 1):
            row = np.floor(y) + offset
            square = radius * radius - np.square(row - y)
            half = np.sqrt(np.maximum(square, 0.0))
            hit = square >= 0
            left, right = np.ceil(x - half)[hit], np.floor(x + half)[hit]
            self._set(picture, np.maximum(left, 0), np.minimum(right, width - 1), row[hit] - top, value)

    @staticmethod
    def _set(
        picture: NDArray[np.uint8],
        left: NDArray[np.float64],
        right: NDArray[np.float64],
        row: NDArray[np.float64],
        value: int,
    ) -> None:
        """Fill spans of pixels, ends included; what is outside the picture is left out."""
        rows, width = picture.shape
        inside = (row >= 0) & (row < rows) & (left <= right) & (right >= 0) & (left < width)
        start = left[inside].astype(np.int64)
        lengths = right[inside].astype(np.int64) - start + 1
        picture[np.repeat(row[inside].astype(np.int64), lengths), ranges(start, lengths)] = value
