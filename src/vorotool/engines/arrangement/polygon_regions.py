"""Connected regions of polygons in a planar graph: over segments that do not bound the polygon."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.ragged import owners, ranges
from vorotool.types.polygons.planar_graph import PlanarGraph
from vorotool.types.skeleton.tables import connected_roots

Indices = NDArray[np.int64]


class PolygonRegions:
    """The region of each pair of a face and a polygon that it lies in, as a number."""

    def __init__(self, graph: PlanarGraph) -> None:
        polygon = graph.face_polygon.astype(np.int64)
        self._width = int(polygon.max(initial=0)) + 1
        face = owners(np.diff(graph.face_starts))
        self._keys = face * self._width + polygon  # ascending: polygons of a face are
        left, right = graph.segment_faces.astype(np.int64).T
        beside = np.flatnonzero(graph.is_inside[left] & graph.is_inside[right])
        counts = np.diff(graph.face_starts)[left[beside]]
        entry = ranges(graph.face_starts[left[beside]], counts)
        wanted = np.repeat(right[beside], counts) * self._width + polygon[entry]
        rank = np.minimum(np.searchsorted(self._keys, wanted), max(len(self._keys) - 1, 0))
        same = self._keys[rank] == wanted if len(self._keys) else np.zeros(0, dtype=bool)
        self._root = connected_roots(np.stack([entry[same], rank[same]], axis=1), len(self._keys))
        self.of_first = self._root[graph.face_starts[:-1][graph.is_inside]]
        """Of each face inside, in the first of its polygons."""

    def __len__(self) -> int:
        """Give one more than the largest number."""
        return len(self._keys)

    def of(self, face: NDArray[np.integer], polygon: NDArray[np.integer]) -> Indices:
        """Regions of faces in polygons that these lie in."""
        found: Indices = self._root[np.searchsorted(self._keys, face.astype(np.int64) * self._width + polygon)]
        return found
