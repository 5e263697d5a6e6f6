"""The rings of polygons as bare arrays: chosen, put one after the other, and in another order."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.ragged import owners, ranges, starts_of
from vorotool.numeric.row_index import index_of_rows
from vorotool.plain import plain
from vorotool.types.polygons.polygon_set import PolygonSet

Indices = NDArray[np.int64]


@plain(eq=False)
class RingArrays:
    """Rings of polygons, in any order."""

    xy: NDArray[Any]  # (n, 2) array: vertices, ring after ring
    sizes: Indices  # (r,) int64 array: vertices of each ring
    kind: NDArray[np.int8]  # (r,) int8 array: see `PolygonSet`
    rings: Indices  # (p,) int64 array: rings of each polygon

    @classmethod
    def of(cls, polygons: PolygonSet) -> RingArrays:
        """Return those of a set."""
        return cls(polygons.xy, np.diff(polygons.ring_starts), polygons.ring_kind, np.diff(polygons.polygon_starts))

    @classmethod
    def joined(cls, parts: Sequence[RingArrays]) -> RingArrays:
        """Put those of several sets one after the other."""
        columns: list[Any] = [
            np.concatenate([getattr(part, name) for part in parts]) for name in ("xy", "sizes", "kind", "rings")
        ]
        return cls(*columns)

    def taken(self, chosen: NDArray[Any]) -> tuple[RingArrays, Indices, Indices]:
        """Choose polygons; gives the numbers of their rings and vertices, too."""
        rings = ranges(starts_of(self.rings)[chosen], self.rings[chosen])
        vertices = ranges(starts_of(self.sizes)[rings], self.sizes[rings])
        made = RingArrays(self.xy[vertices], self.sizes[rings], self.kind[rings], self.rings[chosen])
        return made, rings, vertices

    def polygons(self, given: PolygonSet, source: NDArray[Any]) -> PolygonSet:
        """Make a set of polygons that are described as those of another set: ids, features, properties and index."""
        assert given.feature is not None
        own = source.tolist()
        return replace(
            given,
            xy=self.xy,
            ring_starts=starts_of(self.sizes),
            ring_kind=self.kind,
            ring_polygon=owners(self.rings),
            ids=None if given.ids is None else [given.ids[k] for k in own],
            feature=given.feature[source],
            properties={name: [values[k] for k in own] for name, values in given.properties.items()},
            index=index_of_rows(given.index, source),
        )
