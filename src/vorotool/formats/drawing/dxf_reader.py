"""Polygons and lines of DXF drawings."""

from __future__ import annotations

import io
import itertools
import logging
import struct
import sys
from collections import Counter
from collections.abc import Callable, Sequence
from configparser import ConfigParser
from dataclasses import dataclass, field
from math import isfinite
from typing import Any, NamedTuple

import numpy as np

from vorotool.convert.extras import needed
from vorotool.errors import InputError, LimitError, Message, VorotoolError, option
from vorotool.formats.drawing.curves import (
    Affine,
    Bezier,
    Curve,
    Line,
    Piece,
    Point,
    arc_between,
    bulged,
    extent_of,
    turned,
    whole_ellipse,
)
from vorotool.formats.drawing.polygons import (
    NESTED,
    Gap,
    Shape,
    default_tolerance,
    joined,
    open_gaps,
    shapes_to_polygons,
)
from vorotool.formats.io.sources import Source
from vorotool.formats.parsing.reader_options import ReadOptions
from vorotool.formats.recognition import BINARY_DXF
from vorotool.numeric.curves.flatten import CURVE_PART, MOST_PIECES
from vorotool.numeric.curves.inverse_functions import PI, cosine_and_sine, hypotenuse
from vorotool.types.fields import UP
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.values import counted

UNITS = {
    **{1: "in", 2: "ft", 3: "mi", 4: "mm", 5: "cm", 6: "m", 7: "km", 9: "mil", 10: "yd"},
    **{11: "Å", 12: "nm", 13: "um", 14: "dm", 21: "ftUS"},
}
"""Units of length by their numbers in the header."""

MOST_ENTITIES = 2**17
"""Of a drawing once its blocks are there as often as they are inserted, where that is more than the file holds; and
pieces of curves in blocks that are inserted."""

MOST_LEVELS = 100
"""Of blocks in blocks."""


def read_dxf(source: Source, options: ReadOptions) -> PolygonSet:
    """Read the lines, arcs, polylines and splines of a drawing; curves become lines within a tolerance."""
    drawing = _loaded(source)
    try:
        blocks = _Blocks(source.name, drawing)
        blocks.count(None, 0)
        blocks.walk(None, Affine(), None, options.flatten)
        unit = UNITS.get(int(drawing.header.get("$INSUNITS", 0) or 0))
    except VorotoolError:
        raise
    except _faults() as error:
        raise _damaged(source.name, error) from None
    if blocks.left_out:
        counts = ", ".join(f"{count} {kind}" for kind, count in sorted(blocks.left_out.items()))
        options.note(f"{source.name}: only lines and curves in the plane are read; skipped: {counts}")
    if blocks.hidden:
        options.note(
            f"{source.name}: {counted(blocks.hidden, 'entity', 'entities')} on layers that are off or frozen skipped"
        )
    return _polygons(source.name, blocks, options, unit)


def _polygons(name: str, blocks: _Blocks, options: ReadOptions, unit: str | None) -> PolygonSet:
    beyond = next((k for k, curves in blocks.curves.items() if not all(map(Curve.is_finite, curves))), None)
    if beyond is not None:
        raise InputError(f"{name}, layer {beyond}: a coordinate is too large for a double; correct or remove it")
    everything = [curve for curves in blocks.curves.values() for curve in curves]
    near = options.join_tolerance
    near = default_tolerance(everything, unit) if near is None else near
    shapes: list[Shape] = []
    layers: list[str] = []
    gaps: list[tuple[Gap, str]] = []
    still_open: list[Curve] = []
    for layer, curves in blocks.curves.items():
        chains = joined(curves, near)
        gaps += [(gap, layer) for gap in open_gaps(chains, near)]
        closed = [chain for chain in chains if chain.is_closed]
        parts = [Shape(closed, NESTED, None, name)] if closed else []
        parts += [Shape([chain], None, None, name) for chain in chains if not chain.is_closed]
        still_open += [chain for chain in chains if not chain.is_closed]
        shapes += parts
        layers += [layer] * len(parts)
    if len(blocks.curves) > 1:
        apart = sum(chain.is_closed for chain in joined(still_open, near))
        if apart:
            stays = (
                "1 outline whose lines are on several layers stays"
                if apart == 1
                else (f"{apart} outlines whose lines are on several layers stay")
            )
            options.note(Message(f"{name}: {stays} open: only lines of one layer are joined"))
    if gaps:
        options.note(Message(f"{name}: {_words_of_gaps(gaps, near, unit)}"))
    return shapes_to_polygons(name, shapes, options, unit=unit, y_axis=UP, properties={"layer": layers})


def _words_of_gaps(gaps: list[tuple[Gap, str]], near: float, unit: str | None) -> str:
    """Say how many there are, and where the widest is."""
    (width, (x, y)), layer = max(gaps)
    stay = "1 gap between ends of lines stays" if len(gaps) == 1 else f"{len(gaps)} gaps between ends of lines stay"
    of = "" if unit is None else f" {unit}"
    return (
        f"{stay} open, wider than the {near:.3g}{of} that {option('--join-tolerance')} allows: the widest is "
        f"{width:.3g}{of}, at ({x:.9g}, {y:.9g}) on layer {layer[:40]}"
    )


# ---- the file --------------------------------------------------------------------------------------
def _loaded(source: Source) -> Any:
    """Parse text or binary data."""
    ezdxf = ezdxf_module()
    tagger, filemanagement = ezdxf_module("ezdxf.lldxf.tagger"), ezdxf_module("ezdxf.filemanagement")
    document = ezdxf_module("ezdxf.document").Drawing
    try:
        if source.data.startswith(BINARY_DXF):
            return document.load(tagger.binary_tags_loader(source.data))
        head = filemanagement.dxf_stream_info(io.StringIO(source.data.decode("utf-8", "ignore")))
        return ezdxf.read(io.StringIO(source.data.decode(head.encoding, "surrogateescape"), newline=None))
    except _faults() as error:
        raise _damaged(source.name, error) from None


def ezdxf_module(module: str = "ezdxf") -> Any:
    """Import ezdxf, or a module of it."""
    if "ezdxf" in sys.modules:
        return needed(module, "cad", "DXF drawings")
    logger = logging.getLogger("ezdxf")
    if not logger.handlers:  # without one, what it ignores in damaged drawings goes to standard error
        logger.addHandler(logging.NullHandler())
    own = ConfigParser.read
    try:
        ConfigParser.read = lambda *_, **__: []  # type: ignore[method-assign]
        return needed(module, "cad", "DXF drawings")
    finally:
        ConfigParser.read = own  # type: ignore[method-assign]


def _faults() -> tuple[type[Exception], ...]:
    """What the library raises of damaged files: its own errors, and those of what it does not look for."""
    own = ezdxf_module("ezdxf.lldxf.const").DXFError
    careless = (ArithmeticError, AssertionError, AttributeError, EOFError, LookupError, RuntimeError, StopIteration)
    return (own, *careless, TypeError, ValueError, struct.error)


def _damaged(name: str, error: Exception) -> InputError:
    said = " ".join(str(error).split())[:80] or type(error).__name__
    return InputError(f"{name} is not a readable DXF file ({said}); save the drawing again, as DXF 2000 or later")


# ---- blocks ----------------------------------------------------------------------------------------
class _Seen(NamedTuple):
    """What is inserted with a block."""

    entities: int
    levels: int


@dataclass
class _Blocks:
    """The blocks of a drawing, and the curves that are found in them; None stands for the drawing itself."""

    name: str
    drawing: Any
    curves: dict[str, list[Curve]] = field(default_factory=dict)
    left_out: Counter[str] = field(default_factory=Counter)
    hidden: int = 0
    _seen: dict[str | None, _Seen | None] = field(default_factory=dict)
    _shown: dict[str, bool] = field(default_factory=dict)
    _inserted: dict[Any, list[Curve]] = field(default_factory=dict)
    _repeated: int = 0

    def entities(self, block: str | None) -> Any:
        """What is in a block."""
        if block is None:
            return self.drawing.modelspace()
        found = self.drawing.blocks.get(block)
        if found is None:
            raise InputError(f"{self.name}: the inserted block {block[:40]!r} does not exist; save the drawing again")
        return found

    def count(self, block: str | None, level: int) -> _Seen:
        """Count what is inserted with a block, before anything is made of it."""
        key = None if block is None else block.lower()
        known = self._seen.get(key, _Seen(0, 0))
        if known is None:
            raise InputError(f"{self.name}: the block {block!r} is inserted in itself; remove that insertion")
        if key not in self._seen:
            if level > MOST_LEVELS:
                raise self._too_deep()
            self._seen[key] = None
            entities, levels = 0, 0
            for entity in self.entities(block):
                if entity.dxftype() == "INSERT":
                    inner = self.count(str(entity.dxf.name), level + 1)
                    entities += max(int(entity.mcount), 1) * (1 + inner.entities)
                    levels = max(levels, inner.levels)
                else:
                    entities += 1
            known = self._seen[key] = _Seen(entities, levels + 1)
        most = max(MOST_ENTITIES, len(self.drawing.entitydb))
        if known.entities > most:
            raise self._too_many(most, "entities")
        if level + known.levels > MOST_LEVELS:
            raise self._too_deep()
        return known

    def _too_many(self, most: int, noun: str) -> LimitError:
        return LimitError(
            f"{self.name}: more than {most} {noun} are drawn, as blocks are inserted many times; split the drawing"
        )

    def _too_deep(self) -> InputError:
        return InputError(f"{self.name}: blocks are nested more than {MOST_LEVELS} deep; explode some of them")

    def walk(self, block: str | None, by: Affine, layer: str | None, flatten: float | None) -> None:
        """Collect the curves of a block, by their layers; what is on layer 0 is on that of the insertion."""
        for entity in self.entities(block):
            kind = entity.dxftype()
            own = str(entity.dxf.get("layer", "0"))
            if not self._is_shown(own) or entity.dxf.get("invisible", 0):
                self.hidden += 1
                continue
            own = layer if layer is not None and own == "0" else own
            if kind == "INSERT" and is_flat(entity):
                for single in entity.multi_insert() if entity.mcount > 1 else (entity,):
                    self.walk(str(single.dxf.name), by.after(_map_of(single)), own, flatten)
            elif kind not in ENTITIES or not is_flat(entity) or (kind == "POLYLINE" and not _is_polyline(entity)):
                self.left_out[kind] += 1
            else:
                found = self.curves.setdefault(own, [])
                curves = [curve for curve in self._curves(entity, block, flatten) if curve.has_extent()]
                found += curves if block is None else [curve.mapped(by) for curve in curves]

    def _curves(self, entity: Any, block: str | None, flatten: float | None) -> list[Curve]:
        """Give the curves of an entity; those in blocks are made once, and counted before they are repeated."""
        if block is None:
            return curves_of(entity, flatten)
        known = self._inserted.get(entity)
        if known is None:
            known = self._inserted[entity] = curves_of(entity, flatten)
            return known
        self._repeated += sum(len(curve.pieces) for curve in known)
        if self._repeated > MOST_ENTITIES:
            raise self._too_many(MOST_ENTITIES, "pieces of curves")
        return known

    def _is_shown(self, layer: str) -> bool:
        if layer not in self._shown:
            has = layer in self.drawing.layers
            found = self.drawing.layers.get(layer) if has else None
            self._shown[layer] = found is None or not (found.is_off() or found.is_frozen())
        return self._shown[layer]


def _is_polyline(entity: Any) -> bool:
    """Whether it is no mesh."""
    return bool(entity.is_2d_polyline or entity.is_3d_polyline)


def _map_of(insert: Any) -> Affine:
    """Give the map of an insertion, seen from above."""
    matrix = insert.matrix44()
    (a, b, *_), (c, d, *_), _, (e, f, *_) = (tuple(matrix.get_row(row)) for row in range(4))
    made = Affine(float(a), float(b), float(c), float(d), float(e), float(f))
    if not all(map(isfinite, made)):
        raise ValueError("an inserted coordinate is too large for a double")
    return made


# ---- entities ------------------------------------------------------------------------------------
_SAME = 1e-12
"""Of ways of the unit circle: apart by no more than the digits of files."""

_SPLINE_FRAME = 16
"""Flag of vertices that only control a curve through the others."""


def curves_of(entity: Any, flatten: float | None) -> list[Curve]:
    """Give the curves of an entity in its own coordinates, seen from above."""
    kind = entity.dxftype()
    made = ENTITIES[kind](entity, flatten)
    mirror = Affine(a=-1.0)  # the arbitrary axes of what is seen from below
    if kind in _IN_OWN_PLANE and entity.dxf.extrusion.z < 0:
        return [curve.mapped(mirror) for curve in made]
    return made


def is_flat(entity: Any) -> bool:
    """Whether an entity lies in a plane that is seen from above or from below."""
    if not entity.dxf.hasattr("extrusion"):
        return True
    x, y, z = entity.dxf.extrusion
    return not x and not y and bool(z)


def _xy(vector: Any) -> Point:
    return (float(vector.x), float(vector.y))


def _line(entity: Any, _: float | None) -> list[Curve]:
    return [Curve(_xy(entity.dxf.start), [Line(_xy(entity.dxf.end))])]


def _circle(entity: Any, _: float | None) -> list[Curve]:
    radius = abs(float(entity.dxf.radius))
    return [whole_ellipse(_xy(entity.dxf.center), (radius, 0.0), (0.0, radius))] if radius > 0 else []


def _arc(entity: Any, _: float | None) -> list[Curve]:
    radius = abs(float(entity.dxf.radius))
    ways = [turned(float(angle)) for angle in (entity.dxf.start_angle, entity.dxf.end_angle)]
    return _elliptic(_xy(entity.dxf.center), (radius, 0.0), (0.0, radius), ways)


def _ellipse(entity: Any, _: float | None) -> list[Curve]:
    major, ratio = entity.dxf.major_axis, float(entity.dxf.ratio)
    turn = -1.0 if entity.dxf.extrusion.z < 0 else 1.0  # its axis is given in the coordinates of the drawing
    first, second = (float(major.x), float(major.y)), (-turn * ratio * float(major.y), turn * ratio * float(major.x))
    turns = [float(entity.dxf.start_param) % (2 * PI), float(entity.dxf.end_param) % (2 * PI)]
    ways = [(float(c), float(s)) for c, s in zip(*cosine_and_sine(turns), strict=True)]
    return _elliptic(_xy(entity.dxf.center), first, second, ways)


def _elliptic(center: Point, first: Point, second: Point, ways: Sequence[Point]) -> list[Curve]:
    """An arc between two ways of the unit circle, counter-clockwise; equal ones mean all of it."""
    if first == (0.0, 0.0):
        return []
    (ax, ay), (bx, by) = ways
    if abs(ax - bx) + abs(ay - by) < _SAME:
        return [whole_ellipse(center, first, second)]
    start, end = ((center[0] + c * first[0] + s * second[0], center[1] + c * first[1] + s * second[1]) for c, s in ways)
    return [Curve(start, [arc_between(center, first, second, (ways[0], ways[1]), end)])]


def _lwpolyline(entity: Any, _: float | None) -> list[Curve]:
    vertices = [(float(x), float(y), float(bulge)) for x, y, bulge in entity.get_points("xyb")]
    return _polyline_of(vertices, bool(entity.closed))


def _polyline(entity: Any, _: float | None) -> list[Curve]:
    shown = [vertex for vertex in entity.vertices if not vertex.dxf.flags & _SPLINE_FRAME]
    vertices = [(*_xy(vertex.dxf.location), float(vertex.dxf.get("bulge", 0.0))) for vertex in shown]
    return _polyline_of(vertices, bool(entity.is_closed))


def _polyline_of(vertices: Sequence[tuple[float, float, float]], is_closed: bool) -> list[Curve]:
    places = [(x, y) for x, y, _ in vertices]
    if not places:
        return []
    following = [*places[1:], *places[: 1 if is_closed else 0]]
    pieces: list[Piece] = [
        bulged(place, after, bulge) for place, after, (_, _, bulge) in zip(places, following, vertices, strict=False)
    ]
    return [Curve(places[0], pieces, is_closed and len(places) > 1)]


def _spline(entity: Any, flatten: float | None) -> list[Curve]:
    """Bézier curves of what is no quotient; others are divided."""
    tool = entity.construction_tool()
    is_closed = bool(entity.closed)
    knots, order = tool.knots(), tool.order
    if not tool.is_rational and len(set(knots[:order])) == len(set(knots[-order:])) == 1:
        parts = [[_xy(point) for point in control] for control in tool.bezier_decomposition()]
        if not parts:
            return []
        return [Curve(parts[0][0], [Bezier(tuple(part[1:])) for part in parts], is_closed)]
    control = [_xy(point) for point in tool.control_points]
    extent = extent_of([Curve(control[0], [Line(point) for point in control[1:]])])
    tolerance = flatten or CURVE_PART / 4 * extent
    inner = sorted(set(knots[order - 1 : len(knots) - order + 1]))
    places = [_xy(tool.point(inner[0]))]
    for begin, end in itertools.pairwise(inner):
        places += _along(tool, begin, end, tolerance)
    return [Curve(places[0], [Line(place) for place in places[1:]], is_closed)]


def _along(tool: Any, begin: float, end: float, tolerance: float) -> list[Point]:
    """Places between two knots, and at the second: twice as many until those between are near the chords."""
    count = 4
    while True:
        places = [_xy(point) for point in tool.points([begin + (end - begin) * k / count for k in range(count + 1)])]
        x, y = np.array(places).T
        apart = hypotenuse((x[:-2:2] + x[2::2]) / 2 - x[1:-1:2], (y[:-2:2] + y[2::2]) / 2 - y[1:-1:2])
        if count >= MOST_PIECES or float(apart.max()) <= 2 * tolerance:  # chords half as long are off by a quarter
            return places[1:]
        count *= 2


def _solid(entity: Any, _: float | None) -> list[Curve]:
    """Triangles and quadrangles, whose last two corners are exchanged."""
    corners = [_xy(corner) for corner in (entity.dxf.vtx0, entity.dxf.vtx1, entity.dxf.vtx3, entity.dxf.vtx2)]
    return [Curve(corners[0], [Line(corner) for corner in corners[1:]], is_closed=True)]


ENTITIES: dict[str, Callable[[Any, float | None], list[Curve]]] = {
    "LINE": _line,
    "CIRCLE": _circle,
    "ARC": _arc,
    "ELLIPSE": _ellipse,
    "LWPOLYLINE": _lwpolyline,
    "POLYLINE": _polyline,
    "SPLINE": _spline,
    "SOLID": _solid,
    "TRACE": _solid,
}
"""What makes the curves of each type of entity that is read."""
_IN_OWN_PLANE = frozenset({"CIRCLE", "ARC", "LWPOLYLINE", "POLYLINE", "SOLID", "TRACE"})
