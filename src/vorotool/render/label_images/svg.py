"""SVG pictures of small label images: cells as crack outlines, labels as numbers, seeds."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from html import escape
from itertools import groupby
from typing import TYPE_CHECKING, Any, BinaryIO, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import LimitError
from vorotool.products.formats import AS_PNG
from vorotool.render.canvas.insets import PixelPage, short
from vorotool.render.canvas.layers import Layer, Page, checked_layers, halo_width
from vorotool.render.canvas.styles import EDGE, FAINT, INK, SEED, cell_color, edge_color
from vorotool.render.canvas.svg import CAPITAL, edge_style, fill_style, halo_style, image_element, layer_parts
from vorotool.types.images import LabelImage

if TYPE_CHECKING:
    from vorotool.render.label_images.picture import LabelPicture

LAYERS = ("cells", "labels", "objects", "seeds")
MOST_PIXELS = 1_000_000
MOST_NUMBERED = 40
LINE_WIDTH = 1.5
"""Px."""

_MARGIN = 0.02


class Names(NamedTuple):
    """Names of regions, and the (k, 2) column and row of the pixel on which each is centered."""

    texts: Sequence[str]
    places: NDArray[np.int64]


def write_label_svg(
    out: BinaryIO, picture: LabelPicture, *, names: Names | None, objects: LabelImage | None, insets: Iterable[Layer]
) -> None:
    """Draw a label image with one path a label, and numbers in the pixels of images of at most 40 x 40."""
    image, backdrop = picture.image, picture.backdrop
    check_size(image.shape)
    wanted = checked_layers(picture.layers, LAYERS)
    page = _Page(picture)
    numbered = "labels" in wanted and has_numbers(image.shape) and names is None
    size = f'width="{page.width}" height="{page.height}"'
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" {size} viewBox="0 0 {page.width} {page.height}">']
    if page.style.ground is not None:
        parts.append(f'<rect {size} fill="{page.style.ground}"/>')
    if backdrop is not None:
        parts.append(image_element(backdrop).decode().rstrip())
        parts.append(f'<g transform="translate({image.frame.x} {image.frame.y})">')
    if "cells" in wanted:
        parts += _cells(page, dict(zip(*(each.tolist() for each in picture.colors), strict=True)))
    if numbered:
        parts += _numbers(page, "seeds" in wanted)
    if objects is not None:
        parts += _outlines(page, objects.labels, wanted)
    elif "seeds" in wanted and image.seeds is not None and not numbered:
        parts += _discs(page)
    if "labels" in wanted and names is not None and not numbered:
        parts += _names(page, names)
    if backdrop is not None:
        parts.append("</g>")
    paper = PixelPage(Page((0.0, 0.0, 1.0, 1.0), width=page.width, y_up=False))
    parts += [b"".join(layer_parts(inset, paper)).decode().rstrip() for inset in insets]
    out.write(("\n".join([*parts, "</svg>"]) + "\n").encode())


def has_numbers(shape: tuple[int, int]) -> bool:
    """Whether an image is so small that each pixel shows its label, as in the paper's Figures 1 and 2."""
    return max(shape) <= MOST_NUMBERED


def aspect_of(image: LabelImage) -> float:
    """Give how much higher than wide a pixel is."""
    return image.sides.y / image.sides.x


def check_size(shape: tuple[int, int], fmt: str = "SVG") -> None:
    """Refuse an image that is too large for a picture with a path a label, as SVG or on a page."""
    if shape[0] * shape[1] > MOST_PIXELS:
        raise LimitError(f"{shape[1]} x {shape[0]} pixels are too many for {fmt}, at most {MOST_PIXELS}: use {AS_PNG}")


class _Page:
    """Where pixels are on the page: it is as wide as the image and 2 % of its larger side as a margin."""

    def __init__(self, picture: LabelPicture) -> None:
        image, width, backdrop = picture.image, picture.width, picture.backdrop
        rows, columns = image.shape
        aspect = aspect_of(image)
        margin = _MARGIN * max(rows * aspect, columns)
        self.image, self.width, self.backdrop, self.style = image, width, backdrop, picture.style
        if backdrop is not None:
            self.height, self.width = backdrop.pixels.shape[:2]
            self.scale = self.scale_down = 1.0
            self.offset = 0.0
            return
        self.scale = width / (columns + 2 * margin)
        self.scale_down = self.scale * aspect
        self.offset = margin * self.scale
        self.height = max(1, round((rows * aspect + 2 * margin) * self.scale))

    def corners(self) -> tuple[list[str], list[str]]:
        """Return the page coordinates, across and down, of the lines of the lattice of pixel corners."""
        rows, columns = self.image.shape
        across = [short(index * self.scale + self.offset, 2) for index in range(columns + 1)]
        return across, [short(index * self.scale_down + self.offset, 2) for index in range(rows + 1)]

    def place(self, x: float, y: float) -> tuple[str, str]:
        """Return the page coordinates of a point given in pixels, whose centers are at integers."""
        return short((x + 0.5) * self.scale + self.offset, 2), short((y + 0.5) * self.scale_down + self.offset, 2)

    def seeds(self) -> NDArray[np.float64]:
        """(k, 2) positions in pixels of the image, of the seeds that lie in it."""
        seeds, frame = self.image.seeds, self.image.frame
        if seeds is None:
            return np.empty((0, 2))
        places = np.stack([seeds.x / seeds.scale - frame.x, seeds.y / seeds.scale - frame.y], axis=1)
        rows, columns = self.image.shape
        inside = (places >= -0.5) & (places < np.array([columns - 0.5, rows - 0.5]))
        return places[inside.all(axis=1)]


def _cells(page: _Page, color_of_label: Mapping[int, int]) -> Iterator[str]:
    # page coordinates, not a transform: not every renderer knows strokes that do not scale
    style = fill_style(page.backdrop)
    yield f'<g id="cells" fill-rule="evenodd"{style}{_stroke(page, "cells", EDGE)}>'
    for label, path in _paths(page, page.image.labels):
        color = cell_color(color_of_label[label])
        yield f'<path id="cell-{label}" fill="{color}" vector-effect="non-scaling-stroke" d="{path}"/>'
    yield "</g>"


def _outlines(page: _Page, objects: NDArray[np.integer], wanted: Iterable[str]) -> Iterator[str]:
    """Objects filled, and their outlines; over an image with a white edge beneath these."""
    paths = list(_paths(page, objects))
    color = page.style.of("seeds")[0] or SEED
    if "objects" in wanted:
        fill = page.style.of("objects")[0] or color
        yield f'<g id="objects" fill="{fill}" fill-rule="evenodd"{fill_style(page.backdrop)}>'
        yield from (f'<path id="object-{label}" d="{path}"/>' for label, path in paths)
        yield "</g>"
    if "seeds" not in wanted or page.style.width_of("seeds", LINE_WIDTH) == 0:
        return
    if page.backdrop is not None:
        yield f'<g id="seeds-halo" fill="none"{_stroke(page, "seeds", edge_color(color), wider=True)}>'
        yield from (f'<path vector-effect="non-scaling-stroke" d="{path}"/>' for _, path in paths)
        yield "</g>"
    yield f'<g id="seeds" fill="none"{_stroke(page, "seeds", color)}>'
    yield from (f'<path id="seed-{label}" vector-effect="non-scaling-stroke" d="{path}"/>' for label, path in paths)
    yield "</g>"


def _stroke(page: _Page, layer: str, usual: str, *, wider: bool = False) -> str:
    """Attributes of the lines of a layer; wider ones are the edge of those."""
    color, width = page.style.of(layer)
    width = LINE_WIDTH if width is None else width
    if width == 0:
        return ""
    if wider:
        color, width = usual, halo_width(width)
    return f' stroke="{color or usual}" stroke-width="{width:.3g}" stroke-linejoin="round"'


def _paths(page: _Page, labels: NDArray[np.integer]) -> Iterator[tuple[int, str]]:
    """Each label, and its outline in the coordinates of the page."""
    corners = page.corners()
    for label, loops in crack_loops(labels):
        yield label, "".join(_loop_path(loop, corners) for loop in loops)


def _loop_path(loop: Loop, corners: tuple[list[str], list[str]]) -> str:
    """Horizontal and vertical steps in turn; the last one closes the loop."""
    (x, y), steps = loop[0], []
    across, down = corners
    for number, (next_x, next_y) in enumerate(loop[1:]):
        steps.append(f"V{down[next_y]}" if number % 2 else f"H{across[next_x]}")
    return f"M{across[x]} {down[y]}{''.join(steps)}Z"


def _numbers(page: _Page, mark_seeds: bool) -> Iterator[str]:
    """Write the label in each pixel; those of seeds, bold and underlined, in a group of their own."""
    labels = page.image.labels
    marked = np.zeros(labels.shape, bool)
    if mark_seeds:
        column, row = np.floor(page.seeds() + 0.5).astype(np.int64).T
        marked[row, column] = True
    digits = len(str(int(labels.max())))
    size = min(page.scale_down * 0.5, page.scale * min(0.5, 1.3 / max(digits, 1)))
    style = f'text-anchor="middle" font-family="Helvetica, Arial, sans-serif" font-size="{short(size, 2)}"'
    yield f'<g id="labels" {style} fill="{page.style.of("labels")[0] or INK}">'
    yield from _texts(page, ~marked, size, "")
    yield "</g>"
    if mark_seeds:
        yield f'<g id="seeds" {style} fill="{page.style.of("seeds")[0] or SEED}" font-weight="bold">'
        yield from _texts(page, marked, size, ' text-decoration="underline"')
        yield "</g>"


def _texts(page: _Page, chosen: NDArray[np.bool_], size: float, attributes: str) -> Iterator[str]:
    below_center = 0.36 * size / page.scale_down  # half the height of a digit
    for row, column in np.argwhere(chosen).tolist():
        label = int(page.image.labels[row, column])
        x, y = page.place(column, row + below_center)
        faint = "" if label else f' fill="{FAINT}"'
        yield f'<text x="{x}" y="{y}"{attributes}{faint}>{label}</text>'


def _names(page: _Page, names: Names) -> Iterator[str]:
    """Write a name in each region, with an edge around the letters."""
    spacing = math.sqrt(page.width * page.height / max(len(names.texts), 1))
    size = min(max(spacing / 4, 6.0), 16.0)
    style = f'text-anchor="middle" font-family="Helvetica, Arial, sans-serif" font-size="{short(size, 2)}"'
    color = page.style.of("labels")[0] or INK
    yield f'<g id="labels" {style} fill="{color}" {halo_style(edge_color(color), size)}>'
    for text, (column, row) in zip(names.texts, names.places.tolist(), strict=True):
        x, y = page.place(column, row + CAPITAL * size / page.scale_down / 2)
        yield f'<text x="{x}" y="{y}">{escape(text)}</text>'
    yield "</g>"


def _discs(page: _Page) -> Iterator[str]:
    places = page.seeds()
    radius = min(max(disc_radius(page.image.shape, len(places)) * page.scale, 1.2), 4.0)
    color = page.style.of("seeds")[0] or SEED
    halo = "" if page.backdrop is None else f" {edge_style(edge_color(color), min(1.0, radius))}"
    yield f'<g id="seeds" fill="{color}"{halo}>'
    for x, y in places.tolist():
        across, down = page.place(x, y)
        yield f'<circle cx="{across}" cy="{down}" r="{short(radius, 2)}"/>'
    yield "</g>"


def disc_radius(shape: tuple[int, int], count: int) -> float:
    """Radius of a seed's disc in pixels: 1/250 of the smaller side, but less where that would fill cells."""
    height, width = shape
    spacing = math.sqrt(width * height / max(count, 1))
    return min(max(1.0, min(shape) / 250), max(0.5, spacing / 8))


Loop = list[tuple[int, int]]


def crack_loops(labels: NDArray[Any]) -> Iterator[tuple[int, list[Loop]]]:
    """Give each label's boundary as loops of corners, for filling by the even-odd rule."""
    owner, x, y = _corners(labels)
    beside, below = _partners(owner, y, x), _partners(owner, x, y)
    order, owners = np.lexsort((x, y, owner)).tolist(), owner.tolist()
    places, used = list(zip(x.tolist(), y.tolist(), strict=True)), bytearray(len(owners))
    for label, starts in groupby(order, key=owners.__getitem__):
        yield label, [_loop(start, places, beside, below, used) for start in starts if not used[start]]


def _corners(labels: NDArray[Any]) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """Label and place of each corner: where one or three of the pixels around a point have the label."""
    padded = np.pad(labels.astype(np.int64), 1)
    rows, columns = labels.shape[0] + 1, labels.shape[1] + 1
    quarters = {(dy, dx): padded[dy : dy + rows, dx : dx + columns] for dy in (0, 1) for dx in (0, 1)}
    found = []
    for (dy, dx), own in quarters.items():
        horizontal = quarters[dy, 1 - dx] == own
        vertical = quarters[1 - dy, dx] == own
        diagonal = quarters[1 - dy, 1 - dx] == own
        corner = (own != 0) & ((~horizontal & ~vertical) | (horizontal & vertical & ~diagonal))
        y, x = np.nonzero(corner)
        found.append((own[corner], x, y))
    owner, x, y = (np.concatenate(parts) for parts in zip(*found, strict=True))
    return owner, x, y


def _partners(owner: NDArray[np.int64], line: NDArray[np.int64], along: NDArray[np.int64]) -> list[int]:
    """Other end of each corner's crack on its line: there the corners of a label pair up in order."""
    order = np.lexsort((along, line, owner))
    partner = np.empty(len(order), np.int64)
    partner[order[0::2]], partner[order[1::2]] = order[1::2], order[0::2]
    return partner.tolist()


def _loop(start: int, places: list[tuple[int, int]], beside: list[int], below: list[int], used: bytearray) -> Loop:
    loop, corner = Loop(), start
    while not used[corner]:
        other = beside[corner]
        used[corner] = used[other] = 1
        loop += [places[corner], places[other]]
        corner = below[other]
    return loop
