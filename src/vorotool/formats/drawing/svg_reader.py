"""Polygons and lines of SVG drawings."""

from __future__ import annotations

import zlib
from dataclasses import dataclass, field
from typing import NamedTuple

from vorotool.errors import InputError, LimitError
from vorotool.formats.drawing.curves import Affine, Curve
from vorotool.formats.drawing.polygons import Shape, shapes_to_polygons
from vorotool.formats.drawing.svg_document import GROUPS, MOST_REPEATED, NO_SHAPES, Document, Element, Style, is_hidden
from vorotool.formats.drawing.svg_shapes import (
    MM,
    PX,
    SHAPES,
    Geometry,
    Viewport,
    fitted,
    parsed_length,
    parsed_transform,
    viewbox_of,
)
from vorotool.formats.io.sources import Source
from vorotool.formats.io.unpacking import unpack_gzip
from vorotool.formats.parsing.reader_options import ReadOptions
from vorotool.types.box import Box
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.values import counted

_INKSCAPE = "http://www.inkscape.org/namespaces/inkscape}"
GZIP_MAGIC = b"\x1f\x8b"
MOST_BYTES = 2**27
"""Of a drawing that is unpacked."""


def read_svg(source: Source, options: ReadOptions) -> PolygonSet:
    """Read the shapes of a drawing, one feature an element, with its id; curves become lines within a tolerance."""
    document = Document.parsed(source.name, _unpacked(source))
    page = _page(document)
    reader = _Reader(document, options)
    reader.walk_root(_State(page.map, Style(), page.viewport, None))
    document.note_skipped(options.note)
    if reader.unpainted:
        options.note(f"{source.name}: {counted(reader.unpainted, 'shape')} without fill and stroke skipped")
    if reader.has_background and len(reader.shapes) > 1:
        background = reader.shapes.pop(0)
        del reader.layers[0]
        options.note(f"{background.place}: the background of the page is skipped; give it an id to keep it as a shape")
    document.note_styles(options.note)
    layers = {"layer": reader.layers} if any(layer is not None for layer in reader.layers) else None
    return shapes_to_polygons(source.name, reader.shapes, options, unit=page.unit, page=page.box, properties=layers)


def _unpacked(source: Source) -> bytes:
    """Undo the compression of .svgz files."""
    if not source.data.startswith(GZIP_MAGIC):
        return source.data
    try:
        data = unpack_gzip(source.data, MOST_BYTES)
    except (ValueError, zlib.error) as error:
        raise InputError(f"{source.name}: the compressed drawing is damaged ({error}); save it again") from None
    if len(data) > MOST_BYTES:
        raise LimitError(f"{source.name} unpacks to more than {MOST_BYTES} bytes: split the drawing")
    return data


# ---- the page --------------------------------------------------------------------------------------
class _Page(NamedTuple):
    """The map to the coordinates that are read, their unit, what percentages are of, and what is seen."""

    map: Affine
    unit: str | None
    viewport: Viewport
    box: Box | None


def _page(document: Document) -> _Page:
    """Of a drawing with a physical size, in mm; others stay in their own units."""
    root = document.root
    place = document.place(root)
    box = viewbox_of(root.attributes, place)
    if box is not None and (not box[2] or not box[3]):
        raise InputError(f"{place}: the viewBox is empty, so it shows nothing; give it a width and a height")
    sizes = {name: _size(root, name, place) for name in ("width", "height")}
    x, y, across, down = box or (0.0, 0.0, *((size or 0.0) / PX for size, _ in sizes.values()))
    own, seen = Viewport(across, down), _box(x, y, across, down)
    if not any(is_physical for _, is_physical in sizes.values()):
        return _Page(Affine(), None, own, seen)
    if box is None:
        return _Page(Affine(PX, 0.0, 0.0, PX), "mm", own, seen and seen.stretched(PX, PX))
    width, height = (sizes[name][0] for name in ("width", "height"))
    if width is None and height is not None:
        width = height * box[2] / box[3]
    if height is None and width is not None:
        height = width * box[3] / box[2]
    assert width is not None
    assert height is not None
    if not width > 0 or not height > 0:
        raise InputError(f"{place}: the drawing is {width:g} mm by {height:g} mm; give it a width and a height")
    viewport = Viewport(width, height)
    by = fitted(box, viewport, root.attributes.get("preserveAspectRatio", ""))
    return _Page(by, "mm", own, _box(0.0, 0.0, width, height))


def _box(x: float, y: float, width: float, height: float) -> Box | None:
    """Return the page, if it has a size."""
    return Box.of_size(x, y, width, height) if width > 0 and height > 0 else None


def _size(root: Element, name: str, place: str) -> tuple[float | None, bool]:
    """Width or height in mm, with whether a physical unit says so; without, in px where it is alone."""
    text = root.attributes.get(name, "").strip()
    if text in ("", "auto"):
        return None, False
    number, unit = parsed_length(text, f"{place}: {name}")
    if unit == "%":
        return None, False
    return (number * MM[unit], True) if unit in MM else (number * PX, False)


# ---- elements --------------------------------------------------------------------------------------
class _State(NamedTuple):
    """What elements inherit: the map, the style, what percentages are of, what uses them, their layer."""

    map: Affine
    style: Style
    viewport: Viewport
    used_as: str | None
    layer: str | None = None
    is_used: bool = False


@dataclass
class _Reader:
    """What is found on a walk through a drawing."""

    document: Document
    options: ReadOptions
    shapes: list[Shape] = field(default_factory=list)
    layers: list[str | None] = field(default_factory=list)
    unpainted: int = 0
    has_background: bool = False  # as the first shape
    _maps: dict[str, Affine] = field(default_factory=dict)  # of the transforms of all elements
    _used: dict[Element, list[Curve]] = field(default_factory=dict)  # paths that may be used again
    _repeated: int = 0
    _places: int = 0

    def walk_root(self, state: _State) -> None:
        """Walk through all of it; its outermost element has its place already."""
        document, root = self.document, self.document.root
        own = document.styles.of_element(root)
        style = state.style.inherited_by(own)
        document.check_own(root, own, style)
        by = state.map.after(self._transform(root, own))
        if is_hidden(own):
            document.hidden += 1
        else:
            self.walk_in(root, state._replace(map=by, style=style))

    def walk_in(self, group: Element, state: _State) -> None:
        for child in self.document.shown(group):
            self.walk(child, state)

    def walk(self, element: Element, state: _State) -> None:
        document = self.document
        is_shown = element.tag in SHAPES or element.tag in (*GROUPS, "use", "text", "image", "foreignObject")
        if not is_shown:  # definitions, titles, what other programs keep for themselves
            return
        own = document.styles.of_element(element)
        if is_hidden(own):
            document.hidden += 1
            return
        style = state.style.inherited_by(own)
        if element.tag in (*SHAPES, "text", "image") and style.visibility in ("hidden", "collapse"):
            document.hidden += 1
            return
        if element.tag in NO_SHAPES:
            document.skipped.setdefault(element.tag, []).append(element.line)
            return
        document.check_own(element, own, style)
        by = state.map.after(self._transform(element, own))
        state = state._replace(map=by, style=style)
        if element.tag == "use":
            self._use(element, state)
        elif element.tag == "svg":
            inner = self._viewport(element, element, state)
            if inner is not None:
                self.walk_in(element, inner)
        elif element.tag in GROUPS:
            self.walk_in(element, state._replace(layer=_layer_of(element, state.layer)))
        else:
            self._shape(element, state)

    def _transform(self, element: Element, own: dict[str, str]) -> Affine:
        text = own.get("transform", "")
        if text not in self._maps:
            self._maps[text] = parsed_transform(text, self.document.place(element))
        return self._maps[text]

    def _use(self, use: Element, state: _State) -> None:
        target = self.document.target(use)
        of = Geometry(use.attributes, self.document.place(use), state.viewport)
        moved = state.map.after(Affine(e=of.across("x"), f=of.down("y")))
        state = state._replace(map=moved, used_as=state.used_as or use.attributes.get("id"), is_used=True)
        if target.tag not in ("symbol", "svg"):
            self.walk(target, state)
            return
        own = self.document.styles.of_element(target)
        self.document.check_own(target, own, state.style)
        if is_hidden(own):
            return
        inner = self._viewport(target, use, state._replace(style=state.style.inherited_by(own)))
        if inner is not None:
            self.walk_in(target, inner)

    def _viewport(self, element: Element, sized: Element, state: _State) -> _State | None:
        """What is inherited in an svg or a symbol, whose size another element may give; None if it shows nothing."""
        place = self.document.place(element)
        given = element.attributes | {k: sized.attributes[k] for k in ("width", "height") if k in sized.attributes}
        of = Geometry(given, place, state.viewport)
        width, height = of.across("width", state.viewport.width), of.down("height", state.viewport.height)
        by = state.map
        if element.tag == "svg":
            by = by.after(Affine(e=of.across("x"), f=of.down("y")))
        box = viewbox_of(element.attributes, place)
        if box is None:
            return state._replace(map=by, viewport=Viewport(width, height))
        if not (box[2] and box[3] and width > 0 and height > 0):
            return None
        by = by.after(fitted(box, Viewport(width, height), element.attributes.get("preserveAspectRatio", "")))
        return state._replace(map=by, viewport=Viewport(box[2], box[3]))

    def _shape(self, element: Element, state: _State) -> None:
        style, place = state.style, self.document.place(element)
        is_line = element.tag == "line"
        if not style.is_stroked and (is_line or not style.is_filled):
            self.unpainted += 1
            return
        mapped = [curve.mapped(state.map) for curve in self._curves(element, state)]
        if not mapped:
            return
        self._places += len(mapped)
        self.options.check_vertices(self.document.name, self._places)  # of each curve one, before any is flattened
        identity = state.used_as or element.attributes.get("id")
        rule = style.rule if style.is_filled and not is_line else None
        if not self.shapes and not style.is_stroked:
            self.has_background = self._is_background(element, state)
        self.layers.append(state.layer)
        self.shapes.append(Shape(mapped, rule, identity, place, style.is_stroked))

    def _is_background(self, element: Element, state: _State) -> bool:
        """Whether it is a bare rectangle below everything that fills the page: drawing programs name theirs."""
        document, root = self.document, self.document.root
        first = next((each for each in document.shown(root) if each.tag in (*SHAPES, *GROUPS, "use")), None)
        if element is not first or element.tag != "rect" or {"id", "transform", "rx", "ry"} & set(element.attributes):
            return False
        of, (width, height) = Geometry(element.attributes, document.place(element), state.viewport), state.viewport
        x, y, *_ = viewbox_of(root.attributes, document.place(root)) or (0.0, 0.0)
        own = (of.across("x"), of.down("y"), of.size("width", width), of.size("height", height))
        page, least = (x, y, width, height), (width + height) / 10**6  # pages are rounded, of those in mm too
        return all(abs(a - b) <= least for a, b in zip(own, page, strict=True))

    def _curves(self, element: Element, state: _State) -> list[Curve]:
        """Give the curves of a shape; paths that are used are parsed once, and counted before they are repeated."""
        known = self._used.get(element)
        if known is not None:
            self._repeated += sum(len(curve.pieces) for curve in known)
            if self._repeated > MOST_REPEATED:
                raise LimitError(
                    f"{self.document.place(element)}: more than {MOST_REPEATED} pieces of curves are drawn, because "
                    "some elements are used many times; split the drawing"
                )
            return known
        made = SHAPES[element.tag](Geometry(element.attributes, self.document.place(element), state.viewport))
        if state.is_used and element.tag in ("path", "polygon", "polyline"):  # of which nothing is a percentage
            self._used[element] = made
        return made


def _layer_of(group: Element, outer: str | None) -> str | None:
    """Give the layer of a group: its own if it is one, as Inkscape has them, else that around it."""
    attributes = group.attributes
    if attributes.get(f"{_INKSCAPE}groupmode") != "layer":
        return outer
    return attributes.get(f"{_INKSCAPE}label", attributes.get("id", outer))
