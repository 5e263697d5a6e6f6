"""The rings of polygons as bare arrays: chosen, put one after the other, and in another order."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.geometry.polygons.polygon_set import PolygonSet
from vorotool.geometry.ragged import owners, ranges, starts_of
from vorotool.geometry.row_index import index_of_rows

Indices = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class RingArrays:
    """Rings of polygons, in any order.

    Parameters
    ----------
    xy : (n, 2) array
        Vertices, ring after ring.
    sizes : (r,) int64 array
        Vertices of each ring.
    kind : (r,) int8 array
        See `PolygonSet`.
    rings : (p,) int64 array
        Rings of each polygon.
    """

    xy: NDArray[Any]
    sizes: Indices
    kind: NDArray[np.int8]
    rings: Indices

    @classmethod
    def of(cls, polygons: PolygonSet) -> RingArrays:
        """Give those of a set."""
        return cls(polygons.xy, np.diff(polygons.ring_start), polygons.ring_kind, np.diff(polygons.polygon_start))

    @classmethod
    def joined(cls, parts: Sequence[RingArrays]) -> RingArrays:
        """Put those of several sets one after the other."""
        columns: list[Any] = [
            np.concatenate([getattr(part, name) for part in parts]) for name in ("xy", "sizes", "kind", "rings")
        ]
        return cls(*columns)

    def taken(self, chosen: NDArray[Any]) -> tuple[RingArrays, Indices, Indices]:
        """Choose polygons; gives the numbers of their rings and vertices, too.

        Examples
        --------
        >>> square, point = np.zeros((4, 2)), np.ones((1, 2))
        >>> both = RingArrays(np.concatenate([square, point]), np.array([4, 1]), np.zeros(2, np.int8), np.array([1, 1]))
        >>> [array.tolist() for array in both.taken(np.array([1]))[1:]]
        [[1], [4]]
        """
        rings = ranges(starts_of(self.rings)[chosen], self.rings[chosen])
        vertices = ranges(starts_of(self.sizes)[rings], self.sizes[rings])
        made = RingArrays(self.xy[vertices], self.sizes[rings], self.kind[rings], self.rings[chosen])
        return made, rings, vertices

    def polygons(self, given: PolygonSet, source: NDArray[Any]) -> PolygonSet:
        """Make a set of polygons that are described as those of another set: ids, features, properties and index.

        Parameters
        ----------
        given : PolygonSet
            The other set.
        source : (p,) array
            The polygon there of each polygon here, not decreasing.
        """
        assert given.feature is not None
        own = source.tolist()
        return replace(
            given,
            xy=self.xy,
            ring_start=starts_of(self.sizes),
            ring_kind=self.kind,
            ring_polygon=owners(self.rings),
            ids=None if given.ids is None else [given.ids[k] for k in own],
            feature=given.feature[source],
            properties={name: [values[k] for k in own] for name, values in given.properties.items()},
            index=index_of_rows(given.index, source),
        )
