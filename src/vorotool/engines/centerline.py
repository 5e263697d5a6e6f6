"""Centerlines: the longest of the shortest paths along the skeleton of each polygon, extended to the boundary."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.label_arrays import Progress
from vorotool.engines.pruning import skeleton_arrays
from vorotool.engines.skeleton_places import nearest_place
from vorotool.errors import InputError, UsageError, VorotoolWarning
from vorotool.geometry.centerline import Centerlines, without_centerline
from vorotool.geometry.magnitude import check_lengths
from vorotool.geometry.skeleton import EDGE, INTERIOR, Skeleton

Floats = NDArray[np.float64]
Indices = NDArray[np.int32]
Place = tuple[float, float]

MOST_NAMED = 10
"""Polygons without a centerline that a warning names."""


def centerline(
    skeleton: Skeleton, *, start: Place | None = None, end: Place | None = None, progress: Progress = None
) -> Centerlines:
    """Find the centerline of each polygon: the longest of the shortest paths between leaves of its skeleton.

    Where a connected skeleton has no leaf, paths between its nodes are compared; where it has one, paths from it. Of
    equally long paths that whose ends have the smallest numbers is taken. Usually the skeleton is pruned before, so
    that a path does not lead into a
    corner. Leaves inside are extended to the boundary, straight on from the place of the path one radius of the
    leaf's disc before.

    Trees take linear time. Let a skeleton have F branches on cycles, and trees at K places of these (all nodes, if
    there is no tree): that takes at most K searches in F branches, most of which bounds on distances save.

    Parameters
    ----------
    skeleton : Skeleton
        Its arcs inside polygons are used.
    start, end : (x, y), optional
        Give the one path between the places on the skeleton nearest to these, which are not extended. With one of
        the two, the path leads to the leaf that is farthest from there.
    progress : callable, optional
        Called with the fraction done.

    Returns
    -------
    Centerlines
        In the order of the polygons.

    Raises
    ------
    InputError
        If there is no path between the places that are given.
    UsageError
        If a place is not finite.

    Warns
    -----
    VorotoolWarning
        If polygons have none, with their number and names: there is no skeleton inside, or a single place.

    Examples
    --------
    >>> from vorotool import prune, skeleton_exact
    >>> skeleton = prune(skeleton_exact([[0, 0], [6, 0], [6, 2], [0, 2]]), scale=1.5)
    >>> line = centerline(skeleton)
    >>> line.flattened(0.1)[0].tolist()
    [[0.0, 1.0], [1.0, 1.0], [5.0, 1.0], [6.0, 1.0]]
    >>> centerline(skeleton, start=(2, 2), end=(3, 0)).flattened(0.1)[0].tolist()
    [[2.0, 1.0], [3.0, 1.0]]
    """
    inside = np.flatnonzero(skeleton.side == INTERIOR)
    network = _Network(skeleton, inside)
    if start is None and end is None:
        lines = _made(skeleton, network, network.longest_paths(progress), extends=(True, True))
        _warn_missing(lines)
        return lines
    for place in (start, end):
        if place is not None and not np.isfinite(place).all():
            raise UsageError(f"({place[0]}, {place[1]}) is no place: its coordinates must be finite")
        check_lengths(place or (), "coordinate")
    if not len(inside):
        raise InputError("there is no skeleton inside polygons for a path to follow")
    is_reversed = start is None
    one, other = (end, start) if is_reversed else (start, end)
    assert one is not None
    first = network.node_at(*nearest_place(skeleton, one, inside))
    last = -1 if other is None else network.node_at(*nearest_place(skeleton, other, inside))
    path = network.path(first, last, progress)
    if path is None or not len(path.arcs):
        raise InputError(_no_path(skeleton, start, end, is_apart=path is None))
    extends = (False, other is None)
    made = path.reversed() if is_reversed else path
    return _made(skeleton, network, made, extends=extends[::-1] if is_reversed else extends)


@dataclass(frozen=True, eq=False)
class _Paths:
    """Arcs of paths that follow one another, and the nodes that each leads from and to."""

    start: NDArray[np.int64]
    arcs: Indices
    sources: Indices
    targets: Indices

    def reversed(self) -> _Paths:
        """One path, the other way round."""
        return _Paths(self.start, self.arcs[::-1], self.targets[::-1], self.sources[::-1])


class _Network:
    """Arcs of a skeleton, or parts of them, as a graph; places inside arcs can be made nodes."""

    def __init__(self, skeleton: Skeleton, arcs: NDArray[np.intp]) -> None:
        self.skeleton = skeleton
        self.arc = arcs.astype(np.int32)
        self.ends = np.ascontiguousarray(skeleton.arcs[arcs])
        self.first, self.last = np.zeros(len(arcs)), np.ones(len(arcs))
        self.length = np.ascontiguousarray(skeleton.length[arcs])
        self.nodes = len(skeleton.vertices)

    def node_at(self, arc: int, place: float) -> int:
        """The node at a place of an arc, which is parted there if need be."""
        k = int(np.flatnonzero((self.arc == arc) & (self.first <= place) & (place <= self.last))[0])
        for end, own in ((0, self.first[k]), (1, self.last[k])):
            if place == own:
                return int(self.ends[k, end])
        node, self.nodes = self.nodes, self.nodes + 1
        self.arc = np.append(self.arc, self.arc[k])
        self.ends = np.concatenate([self.ends, [[node, self.ends[k, 1]]]]).astype(np.int32)
        self.first, self.last = np.append(self.first, place), np.append(self.last, self.last[k])
        self.ends[k, 1], self.last[k] = node, place
        both = [k, len(self.arc) - 1]
        self.length = np.append(self.length, 0.0)
        self.length[both] = _geometry(self.skeleton, self.arc[both], self.first[both], self.last[both])["length"]
        return node

    def longest_paths(self, progress: Progress) -> _Paths:
        """One path a polygon that has one of more than a place."""
        count = len(self.skeleton.polygons)
        polygon = np.ascontiguousarray(self.skeleton.polygon[self.arc])
        start, arcs, targets = _core.longest_paths(self.ends, self.length, polygon, count, self.nodes, progress)
        path = np.repeat(np.arange(count), np.diff(start))
        length = np.bincount(path, self.length[arcs], minlength=count)
        kept = (length > 0)[path]
        sizes = np.diff(start)[length > 0]
        return self._with_sources(np.concatenate([[0], np.cumsum(sizes)]), arcs[kept], targets[kept])

    def path(self, first: int, last: int, progress: Progress) -> _Paths | None:
        """The shortest path between two nodes; with last -1 the longest of those to leaves."""
        found = _core.path_from(self.ends, self.length, self.nodes, first, last, progress)
        return None if found is None else self._with_sources(np.array([0, len(found[0])]), *found)

    def _with_sources(self, start: NDArray[np.int64], arcs: Indices, targets: Indices) -> _Paths:
        ends = self.ends[arcs]
        return _Paths(start, arcs, np.where(ends[:, 1] == targets, ends[:, 0], ends[:, 1]), targets)


def _geometry(skeleton: Skeleton, arc: Indices, first: Floats, last: Floats) -> dict[str, Floats]:
    return _core.part_geometry(skeleton_arrays(skeleton), arc, first, last)


def _made(skeleton: Skeleton, network: _Network, paths: _Paths, *, extends: tuple[bool, bool]) -> Centerlines:
    """Put the arcs of paths together as skeletons, each in the direction of its path."""
    arc = network.arc[paths.arcs]
    parts = _geometry(skeleton, arc, network.first[paths.arcs], network.last[paths.arcs])
    is_reversed = network.ends[paths.arcs, 0] != paths.sources
    turned = is_reversed[:, None]
    line = np.repeat(np.arange(len(paths.start) - 1, dtype=np.int32), np.diff(paths.start))
    is_first = np.diff(line, prepend=-1) > 0
    node = np.arange(len(arc)) + line  # at the source of each arc: one more than arcs on each line
    count = len(arc) + len(paths.start) - 1
    vertices, radius = np.empty((count, 2)), np.empty(count)
    vertices[node[is_first]] = np.where(turned, parts["last"], parts["first"])[is_first]
    radius[node[is_first]] = np.where(is_reversed, parts["last_radius"], parts["first_radius"])[is_first]
    vertices[node + 1] = np.where(turned, parts["first"], parts["last"])
    radius[node + 1] = np.where(is_reversed, parts["first_radius"], parts["last_radius"])
    sites = skeleton.sites[arc]
    path = replace(
        skeleton,
        vertices=vertices,
        radius=radius,
        arcs=np.stack([node, node + 1], axis=1),
        control=parts["control"],
        sites=np.where(turned, sites[:, ::-1], sites),
        polygon=skeleton.polygon[arc],
        side=skeleton.side[arc],
        branch=line,
        length=parts["length"],
        error_bound=skeleton.error_bound[arc],
        frame=None,
    )
    lines = Centerlines(path, np.full((len(paths.start) - 1, 2, 2), np.nan))
    is_leaf = np.append(skeleton.degree == 1, False)[np.minimum(_end_nodes(paths), len(skeleton.vertices))]
    return replace(lines, ends=_extended(lines, is_leaf & np.array(extends)))


def _end_nodes(paths: _Paths) -> Indices:
    """(k, 2) the first and the last node of each path."""
    return np.stack([paths.sources[paths.start[:-1]], paths.targets[paths.start[1:] - 1]], axis=1)


# ---- to the boundary ------------------------------------------------------------------------------
def _extended(lines: Centerlines, wanted: NDArray[np.bool_]) -> Floats:
    """Where rays from the ends of paths meet the boundary first; NaN where an end stays, or is there already."""
    ends = lines.ends.copy()
    wanted = wanted & (lines.path.radius[lines.end_nodes] > 0)
    if wanted.any():
        origin = lines.path.vertices[lines.end_nodes]
        ends[wanted] = _first_hits(origin[wanted], (origin - _places_before(lines))[wanted], _boundary(lines.path))
    return ends


def _places_before(lines: Centerlines) -> Floats:
    """(k, 2, 2) places on each path, one radius after its start and before its end, or its other end."""
    path, start = lines.path, lines.arc_start
    along = np.concatenate([[0], np.cumsum(path.length)])
    first, last = along[start[:-1]], along[start[1:]]
    radius = path.radius[lines.end_nodes]
    position = np.stack([np.minimum(first + radius[:, 0], last), np.maximum(last - radius[:, 1], first)], axis=1)
    arc = np.clip(np.searchsorted(along, position, side="right") - 1, start[:-1, None], start[1:, None] - 1).reshape(-1)
    measures = path.measures(arc)
    places: Floats = measures.place(measures.parameter(position.reshape(-1) - along[arc]))
    return places.reshape(-1, 2, 2)


def _boundary(skeleton: Skeleton) -> Floats:
    """(e, 2, 2) ends of all edges of polygons and lines."""
    edges: Floats = replace(skeleton, gap=0.0).site_ends[skeleton.site_table.kind == EDGE]
    return edges


def _first_hits(origin: Floats, way: Floats, edges: Floats) -> Floats:
    """Where each ray meets an edge first."""
    import shapely

    size = np.sqrt((way * way).sum(axis=1))
    way = way / size[:, None]
    reach = 2 * float(np.ptp(edges.reshape(-1, 2), axis=0).sum())
    rays = shapely.linestrings(np.stack([origin, origin + reach * way], axis=1))
    ray, edge = shapely.STRtree(shapely.linestrings(edges)).query(rays, predicate="intersects")
    a, along = edges[edge, 0] - origin[ray], edges[edge, 1] - edges[edge, 0]
    direction = way[ray]
    across = direction[:, 0] * along[:, 1] - direction[:, 1] * along[:, 0]
    over = a[:, 0] * along[:, 1] - a[:, 1] * along[:, 0]
    beside = np.minimum((a * direction).sum(axis=1), ((a + along) * direction).sum(axis=1))
    distance = np.divide(over, across, out=beside, where=across != 0)
    nearest = np.full(len(origin), np.inf)
    np.minimum.at(nearest, ray, np.where(distance > 0, distance, np.inf))
    with np.errstate(invalid="ignore"):
        hits: Floats = np.where(np.isfinite(nearest)[:, None], origin + nearest[:, None] * way, np.nan)
    return hits


# ---- what is said ---------------------------------------------------------------------------------
def _warn_missing(lines: Centerlines) -> None:
    missing = without_centerline(lines)
    if not len(missing):
        return
    polygons = lines.path.polygons
    total = int(np.count_nonzero(~polygons.is_line))
    ids = polygons.ids
    has_ids = ids is not None and all(ids[k] is not None for k in missing.tolist())
    named = [str(ids[k] if ids is not None and has_ids else k + 1) for k in missing[:MOST_NAMED].tolist()]
    more = f" and {len(missing) - MOST_NAMED} more" if len(missing) > MOST_NAMED else ""
    what = "ids" if has_ids else "numbers"
    warnings.warn(
        f"{len(missing)} of {total} polygons gave no centerline: {what} {', '.join(named)}{more}",
        VorotoolWarning,
        stacklevel=3,
    )


def _no_path(skeleton: Skeleton, start: Place | None, end: Place | None, *, is_apart: bool) -> str:
    def told(place: Place | None) -> str:
        return "a leaf" if place is None else f"({place[0]:g}, {place[1]:g})"

    if is_apart:
        return f"no path along the skeleton leads from {told(start)} to {told(end)}: they are in different parts of it"
    return f"the path from {told(start)} to {told(end)} is a single place of the skeleton: give others"
