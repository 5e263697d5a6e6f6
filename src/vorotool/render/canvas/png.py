"""PNG pictures from layers: drawn four times as large without gray, then reduced; and texts as pixels."""

from __future__ import annotations

import unicodedata
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from functools import cache

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import LimitError, option
from vorotool.numeric.arrays import owners, ranges, within
from vorotool.products.formats import AS_SVG
from vorotool.render.canvas.insets import PixelPage
from vorotool.render.canvas.layers import Arcs, CurvedPolygons, Curves, Layer, Lines, Page, Points, Polygons, Texts
from vorotool.render.canvas.styles import edge_color, triples

HEIGHT, WIDTH, ADVANCE = 7, 5, 6
"""Of a glyph, and from one to the next, in cells."""

_FIRST, _UNKNOWN = " ", "?"
_MICRO = bytes.fromhex("7c2020203c")
"""Columns of µ and of the Greek letter."""
_COLUMNS = bytes.fromhex(
    "0000000000 00005f0000 0007000700 147f147f14 242a7f2a12 2313086462 3649552250 0005030000 001c224100 0041221c00"
    "14083e0814 08083e0808 0050300000 0808080808 0060600000 2010080402 3e5149453e 00427f4000 4261514946 2141454b31"
    "1814127f10 2745454539 3c4a494930 0171090503 3649494936 064949291e 0036360000 0056360000 0814224100 1414141414"
    "0041221408 0201510906 324979413e 7e1111117e 7f49494936 3e41414122 7f4141221c 7f49494941 7f09090901 3e4149497a"
    "7f0808087f 00417f4100 2040413f01 7f08142241 7f40404040 7f020c027f 7f0408107f 3e4141413e 7f09090906 3e4151215e"
    "7f09192946 4649494931 01017f0101 3f4040403f 1f2040201f 3f4038403f 6314081463 0708700807 6151494543 007f414100"
    "0204081020 0041417f00 0402010204 4040404040 0001020400 2054545478 7f48444438 3844444420 384444487f 3854545418"
    "087e090102 0c5252523e 7f08040478 00447d4000 2040443d00 7f10284400 00417f4000 7c04180478 7c08040478 3844444438"
    "7c14141408 081414187c 7c08040408 4854545420 043f444020 3c4040207c 1c2040201c 3c4030403c 4428102844 0c5050503c"
    "4464544c44 0008364100 00007f0000 0041360800 1008081008"
)
"""Columns of the glyphs from blank to tilde; the least bit is the topmost cell."""


@cache
def _glyph(letter: str) -> NDArray[np.bool_]:
    """(7, 5) the cells of a letter; of one with an accent those of the letter without it."""
    plain = unicodedata.normalize("NFKD", letter)[:1]
    index = ord(plain if " " <= plain <= "~" else _UNKNOWN) - ord(_FIRST)
    is_micro = plain == "\N{GREEK SMALL LETTER MU}"
    columns = np.frombuffer(_MICRO, np.uint8) if is_micro else np.frombuffer(_COLUMNS, np.uint8, WIDTH, WIDTH * index)
    return (columns >> np.arange(HEIGHT, dtype=np.uint8)[:, None] & 1).astype(bool)


def grown(pixels: NDArray[np.bool_], *, back: bool = True, on: bool = True) -> NDArray[np.bool_]:
    """Add the pixels before and after each, above and below, corner to corner, too."""
    made = pixels.copy()
    for along in (made, made.T):
        before = along.copy(order="K")
        if back:
            along[:-1] |= before[1:]
        if on:
            along[1:] |= before[:-1]
    return made


@cache
def _cells(text: str) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Cells of a text and of its halo, as (n, 2) columns and rows from the middle of its box."""
    ink = np.zeros((HEIGHT + 2, ADVANCE * len(text) + 1), bool)
    for k, letter in enumerate(text):
        ink[1:-1, ADVANCE * k + 1 : ADVANCE * k + 1 + WIDTH] = _glyph(letter)
    middle = np.array([ink.shape[1] // 2, ink.shape[0] // 2])
    return np.argwhere(ink)[:, ::-1] - middle, np.argwhere(grown(ink) & ~ink)[:, ::-1] - middle


def text_cells(texts: Sequence[str]) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.bool_]]:
    """Give the cells of texts."""
    parts = [np.concatenate(_cells(text)) for text in texts]
    inks = [len(_cells(text)[0]) for text in texts]
    sizes = np.array([len(part) for part in parts], dtype=np.int64)
    owner, number = owners(sizes), within(sizes)
    cells = np.concatenate([np.empty((0, 2), np.int64), *parts])
    return owner, cells, number < np.array(inks, dtype=np.int64)[owner]


FINE = 4
"""Pixels of the drawing a pixel of the picture, each way: 16 shades."""

FLATNESS = 0.25
"""Pixels of the drawing that lines may be off the curves that they stand for."""

CAPITAL = 0.72
"""Height of capitals, as a part of the size of letters; as in SVG."""

MOST_COLORS = 255
NOTHING = "#000000"
"""A color that adds nothing to the image beneath."""
BAND_ROWS = 64
_HALVES: tuple[Callable[[NDArray[np.int64], NDArray[np.int64]], NDArray[np.int64]], ...] = (
    lambda row, x: row + x,
    lambda row, _: row,
    lambda row, _: row // 2,
    lambda _, x: x // 2,
)
"""Where these are even lie halves of the pixels; each layer that is seen through sets another one, which has half of
what any other has set: so colors mix as in SVG."""

_PIXELS = 1 << 22  # of the drawing, that are set at a time
_TEXTS = 1 << 14  # that are written at a time
_ITEMS = 1 << 18  # lines or corners that are taken at a time


def check_picture_size(page: Page, max_pixels: int) -> None:
    """Refuse a picture whose drawing would have more pixels than there may be."""
    fine = page.width * page.height * FINE**2
    if fine > max_pixels:
        raise LimitError(
            f"a PNG of {page.width} x {page.height} pixels is drawn with {fine}, more than "
            f"{option(f'--max-pixels {max_pixels}')}: use a smaller {option('--width')}, or {AS_SVG}"
        )


def layer_bands(layers: Iterable[Layer], page: Page, *, insets: Iterable[Layer] = ()) -> Iterator[NDArray[np.uint8]]:
    """Draw layers from below, over the page's image if it has one."""
    canvas = _Canvas(page)
    for layer in layers:
        canvas.draw(layer, page)
    for inset in insets:
        canvas.draw(inset, PixelPage(page))
    return canvas.bands()


class _Canvas:
    """A drawing in palette indices, ``FINE`` times as large as the page each way."""

    def __init__(self, page: Page) -> None:
        self.page = page
        self.indices = np.zeros((page.height * FINE, page.width * FINE), np.uint8)  # 0: nothing
        self.colors: dict[str, int] = {}
        self.sheer = 0  # which half of the pixels the next layer that is seen through sets

    def draw(self, layer: Layer, page: Page) -> None:
        if isinstance(layer, Arcs | CurvedPolygons) or (isinstance(layer, Curves) and layer.center is not None):
            layer = layer.chords(page.distance(FLATNESS / FINE))
        places = page.place(layer.points) * FINE
        if isinstance(layer, Polygons):
            half = None
            if layer.is_sheer or page.backdrop is not None:
                half, self.sheer = self.sheer, (self.sheer + 1) % len(_HALVES)
            self._fill(layer, places, half)
            if layer.edge is not None:
                self._stroke(places, layer.sides(), layer.width, self._color(layer.edge))
        elif isinstance(layer, Lines):
            self._stroke(places, layer.pairs, layer.width, self._color(layer.color))
        elif isinstance(layer, Curves):
            lines = replace(layer, points=places).chords(FLATNESS)
            self._stroke(lines.points, lines.pairs, layer.width, self._color(layer.color))
        elif isinstance(layer, Points):
            if layer.halo is not None:
                self._discs(places, (layer.radius + layer.edge) * FINE, self._color(layer.halo))
            self._discs(places, layer.radius * FINE, self._color(layer.color))
        elif isinstance(layer, Texts):
            self._write(layer, places)

    def bands(self) -> Iterator[NDArray[np.uint8]]:
        """Means of the colors of FINE x FINE pixels; where nothing is drawn, that of the ground or the image."""
        backdrop, ground = self.page.backdrop, self.page.style.ground
        has_alpha = backdrop is None and ground is None
        names = [NOTHING if backdrop is not None or ground is None else ground, *self.colors]
        palette = triples(names).astype(np.uint16)
        for top in range(0, self.page.height, BAND_ROWS):
            fine = self.indices[top * FINE : (top + BAND_ROWS) * FINE]
            rows = len(fine) // FINE
            sums = np.zeros((rows, self.page.width, 3), np.uint16)
            bare = np.zeros((rows, self.page.width, 1), np.uint16)
            for k in range(FINE**2):
                part = fine[k // FINE :: FINE, k % FINE :: FINE]
                sums += palette[part]
                bare[:, :, 0] += part == 0
            if backdrop is not None:
                sums += bare * backdrop.pixels[top : top + rows]
            yield (_with_alpha(sums, FINE**2 - bare) if has_alpha else _means(sums, FINE**2)).reshape(rows, -1)

    def _color(self, name: str) -> int:
        number = self.colors.setdefault(name, len(self.colors) + 1)
        if number > MOST_COLORS:
            raise LimitError(f"a PNG picture has at most {MOST_COLORS} colors: use {AS_SVG}")
        return number

    def _fill(self, layer: Polygons, places: NDArray[np.float64], half: int | None) -> None:
        """Fill each polygon by the even-odd rule: rows of pixels between crossings of its sides, in pairs."""
        classes = np.array([self._color(name) for name in layer.colors], dtype=np.uint8)
        polygon = layer.polygon_of_ring
        limits, rings = layer.ring_limits, np.asarray(layer.rings)
        fills = classes[np.zeros(len(limits) - 1, np.int64) if layer.color_of is None else layer.color_of]
        owner = np.repeat(polygon, np.diff(rings))
        sides = layer.sides()
        corner_limits = rings[limits]  # where each polygon begins among the corners
        start = 0
        while start < len(corner_limits) - 1:  # some whole polygons at a time
            stop = max(start + 1, int(np.searchsorted(corner_limits, corner_limits[start] + _ITEMS, "right")) - 1)
            part = slice(corner_limits[start], corner_limits[stop])
            self._fill_part(places, sides[part], owner[part], fills, half)
            start = stop

    def _fill_part(
        self,
        places: NDArray[np.float64],
        sides: NDArray[np.int32],
        owner: NDArray[np.int64],
        fills: NDArray[np.uint8],
        half: int | None,
    ) -> None:
        a, b = places[sides[:, 0]], places[sides[:, 1]]
        height = self.indices.shape[0]
        ends = np.clip(np.ceil(np.stack([a[:, 1], b[:, 1]]) - 0.5), 0, height).astype(np.int64)
        first, counts = ends.min(axis=0), np.abs(ends[1] - ends[0])
        side, row = _expanded(first, counts)
        slope = (b[side, 0] - a[side, 0]) / (b[side, 1] - a[side, 1])
        x = a[side, 0] + (row + 0.5 - a[side, 1]) * slope
        order = np.lexsort((x, row, owner[side]))
        row, x, of = row[order], np.ceil(x[order] - 0.5), owner[side][order]
        self._set_rows(row[::2], x[::2], x[1::2], fills[of[::2]], half=half)

    def _stroke(self, places: NDArray[np.float64], pairs: NDArray[np.int32], width: float, value: int) -> None:
        """Draw lines as runs of pixels across them: a column of pixels where they are flat, else a row."""
        thick = max(width * FINE, 1.0)
        for begin in range(0, len(pairs), _ITEMS):
            part = pairs[begin : begin + _ITEMS]
            a, b = places[part[:, 0]], places[part[:, 1]]
            way = np.abs(b - a)
            flat = way[:, 0] >= way[:, 1]
            self._runs(a[flat], b[flat], thick, value, self.indices.T)
            self._runs(a[~flat][:, ::-1], b[~flat][:, ::-1], thick, value, self.indices)

    def _runs(
        self,
        a: NDArray[np.float64],
        b: NDArray[np.float64],
        thick: float,
        value: int,
        target: NDArray[np.uint8],
    ) -> None:
        """Lines along the rows of a target, which lies with its rows across them."""
        swap = a[:, 0] > b[:, 0]
        a, b = np.where(swap[:, None], b, a), np.where(swap[:, None], a, b)
        way = b - a
        along = np.maximum(way[:, 0], 2.0**-30)  # of a line of no length: a dot
        length = np.sqrt(way[:, 0] * way[:, 0] + way[:, 1] * way[:, 1])
        half = 0.5 * thick * np.clip(length / along, 1.0, 1.5)
        first = np.clip(np.floor(a[:, 0]), 0, target.shape[0]).astype(np.int64)
        last = np.clip(np.floor(b[:, 0]) + 1, 0, target.shape[0]).astype(np.int64)
        line, step = _expanded(first, last - first)
        ahead = np.clip((step + 0.5 - a[line, 0]) / along[line], 0.0, 1.0)
        middle = a[line, 1] + ahead * way[line, 1]
        self._set_rows(step, np.ceil(middle - half[line] - 0.5), np.ceil(middle + half[line] - 0.5), value, target)

    def _write(self, layer: Texts, places: NDArray[np.float64]) -> None:
        """Write texts, each cell of a glyph a square of pixels; halos first, so that they cover no letter."""
        cell = max(2, round(CAPITAL * layer.size * FINE / HEIGHT))
        foot = layer.lowered(places[:, 1] / FINE, CAPITAL) * FINE - cell * (HEIGHT - 1) / 2
        left = places[:, 0]
        if layer.is_led:
            left = left + cell * ADVANCE * np.array([len(text) for text in layer.texts]) / 2
        corner = np.floor(np.stack([left, foot], axis=1) - cell / 2).astype(np.int64)
        if cell % FINE == 0:  # whole pixels, which are not blurred
            corner -= corner % FINE
        ink, halo = self._color(layer.color), self._color(layer.halo or edge_color(layer.color))
        for begin in range(0, len(layer.texts), _TEXTS):
            owner, cells, is_ink = text_cells(layer.texts[begin : begin + _TEXTS])
            at = corner[begin + owner] + cell * cells
            for chosen, value in ((~is_ink, halo), (is_ink, ink)):
                left, top = at[chosen].T
                for row in range(cell):
                    self._set_rows(top + row, left.astype(np.float64), (left + cell).astype(np.float64), value)

    def _discs(self, places: NDArray[np.float64], radius: float, value: int) -> None:
        radius = max(radius, 1.0)
        for begin in range(0, len(places), _ITEMS):
            x, y = places[begin : begin + _ITEMS].T
            for offset in range(-int(radius) - 1, int(radius) + 2):
                row = np.floor(y) + offset
                square = radius * radius - np.square(row + 0.5 - y)
                half = np.sqrt(np.maximum(square, 0.0))
                hit = square > 0
                left, right = np.ceil(x - half - 0.5)[hit], np.ceil(x + half - 0.5)[hit]
                self._set_rows(row[hit].astype(np.int64), left, right, value)

    def _set_rows(
        self,
        row: NDArray[np.int64],
        left: NDArray[np.float64],
        right: NDArray[np.float64],
        values: NDArray[np.uint8] | int,
        target: NDArray[np.uint8] | None = None,
        *,
        half: int | None = None,
    ) -> None:
        """Set pixels from ``left`` to before ``right`` of rows, or a half of them; what is outside is left out."""
        drawing = self.indices if target is None else target
        height, width = drawing.shape
        start = np.clip(left, 0, width).astype(np.int64)
        counts = np.clip(right, 0, width).astype(np.int64) - start
        counts[(counts < 0) | (row < 0) | (row >= height)] = 0
        done = np.cumsum(counts)
        begin = 0
        while begin < len(row):  # runs of about _PIXELS pixels together
            before = int(done[begin - 1]) if begin else 0
            end = max(begin + 1, int(np.searchsorted(done, before + _PIXELS, "right")))
            run, x = _expanded(start[begin:end], counts[begin:end])
            if half is not None:
                chosen = _HALVES[half](row[begin:end][run], x) % 2 == 0
                run, x = run[chosen], x[chosen]
            drawing[row[begin:end][run], x] = values if isinstance(values, int) else values[begin:end][run]
            begin = end


def _means(sums: NDArray[np.uint16], counts: NDArray[np.uint16] | int) -> NDArray[np.uint8]:
    return ((sums + counts // 2) // counts).astype(np.uint8)


def _with_alpha(sums: NDArray[np.uint16], drawn: NDArray[np.uint16]) -> NDArray[np.uint8]:
    """Means of what is drawn alone, and how much of each pixel that is."""
    return np.concatenate([_means(sums, np.maximum(drawn, np.uint16(1))), _means(255 * drawn, FINE**2)], axis=2)


def _expanded(first: NDArray[np.int64], counts: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Every whole number of runs that begin at ``first``, and the run that each is in."""
    return owners(counts), ranges(first, counts)
