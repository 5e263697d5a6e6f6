"""Styles of pictures: light cells that people with any color vision tell apart, dark lines and seeds, widths."""

from __future__ import annotations

import colorsys
from collections.abc import Iterable, Mapping
from dataclasses import field
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import LimitError
from vorotool.frozen import frozen
from vorotool.products.formats import AS_SVG

WHITE = "#ffffff"
LINE = "#000000"
SEED = "#332288"
INK = "#222222"
EDGE = "#ffffff"
FAINT = "#999999"
PALE = "#cccccc"
BOUNDARY = "#222222"
SINGULAR = "#cc3311"
LIGHT = "#e4e4e4"
RESULT = "#aa3344"

CELLS = (
    "#77aadd",
    "#ee8866",
    "#eedd88",
    "#e6acbc",
    "#99ddff",
    "#cfeec2",
    "#b578a1",
    "#938f0c",
    "#7882ea",
    "#4d9980",
    "#91bf91",
    "#e65e6f",
)
"""Cell colors in the order in which they are used: few classes get the most distinct ones."""

LARGEST_PALETTE = 256
"""Colors whose numbers fit in a byte."""

_GOLDEN_ANGLE = 0.381966011250105  # of a turn: successive hues never come close soon


def triples(names: Iterable[str]) -> NDArray[np.uint8]:
    """(n, 3) red, green and blue of colors."""
    return np.array([list(bytes.fromhex(name[1:])) for name in names], dtype=np.uint8)


LINE_ON_PAPER = triples([WHITE, LINE])
"""Palette of the diagram: an image of 0 and 1 that looks like ink on paper."""


class PicturePalette(NamedTuple):
    """Colors of a palette picture: 0 is the ground, for no label, c is color class c, then line and seed."""

    colors: NDArray[np.uint8]
    line: int
    seed: int
    bit_depth: int
    halo: int = -1
    border: int = -1
    ink: int = -1
    object: int = -1
    has_halos: bool = False
    letter_edge: int = -1

    @property
    def opaque(self) -> list[int]:
        """Entries of lines, seeds and letters."""
        found = {self.line, self.seed, self.halo, self.border, self.ink, self.letter_edge} - {-1}
        return sorted(found)


def is_light(color: str) -> bool:
    """Whether letters and lines of a color, ``#rrggbb``, are lost on white."""
    red, green, blue = bytes.fromhex(color[1:])
    return 299 * red + 587 * green + 114 * blue > 180_000


def edge_color(color: str) -> str:
    """Return the color of the edge around letters, lines and points that sets them off: white, dark around light."""
    return INK if is_light(color) else WHITE


def cell_color(color_class: int) -> str:
    """Color of a class as ``#rrggbb``: 0 is white, and from the 13th class on hues are generated."""
    if color_class < 1:
        return WHITE
    if color_class <= len(CELLS):
        return CELLS[color_class - 1]
    number = color_class - len(CELLS)
    lightness = (0.72, 0.60, 0.84)[number % 3]
    rgb = colorsys.hls_to_rgb(number * _GOLDEN_ANGLE % 1.0, lightness, 0.55)
    return "#" + "".join(f"{round(255 * channel):02x}" for channel in rgb)


def picture_palette(
    classes: int, *, has_halo: bool = False, has_halos: bool = False, chosen: Mapping[str, str] | None = None
) -> PicturePalette:
    """Palette for pictures with color classes 1 to ``classes``; the same for all that need at most 12."""
    chosen = chosen or {}
    count = max(classes, len(CELLS))
    names = [*(cell_color(c) for c in range(count + 1)), chosen.get("diagram", LINE), chosen.get("seeds", SEED)]
    names[0] = chosen.get("ground", names[0])
    if has_halo:
        names.append(WHITE)
    halo, line, seed = (count + 3 if has_halo else -1), count + 1, count + 2
    own = {}
    for layer, usual in (("cells", halo), ("labels", line), ("objects", seed)):
        own[layer] = usual
        if layer in chosen or (layer == "labels" and "diagram" in chosen) or (layer == "objects" and has_halos):
            own[layer] = len(names)
            names.append(chosen.get(layer, LINE if layer == "labels" else names[seed]))
    letter_edge = halo
    if has_halo and is_light(names[own["labels"]]):
        letter_edge = len(names)
        names.append(INK)
    if len(names) > LARGEST_PALETTE:
        most = LARGEST_PALETTE - (len(names) - count)
        raise LimitError(f"{classes} color classes: a palette picture has at most {most}, use {AS_SVG}")
    depth = 4 if len(names) <= 16 else 8
    return PicturePalette(
        triples(names), line, seed, depth, halo, own["cells"], own["labels"], own["objects"], has_halos, letter_edge
    )


DRAWN_AS = {"lines": "polygons", "centerline": "skeleton", "diagram": "skeleton", "object-points": "objects"}
"""Names of layers in pictures that are chosen by another name, if not by their own."""


class ScaleBar(NamedTuple):
    """What the length of a scale bar is written in: so many of a unit are one of the data."""

    factor: float
    unit: str | None


@frozen
class PictureStyle:
    """What of a picture is not left to what draws it."""

    ground: str | None = WHITE  # color of what lies beneath all layers, `#rrggbb`; None is nothing
    colors: Mapping[str, str] = field(default_factory=dict)  # of layers, by their names
    widths: Mapping[str, float] = field(default_factory=dict)  # of the lines of layers, in px
    has_legend: bool = False  # names of the layers stand in a corner, each with its color
    scale_bar: ScaleBar | None = None  # a length stands in another one
    label_by: str | None = None  # column of properties that names objects, instead of their ids

    def of(self, layer: str) -> tuple[str | None, float | None]:
        """Give color and width of a layer, None where they are left to what draws it."""
        other = DRAWN_AS.get(layer, layer)
        return self.colors.get(layer, self.colors.get(other)), self.widths.get(layer, self.widths.get(other))

    @property
    def has_insets(self) -> bool:
        """Whether there is anything in the corners."""
        return self.has_legend or self.scale_bar is not None

    def width_of(self, layer: str, usual: float = 1.0) -> float:
        """Give the width of a layer's lines, or a usual one."""
        chosen = self.of(layer)[1]
        return usual if chosen is None else chosen
