"""What lies in the pixels of an image with y upwards instead of downwards: y becomes -y, and nothing is rounded."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vorotool.numeric.ragged import within
from vorotool.types.axis import UP
from vorotool.types.points.seed_set import SeedSet
from vorotool.types.polygons.polygon_set import LINE, PolygonSet


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
