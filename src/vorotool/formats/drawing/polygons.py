"""Polygons and lines of the curves of drawings, which are joined where their ends meet."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import inf, isfinite
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.errors import InputError
from vorotool.formats.drawing.curves import Arc, Bezier, Curve, Line, Piece, Point, extent_of
from vorotool.formats.parsing.reader_options import ReadOptions
from vorotool.formats.polygons.poly import chains_of
from vorotool.numeric.length_units import ratio
from vorotool.types.box import Box
from vorotool.types.fields import DOWN, YAxis
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
    if options.curves_advice:
        options.note_curves(name, collected.curves)
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
        self.curves = self.outlines = self.without_area = self.vertices = self._next = 0

    def add(self, index: int, shape: Shape) -> None:
        """Flatten a shape."""
        flat = []
        for curve in shape.curves:
            flat.append(curve.flattened(self.options.flatten, self.most))
            self.curves += sum(not isinstance(piece, Line) for piece in curve.pieces)
            self.vertices += len(flat[-1])
            self.options.check_vertices(self.name, self.vertices)
        self._begin()
        if shape.rule == NESTED:
            from vorotool.formats.drawing.fill_rules import nested_polygons

            for polygon in nested_polygons([_open_end(ring) for ring in flat]):
                self._polygon(index, polygon)
                self._begin()
            return
        if shape.rule is not None:
            from vorotool.formats.drawing.fill_rules import filled_polygons

            rings = [_open_end(ring) for ring in flat]
            areas = [ring for ring in rings if len(ring) > 2]
            filled = filled_polygons(areas, shape.rule) if areas else []
            self.without_area += bool(areas) and not filled
            for polygon in filled:
                self._polygon(index, polygon)
            for ring in (ring for ring in rings if len(ring) == 2 and shape.is_stroked):
                self._take(index, ring, LINE)
            return
        outlines = []
        for curve, points in zip(shape.curves, flat, strict=True):
            ring = _open_end(points)
            if (curve.is_closed or len(ring) < len(points)) and len(ring) > 2:
                outlines.append(ring)
            else:
                self._take(index, points, LINE)
        self.outlines += len(outlines)
        if outlines:
            from vorotool.formats.drawing.fill_rules import nested_polygons

            for polygon in nested_polygons(outlines):
                self._polygon(index, polygon)

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


# ---- joining -------------------------------------------------------------------------------------
JOINED = Fraction(5, 1000)
"""In mm: how far ends may be apart that are joined, if nothing else is asked for, as files round numbers."""

JOINED_PART = 1e-5
"""The same as a part of the extent, where the unit is not known."""

_NEAR = 10
"""Times as wide a gap is told of."""


class Gap(NamedTuple):
    """Between two ends that stay open."""

    width: float
    place: Point
    """Of one of them."""


def default_tolerance(curves: Sequence[Curve], unit: str | None) -> float:
    """Give how far ends of curves may be apart that are joined, by the unit of their coordinates."""
    length = None if unit is None else ratio(unit, "mm")
    return JOINED_PART * extent_of(curves) if length is None else float(JOINED / length)


def open_gaps(chains: Sequence[Curve], tolerance: float) -> list[Gap]:
    """Give the gaps between ends of open curves that are wider than a tolerance, by up to ten times, widest last."""
    import shapely

    ends = np.array([end for chain in chains if not chain.is_closed for end in (chain.start, chain.end)])
    if len(ends) < 2 or not tolerance > 0 or not isfinite(_NEAR * tolerance):
        return []
    places = ends[np.unique(_places(ends, tolerance), return_index=True)[1]]
    points = shapely.points(places)
    pairs, widths = shapely.STRtree(points).query_nearest(
        points, max_distance=_NEAR * tolerance, return_distance=True, exclusive=True, all_matches=False
    )
    found = {(min(a, b), max(a, b)): width for (a, b), width in zip(pairs.T.tolist(), widths.tolist(), strict=True)}
    gaps = [Gap(width, (float(places[a, 0]), float(places[a, 1]))) for (a, _), width in found.items()]
    return sorted(gap for gap in gaps if tolerance < gap.width)


def joined(curves: Sequence[Curve], tolerance: float) -> list[Curve]:
    """Join open curves at places where exactly two ends meet; closed ones stay."""
    is_open = [not curve.is_closed and bool(curve.pieces) for curve in curves]
    ends = np.array(
        [end for curve, each in zip(curves, is_open, strict=True) if each for end in (curve.start, curve.end)]
    )
    numbers = iter(_places(ends.reshape(-1, 2), tolerance))
    places = [(next(numbers), next(numbers)) if each else None for each in is_open]
    chains = {index: (path, is_closed) for index, path, is_closed in chains_of(places)}
    made: list[Curve] = []
    for index, pair in enumerate(places):
        if pair is None:
            made.append(curves[index])
        elif index in chains:
            path, is_closed = chains[index]
            made.append(_chain([curves[k] if way else _reversed(curves[k]) for k, way in path], is_closed))
    return made


def _places(ends: NDArray[np.float64], tolerance: float) -> list[int]:
    """Numbers of places: ends that are near each other have the same, and so have those near these."""
    import shapely

    unique, number = np.unique(ends, axis=0, return_inverse=True)
    pairs = np.empty((0, 2), dtype=np.int32)
    if tolerance > 0 and len(unique):
        points = shapely.points(unique)
        found = shapely.STRtree(points).query(points, predicate="dwithin", distance=tolerance)
        pairs = np.ascontiguousarray(found.T, dtype=np.int32)
    return _core.graphs.connected_components(pairs, len(unique))[number.reshape(-1)].tolist()


def _chain(curves: Sequence[Curve], is_closed: bool) -> Curve:
    """Put curves one after the other: each begins where the one before ends."""
    pieces = [piece for curve in curves for piece in curve.pieces]
    start = curves[0].start
    if is_closed and pieces[-1].end != start:
        last = pieces[-1]
        pieces[-1] = Bezier((*last.control[:-1], start)) if isinstance(last, Bezier) else last._replace(end=start)
    return Curve(start, pieces, is_closed)


def _reversed(curve: Curve) -> Curve:
    """Give the same curve, from its end to its start."""
    pieces: list[Piece] = []
    starts = [curve.start, *(piece.end for piece in curve.pieces[:-1])]
    for start, piece in zip(reversed(starts), reversed(curve.pieces), strict=True):
        if isinstance(piece, Line):
            pieces.append(Line(start))
        elif isinstance(piece, Bezier):
            pieces.append(Bezier((*reversed(piece.control[:-1]), start)))
        else:
            mirrored = tuple((x, -y) for x, y in reversed(piece.ways))
            pieces.append(Arc(piece.center, piece.first, (-piece.second[0], -piece.second[1]), mirrored, start))
    return Curve(curve.end, pieces, curve.is_closed)
