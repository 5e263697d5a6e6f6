"""Lines along skeletons as polylines that are much nearer than the tolerance: what curves are fitted to."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.arrays import Floats, Indices, owners, starts_of, within
from vorotool.numeric.curves.flatten import chained, polylines
from vorotool.plain import plain
from vorotool.types.skeleton.extended_lines import LedOn
from vorotool.types.skeleton.skeleton import Skeleton

NEARNESS = 16
"""How many times nearer the polylines are than the tolerance."""

LEAST_PIECES = 8
"""Of each line with more than one, so that there are places enough to fit by."""


@plain(eq=False)
class LineSamples:
    """Places along lines, line by line, from the start to the end of each."""

    xy: Floats  # (2, n) float64 array: their coordinates. Neighbors differ; a line without a length has one place
    start: Indices  # (l + 1,) integer array: the first place of each line, and `n`
    along: Floats  # (n,) float64 array: lengths along the polylines, all lines after one another
    # (n,) float64 array: how far the line may be from the straight piece that begins at each place; 0 at the ends of
    # lines
    off: Floats
    # (l,) bool array: whether each line ends where it starts, and goes on there without a junction
    is_closed: NDArray[np.bool_]


def sampled_lines(lines: Skeleton | LedOn, tolerance: float) -> LineSamples:
    """Branches of a skeleton, or centerlines, as polylines with what leads on."""
    path = lines if isinstance(lines, Skeleton) else lines.path
    first = np.flatnonzero(np.diff(path.branch, prepend=-1))
    source, target = path.vertices[path.arcs[:, 0]], path.vertices[path.arcs[:, 1]]
    points, start = polylines(source, path.control, target, path.is_parabola, tolerance / NEARNESS)
    off = np.repeat(np.where(path.is_parabola, tolerance / NEARNESS, 0.0), np.diff(start))
    off[start[1:] - 1] = 0.0
    kept = np.ones(len(points), dtype=bool)
    kept[start[:-1]] = False
    kept[start[first]] = True
    # the last place of an arc gives way to the first one of the next, from which its pieces begin
    joints = np.setdiff1d(np.arange(len(path)), first, assume_unique=True)
    off[start[joints] - 1] = off[start[joints]]
    points, start = chained(points, start, first)
    off = off[kept]
    if isinstance(lines, LedOn):
        points, off, start = _led_on(lines, points, off, start)
    ends = path.arcs[first, 0], path.arcs[np.append(first[1:], len(path))[: len(first)] - 1, 1]
    return _parted(points, off, start, (ends[0] == ends[1]) & (path.degree[ends[0]] == 2))


def _led_on(lines: LedOn, points: Floats, off: Floats, start: Indices) -> tuple[Floats, Floats, Indices]:
    """With the straight pieces at both ends of lines."""
    first, last = lines.extended
    line = np.concatenate([first, owners(np.diff(start)), last])
    order = np.argsort(line, kind="stable")
    off = np.concatenate([np.zeros(len(first)), off, np.zeros(len(last))])
    points = np.concatenate([lines.ends[first, 0], points, lines.ends[last, 1]])
    return points[order], off[order], np.searchsorted(line[order], np.arange(len(lines) + 1))


def _parted(points: Floats, off: Floats, start: Indices, is_closed: NDArray[np.bool_]) -> LineSamples:
    """Without places that are repeated, and with long pieces parted evenly."""
    line = owners(np.diff(start))
    kept = np.ones(len(line), dtype=bool)
    kept[:-1] = (points[1:] != points[:-1]).any(axis=1) | (line[1:] != line[:-1])
    points, off, line = points[kept], off[kept], line[kept]
    start = np.searchsorted(line, np.arange(len(is_closed) + 1))
    way = np.diff(points, axis=0, append=points[-1:])
    size = np.sqrt((way * way).sum(axis=1))
    size[start[1:] - 1] = 0.0
    whole = np.add.reduceat(size, start[:-1]) if len(is_closed) else size
    most = np.repeat(np.where(np.diff(start) > 2, whole / LEAST_PIECES, whole), np.diff(start))
    pieces = np.maximum(np.ceil(np.divide(size, most, out=np.ones_like(size), where=most > 0) - 2.0**-20), 1)
    pieces = pieces.astype(np.int64)
    share = (within(pieces) / np.repeat(pieces, pieces))[:, None]
    made = np.repeat(points, pieces, axis=0) + share * np.repeat(way, pieces, axis=0)
    size = np.repeat(size / pieces, pieces)
    x, y = made.T
    return LineSamples(
        np.stack([x, y]),
        starts_of(pieces)[start],
        np.concatenate([[0.0], np.cumsum(size[:-1])])[: len(size)],
        np.repeat(off, pieces),
        is_closed,
    )
