"""Seeds on the edges of shapes, as they are sampled for approximate skeletons."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.arrays import owners
from vorotool.plain import plain
from vorotool.types.identity import names_of, part_table, place_columns
from vorotool.types.polygons.planar_graph import PlanarGraph
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.skeleton.skeleton import SiteTable
from vorotool.types.table import Lookup, Table


@plain(eq=False)
class BoundarySamples:
    """Seeds: the points of a planar graph, then those inside each of its segments, along it."""

    # (s, 2) float64 array: lattice coordinates: multiples of 2^-22, within 2^-21 of their segments
    seeds: NDArray[np.float64]
    segment: NDArray[np.int32]  # (s,) int32 array: the segment that each is inside of; -1 of points
    start: NDArray[np.int32]  # (m + 1,) int32 array: the first seed inside each segment
    graph: PlanarGraph
    sites: SiteTable  # what its points, and then its segments, are in `polygons`
    polygons: PolygonSet  # the shapes as they are used

    def __len__(self) -> int:
        return len(self.seeds)

    @property
    def xy(self) -> NDArray[np.float64]:
        """(s, 2) in input units, rounded once more."""
        return self.graph.coordinates(self.seeds)

    @property
    def site(self) -> NDArray[np.int32]:
        """(s,) row of `sites` of each seed: a vertex, or the edge that it is inside of."""
        points = len(self.graph.points)
        own = np.arange(len(self), dtype=np.int32)
        return np.where(self.segment < 0, own, self.segment + np.int32(points))

    @property
    def labels(self) -> NDArray[np.int32]:
        """(s, 2) the first two labels of each seed, numbers of segments from 1; 0 for none."""
        points, segments = len(self.graph.points), self.graph.segments
        labels = np.zeros((len(self), 2), dtype=np.int32)
        labels[points:, 0] = self.segment[points:] + 1
        end = segments.reshape(-1)
        label = np.repeat(np.arange(1, len(segments) + 1, dtype=np.int32), 2)
        order = np.argsort(end, kind="stable")
        end, label = end[order], label[order]
        nth = np.arange(len(end)) - np.searchsorted(end, end)
        labels[end[nth < 2], nth[nth < 2]] = label[nth < 2]
        return labels

    def gaps(self) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
        """Lengths of the pieces between seeds that follow each other, in input units, and the segment of each."""
        points, segments = len(self.graph.points), self.graph.segments
        count = np.diff(self.start)
        last = np.cumsum(count + 1) - 1  # of each segment, among the pieces
        before = np.insert(self.seeds[points:], self.start[:-1] - points, self.seeds[segments[:, 0]], axis=0)
        after = np.empty_like(before)
        inner = np.ones(len(after), dtype=bool)
        inner[last] = False
        after[inner], after[last] = self.seeds[points:], self.seeds[segments[:, 1]]
        way = after - before
        lengths = self.graph.scale * np.sqrt((way * way).sum(axis=1))
        return lengths, owners(count + 1, dtype=np.int32)


def sample_table(samples: BoundarySamples) -> Table:
    """Return one row a seed."""
    site, labels, xy = samples.site, samples.labels, samples.xy
    sites = samples.sites
    return part_table(
        {
            "element": np.arange(len(samples)),
            "kind": Lookup(["vertex", "sample"], (samples.segment >= 0).astype(np.int32)),
            **names_of(samples.polygons, sites.polygon[site]),
            "ring": sites.ring[site],
            "vertex_index": sites.index[site],
            **place_columns(xy),
            "label_a": np.ma.array(labels[:, 0], mask=labels[:, 0] == 0),
            "label_b": np.ma.array(labels[:, 1], mask=labels[:, 1] == 0),
        },
        samples.polygons,
        sites.polygon[site],
    )
