"""A frame of square cells over a part of a map, and coordinates mirrored from y down to y up."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from math import ceil, floor
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError, LimitError, UsageError, option
from vorotool.numeric.arrays import within
from vorotool.types.fields import DOWN, UP, YAxis
from vorotool.types.pixels import FARTHEST, Frame, PixelGrid, map_grid
from vorotool.types.points.seed_set import SeedSet
from vorotool.types.polygons.polygon_set import LINE, PolygonSet

MapWindow = tuple[Fraction, Fraction, Fraction, Fraction]

MOST_UNASKED = 2**28
"""Cells that a frame may have which follows from the bounds alone."""


def map_frame(
    low: NDArray[np.float64],
    high: NDArray[np.float64],
    side: Fraction,
    *,
    window: MapWindow | None,
    y_axis: YAxis = UP,
    crs: Any = None,
) -> tuple[Frame, PixelGrid]:
    """Lay cells over what lies between two corners, or over a window; rows go southwards, or down as y does."""
    if window is not None:
        left, bottom = window[:2]
        columns, rows = window[2] / side, window[3] / side
        if columns.denominator != 1 or rows.denominator != 1:
            nearest = ",".join(f"{float(max(1, round(number)) * side):.17g}" for number in (columns, rows))
            raise UsageError(
                f"{option('--window')} is {float(window[2]):.17g} x {float(window[3]):.17g}, not a whole number of "
                f"cells of {float(side):.17g}: the nearest W,H is {nearest}"
            )
        width, height = int(columns), int(rows)
    else:
        first = [floor(Fraction(float(value)) / side) for value in low]
        last = [ceil(Fraction(float(value)) / side) for value in high]
        if max(map(abs, [*first, *last])) > FARTHEST:
            raise InputError(
                f"coordinates are more than 2^44 cells of {float(side):.17g} from 0: use a larger "
                f"{option('--cell-size', 'side')}"
            )
        width, height = (max(1, b - a) for a, b in zip(first, last, strict=True))
        left, bottom = first[0] * side, first[1] * side
        if width * height > MOST_UNASKED:
            raise LimitError(
                f"the input needs {width} x {height} cells of {float(side):.17g}, more than {MOST_UNASKED}: use a "
                f"larger {option('--cell-size', 'side')}, or choose a part with "
                f"{option('--window X,Y,W,H', 'window=(x, y, w, h)')}"
            )
    top = bottom + height * side
    step = float(side)
    down = (step, float(bottom)) if y_axis == DOWN else (-step, float(top))
    return Frame(0, 0, width, height), map_grid((step, 0.0, float(left), 0.0, *down), crs=crs)


def in_cells(xy: NDArray[np.float64], grid: PixelGrid) -> NDArray[np.float64]:
    """Coordinates in cells: (0, 0) is the center of the first one, y goes down."""
    assert grid.transform is not None
    a, _, c, _, e, f = grid.transform
    return (xy - (c, f)) / (a, e) - 0.5


def mirrored_polygons(polygons: PolygonSet) -> PolygonSet:
    """Mirror polygons; closed rings begin at the same vertex, and run the other way, so that areas keep their signs."""
    sizes = np.diff(polygons.ring_starts)
    place = within(sizes)
    size, first = np.repeat(sizes, sizes), np.repeat(polygons.ring_starts[:-1], sizes)
    is_line = np.repeat(polygons.ring_kind == LINE, sizes)
    taken = first + np.where(is_line, place, (size - place) % np.maximum(size, 1))
    frame = None if polygons.frame is None else polygons.frame.stretched(1.0, -1.0)
    return replace(polygons, xy=polygons.xy[taken] * (1.0, -1.0) + 0.0, y_axis=UP, frame=frame)


def mirrored_seeds(seeds: SeedSet) -> SeedSet:
    """Mirror seeds and the frame that they bring."""
    frame, sites = seeds.frame, seeds.sites
    if frame is not None:
        frame = replace(frame, y=-(frame.y + frame.height - 1))
    return replace(
        seeds,
        y=-seeds.y,
        frame=frame,
        sites=None if sites is None else sites * (1.0, -1.0) + 0.0,
    )
