"""Polygons and lines as labels of pixels, decided exactly."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from math import ceil, floor
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError, option
from vorotool.numeric.arrays import Floats, Indices, owners, ranges, within
from vorotool.types.pixels import FARTHEST, Frame
from vorotool.types.polygons.polygon_set import LINE, PolygonSet

_PIXELS = 2**22
"""Rows of edges, or pixels, that are listed at a time."""

_ERROR = 2.0**-49
"""Of a crossing, relative to the coordinates that it is computed of: five roundings of at most 2^-53 each, on values
of at most three times these, with as much to spare."""

_SHORT = 2
"""Vertices of a ring that has no inside: a point, or a segment."""


class _Edges(NamedTuple):
    """Segments, from the end with the smaller y to the other, and the polygon of each."""

    x0: Floats
    y0: Floats
    x1: Floats
    y1: Floats
    polygon: Indices

    def taken(self, chosen: NDArray[np.generic]) -> _Edges:
        return _Edges(*(part[chosen] for part in self))


def rasterized(polygons: PolygonSet, frame: Frame) -> NDArray[np.uint32]:
    """Label each pixel with the first feature that has it, counted from 1; 0 where none has."""
    if len(polygons.xy) and np.abs(polygons.xy).max() > FARTHEST:
        raise InputError(
            f"vertices are more than 2^44 pixels from the frame: use {option('a larger --cell-size', 'larger pixels')}"
        )
    labels = np.zeros(frame.shape, np.uint32)
    flat, label = labels.reshape(-1), np.asarray(polygons.feature, np.int64) + 1
    edges = _edges(polygons, frame)
    is_line = _is_line(polygons)
    for chosen in _parts(edges, frame):
        part = edges.taken(chosen)
        drawn = is_line[part.polygon]
        spans = [_passed(part.taken(drawn), frame), _inside(part.taken(~drawn), frame)]
        polygon, row, first, last = (np.concatenate(columns) for columns in zip(*spans, strict=True))
        order = np.argsort(-label[polygon], kind="stable")  # of two values for one pixel the later one stays
        polygon, row, first, last = (column[order] for column in (polygon, row, first, last))
        count = np.maximum(last - first, 0)
        full = np.flatnonzero(np.diff(np.cumsum(count) // _PIXELS)) + 1
        for piece in np.split(np.arange(len(count)), full):
            pixels = ranges(row[piece] * frame.width + first[piece], count[piece])
            flat[pixels] = np.repeat(label[polygon[piece]], count[piece])
    return labels


def _edges(polygons: PolygonSet, frame: Frame) -> _Edges:
    """All segments, in the frame's own coordinates; rings close, lines do not, and points are segments of no length."""
    sizes = np.diff(polygons.ring_starts)
    ring = owners(sizes)
    is_last = within(sizes) == sizes[ring] - 1
    is_open = ((polygons.ring_kind == LINE) | (sizes <= _SHORT))[ring] & (sizes[ring] > 1)
    start = np.flatnonzero(~(is_last & is_open))
    ends = polygons.xy - (frame.x, frame.y)
    a, b = ends[start], ends[polygons.following[start]]
    swapped = a[:, 1] > b[:, 1]
    a, b = np.where(swapped[:, None], b, a), np.where(swapped[:, None], a, b)
    return _Edges(a[:, 0], a[:, 1], b[:, 0], b[:, 1], polygons.ring_polygon[ring[start]].astype(np.int64))


def _is_line(polygons: PolygonSet) -> NDArray[np.bool_]:
    """(p,) whether each polygon is drawn as a line."""
    first = polygons.polygon_starts[:-1]
    short: NDArray[np.bool_] = np.diff(polygons.ring_starts)[first] <= _SHORT
    return polygons.is_line | short


def _parts(edges: _Edges, frame: Frame) -> Iterator[Indices]:
    """Edges of whole polygons, the last polygons first, of about so many rows together."""
    if not len(edges.polygon):
        return
    rows = np.clip(edges.y1, -1, frame.height) - np.clip(edges.y0, -1, frame.height) + 2
    of_polygon = np.bincount(edges.polygon, rows)
    group = (np.cumsum(of_polygon) // _PIXELS).astype(np.int64)[edges.polygon]
    for number in np.unique(group)[::-1]:
        yield np.flatnonzero(group == number)


def _inside(edges: _Edges, frame: Frame) -> tuple[Indices, Indices, Indices, Indices]:
    """Spans of pixels whose centers are inside: polygon, row, first column, and the one after the last."""
    first = np.clip(np.ceil(edges.y0), 0, frame.height).astype(np.int64)
    count = np.clip(np.ceil(edges.y1), 0, frame.height).astype(np.int64) - first
    each = edges.taken(owners(count))
    row = ranges(first, count)
    column = np.clip(_crossing(each, row.astype(np.float64), up=True), 0, frame.width)
    order = np.lexsort((column, row, each.polygon))
    polygon, row, column = each.polygon[order], row[order], column[order]
    return polygon[::2], row[::2], column[::2], column[1::2]


def _passed(edges: _Edges, frame: Frame) -> tuple[Indices, Indices, Indices, Indices]:
    """Spans of pixels that segments pass through; a pixel has its left and its upper side."""
    first = np.clip(np.floor(edges.y0 + 0.5), 0, frame.height).astype(np.int64)
    last = np.clip(np.floor(edges.y1 + 0.5), -1, frame.height - 1).astype(np.int64)
    count = np.maximum(last - first + 1, 0)
    each, row = edges.taken(owners(count)), ranges(first, count)
    middle = row.astype(np.float64)
    upper, lower = np.asarray(middle - 0.5), np.asarray(middle + 0.5)
    begins, leaves = each.y0 >= upper, each.y1 >= lower
    at_first = np.where(begins, np.floor(each.x0 + 0.5), _crossing(each, upper, shift=0.5))
    at_last = np.where(leaves, _crossing(each, lower, shift=0.5), np.floor(each.x1 + 0.5))
    # the lower side is the next row's: what comes to a corner there from the left does not reach its column
    rises = leaves & (each.x1 > each.x0)
    at_last = np.where(rises, np.maximum(_crossing(each, lower, shift=0.5, up=True) - 1, at_first), at_last)
    left, right = np.minimum(at_first, at_last), np.maximum(at_first, at_last)
    left, right = (np.clip(side, 0, frame.width).astype(np.int64) for side in (left, right + 1))
    return each.polygon, row, left, right


def _crossing(edges: _Edges, y: Floats, *, shift: float = 0.0, up: bool = False) -> Indices:
    """Round where lines through edges cross levels, moved to the right: down, or up to the next integer; exactly."""
    x0, y0, x1, y1, _ = edges
    rise = y1 - y0
    safe = np.where(rise > 0, rise, 1.0)
    x = x0 + (y - y0) * ((x1 - x0) / safe)
    error = _ERROR * (np.abs(x0) + np.abs(x1) + np.abs(x - x0) + np.abs(y0 * ((x1 - x0) / safe)) + 1)
    moved = x + shift
    found = np.ceil(moved) if up else np.floor(moved)
    unsure = (np.abs(moved - np.rint(moved)) <= error) & (x0 != x1) & (rise > 0)
    for k in np.flatnonzero(unsure):
        ends = (Fraction(float(part[k])) for part in (x0, y0, x1, y1))
        a, b, c, d = ends
        exact = a + (Fraction(float(y[k])) - b) * (c - a) / (d - b) + Fraction(shift)
        found[k] = ceil(exact) if up else floor(exact)
    return np.clip(found, -(2.0**40), 2.0**40).astype(np.int64)
