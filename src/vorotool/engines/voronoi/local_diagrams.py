"""The Voronoi diagrams of several regions, each of its own sites alone, on one lattice."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.arrangement.planar_graph import Placement, arranged
from vorotool.engines.segment_voronoi.segment_voronoi import segment_voronoi_of_groups
from vorotool.engines.voronoi.borders import Borders, borders_of
from vorotool.engines.voronoi.diagram import diagram_of
from vorotool.engines.voronoi.elements import OwnedGraph, owners_of
from vorotool.engines.voronoi.regions import Regions
from vorotool.numeric.parallel import Progress
from vorotool.numeric.ragged import ranges, starts_of
from vorotool.plain import plain
from vorotool.types.polygons.planar_graph import PlanarGraph
from vorotool.types.polygons.polygon_set import PolygonSet

Indices = NDArray[np.int64]
Sites = NDArray[np.int32]


@plain(eq=False)
class LocalDiagrams:
    """What belongs to whom in each of several regions, and the borders there."""

    # the graphs of all regions, one after the other, as if they were one: what two of them share is there twice
    owned: OwnedGraph
    point_region: Indices  # int64 array: of points and segments
    segment_region: Indices  # int64 array: of points and segments
    borders: Borders  # in the whole plane, of each region by itself
    polygons: PolygonSet  # of all sites, on the lattice
    site: Sites  # (p,) int32 array: of these

    @property
    def region(self) -> Indices:
        """(b,) the region of each piece of borders."""
        both = np.concatenate([self.point_region, self.segment_region])
        return both[self.borders.elements[:, 0]]


def local_diagrams(
    sites: PlanarGraph,
    site: Sites,
    count: int,
    regions: Regions,
    *,
    limit: float | None = None,
    pieces_of: Callable[..., Borders] = borders_of,
    threads: int = 0,
    progress: Progress = None,
) -> LocalDiagrams:
    """Make the diagram of each region."""
    given = sites.polygons
    assert given is not None
    level = np.inf if limit is None else limit / sites.scale
    if regions.count == 1 and len(regions.site) == count:
        owned = owners_of(sites, site)
        diagram = diagram_of(owned, is_whole=limit is not None, threads=threads, progress=progress)
        none = np.zeros(len(owned.graph.points), dtype=np.int64), np.zeros(len(owned.graph), dtype=np.int64)
        return LocalDiagrams(owned, *none, pieces_of(owned, diagram, level=level, threads=threads), given, site)
    parts = [*_graphs_of_regions(sites, site, count, regions)]
    points, segments = (
        np.repeat(np.arange(len(parts)), sizes)
        for sizes in ([len(part.graph.points) for part in parts], [len(part.graph) for part in parts])
    )
    owned = _joined(parts, sites)
    diagram = segment_voronoi_of_groups(
        owned.graph.points, owned.graph.segments, np.concatenate([points, segments]), threads=1, progress=progress
    )
    return LocalDiagrams(owned, points, segments, pieces_of(owned, diagram, level=level, threads=threads), given, site)


def _graphs_of_regions(sites: PlanarGraph, site: Sites, count: int, regions: Regions) -> Iterator[OwnedGraph]:
    given = sites.polygons
    assert given is not None
    assert sites.vertices is not None
    order = np.argsort(site, kind="stable")
    start = np.searchsorted(site[order], np.arange(count + 1))
    above, below = sites.scale.as_integer_ratio()  # a power of two
    for region in range(regions.count):
        own = regions.sites_of(region)
        polygon = np.sort(order[ranges(start[own], np.diff(start)[own])])
        part, vertices = _chosen(given, polygon, sites.vertices)
        placement = Placement(vertices, sites.origin, above.bit_length() - below.bit_length(), 0.0)
        yield owners_of(arranged(part, placement).graph, site[polygon])


def _chosen(given: PolygonSet, polygon: Indices, vertices: NDArray[np.int32]) -> tuple[PolygonSet, NDArray[np.int32]]:
    """Some polygons, and where their vertices are."""
    rings = np.diff(given.polygon_starts)[polygon]
    ring = ranges(given.polygon_starts[polygon], rings)
    sizes = np.diff(given.ring_starts)[ring]
    taken = ranges(given.ring_starts[ring], sizes)
    number = np.repeat(np.arange(len(polygon), dtype=np.int32), rings)
    return PolygonSet(given.xy[taken], starts_of(sizes), given.ring_kind[ring], number), vertices[taken]


def _joined(parts: list[OwnedGraph], sites: PlanarGraph) -> OwnedGraph:
    """Graphs one after the other, with the numbers of points and faces shifted."""
    graphs = [part.graph for part in parts]
    points = np.cumsum([0, *(len(graph.points) for graph in graphs)])
    faces = np.cumsum([0, *(graph.faces for graph in graphs)])
    count = int(points[-1])
    segments = np.concatenate(
        [np.empty((0, 2), dtype=np.int32), *(g.segments + at for g, at in zip(graphs, points, strict=False))]
    )
    sides = np.concatenate(
        [np.empty((0, 2), dtype=np.int32), *(g.segment_faces + at for g, at in zip(graphs, faces, strict=False))]
    )
    elements = [np.split(part.element, [len(part.graph.points)]) for part in parts]
    none = np.empty(0, dtype=np.int32)
    graph = PlanarGraph(
        np.concatenate([np.empty((0, 2), dtype=np.int32), *(g.points for g in graphs)]),
        segments,
        np.full(count, -1, dtype=np.int32),
        np.zeros(len(segments) + 1, dtype=np.int32),
        none,
        sides,
        np.zeros(max(int(faces[-1]), 1) + 1, dtype=np.int32),  # the unbounded one at least
        none,
        origin=sites.origin,
        scale=sites.scale,
    )
    element = np.concatenate([none, *(own for own, _ in elements), *(own for _, own in elements)])
    face = np.concatenate([part.face for part in parts]) if parts else np.full(1, -1, dtype=np.int32)
    return OwnedGraph(graph, element, face)
