"""Features divided into batches: those of one batch may share a diagram, and none changes what is inside another."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.numeric.progress import Progress
from vorotool.numeric.ragged import owners, ranges, starts_of
from vorotool.numeric.sorted_sets import distinct
from vorotool.plain import plain
from vorotool.types.polygons.polygon_set import PolygonSet

Indices = NDArray[np.int64]

BATCH = 1 << 13
"""Vertices of a batch or more: some megabytes of its diagram, which stay in the cache, and soon done by any thread."""
APART = 1
"""Lattice steps around each feature: what snap rounding may move is nearer than one to it."""


@plain(eq=False)
class Features:
    """The features of polygons, numbered without gaps."""

    polygon_starts: Indices  # (f + 1,) int64 array: the first polygon of each, and the number of polygons
    vertex_starts: Indices  # (f + 1,) int64 array: the first vertex of each, and the number of vertices

    @classmethod
    def of(cls, polygons: PolygonSet) -> Features:
        """Find them."""
        assert polygons.feature is not None
        first = np.flatnonzero(np.diff(polygons.feature, prepend=-1))
        start = np.append(first, len(polygons))
        return cls(start, polygons.ring_starts[polygons.polygon_starts[start]])

    def __len__(self) -> int:
        return len(self.polygon_starts) - 1

    @property
    def of_vertex(self) -> Indices:
        """(n,) the feature of each vertex."""
        return owners(np.diff(self.vertex_starts))

    def polygons_of(self, chosen: Indices) -> Indices:
        """Polygons of some features."""
        return ranges(self.polygon_starts[chosen], np.diff(self.polygon_starts)[chosen])


def sheets_of_boxes(
    features: Features,
    vertices: NDArray[np.int32],
    *,
    reach: NDArray[np.int64] | None = None,
    progress: Progress = None,
) -> NDArray[np.int32]:
    """(f,) sheets of features: on the lattice the bounds of those of one sheet have a gap between them."""
    if len(features) < 2:
        return np.zeros(len(features), dtype=np.int32)
    first = features.vertex_starts[:-1]
    low, high = (bound.reduceat(vertices, first, axis=0).astype(np.int64) for bound in (np.minimum, np.maximum))
    wide = (APART if reach is None else reach + APART) * np.ones((len(features), 1), dtype=np.int64)
    return _core.spatial.disjoint_sheets(np.hstack([low - wide, high + wide]), progress)


def sheets_of_cracks(
    features: Features, vertices: NDArray[np.int32], *, progress: Progress = None
) -> NDArray[np.int32]:
    """(f,) sheets of features that are outlines of pixels: those of one sheet have no vertex in common."""
    sheet = np.zeros(len(features), dtype=np.int32)
    pairs = touching_features(features, vertices, progress=progress)
    if len(pairs):
        touching, index = np.unique(pairs, return_inverse=True)
        a, b = np.ascontiguousarray(index.reshape(-1, 2).T.astype(np.uint32))
        sheet[touching] = _core.graphs.color_graph(len(touching), a, b, progress).astype(np.int32) - 1
    return sheet


def touching_features(features: Features, vertices: NDArray[np.int32], *, progress: Progress = None) -> Indices:
    """(k, 2) pairs of features that have a vertex in common, each once: the smaller number first."""
    first = _core.arrangement.first_at_place(vertices, progress)
    again = np.flatnonzero(first != np.arange(len(first)))
    if not again.size:
        return np.empty((0, 2), dtype=np.int64)
    owner = features.of_vertex
    count = len(features)
    at = distinct(np.concatenate([first[again] * count + owner[again], first[again] * count + owner[first[again]]]))
    place, own = at // count, at % count
    pairs = []
    for step in range(1, int(np.bincount(np.unique(place, return_inverse=True)[1]).max())):
        same = place[step:] == place[:-step]
        pairs.append(own[:-step][same] * count + own[step:][same])
    if not pairs:
        return np.empty((0, 2), dtype=np.int64)
    keys = distinct(np.concatenate(pairs))
    return np.stack([keys // count, keys % count], axis=1)


def batches_of(features: Features, sheet: NDArray[np.int32]) -> list[Indices]:
    """Features of each batch: of one sheet, ascending, and about `BATCH` vertices or more."""
    if not len(features):
        return []
    order = np.argsort(sheet, kind="stable")
    sizes = np.diff(features.vertex_starts)[order]
    begin = starts_of(sizes)[:-1]
    new_sheet = np.diff(sheet[order], prepend=-1) != 0
    of_sheet = begin - np.maximum.accumulate(np.where(new_sheet, begin, 0))
    cut = new_sheet | (np.diff(of_sheet // BATCH, prepend=0) > 0)
    return np.split(order, np.flatnonzero(cut)[1:])
