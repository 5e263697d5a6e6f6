"""Polygons and lines of DXF drawings."""

from __future__ import annotations

import io
import struct
from collections import Counter
from dataclasses import dataclass, field
from math import isfinite
from typing import Any, NamedTuple

from vorotool.errors import InputError, LimitError, Message, VorotoolError, option
from vorotool.formats.drawing.curves import Affine, Curve
from vorotool.formats.drawing.dxf_drawing import UNITS
from vorotool.formats.drawing.dxf_entities import ENTITIES, curves_of, is_flat
from vorotool.formats.drawing.ezdxf_library import ezdxf_module
from vorotool.formats.drawing.joining import Gap, default_tolerance, joined, open_gaps
from vorotool.formats.drawing.polygons import NESTED, Shape, shapes_to_polygons
from vorotool.formats.drawing.recognition import BINARY_DXF
from vorotool.formats.io.sources import Source
from vorotool.formats.parsing.reader_options import ReadOptions
from vorotool.types.axis import UP
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.values import counted

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
    for layer, curves in blocks.curves.items():
        chains = joined(curves, near)
        gaps += [(gap, layer) for gap in open_gaps(chains, near)]
        closed = [chain for chain in chains if chain.is_closed]
        parts = [Shape(closed, NESTED, None, name)] if closed else []
        parts += [Shape([chain], None, None, name) for chain in chains if not chain.is_closed]
        shapes += parts
        layers += [layer] * len(parts)
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
