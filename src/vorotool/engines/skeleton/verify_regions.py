"""Checks of skeletons by regions: connection, cycles, ends and areas."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.common import fail, first_wrong
from vorotool.engines.skeleton.clearance import SitePlaces
from vorotool.engines.skeleton.shortened_edges import corner_sectors
from vorotool.numeric.arrays import Floats, Indices, connected_roots, crosses, norms, ranks_of
from vorotool.numeric.numbers import distinct, is_among
from vorotool.types.polygons.planar_graph import PlanarGraph
from vorotool.types.skeleton.skeleton import EXTERIOR, INTERIOR, Skeleton

AREA = 1e-9
AREA_ULPS = 8
"""Of the extent, times the perimeter: what the area of a region may be wrong by besides `AREA` of it."""


class SkeletonRegions:
    """Connected parts of a skeleton, and the faces of the planar graph that they are in."""

    def __init__(self, skeleton: Skeleton, graph: PlanarGraph, sites: SitePlaces) -> None:
        self.skeleton, self.graph, self.sites = skeleton, graph, sites
        self.lattice_site = self._graph_sites()
        self.sectors = corner_sectors(graph)
        self.root = connected_roots(skeleton.arcs, len(skeleton.vertices))
        self.face = self._faces()
        framed = distinct(self.root[skeleton.touches_frame])
        framed = framed[self.face[framed] <= 0]
        if len(framed):  # all that leads to infinity is connected there
            self.root[np.isin(self.root, framed)] = framed[0]
            self.face[framed] = 0

    def _graph_sites(self) -> Indices:
        """The graph's number of each site."""
        graph, skeleton = self.graph, self.skeleton
        ends = _found(graph.coordinates(), self.sites.ends.reshape(-1, 2)).reshape(-1, 2).T
        at = first_wrong((ends[0] < 0) | (ends[1] < 0))
        count = len(graph.points)
        segment = _found(np.sort(graph.segments, axis=1), np.sort(ends.T, axis=1))
        number = np.where(self.sites.is_edge, segment + count, ends[0])
        if at is None:
            at = first_wrong(self.sites.is_edge & (number < count))
        if at is not None:
            fail(f"site {at} is not a vertex or edge of the polygons")
        if len(distinct(number)) != len(number) or len(number) != count + len(graph):
            fail(f"there are {count + len(graph)} vertices and edges, but {len(distinct(number))} different sites")
        deleted = self.sites.is_edge[skeleton.sites]
        mixed = np.flatnonzero(deleted[:, 0] != deleted[:, 1])
        edge = np.where(deleted[mixed, 0], skeleton.sites[mixed, 0], skeleton.sites[mixed, 1])
        vertex = np.where(deleted[mixed, 0], skeleton.sites[mixed, 1], skeleton.sites[mixed, 0])
        own = first_wrong((graph.segments[number[edge] - count] == number[vertex][:, None]).any(axis=1))
        if own is not None:
            fail(f"arc {mixed[own]} is between an edge and its own end")
        return number

    def _faces(self) -> Indices:
        """(v,) at the root of each part its face, from the corners that it ends in; -1 elsewhere."""
        skeleton, sectors = self.skeleton, self.sectors
        count = len(self.graph.points)
        is_corner = skeleton.radius == 0
        arc, end = np.nonzero(is_corner[skeleton.arcs])
        node = skeleton.arcs[arc, end]
        if (at := first_wrong(skeleton.degree[node] != 1)) is not None:
            fail(f"node {node[at]} is a corner, but several arcs end there")
        hands = self.lattice_site[skeleton.sites[arc]] - count
        # an arc that leaves a corner has the sector's first segment on its right
        right, left = np.where(end == 0, hands[:, 1], hands[:, 0]), np.where(end == 0, hands[:, 0], hands[:, 1])
        points = _found(self.graph.coordinates(), skeleton.vertices[node])
        table = np.stack([sectors.right, sectors.left, sectors.point], axis=1)
        found = _found(table, np.stack([right, left, points], axis=1))
        if (at := first_wrong(found < 0)) is not None:
            place = tuple(skeleton.vertices[node[at]].tolist())
            fail(f"arc {arc[at]} ends at {place}, which is not a corner between its sites")
        self.corner_sector = found
        face = np.full(len(skeleton.vertices), -1, dtype=np.int64)
        face[self.root[node]] = sectors.face[found]
        if (at := first_wrong(face[self.root[node]] != sectors.face[found])) is not None:
            fail(f"arc {arc[at]} is connected with a skeleton in another region")
        return face


def _found(rows: NDArray[Any], wanted: NDArray[Any]) -> Indices:
    """The number of each wanted row among others, or -1."""
    _, number = np.unique(np.concatenate([rows, wanted]) + 0.0, axis=0, return_inverse=True)  # no -0
    own, others = np.split(number.reshape(-1), [len(rows)])
    return ranks_of(own, int(number.max(initial=-1)) + 1)[others]


def with_corners_apart(skeleton: Skeleton) -> Skeleton:
    """Give each arc a node of its own at corners where arcs are joined, after a check that just these are."""
    inside = {8: True, 4: False}.get(skeleton.polygons.connectivity or 0)
    if inside is None:
        return skeleton
    on_side = (skeleton.polygon >= 0) == inside
    arc, end = np.nonzero((skeleton.radius[skeleton.arcs] == 0) & on_side[:, None])
    node = skeleton.arcs[arc, end]
    keys = np.column_stack([skeleton.vertices[node], skeleton.polygon[arc]])
    _, corner = np.unique(keys, axis=0, return_inverse=True)
    corner = corner.reshape(-1)
    first = np.full(corner.max(initial=-1) + 1, len(skeleton.vertices))
    np.minimum.at(first, corner, node)
    if (at := first_wrong(node != first[corner])) is not None:
        fail(f"nodes {first[corner[at]]} and {node[at]} are at one corner, where pixels are connected, but not joined")
    _, owner = np.unique(np.stack([node, corner]), axis=1, return_index=True)
    if (at := first_wrong(np.bincount(node[owner], minlength=1) > 1)) is not None:
        fail(f"node {at} is a corner that arcs in different polygons share")
    arcs = skeleton.arcs.copy()
    arcs[arc, end] = len(skeleton.vertices) + np.arange(len(arc))
    used, numbers = np.unique(arcs, return_inverse=True)
    origin = np.concatenate([np.arange(len(skeleton.vertices)), node])[used]
    return replace(
        skeleton,
        arcs=numbers.reshape(-1, 2).astype(np.int32),
        vertices=skeleton.vertices[origin],
        radius=skeleton.radius[origin],
    )


def check_regions(regions: SkeletonRegions) -> None:
    """Raise unless ends, sides, connection, cycles and areas are what those of a skeleton are."""
    skeleton, graph = regions.skeleton, regions.graph
    inside = graph.is_inside
    wanted = np.zeros(graph.faces, dtype=bool)
    for side, of_side in ((INTERIOR, inside), (EXTERIOR, ~inside)):
        if (skeleton.side == side).any():
            wanted |= of_side & (_uncut_faces(skeleton, graph) | (side == INTERIOR))
    _check_ends(regions, wanted)
    roots = np.flatnonzero(regions.root == np.arange(len(regions.root)))
    face = regions.face[roots]
    _check_sides(regions, inside)
    bounded = np.flatnonzero(face > 0)
    parts = np.bincount(face[bounded], minlength=graph.faces)
    if (at := first_wrong(wanted[1:] & (parts[1:] != 1))) is not None:
        fail(f"the skeleton of region {at + 1} has {parts[at + 1]} connected parts")
    if np.count_nonzero(face <= 0) > 1:
        fail("the skeleton outside has parts that are not connected, even by the frame")
    _check_cycles(regions, roots, face)
    _check_areas(regions, wanted)


def _uncut_faces(skeleton: Skeleton, graph: PlanarGraph) -> NDArray[np.bool_]:
    """(f,) faces that are within the frame as a whole, and the unbounded one."""
    uncut = np.ones(graph.faces, dtype=bool)
    if skeleton.frame is not None:
        x, y, w, h = skeleton.frame
        places = graph.coordinates()[graph.segments].reshape(-1, 2)
        beyond = ((places < [x, y]) | (places > [x + w, y + h])).any(axis=1).reshape(-1, 2).any(axis=1)
        uncut[graph.segment_faces[beyond]] = False
        uncut[0] = True
    return uncut


def _check_ends(regions: SkeletonRegions, wanted: NDArray[np.bool_]) -> None:
    """One arc ends in each corner under 180 degrees, and nowhere else but on the frame."""
    skeleton, sectors = regions.skeleton, regions.sectors
    corner = _corners_of_nodes(regions)
    at = first_wrong((skeleton.degree == 1) & (skeleton.radius > 0) & ~skeleton.on_frame & (corner < 0))
    if at is not None:
        fail(f"the skeleton ends at node {at}, {tuple(skeleton.vertices[at].tolist())}, which is not a corner")
    times = np.bincount(regions.corner_sector, minlength=len(sectors.face))
    expected = wanted[sectors.face]
    if skeleton.frame is not None:
        x, y, w, h = skeleton.frame
        places = regions.graph.coordinates()[sectors.point]
        in_frame = ((places > [x, y]) & (places < [x + w, y + h])).all(axis=1)
        expected &= in_frame | regions.graph.is_inside[sectors.face]
    expected &= ~is_among(sectors.point, corner[corner >= 0])
    if (at := first_wrong(expected & (times != 1) | (times > 1))) is not None:
        place = tuple(regions.graph.coordinates()[sectors.point[at]].tolist())
        fail(f"{times[at]} arcs end in the corner at {place}, which should be one")


def _corners_of_nodes(regions: SkeletonRegions) -> Indices:
    """(v,) the point that each node inside is at, or -1: doubles may not tell it from a corner that an arc led to."""
    found = _found(regions.graph.coordinates(), regions.skeleton.vertices)
    return np.where(regions.skeleton.radius > 0, found, -1)


def _check_sides(regions: SkeletonRegions, inside: NDArray[np.bool_]) -> None:
    skeleton, graph = regions.skeleton, regions.graph
    face = np.maximum(regions.face[regions.root[skeleton.arcs[:, 0]]], 0)
    if (at := first_wrong(inside[face] != (skeleton.side == INTERIOR))) is not None:
        fail(f"arc {at} is in region {face[at]}, which is on the other side")
    first = (
        np.where(inside[face], graph.face_polygon[np.minimum(graph.face_starts[face], len(graph.face_polygon) - 1)], -1)
        if len(graph.face_polygon)
        else np.full(len(face), -1)
    )
    if (at := first_wrong(first != skeleton.polygon)) is not None:
        fail(f"arc {at} is listed in polygon {skeleton.polygon[at]}, but is in {first[at]}")


def _check_cycles(regions: SkeletonRegions, roots: Indices, face: Indices) -> None:
    """Independent cycles of each part: components of the complement of its region less one."""
    skeleton, graph = regions.skeleton, regions.graph
    nodes = np.bincount(regions.root, minlength=len(regions.root))
    arcs = np.bincount(regions.root[skeleton.arcs[:, 0]], minlength=len(regions.root))
    cycles = (arcs - nodes + 1)[roots]
    borders = border_components(graph)
    lone = np.bincount(graph.segments.reshape(-1), minlength=len(graph.points)) == 0
    numbers = regions.lattice_site[skeleton.sites]
    is_lone = np.concatenate([lone, np.zeros(len(graph), dtype=bool)])[numbers]
    arc, hand = np.nonzero(is_lone)
    pairs = np.unique(np.stack([regions.root[skeleton.arcs[arc, 0]], numbers[arc, hand]], axis=1), axis=0)
    points = np.bincount(pairs[:, 0], minlength=len(regions.root))[roots]
    expected = np.where(face > 0, borders[np.maximum(face, 0)], borders[0]) + points - 1
    cut = (face <= 0) & skeleton.touches_frame.any()  # what is beyond the frame is unknown: see verify_exterior
    uncut = _uncut_faces(skeleton, graph)[np.maximum(face, 0)] | graph.is_inside[np.maximum(face, 0)]
    if (at := first_wrong(~cut & uncut & (cycles != expected))) is not None:
        fail(f"the skeleton of region {max(face[at], 0)} has {cycles[at]} independent cycles, not {expected[at]}")


def border_components(graph: PlanarGraph) -> Indices:
    """(f,) connected components of the segments around each face."""
    component = connected_roots(graph.segments, len(graph.points))[graph.segments[:, 0]]
    pairs = np.stack([graph.segment_faces.reshape(-1).astype(np.int64), np.repeat(component, 2)], axis=1)
    return np.bincount(np.unique(pairs, axis=0)[:, 0], minlength=graph.faces)


def _check_areas(regions: SkeletonRegions, wanted: NDArray[np.bool_]) -> None:
    """Regions between arcs and their feet on both sides sum to the area of each bounded face."""
    skeleton, graph, sites = regions.skeleton, regions.graph, regions.sites
    total = areas_beside(skeleton, sites)
    face = np.maximum(regions.face[regions.root[skeleton.arcs[:, 0]]], 0)
    summed = np.bincount(face, total, graph.faces)
    area, perimeter = face_measures(graph)
    allowed = AREA * np.abs(area) + AREA_ULPS * np.spacing(sites.largest) * perimeter
    wrong = wanted & ~(np.abs(summed - area) <= allowed)
    wrong[0] = False
    if (at := first_wrong(wrong)) is not None:
        fail(f"the regions around the arcs in region {at} sum to {summed[at]}, but its area is {area[at]}")


def areas_beside(skeleton: Skeleton, sites: SitePlaces) -> Floats:
    """(a,) areas between arcs and their feet, on both sides."""
    source, target = skeleton.vertices[skeleton.arcs].swapaxes(0, 1)
    total = np.zeros(len(skeleton))
    for hand, sign in ((0, 0.5), (1, -0.5)):
        site = skeleton.sites[:, hand]
        from_source, from_target = sites.feet(site, source), sites.feet(site, target)
        a, b = from_target - source, from_source - target  # diagonals
        total += sign * (crosses(a, b))
    return total


def face_measures(graph: PlanarGraph) -> tuple[Floats, Floats]:
    """Areas and perimeters of faces; the unbounded one's means nothing."""
    way = graph.coordinates()[graph.segments]
    length = norms(way[:, 1] - way[:, 0])
    ends = graph.points[graph.segments].astype(np.float64)
    # relative to a corner of each face, so that products stay small
    first = np.full(graph.faces, len(graph), dtype=np.int64)
    np.minimum.at(first, graph.segment_faces, np.repeat(np.arange(len(graph))[:, None], 2, axis=1))
    corner = ends[np.minimum(first, len(graph) - 1), 0] if len(graph) else np.zeros((graph.faces, 2))
    area, perimeter = np.zeros(graph.faces), np.zeros(graph.faces)
    for hand, sign in ((0, 0.5), (1, -0.5)):
        face = graph.segment_faces[:, hand]
        a, b = (ends[:, k] - corner[face] for k in (0, 1))
        np.add.at(area, face, sign * (crosses(a, b)))
        np.add.at(perimeter, face, length)
    return area * (graph.scale * graph.scale), perimeter
