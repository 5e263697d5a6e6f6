"""Edges that a gap at both ends leaves nothing of."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError
from vorotool.numeric.curves.inverse_functions import hypotenuse
from vorotool.plain import plain
from vorotool.types.polygons.planar_graph import PlanarGraph
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.skeleton.skeleton import SiteTable
from vorotool.types.values import counted


@plain(eq=False)
class ShortEdges:
    """Segments that are not longer than twice a gap."""

    site: NDArray[np.int64]  # (k,) int array: their numbers among the sites
    ends: NDArray[np.float64]  # (k, 2, 2) float64 array: where they begin and end
    length: NDArray[np.float64]  # (k,) float64 array: how long they are

    @classmethod
    def of(cls, graph: PlanarGraph, gap: float) -> ShortEdges:
        """Find those of a graph."""
        ends = graph.coordinates()[graph.segments]
        length = hypotenuse(*(ends[:, 1] - ends[:, 0]).T)
        short = np.flatnonzero(~(length > 2 * gap))
        return cls(len(graph.points) + short, ends[short], length[short])

    def __len__(self) -> int:
        return len(self.site)

    def refuse(self, polygons: PolygonSet, sites: SiteTable, gap: float) -> None:
        """Raise InputError if there are any, naming the first along the input."""
        if not len(self):
            return
        first = int(self.site.argmin())
        site = self.site[first]
        ring = int(polygons.polygon_starts[sites.polygon[site]] + sites.ring[site])
        (ax, ay), (bx, by) = self.ends[first].tolist()
        raise InputError(
            f"{polygons.ring_place(ring)}, edge {int(sites.index[site]) + 1} from ({ax!r}, {ay!r}) to ({bx!r}, {by!r}) "
            f"is {self.length[first]:.6g} long, and a gap of {gap:g} at both ends leaves nothing of it "
            f"({counted(len(self), 'such edge')}): use a gap below {self.length.min() / 2:.6g}"
        )
