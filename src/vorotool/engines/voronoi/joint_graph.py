"""One planar graph of sites and of what cuts their cells: where they meet is decided in whole numbers."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.convert.polygons import as_polygons
from vorotool.engines.arrangement.planar_graph import MOST_VERTICES, Placement, arranged, placed_vertices
from vorotool.engines.arrangement.repaired_polygons import with_flat_shells_as_lines
from vorotool.engines.voronoi.elements import graph_of_sites
from vorotool.errors import InputError, LimitError
from vorotool.numeric.arrays import owners, ranges, starts_of
from vorotool.numeric.crs import crs_name, same_crs
from vorotool.numeric.parallel import Progress
from vorotool.plain import plain
from vorotool.types.box import Extent, Sides, bounds, check_magnitude, default_frame, extent_sides
from vorotool.types.polygons.planar_graph import PlanarGraph
from vorotool.types.polygons.polygon_set import LINE, SHELL, PolygonSet, set_of_rings
from vorotool.types.polygons.shapely_geometry import RingArrays


@plain(eq=False)
class JointGraph:
    """The planar graph of sites, a frame, clips and enclosures together."""

    graph: PlanarGraph  # of all
    polygons: PolygonSet  # those of the sites first, then the frame, the clips and the enclosures
    of_frame: range  # its polygon; none without a frame
    of_clip: range  # their polygons; none without a clip
    of_enclosures: range
    sites: PlanarGraph  # of the sites alone, on the same lattice, with a vertex wherever one of the others meets them

    @cached_property
    def source_polygon(self) -> NDArray[np.int32]:
        """(k,) the polygon of each edge that segments are part of."""
        ring = np.searchsorted(self.polygons.ring_starts, self.graph.source_edge, side="right") - 1
        return self.polygons.ring_polygon[ring]

    @property
    def clips(self) -> bool:
        """Whether a clip covers any face."""
        return bool(is_of(self.of_clip, self.graph.face_polygon).any())


def is_of(polygons: range, number: NDArray[np.int32]) -> NDArray[np.bool_]:
    """(k,) whether each is the number of one of some polygons."""
    return (number >= polygons.start) & (number < polygons.stop)


def joint_graph(
    polygons: PolygonSet,
    sides: Sides | None,
    clip: PolygonSet | None,
    enclosures: PolygonSet | None,
    *,
    threads: int = 0,
    progress: Progress = None,
) -> JointGraph:
    """Put sites, the sides of a frame and cuts on one lattice, and cut all where they meet."""
    given = with_flat_shells_as_lines(polygons)
    parts = [RingArrays.of(given)]
    parts.append(_no_rings() if sides is None else _box(sides))
    parts.append(_no_rings() if clip is None else RingArrays.of(clip).taken(np.flatnonzero(~clip.is_line))[0])
    parts.append(_no_rings() if enclosures is None else _as_closed_lines(enclosures))
    joined = RingArrays.joined(parts).bare()
    _, frame, first, second, _ = np.cumsum([0, *(len(part.rings) for part in parts)]).tolist()
    check_magnitude(joined.xy)
    if len(joined.xy) > MOST_VERTICES:
        raise LimitError(f"there are {len(joined.xy)} vertices, more than {MOST_VERTICES}: split the polygons")
    placement = placed_vertices(joined, threads=threads, progress=progress)
    graph = arranged(joined, placement, progress=progress).graph
    noded, vertices = _noded(given, graph)
    of_sites = Placement(vertices, placement.origin, placement.exponent, placement.largest_move)
    return JointGraph(
        graph,
        joined,
        range(frame, first),
        range(first, second),
        range(second, len(joined)),
        graph_of_sites(noded, of_sites, progress=progress),
    )


def _box(sides: Sides) -> RingArrays:
    left, bottom, right, top = sides
    corners = np.array([[left, bottom], [right, bottom], [right, top], [left, top]])
    return RingArrays(corners, np.array([4]), np.array([SHELL], dtype=np.int8), np.array([1]))


def _no_rings() -> RingArrays:
    none = np.empty(0, dtype=np.int64)
    return RingArrays(np.empty((0, 2)), none, none.astype(np.int8), none)


def _as_closed_lines(enclosures: PolygonSet) -> RingArrays:
    """Each ring of polygons and lines as a line of its own."""
    closes = (np.asarray(enclosures.ring_kind) != LINE).astype(np.int64)
    own = np.diff(enclosures.ring_starts)
    sizes = own + closes
    taken = ranges(enclosures.ring_starts[:-1], sizes)
    ends = np.cumsum(sizes) - 1
    taken[ends[closes > 0]] = enclosures.ring_starts[:-1][closes > 0]
    return RingArrays(enclosures.xy[taken], sizes, np.full(len(own), LINE, dtype=np.int8), np.ones(len(own), np.int64))


def _noded(given: PolygonSet, graph: PlanarGraph) -> tuple[PolygonSet, NDArray[np.int32]]:
    """Polygons with a vertex wherever a graph cuts their edges, and all vertices on its lattice."""
    assert graph.vertices is not None
    vertices, count = graph.vertices, len(given.xy)
    segment = owners(graph.source_count)
    of_sites = graph.source_edge < count
    edge = np.repeat(graph.source_edge[of_sites].astype(np.int64), 2)
    place = graph.points[graph.segments[segment[of_sites]].ravel()].astype(np.int64)
    a = vertices[:count].astype(np.int64)
    after = given.following
    along = a[after] - a
    inner = (place != a[edge]).any(axis=1) & (place != a[after[edge]]).any(axis=1)
    edge, place = edge[inner], place[inner]
    far = ((place - a[edge]) * along[edge]).sum(axis=1)
    edge, _, *xy = np.unique(np.column_stack([edge, far, place]), axis=0).T
    order = np.argsort(np.concatenate([np.arange(count), edge]), kind="stable")
    places = np.concatenate([a, np.stack(xy, axis=1)])[order].astype(np.int32)
    ring = np.searchsorted(given.ring_starts, edge, side="right") - 1
    sizes = np.diff(given.ring_starts) + np.bincount(ring, minlength=len(given.ring_kind))
    noded = PolygonSet(places.astype(np.float64), starts_of(sizes), given.ring_kind, given.ring_polygon)
    return noded, places


FARTHEST = 8.0
"""Margin of the frame at most, in extents of what is in it: the frame is on the lattice, whose step grows with it."""


@plain(eq=False)
class GivenCuts:
    """What cells are cut by, beside a frame."""

    clip: PolygonSet | None  # each in the coordinate reference system of the sites
    enclosures: PolygonSet | None  # each in the coordinate reference system of the sites

    @property
    def are_there(self) -> bool:
        """Whether there is one of them."""
        return self.clip is not None or self.enclosures is not None

    def frame_for(self, sites: PolygonSet, frame: Extent | None, limit: float | None) -> Extent | None:
        """Return the frame that was given, else that of an image; without a clip that around sites and enclosures."""
        if frame is None and sites.frame is not None:
            return sites.frame.extent
        if frame is not None or self.clip is not None:
            return frame
        if self.enclosures is None or not len(self.enclosures.xy):
            return default_frame(sites, limit)
        xy = np.concatenate([sites.xy, self.enclosures.xy])
        if limit is not None:
            low, high = bounds(xy)
            limit = min(limit, FARTHEST * float((high - low).max()))
        return default_frame(set_of_rings(xy, [len(xy)], [LINE], [0]), limit)

    def sides_near(self, frame: Extent | None) -> Sides | None:
        """Draw far sides of a frame near the clip, or leave out all: the step of the lattice grows with them."""
        if frame is None or self.clip is None or not len(self.clip.xy):
            return None if frame is None else extent_sides(frame)
        sides = np.array(extent_sides(frame)).reshape(2, 2)
        low, high = bounds(self.clip.xy)
        if (sides[0] <= low).all() and (high <= sides[1]).all():
            return None
        if (sides[0] < high).all() and (low < sides[1]).all():
            margin = (high - low).max()
            sides = np.array([np.maximum(sides[0], low - margin), np.minimum(sides[1], high + margin)])
        left, bottom, right, top = sides.ravel().tolist()
        return left, bottom, right, top


def given_cuts(clip: Any, enclosures: Any, crs: Any) -> GivenCuts:
    """Take polygons to clip by, and lines and polygons that enclose."""
    made = []
    for name, source in (("clip", clip), ("enclosures", enclosures)):
        given = None if source is None else as_polygons(source, name)
        if given is not None:
            given = _in_crs(given, crs, name)
        made.append(given)
    if made[0] is not None and made[0].is_line.all():
        raise InputError("the clip has no polygon: give polygons that have an area")
    return GivenCuts(*made)


def _in_crs(given: PolygonSet, crs: Any, name: str) -> PolygonSet:
    """The same in a system; what names none is taken to be in it."""
    if crs is None or given.crs is None:
        return given if crs is None or given.crs is crs else replace(given, crs=crs)
    if not same_crs(given.crs, crs):
        raise InputError(
            f"the {name} and the sites are in different coordinate reference systems, {crs_name(given.crs)} and "
            f"{crs_name(crs)}: reproject one of them"
        )
    return given
