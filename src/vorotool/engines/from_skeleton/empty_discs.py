"""The largest discs between points, lines and polygons, with centers in a region."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from vorotool.convert.polygons import as_polygons
from vorotool.convert.sites import as_sites
from vorotool.engines.from_skeleton.largest_discs import Axis, Candidates, bernstein_roots, check_count
from vorotool.engines.skeleton.diagrams import diagram_of_all, skeleton_in
from vorotool.errors import InputError
from vorotool.numeric.arrays import Floats, Numbers, crosses, dots, mask_of
from vorotool.numeric.checks import checked_threads
from vorotool.numeric.lazy import shapely
from vorotool.numeric.parallel import Progress
from vorotool.types.box import Box, Extent, as_extent, bounds, corners_of, default_frame, extent_sides, is_extent
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.polygons.shapely_geometry import used_shapes
from vorotool.types.skeleton.discs import Discs
from vorotool.types.skeleton.skeleton import Skeleton

if TYPE_CHECKING:
    from vorotool.typing import ImageLike, PointsLike, PolygonsLike


def largest_empty_discs(
    shapes: PointsLike | PolygonsLike | ImageLike,
    *,
    within: Box | Extent | PolygonsLike | None = None,
    count: int = 1,
    threads: int = 0,
    progress: Progress = None,
) -> Discs:
    """Find the largest discs that no point, line or polygon enters, exact to rounding.

    Its center is in a region; the disc may reach beyond. It is at a vertex of the Voronoi diagram of all vertices and
    edges, where one of its edges meets the border of the region, or in a corner of this.

    Parameters
    ----------
    shapes : PolygonSet, PointSet, (n, 2) array-like, data frame, geometry of shapely, geopandas, GeoJSON or WKT, image
        As of `vorotool.voronoi`. Polygons are filled: no center is inside. Those beyond the region count as well.
    within : Box, (x, y, w, h) or polygons, optional
        Where centers are; by default the bounds and a tenth of their larger side around them.
    count : int
        How many: first the largest, then the largest that is disjoint from those before, with its center on the edges
        of the diagram or in a corner of the region, and so on. Discs may touch.
    threads : int
        Number of threads; 0 uses all.
    progress : callable, optional
        Called with the fraction done of each step.

    Returns
    -------
    Discs
        From the largest; of such of one radius that with the smallest x is first, of these that with the smallest y,
        and of a segment between parallel edges its middle stands for all.

    Raises
    ------
    InputError
        If the shapes or the region are invalid.
    UsageError
        If the count is not a positive integer.
    LimitError
        If there are too many vertices.

    Examples
    --------
    >>> discs = largest_empty_discs([[0, 0], [4, 0], [4, 4], [0, 4]], within=(0, 0, 4, 4))
    >>> discs.xy.tolist(), discs.radius.round(6).tolist()
    ([[2.0, 2.0]], [2.828427])
    """
    check_count(1 if count is None else count)
    count = 1 if count is None else count
    given = as_sites(shapes, None).polygons
    region = _region(given, within)
    threads = checked_threads(threads)
    diagram = diagram_of_all(given, features="together", threads=threads, progress=progress)
    return _discs_in(diagram, region, count, threads, progress)


def _region(given: PolygonSet, within: Any) -> PolygonSet:
    frame = default_frame(given) if within is None else None
    if isinstance(within, Box) or (isinstance(within, tuple) and len(within) == 4 and np.isscalar(within[0])):
        frame = as_extent(within, "within")
        if not is_extent(frame):
            raise InputError(f"invalid within {frame}: expected X, Y, W, H with W and H above 0, or polygons")
    if frame is None:
        region = as_polygons(within, name="within")
        if len(region) and region.is_line.all():
            raise InputError("invalid within: it has no area; expected X, Y, W, H, or polygons")
        return region
    return as_polygons(corners_of(frame))


def shared_region(given: PolygonSet, clip: PolygonSet | None, frame: Extent | None) -> PolygonSet:
    """Give what a map in a frame and a clip shares out: what lies in both, if there are both; it may be nothing."""
    if clip is None or frame is None:
        return _region(given, clip or frame)
    area = shapely.union_all(used_shapes(clip)[~clip.is_line])
    common = shapely.intersection(area, shapely.box(*extent_sides(frame)))
    return as_polygons([each for each in shapely.get_parts(common) if each.area > 0])


def _discs_in(diagram: Any, region: PolygonSet, count: int, threads: int, progress: Progress) -> Discs:
    frame = None
    if len(region):
        low, high = bounds(region.xy)
        frame = (*low.tolist(), *(high - low).tolist())
    skeleton = skeleton_in(
        diagram, side="exterior", features="together", frame=frame, threads=threads, progress=progress
    )
    space = _Space(skeleton, region, threads)
    return replace(space.discs(*space.largest(count), local=False), within=region)


class _Space(Axis):
    """What is outside of shapes and in a region."""

    def __init__(self, skeleton: Skeleton, region: PolygonSet, threads: int) -> None:
        super().__init__(skeleton, np.zeros(len(skeleton), dtype=np.intp), threads)
        self.region = region
        self._area = shapely.union_all(used_shapes(region)[~region.is_line])
        self._shapes = shapely.union_all(used_shapes(skeleton.polygons)[~skeleton.polygons.is_line])
        shapely.prepare([self._area, self._shapes])
        self._crossings = self._on_border()
        crossed = mask_of(self.plateau[skeleton.arcs[self._crossings.arc].ravel()], len(self.middles))
        self._is_whole = ~crossed
        if len(self.middles):
            self._is_whole &= self._is_near(self.middles.xy)

    def _is_near(self, places: Floats) -> NDArray[np.bool_]:
        return np.asarray(shapely.distance(self._area, shapely.points(places)) <= self.rounding)

    def is_allowed(self, candidates: Candidates) -> NDArray[np.bool_]:
        """Those in the region."""
        return self._is_near(candidates.xy)

    @property
    def is_whole(self) -> NDArray[np.bool_]:
        """(p,) plateaus of which all is in the region."""
        return self._is_whole

    def first(self) -> Candidates:
        """Give nodes and middles in the region, where edges meet its border, and its corners."""
        whole = self.middles[np.flatnonzero(self._is_whole)]
        others = self.nodes[np.flatnonzero(~self._is_whole[self.plateau])]
        every = whole.joined(others).joined(self.more())
        return every[np.flatnonzero(self.is_allowed(every) & (every.radius > self.rounding))]

    def more(self) -> Candidates:
        """Give places where edges meet the border, and its corners."""
        corners = np.unique(self.region.xy, axis=0)
        corners = corners[~shapely.intersects_xy(self._shapes, *corners.T)]
        tree = shapely.STRtree(shapely.linestrings(self.sites.ends))
        radius = np.zeros(len(corners))
        if len(corners) and len(tree):
            _, radius = tree.query_nearest(shapely.points(corners), return_distance=True, all_matches=False)
        none = np.full(len(corners), -1, dtype=np.intp)
        at_corners = Candidates(corners, radius, np.zeros(len(corners), dtype=np.intp), none, none)
        return self._crossings.joined(at_corners)

    def _touched(self, found: Candidates) -> tuple[Numbers, NDArray[np.int32]]:
        """Discs and all elements that each touches, ascending."""
        tree = shapely.STRtree(shapely.linestrings(self.sites.ends))
        disc, site = tree.query(shapely.points(found.xy), predicate="dwithin", distance=found.radius + self.rounding)
        order = np.lexsort((site, disc))
        return disc[order], site[order].astype(np.int32)

    def _on_border(self) -> Candidates:
        """Places inside arcs where they cross the border of the region."""
        skeleton = self.skeleton
        measures = skeleton.measures(np.arange(len(skeleton)))
        places = np.stack([measures.source, measures.control, measures.target])
        a, b = self.region.xy, self.region.xy[self.region.following]
        boxes = shapely.box(*places.min(axis=0).T, *places.max(axis=0).T)
        edge, arc = shapely.STRtree(boxes).query(shapely.linestrings(np.stack([a, b], axis=1)))
        way = (b - a)[edge]
        beside = places[:, arc] - a[edge]
        height = crosses(way, beside)
        roots = bernstein_roots(*height)
        hand, pair = np.nonzero((roots >= 0) & (roots <= 1))
        u, arc, edge, way = roots[hand, pair], arc[pair], edge[pair], way[pair]
        found = measures[arc]
        xy = found.place(u)
        share = dots(xy - a[edge], way) / dots(way, way)
        from_ends = [np.abs(xy - end).max(axis=1) for end in (found.source, found.target)]
        is_node = np.minimum(*from_ends) <= self.rounding
        kept = np.flatnonzero((share >= 0) & (share <= 1) & ~is_node)
        node = np.full(len(kept), -1, dtype=np.intp)
        return Candidates(xy[kept], found.radius(u)[kept], np.zeros(len(kept), dtype=np.intp), arc[kept], node)
