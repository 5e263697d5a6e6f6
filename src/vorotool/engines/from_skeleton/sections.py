"""Places at equal steps along centerlines, and the sections of the polygon across them."""

from __future__ import annotations

import numpy as np
import shapely
from numpy.typing import NDArray

from vorotool.engines.from_skeleton.cross_sections import section_ends
from vorotool.numeric.curves.inverse_functions import hypotenuse
from vorotool.numeric.ragged import owners, within
from vorotool.plain import plain
from vorotool.types.polygons.conversion import to_shapely
from vorotool.types.skeleton.led_on import LedOn
from vorotool.types.skeleton.points_along import SkeletonPoints

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]

_TOUCH = 8
"""Ulp of the largest coordinate: discs that are smaller are on the outline, but for rounding."""


def sections_along(lines: LedOn, counts: Indices, every: float) -> SkeletonPoints:
    """Give places at 0, 1, 2, … steps from where each line begins, and the ends of the section across it there."""
    pieces = _pieces(lines)
    line: Indices = owners(counts)
    along: Floats = np.asarray(every * within(counts), dtype=np.float64)
    piece, reached = _found(pieces, line, along)
    xy, way = _places(lines, pieces, piece, reached)
    radius, given = _radii(lines, pieces, piece, reached, xy, line), lines.as_given
    for at, is_end in enumerate((along == 0, along >= lines.length[line])):
        led_on, nodes = given.ends[line, at][is_end], lines.end_nodes[line, at][is_end]
        is_led_on = ~np.isnan(led_on[:, :1])
        xy[is_end] = np.where(is_led_on, led_on, given.path.vertices[nodes])
        radius[is_end] = np.where(is_led_on[:, 0], 0, lines.path.radius[nodes])
    polygons = given.path.polygons
    inside = (radius > _TOUCH * np.spacing(np.abs(polygons.xy).max(initial=0.0))) & way.any(axis=1)
    feet, rings = np.repeat(xy[:, None], 2, axis=1), np.full((len(xy), 2), -1, dtype=np.int32)
    own = None if lines.path.features == "together" else lines.polygon[line][inside]
    feet[inside], rings[inside] = section_ends(polygons, own, xy[inside], way[inside], radius[inside])
    arc = pieces.nearest_arc[piece]
    return SkeletonPoints(lines.path, arc, along, xy, radius, feet, rings)


@plain(eq=False)
class _Pieces:
    """Arcs of lines and the straight lines that lead on, line by line."""

    arc: Indices  # (p,) int64 array: -1 for what leads on; the first or the last arc of its line
    nearest_arc: Indices  # (p,) int64 array: -1 for what leads on; the first or the last arc of its line
    ends: Floats  # (p, 2, 2) float64 array: where each begins and ends
    length: Floats  # (p,) float64 array: and how far from the beginning of its line it begins
    begin: Floats  # (p,) float64 array: and how far from the beginning of its line it begins
    line: Indices  # (p,) int64 array: not decreasing


def _pieces(lines: LedOn) -> _Pieces:
    path, (first, last) = lines.path, lines.extended
    arcs = np.arange(len(path))
    start = lines.arc_starts
    nodes = path.vertices[lines.end_nodes]
    of_first = np.stack([lines.ends[first, 0], nodes[first, 0]], axis=1)
    of_last = np.stack([nodes[last, 1], lines.ends[last, 1]], axis=1)
    line = np.concatenate([first, owners(np.diff(start)), last])
    order = np.argsort(line, kind="stable")
    line = line[order]
    arc = np.concatenate([np.full(len(first), -1), arcs, np.full(len(last), -1)])[order]
    nearest = np.concatenate([start[:-1][first], arcs, start[1:][last] - 1])[order]
    ends = np.concatenate([of_first, path.vertices[path.arcs], of_last])[order]
    extension = lines.extension_length
    length = np.concatenate([extension[first, 0], path.length, extension[last, 1]])[order]
    whole = np.concatenate([[0.0], np.cumsum(length)])
    begin = whole[:-1] - whole[np.searchsorted(line, line)]
    return _Pieces(arc, nearest, ends, length, begin, line)


def _found(pieces: _Pieces, line: Indices, along: Floats) -> tuple[Indices, Floats]:
    """The piece that each place is on, the last that begins there or before, and how far along it."""
    count = len(pieces.line)
    keys = np.concatenate([pieces.begin, along]), np.concatenate([pieces.line, line])
    order = np.lexsort(keys)  # stable: pieces come before the places where they begin
    piece = np.empty(len(order), dtype=np.int64)
    piece[order] = np.maximum.accumulate(np.where(order < count, order, -1))
    found = piece[count:]
    return found, np.minimum(along - pieces.begin[found], pieces.length[found])


def _places(lines: LedOn, pieces: _Pieces, piece: Indices, reached: Floats) -> tuple[Floats, Floats]:
    """Places, and the directions of their lines; where two pieces meet half-way between theirs."""
    arc = pieces.arc[piece]
    length = pieces.length[piece]
    u = np.divide(reached, length, out=np.zeros(len(piece)), where=length > 0)
    a, b = pieces.ends[piece].swapaxes(0, 1)
    xy = a + u[:, None] * (b - a)
    on_arc = np.flatnonzero(arc >= 0)
    measures = lines.path.measures(arc[on_arc])
    u[on_arc] = measures.parameter(reached[on_arc])
    xy[on_arc] = measures.place(u[on_arc])
    way = _directions(lines, pieces, piece, u)
    before = piece - 1
    meets = np.flatnonzero((reached == 0) & (pieces.line[np.maximum(before, 0)] == pieces.line[piece]) & (before >= 0))
    both = way[meets] + _directions(lines, pieces, before[meets], np.ones(len(meets)))
    way[meets] = np.where((both == 0).all(axis=1)[:, None], way[meets], both)  # a way that turns back has no middle
    return xy, way


def _directions(lines: LedOn, pieces: _Pieces, piece: Indices, u: Floats) -> Floats:
    """Unit vectors along pieces; where a curve has none, along its chord."""
    a, b = pieces.ends[piece].swapaxes(0, 1)
    arc = pieces.arc[piece]
    control = np.where(arc[:, None] >= 0, lines.path.control[arc], np.nan)
    v = u[:, None]
    bent = (1 - v) * (control - a) + v * (b - control)
    way = np.where(np.isnan(control) | ~bent.any(axis=1)[:, None], b - a, bent)
    length = hypotenuse(*way.T)[:, None]
    unit: Floats = np.divide(way, length, out=np.zeros_like(way), where=length > 0)
    return unit


def _radii(lines: LedOn, pieces: _Pieces, piece: Indices, reached: Floats, xy: Floats, line: Indices) -> Floats:
    """Clearances: of the arcs, and on what leads on the distances from the outline."""
    arc, polygons = pieces.arc[piece], lines.path.polygons
    radius = np.empty(len(arc))
    on_arc, off = np.flatnonzero(arc >= 0), np.flatnonzero(arc < 0)
    measures = lines.path.measures(arc[on_arc])
    radius[on_arc] = measures.radius(measures.parameter(reached[on_arc]))
    outlines, own = shapely.boundary(to_shapely(polygons)), lines.polygon[line[off]]
    if lines.path.features == "together":
        outlines, own = np.array([shapely.GeometryCollection(list(outlines))]), np.zeros_like(own)
    radius[off] = shapely.distance(shapely.points(xy[off]), outlines[own])
    return radius
