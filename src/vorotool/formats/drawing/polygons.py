"""Polygons and lines of the curves of drawings."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import inf
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError
from vorotool.formats.drawing.curves import Curve
from vorotool.formats.drawing.fill_rules import filled_polygons, nested_polygons
from vorotool.formats.parsing.reader_options import ReadOptions
from vorotool.numeric.length_units import ratio
from vorotool.types.axis import DOWN, YAxis
from vorotool.types.box import Box
from vorotool.types.polygons.polygon_set import HOLE, LINE, SHELL, PolygonSet, set_of_rings
from vorotool.types.values import counted

NESTED = "nested"
"""A rule beside those of SVG: closed curves are shells, holes, and shells in these by how they lie in one another, each
shell a feature of its own; where they cross each is a shell."""


class Shape(NamedTuple):
    """One feature of a drawing."""

    curves: Sequence[Curve]  # what it is drawn with
    # what of the plane they fill, open ones as if they were closed; None where each is by itself: closed ones are
    # polygons, others lines
    rule: str | None
    id: Any  # its name in the drawing, if it has one
    place: str  # words for its place
    is_stroked: bool = True  # whether lines are drawn along what fills nothing, as one or two places do not


def shapes_to_polygons(
    name: str,
    shapes: Sequence[Shape],
    options: ReadOptions,
    *,
    unit: str | None = None,
    page: Box | None = None,
    y_axis: YAxis = DOWN,
    properties: dict[str, list[Any]] | None = None,
) -> PolygonSet:
    """Flatten the curves of shapes, one feature a shape."""
    beyond = next((shape for shape in shapes if not all(curve.is_finite() for curve in shape.curves)), None)
    if beyond is not None:
        raise InputError(f"{beyond.place}: a coordinate is too large for a double; correct or remove it")
    collected = _Rings(name, options, _finest(unit))
    for index, shape in enumerate(shapes):
        collected.add(index, shape)
    owner = collected.owner
    ids = [shapes[k].id for k in owner]
    named = options.properties and any(value is not None for value in ids)
    columns = properties if properties and options.properties else {}
    made = set_of_rings(
        np.concatenate([np.empty((0, 2)), *collected.rings]),
        [len(ring) for ring in collected.rings],
        collected.kinds,
        collected.polygons,
        feature=collected.feature,
        ids=ids if named else None,
        properties={key: [values[k] for k in owner] for key, values in columns.items()},
        y_axis=y_axis,
        unit=unit,
        page=page,
        is_drawing=True,
    )
    if collected.outlines:
        options.note(f"{name}: {counted(collected.outlines, 'closed line')} without a fill read as polygons")
    if collected.without_area:
        options.note(f"{name}: {counted(collected.without_area, 'filled shape')} without area skipped")
    return made


def _finest(unit: str | None) -> float:
    """Return 0.01 mm in a unit; infinity where it is not known."""
    length = None if unit is None else ratio(unit, "mm")
    return inf if length is None else float(Fraction(1, 100) / length)


class _Rings:
    """Rings of all shapes."""

    def __init__(self, name: str, options: ReadOptions, most: float) -> None:
        self.name, self.options, self.most = name, options, most
        self.rings: list[NDArray[np.float64]] = []
        self.kinds: list[int] = []
        self.polygons: list[int] = []
        self.feature: list[int] = []  # of each polygon
        self.owner: list[int] = []  # its shape
        self.outlines = self.without_area = self.vertices = self._next = 0

    def add(self, index: int, shape: Shape) -> None:
        """Flatten a shape."""
        flat = []
        for curve in shape.curves:
            flat.append(curve.flattened(self.options.flatten, self.most))
            self.vertices += len(flat[-1])
            self.options.check_vertices(self.name, self.vertices)
        self._begin()
        if shape.rule == NESTED:
            for polygon in nested_polygons([_open_end(ring) for ring in flat]):
                self._polygon(index, polygon)
                self._begin()
            return
        if shape.rule is not None:
            rings = [_open_end(ring) for ring in flat]
            areas = [ring for ring in rings if len(ring) > 2]
            filled = filled_polygons(areas, shape.rule) if areas else []
            self.without_area += bool(areas) and not filled
            for polygon in filled:
                self._polygon(index, polygon)
            for ring in (ring for ring in rings if len(ring) == 2 and shape.is_stroked):
                self._take(index, ring, LINE)
            return
        for curve, points in zip(shape.curves, flat, strict=True):
            ring = _open_end(points)
            if (curve.is_closed or len(ring) < len(points)) and len(ring) > 2:
                self.outlines += 1
                self._polygon(index, [ring])
            else:
                self._take(index, points, LINE)

    def _begin(self) -> None:
        """Begin a feature, once the one before has anything."""
        self._next = self.feature[-1] + 1 if self.feature else 0

    def _polygon(self, index: int, rings: Sequence[NDArray[np.float64]]) -> None:
        for k, ring in enumerate(rings):
            self._take(index, ring, HOLE if k else SHELL)

    def _take(self, index: int, ring: NDArray[np.float64], kind: int) -> None:
        if kind != HOLE:
            self.feature.append(self._next)
            self.owner.append(index)
        self.rings.append(ring)
        self.kinds.append(kind)
        self.polygons.append(len(self.feature) - 1)


def _open_end(ring: NDArray[np.float64]) -> NDArray[np.float64]:
    """Without the start at the end."""
    return ring[:-1] if len(ring) > 1 and (ring[0] == ring[-1]).all() else ring
