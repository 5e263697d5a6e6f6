"""SVG pictures from layers, streamed: the numbers are formatted in the core."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Callable, Iterable, Iterator
from html import escape
from itertools import chain
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.numeric.arrays import mask_of
from vorotool.numeric.coordinates import current_written
from vorotool.numeric.curves.flatten import middles_of
from vorotool.numeric.curves.inverse_functions import hypotenuse
from vorotool.numeric.xml_text import xml_characters
from vorotool.render.canvas.insets import PixelPage, short
from vorotool.render.canvas.layers import (
    Arcs,
    Backdrop,
    Circles,
    CubicCurves,
    CurvedPolygons,
    Curves,
    Layer,
    Lines,
    Page,
    Points,
    Polygons,
    Texts,
)

PATH_ROWS = 4096
"""Lines or polygons of one path: viewers slow down with longer ones, and with many elements."""

MOST_ELEMENTS = 100_000
"""Elements of a layer: resvg refuses files of 10^6, browsers become slow before. More share paths."""

CAPITAL = 0.72
"""Height of capitals, as a part of the size of letters."""

HALO = 0.25
"""Width of the edge around letters, half of it outside, as a part of their size."""

SLICE_ROWS = 1 << 17
DECIMALS = 2
DASH = 6
"""Px: of broken lines, and between."""


def write_layers_svg(out: BinaryIO, layers: Iterable[Layer], page: Page, *, insets: Iterable[Layer] = ()) -> None:
    """Draw layers from below, each a group with its name for an id; strokes keep their width when it is scaled."""
    ground = "" if page.style.ground is None else f'<rect {page.size} fill="{page.style.ground}"/>\n'
    head = f'<svg xmlns="http://www.w3.org/2000/svg" {page.size} viewBox="0 0 {page.extent}">\n'
    out.write((head + ground).encode())
    if page.backdrop is not None:
        out.write(image_element(page.backdrop))
    for layer in layers:
        for part in layer_parts(layer, page):
            out.write(part)
    for inset in insets:
        for part in layer_parts(inset, PixelPage(page)):
            out.write(part)
    out.write(b"</svg>\n")


def image_element(backdrop: Backdrop) -> bytes:
    """The image as an element with its pixels in it."""
    height, width = backdrop.pixels.shape[:2]
    head = f'<image id="image" width="{width}" height="{height}" style="image-rendering:pixelated" href="data:image/png'
    return head.encode() + b";base64," + b64encode(backdrop.encode()) + b'"/>\n'


def halo_style(color: str, size: float) -> str:
    """Attributes of letters of a size that have an edge around them."""
    return f'stroke="{color}" stroke-width="{HALO * size:.3g}" stroke-linejoin="round" paint-order="stroke"'


def fill_style(backdrop: Backdrop | None, *, is_sheer: bool = False) -> str:
    """Attribute of a group whose areas the image shows through, if there is one, or in any case."""
    return "" if backdrop is None and not is_sheer else ' fill-opacity="0.5"'


def layer_parts(layer: Layer, page: Page) -> Iterator[bytes]:
    """Give the group of a layer, piece by piece."""
    if isinstance(layer, Arcs):
        return _circles(layer, page) if isinstance(layer, Circles) else _arcs(layer, page)
    x, y = np.ascontiguousarray(np.round(page.place(layer.points), page.decimals).T + 0.0)  # no -0
    if isinstance(layer, Lines):
        return _lines(layer, x, y)
    if isinstance(layer, Curves):
        return _curves(layer, x, y, page)
    if isinstance(layer, Polygons):
        if isinstance(layer, CurvedPolygons):
            return _curved_polygons(layer, x, y, page)
        return _polygons(layer, x, y, page)
    return _points(layer, x, y) if isinstance(layer, Points) else _texts(layer, x, y)


def _rows(columns: list[Any], around: tuple[str, ...]) -> list[bytes]:
    return _core.text.format_rows(columns, [None] * len(columns), [], current_written().how.threads, (around, "", ""))


def _chunks(count: int, size: int) -> Iterator[slice]:
    return (slice(begin, min(begin + size, count)) for begin in range(0, count, size))


def _group(name: str, style: str, parts: Iterable[bytes]) -> Iterator[bytes]:
    yield f'<g id="{_escaped(name)}" {style}>\n'.encode()
    yield from parts
    yield b"</g>\n"


def _paths(count: int, places: Callable[[slice], Iterable[bytes]]) -> Iterator[bytes]:
    """Paths of some lines or polygons each."""
    for rows in _chunks(count, PATH_ROWS):
        yield f'<path {_UNSCALED} d="'.encode()
        yield from places(rows)
        yield b'"/>\n'


def _texts_of(x: NDArray[Any], y: NDArray[Any]) -> tuple[_core.text.NumberTexts, _core.text.NumberTexts]:
    threads = current_written().how.threads
    return _core.text.NumberTexts(x, 0, threads), _core.text.NumberTexts(y, 0, threads)


def _lines(layer: Lines, x: NDArray[Any], y: NDArray[Any]) -> Iterator[bytes]:
    across, down = _texts_of(x, y)

    def places(rows: slice) -> list[bytes]:
        a, b = layer.pairs[rows].T
        return _rows([(across, a), (down, a), (across, b), (down, b)], ("M", " ", "L", " ", ""))

    return _group(layer.name, _stroke(layer.color, layer.width), _paths(len(layer.pairs), places))


def _curves(layer: Curves, x: NDArray[Any], y: NDArray[Any], page: Page) -> Iterator[bytes]:
    """One row a place: M before the begin of a path, Q or C before a control point, then L, A or nothing."""
    commands, (across, down) = _Commands(layer, page), _texts_of(x, y)
    more = int(isinstance(layer, CubicCurves))

    def places(rows: slice) -> list[bytes]:
        source, target = layer.pairs[rows].T
        control = layer.control[rows]
        begins = np.append(True, source[1:] != target[:-1])
        bends = control >= 0
        last = np.cumsum(1 + begins + bends + more) - 1  # the row of each target
        place, token = np.empty((2, last[-1] + 1), dtype=np.int32)
        place[last], token[last] = target, commands.before_ends[0, rows]
        place[last[bends] - 1 - more], token[last[bends] - 1 - more] = control[bends], 2
        if isinstance(layer, CubicCurves):
            place[last - 1], token[last - 1] = layer.second[rows], 3
        first = (last - bends - more - 1)[begins]
        place[first], token[first] = source[begins], 0
        return _rows([(commands.texts, token), (across, place), (down, place)], ("", "", " ", ""))

    dashes = f' stroke-dasharray="{DASH:g}"' if layer.is_broken else ""
    return _group(layer.name, _stroke(layer.color, layer.width) + dashes, _paths(len(layer.pairs), places))


class _Commands:
    """What stands before the places of curves: `texts`, and which of them before the end of each, forth and back."""

    def __init__(self, curves: Curves, page: Page) -> None:
        self.texts = ["M", "L", "C" if isinstance(curves, CubicCurves) else "Q", " "]
        forth = np.where(curves.control >= 0, 3, 1)
        self.before_ends = np.stack([forth, forth])
        if curves.center is None or curves.is_left is None:
            return
        is_round = ~np.isnan(curves.center[:, 0])
        center, is_left = curves.center[is_round], curves.is_left[is_round]
        source, target = (curves.points[end][is_round] for end in curves.pairs.T)
        radii, number = np.unique(hypotenuse(*(source - center).T), return_inverse=True)
        for radius in map(page.length, radii.tolist()):
            sides = " ".join(short(side, page.decimals + 1) for side in (radius, radius * page.aspect))
            self.texts += [f"A{sides} 0 0 {sweep} " for sweep in (0, 1)]
        sweeps = is_left != page.y_up  # 1 is clockwise as seen
        numbers = 4 + 2 * number + np.stack([sweeps, ~sweeps])
        is_wide = ((source - center) * (target - center)).sum(axis=1) < 0
        if is_wide.any():
            first, last = np.where(is_left[:, None], [source, target], [target, source])[:, is_wide]
            middles = page.place(middles_of(first, last, center[is_wide], np.zeros(len(first), dtype=bool)))
            numbers[:, is_wide] = [self._halves(each, middles, page.decimals) for each in numbers[:, is_wide]]
        self.before_ends[:, is_round] = numbers

    def _halves(self, commands: NDArray[Any], middles: NDArray[np.float64], decimals: int) -> NDArray[Any]:
        """Add two arcs for each that is over a quarter: rounded ends alone would not tell well where its center is."""
        first = len(self.texts)
        for command, (x, y) in zip(commands.tolist(), middles.tolist(), strict=True):
            arc = self.texts[command]
            self.texts.append(f"{arc}{short(x, decimals)} {short(y, decimals)}{arc}")
        return first + np.arange(len(commands))


def _filled(layer: Polygons, page: Page, rows: int, columns: Callable[[slice], list[Any]]) -> Iterator[bytes]:
    """One row a place: what stands before it, x and y; the end of the last path is missing."""
    edge = _SEAL if layer.is_sealed else "" if layer.edge is None else f" {_outline(layer.edge, layer.width)}"
    parts = (part for chunk in _chunks(rows, SLICE_ROWS) for part in _rows(columns(chunk), ("", "", " ", "")))
    style = f'fill-rule="evenodd"{fill_style(page.backdrop, is_sheer=layer.is_sheer)}{edge}'
    return _group(layer.name, style, chain(parts, [b'Z"/>\n'] * bool(rows)))


def _polygons(layer: Polygons, x: NDArray[Any], y: NDArray[Any], page: Page) -> Iterator[bytes]:
    """What stands before a corner is L, the end of a ring, or the end of a path and another's begin."""
    (across, down), (texts, before) = _texts_of(x, y), _openings(layer)

    def columns(rows: slice) -> list[Any]:
        corners = layer.corners[rows]
        return [(texts, before[rows]), (across, corners), (down, corners)]

    return _filled(layer, page, len(layer.corners), columns)


def _curved_polygons(layer: CurvedPolygons, x: NDArray[Any], y: NDArray[Any], page: Page) -> Iterator[bytes]:
    """Rows as of `_curves`; each ring begins with a place, and ends with it."""
    across, down = _texts_of(x, y)
    curves, commands = layer.curves, _Commands(layer.curves, page)
    side, is_back = np.abs(layer.along) - 1, layer.along < 0
    bends = curves.control[side] >= 0
    rings = np.asarray(layer.rings, dtype=np.int64)
    is_first = mask_of(rings[:-1][rings[1:] > rings[:-1]], len(side))
    last = np.cumsum(1 + is_first + bends) - 1  # the row of the end of each side
    rows = int(last[-1]) + 1 if len(last) else 0
    place, token = np.empty((2, rows), dtype=np.int32)
    place[last] = curves.pairs[side, 1 - is_back]
    token[last] = commands.before_ends[is_back.astype(int), side]
    place[last[bends] - 1], token[last[bends] - 1] = curves.control[side[bends]], 2
    first = (last - bends - 1)[is_first]
    place[first] = curves.pairs[side[is_first], is_back[is_first].astype(int)]
    texts, before = _openings(layer)
    token[first] = before[is_first] + len(commands.texts)
    texts = [*commands.texts, *texts]

    def columns(part: slice) -> list[Any]:
        return [(texts, token[part]), (across, place[part]), (down, place[part])]

    return _filled(layer, page, rows, columns)


def _openings(layer: Polygons) -> tuple[list[str], NDArray[np.int32]]:
    """Texts that stand before corners, and which of them stands before each."""
    rings = np.asarray(layer.rings, dtype=np.int64)
    drawn = np.flatnonzero(rings[1:] > rings[:-1])  # rings with corners
    polygon = layer.polygon_of_ring[drawn]
    is_first = np.ones(len(drawn), dtype=bool)
    is_first[1:] = polygon[1:] != polygon[:-1]
    color = np.zeros(len(layer.ring_limits) - 1, np.int64) if layer.color_of is None else layer.color_of
    ids = None if len(color) > MOST_ELEMENTS else layer.ids
    texts = ["L", "ZM"]
    before = np.zeros(len(layer.corners), dtype=np.int32)
    opens = is_first.copy()
    if ids is None:  # polygons of one color that follow each other share a path
        order = np.cumsum(is_first) - 1
        fills = color[polygon]
        opens &= (order % PATH_ROWS == 0) | np.append(True, fills[1:] != fills[:-1])
        if layer.is_alone is not None:
            is_alone = layer.is_alone[polygon]
            opens |= is_first & (is_alone | np.append(True, is_alone[:-1]))
    for number, of in enumerate(polygon[opens].tolist()):
        name = "" if ids is None else f' id="{_escaped(ids[of])}"'
        fill = layer.colors[int(color[of])]
        seal = f' stroke="{fill}"' if layer.is_sealed else ""
        end = 'Z"/>\n' if number else ""
        texts.append(f'{end}<path{name} {_UNSCALED} fill="{fill}"{seal} d="M')
    before[rings[:-1][drawn]] = np.where(opens, np.cumsum(opens) + 1, 1)
    return texts, before


def _points(layer: Points, x: NDArray[Any], y: NDArray[Any]) -> Iterator[bytes]:
    if len(x) > MOST_ELEMENTS:
        discs = [(layer.name, layer.color, layer.radius)]
        if layer.halo is not None:
            discs.insert(0, (f"{layer.name}-halo", layer.halo, layer.radius + layer.edge))
        return chain.from_iterable(_dots(*each, x, y) for each in discs)
    halo = "" if layer.halo is None else f" {edge_style(layer.halo, layer.edge)}"
    circles = _rows([x, y], ('<circle cx="', '" cy="', f'" r="{layer.radius:.3g}"/>\n'))
    return _group(layer.name, f'fill="{layer.color}"{halo}', circles)


def edge_style(color: str, width: float) -> str:
    """Attributes of discs that have an edge around them."""
    return f'stroke="{color}" stroke-width="{2 * width:.3g}" paint-order="stroke"'


def _dots(name: str, color: str, radius: float, x: NDArray[Any], y: NDArray[Any]) -> Iterator[bytes]:
    """Lines of no length with round ends are discs."""

    def places(rows: slice) -> list[bytes]:
        return _rows([x[rows], y[rows]], ("M", " ", "h0"))

    return _group(name, _stroke(color, 2 * radius), _paths(len(x), places))


def _texts(layer: Texts, x: NDArray[Any], y: NDArray[Any]) -> Iterator[bytes]:
    font = f'font-family="Helvetica, Arial, sans-serif" font-size="{layer.size:g}"'
    halo = "" if layer.halo is None else f" {halo_style(layer.halo, layer.size)}"
    anchor = "start" if layer.is_led else "middle"
    columns = [x, np.round(layer.lowered(y, CAPITAL), DECIMALS), [_escaped(text) for text in layer.texts]]
    texts = _elements(columns, ('<text x="', '" y="', '">', "</text>\n"))
    return _group(layer.name, f'text-anchor="{anchor}" {font} fill="{layer.color}"{halo}', texts)


def _elements(columns: list[Any], around: tuple[str, ...]) -> Iterator[bytes]:
    """An element a row."""
    for rows in _chunks(len(columns[0]), SLICE_ROWS):
        yield from _rows([column[rows] for column in columns], around)


def _arcs(layer: Arcs, page: Page) -> Iterator[bytes]:
    """One path of all curves; with y downwards what turned clockwise turns counter-clockwise."""
    start, end = (np.round(page.place(places), page.decimals) + 0.0 for places in (layer.start, layer.end))
    is_arc = ~np.isnan(layer.center[:, 0])
    radii = hypotenuse(*np.where(is_arc[:, None], layer.start - layer.center, 0).T).tolist()
    sweeps = (layer.turns_left != page.y_up).astype(int).tolist()  # 1 is clockwise as seen
    commands = []
    for k, (x, y) in enumerate(end.tolist()):
        command = "L"
        if is_arc[k]:
            across = page.length(radii[k])
            radius, other = (short(each, page.decimals + 1) for each in (across, across * page.aspect))
            command = f"A{radius} {other} 0 0 {sweeps[k]} "
        commands.append(f"{command}{short(x, page.decimals)} {short(y, page.decimals)}")
    paths = []
    for first, last in zip(layer.rings[:-1].tolist(), layer.rings[1:].tolist(), strict=True):
        x, y = start[first].tolist()
        begin = f"M{short(x, page.decimals)} {short(y, page.decimals)}"
        paths.append(f"{begin}{''.join(commands[first:last])}Z")
    style = _stroke(layer.edge, layer.width)
    if layer.fill is not None:
        area = f'fill="{layer.fill}" fill-rule="evenodd"{fill_style(page.backdrop)}'
        style = f"{area} {_outline(layer.edge, layer.width)}"
    return _group(layer.name, style, _paths(len(paths), lambda rows: ["".join(paths[rows]).encode()]))


def _circles(layer: Circles, page: Page) -> Iterator[bytes]:
    """An element of each, in which a page with different scales along x and y has ellipses."""
    x, y = np.ascontiguousarray(np.round(page.place(layer.center[::2]), page.decimals).T + 0.0)
    across = np.round(np.array([page.length(each) for each in layer.radius.tolist()]), page.decimals + 1)
    columns, around = [x, y, across], _CIRCLE
    if page.aspect != 1:
        columns, around = [*columns, np.round(across * page.aspect, page.decimals + 1)], _ELLIPSE
    return _group(layer.name, _stroke(layer.edge, layer.width), _elements(columns, around))


def _escaped(text: str) -> str:
    return escape(xml_characters(text))


_UNSCALED = 'vector-effect="non-scaling-stroke"'
_SEAL = ' stroke-width="0.8" stroke-linejoin="round"'


_CIRCLE: tuple[str, ...] = ('<circle cx="', '" cy="', '" r="', f'" {_UNSCALED}/>\n')
_ELLIPSE: tuple[str, ...] = ('<ellipse cx="', '" cy="', '" rx="', '" ry="', f'" {_UNSCALED}/>\n')


def _stroke(color: str, width: float) -> str:
    """Attributes of lines that fill nothing."""
    return f'fill="none" {_outline(color, width)}'


def _outline(color: str, width: float) -> str:
    return f'stroke="{color}" stroke-width="{width:.3g}" stroke-linejoin="round" stroke-linecap="round"'
