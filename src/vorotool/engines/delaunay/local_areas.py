"""Cutting many small shapes out of a large area: each is cut out of what the area is around it."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.ragged import owners, starts_of
from vorotool.plain import plain

Floats = NDArray[np.float64]

FEW_SHAPES, FEW_VERTICES = 4, 256
"""Where dividing further takes longer than cutting."""

MARGIN = 0.25
"""Of the larger side of the bounds of shapes: GEOS cuts at bounds that are wider by 0.1 of their smaller side."""


def cut_out(shapes: NDArray[Any], area: Any) -> NDArray[Any]:
    """Give the intersections of shapes with an area, as `shapely.intersection` gives them."""
    import shapely

    made = np.empty(len(shapes), dtype=object)
    center = shapely.bounds(shapes).reshape(-1, 2, 2).mean(axis=1)
    waiting = [(np.arange(len(shapes)), Rings.of(area))]
    while waiting:
        chosen, rings = waiting.pop()
        if not len(chosen):
            continue
        bounds = rings.with_crossing_edges(shapely.total_bounds(shapes[chosen]))
        margin = MARGIN * max(bounds[2] - bounds[0], bounds[3] - bounds[1])
        rings = rings.around(bounds + margin * np.array([-1, -1, 1, 1]))
        if len(chosen) <= FEW_SHAPES or len(rings.xy) <= FEW_VERTICES:
            made[chosen] = _cut_out_of(shapes[chosen], rings.area(), area)
            continue
        axis = int(np.argmax(np.ptp(center[chosen], axis=0)))
        chosen = chosen[np.argsort(center[chosen, axis], kind="stable")]
        middle = len(chosen) // 2
        waiting += [(chosen[:middle], rings), (chosen[middle:], rings)]
    return made


def _cut_out_of(shapes: NDArray[Any], near: Any, whole: Any) -> NDArray[Any]:
    """Cut out of what is near; where GEOS cannot, which what crosses itself far away may be the cause of, of all."""
    import shapely

    try:
        made = shapely.intersection(shapes, near)
    except shapely.errors.GEOSException:
        made = shapely.intersection(shapes, whole)
    return np.asarray(made)


@plain
class Rings:
    """The rings of an area."""

    xy: Floats  # (k, 2) float64 array: vertices, ring by ring, the first not repeated
    start: NDArray[np.int64]  # (r + 1,) int64 array: where rings begin
    part: NDArray[np.int64]  # (r,) int64 array: the polygon of each; its shell comes first

    @classmethod
    def of(cls, area: Any) -> Rings:
        """Those of a shapely polygon, of one part or several."""
        import shapely

        rings, part = shapely.get_rings(shapely.get_parts([area]), return_index=True)
        xy, ring = shapely.get_coordinates(rings, return_index=True)
        is_last = np.append(ring[1:] != ring[:-1], True)
        return cls(xy[~is_last], starts_of(np.bincount(ring, minlength=len(rings)) - 1), part.astype(np.int64))

    def bounds(self) -> Floats:
        """Least x and y, most x and y; of nothing they are the wrong way round."""
        x, y = np.ascontiguousarray(self.xy.T)
        least, most = {"initial": np.inf}, {"initial": -np.inf}
        return np.array([x.min(**least), y.min(**least), x.max(**most), y.max(**most)])

    def with_crossing_edges(self, bounds: Floats) -> Floats:
        """Bounds that hold the edges that reach into some bounds, too: GEOS looks at all that is in these."""
        after = np.arange(1, len(self.xy) + 1)
        after[self.start[1:] - 1] = self.start[:-1]
        ends = self.xy, self.xy[after]
        least, most = np.minimum(*ends), np.maximum(*ends)
        meets = ((most >= bounds[:2]) & (least <= bounds[2:])).all(axis=1)
        edges = Rings(np.concatenate([least[meets], most[meets]]), self.start, self.part).bounds()
        return np.concatenate([np.minimum(bounds[:2], edges[:2]), np.maximum(bounds[2:], edges[2:])])

    def around(self, bounds: Floats) -> Rings:
        """Rings that are the same inside some bounds, with fewer vertices outside, and the same bounds of their own."""
        side = np.zeros(len(self.xy), dtype=np.int8)
        for number, is_beyond in enumerate(
            (self.xy[:, 0] < bounds[0], self.xy[:, 0] > bounds[2], self.xy[:, 1] < bounds[1], self.xy[:, 1] > bounds[3])
        ):
            side[is_beyond & (side == 0)] = number + 1
        lengths = np.diff(self.start)
        first, last = np.repeat(self.start[:-1], lengths), np.repeat(self.start[1:] - 1, lengths)
        place = np.arange(len(side))
        before, after = np.where(place == first, last, place - 1), np.where(place == last, first, place + 1)
        kept = (side == 0) | (side != side[before]) | (side != side[after])
        farthest = np.concatenate([self.xy.argmin(axis=0), self.xy.argmax(axis=0)])
        kept[[farthest, before[farthest], after[farthest]]] = True
        ring = owners(lengths)
        # with a shell beyond one side its holes are gone, too
        is_ring = np.bincount(ring[kept], minlength=len(lengths)) > 0
        # at the top of a ring GEOS sees which way it goes around
        y = self.xy[:, 1]
        top = np.flatnonzero(y == np.maximum.reduceat(y, self.start[:-1])[ring])
        kept[np.concatenate([top, before[top], after[top]])] = True
        kept &= is_ring[ring]
        counts = np.bincount(ring[kept], minlength=len(lengths))
        return Rings(self.xy[kept], starts_of(counts[is_ring]), self.part[is_ring])

    def area(self) -> Any:
        """Make a polygon of them, which need not be valid outside the bounds that they are around."""
        import shapely

        lengths = np.diff(self.start)
        closed = np.insert(self.xy, self.start[1:], self.xy[self.start[:-1]], axis=0)
        rings = shapely.linearrings(closed, indices=owners(lengths + 1))
        _, part = np.unique(self.part, return_inverse=True)
        return shapely.multipolygons(shapely.polygons(rings, indices=part))
