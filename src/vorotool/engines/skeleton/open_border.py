"""Polygons that a rectangle cuts: their edges on its border are no sites, what is inside goes on beyond it.

For a place in the rectangle, the nearest place on a ray that leaves it at a right angle is where the ray begins. So
each edge on the border is put far away, with rays from where the rest of the outline ends: in the rectangle the medial
axis of this is that of the rest alone. Arcs beside a ray, or beside what is far away, are all beyond the border, and
the others are cut there.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError, UsageError
from vorotool.numeric.arrays import Indices
from vorotool.plain import plain
from vorotool.types.box import Extent, check_lengths, is_extent
from vorotool.types.polygons.planar_graph import PlanarGraph
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.skeleton.segment_voronoi import SegmentVoronoiDiagram

ROOM = 1.25
"""Of the sides of the rectangle together: how far around it the lattice has places. What is put away is as far as both
sides, so that no place in the rectangle is nearer to it than to anything else."""

SNAP = 2.0**-19
"""Of a step of the lattice: vertices of a diagram are right to fewer of its last places, so that those as near to the
border are on it. Where an outline ends, the axis has one there."""

OUTWARDS = np.array([[-1, 0], [1, 0], [0, -1], [0, 1]], dtype=np.int64)
"""From the sides of least and most x, then y."""


@plain(eq=False)
class Opening:
    """A planar graph whose segments on the border of a rectangle are far away."""

    graph: PlanarGraph  # with the faces of the graph that it is made of
    # (s,) int32 array: of its points, then its segments, the site of that graph; -1 of what is beyond the border
    site: NDArray[np.int32]
    frame: Extent
    box: tuple[int, int, int, int]  # least and most x, then y, on the lattice

    @property
    def within(self) -> tuple[int, int, int, int]:
        """Least and most x, then y, of all that may be put away."""
        x0, x1, y0, y1 = self.box
        far = _far(self.box)
        return x0 - far, x1 + far, y0 - far, y1 + far

    def snapped(self, diagram: SegmentVoronoiDiagram) -> SegmentVoronoiDiagram:
        """Put vertices that are on the border but for rounding there."""
        vertices = diagram.vertices.copy()
        for axis in (0, 1):
            for side in self.box[2 * axis : 2 * axis + 2]:
                vertices[np.abs(vertices[:, axis] - side) <= SNAP, axis] = side
        return replace(diagram, vertices=vertices)


def around(frame: Extent) -> NDArray[np.float64]:
    """(2, 2) places that the lattice has to have, too."""
    x, y, w, h = frame
    far = ROOM * (w + h)
    return np.array([[x - far, y - far], [x + w + far, y + h + far]])


def check_border(polygons: PolygonSet, frame: Extent | None, *, side: str, features: str, gap: float) -> None:
    """Raise UsageError for a border that is none, or does not go with the rest; InputError for what is beyond it."""
    if frame is None:
        return
    if not is_extent(frame):
        raise UsageError(f"the border is {frame}: use X, Y, W, H with W and H above 0")
    if side != "interior" or features != "separate" or gap:
        raise UsageError(
            "an open border applies to the interior of separate features: leave out side, features and gap"
        )
    check_lengths(frame, "border's coordinate")
    x, y, w, h = frame
    beyond = np.flatnonzero(((polygons.xy < [x, y]) | (polygons.xy > [x + w, y + h])).any(axis=1))
    if beyond.size:
        place = tuple(polygons.xy[beyond[0]].tolist())
        raise InputError(f"{place} is beyond the border {frame}: clip the polygons to the border first")


def opened(graph: PlanarGraph, frame: Extent) -> Opening:
    """Put segments on the border of a rectangle far away."""
    x, y, w, h = frame
    sides = np.array([x - graph.origin[0], x + w - graph.origin[0], y - graph.origin[1], y + h - graph.origin[1]])
    box = tuple(np.rint(sides / graph.scale).astype(int).tolist())
    side = _sides(graph, box)
    border = np.flatnonzero(side >= 0)
    kept_segments = np.flatnonzero(side < 0)
    count = len(graph.points)
    is_inner = np.bincount(graph.segments[kept_segments].ravel(), minlength=count) > 0
    is_gone = (np.bincount(graph.segments[border].ravel(), minlength=count) > 0) & ~is_inner
    kept_points = np.flatnonzero(~is_gone)
    number = np.full(count, -1, dtype=np.int64)
    number[kept_points] = np.arange(len(kept_points))
    far = _FarAway(graph, border, side[border], box, number)
    made = [
        (number[graph.segments[kept_segments].astype(np.int64)], graph.segment_faces[kept_segments].astype(np.int64)),
        far.edges(),
        far.rays(is_inner),
        far.corners(is_inner),
    ]
    places = np.array(far.places, dtype=np.int64).reshape(-1, 2)
    segments = np.concatenate([pairs for pairs, _ in made])
    site = np.concatenate(
        [kept_points, np.full(len(places), -1), kept_segments + count, np.full(len(segments) - len(kept_segments), -1)]
    )
    whole = PlanarGraph(
        np.concatenate([graph.points[kept_points].astype(np.int64), places]).astype(np.int32),
        segments.astype(np.int32),
        np.full(len(kept_points) + len(places), -1, dtype=np.int32),
        np.zeros(len(segments) + 1, dtype=np.int32),
        np.empty(0, dtype=np.int32),
        np.concatenate([faces for _, faces in made]).astype(np.int32),
        graph.face_starts,
        graph.face_polygon,
        origin=graph.origin,
        scale=graph.scale,
        point_holes=_moved_holes(graph, number),
    )
    return Opening(whole, site.astype(np.int32), frame, box)


def _sides(graph: PlanarGraph, box: tuple[int, int, int, int]) -> Indices:
    """(m,) the side of the rectangle that each segment is on, in the order of `OUTWARDS`; -1 inside."""
    ends = graph.points[graph.segments].astype(np.int64)
    side = np.full(len(graph), -1, dtype=np.int64)
    for number, value in enumerate(box):
        side[(ends[:, :, number // 2] == value).all(axis=1)] = number
    return side


def _far(box: tuple[int, int, int, int]) -> int:
    return box[1] - box[0] + box[3] - box[2] + 2


def _moved_holes(graph: PlanarGraph, number: Indices) -> NDArray[np.int32]:
    holes = graph.point_holes.copy()
    holes[:, 0] = number[holes[:, 0]]
    return holes[holes[:, 0] >= 0]


class _FarAway:
    """Segments of a border, put away; their new ends have numbers behind those of the points that stay."""

    def __init__(
        self, graph: PlanarGraph, border: Indices, side: Indices, box: tuple[int, int, int, int], number: Indices
    ) -> None:
        self.ends = graph.segments[border].astype(np.int64)
        self.faces = graph.segment_faces[border].astype(np.int64)
        self.side, self.number = side, number
        self.points = graph.points.astype(np.int64)
        self.far, self.box = _far(box), box
        self.first = int((number >= 0).sum())
        self.places: list[tuple[int, int]] = []
        keys, self.outer = np.unique(self.ends * 4 + side[:, None], return_inverse=True)
        self.outer = self.outer.reshape(-1, 2) + self.first
        self.key_point, self.key_side = keys // 4, keys % 4
        self.places += map(tuple, (self.points[self.key_point] + self.far * OUTWARDS[self.key_side]).tolist())

    def edges(self) -> tuple[Indices, Indices]:
        """The segments themselves: ends, and the faces left and right."""
        return self.outer, self.faces

    def rays(self, is_inner: NDArray[np.bool_]) -> tuple[Indices, Indices]:
        """From where the rest of the outline ends; one on each side of the border, whatever follows it there."""
        faces = np.full((len(self.key_point), 2), -1, dtype=np.int64)
        for end in (0, 1):
            point, other, key = self.ends[:, end], self.ends[:, 1 - end], self.outer[:, end] - self.first
            out, along = OUTWARDS[self.side], self.points[other] - self.points[point]
            hand = np.where(out[:, 0] * along[:, 1] - out[:, 1] * along[:, 0] > 0, 0, 1)
            seen = self.faces if end == 0 else self.faces[:, ::-1]  # from the point outwards
            rows = np.arange(len(key))
            faces[key, hand] = seen[rows, hand]
            empty = faces[key, 1 - hand] < 0
            faces[key[empty], 1 - hand[empty]] = -2 - seen[rows[empty], 1 - hand[empty]]
        faces = np.where(faces <= -2, -2 - faces, faces)
        used = np.flatnonzero(is_inner[self.key_point])
        return np.stack([self.number[self.key_point[used]], used + self.first], axis=1), faces[used]

    def corners(self, is_inner: NDArray[np.bool_]) -> tuple[Indices, Indices]:
        """Around corners of the rectangle that polygons cover."""
        pairs, faces = [], []
        order = np.argsort(self.key_point, kind="stable")
        again = order[1:][self.key_point[order[1:]] == self.key_point[order[:-1]]]
        for key in again.tolist():
            point = int(self.key_point[key])
            if is_inner[point]:
                continue
            corner = self.first + len(self.places)
            out = self.far * (OUTWARDS[self.key_side[self.key_point == point]].sum(axis=0))
            self.places.append(tuple((self.points[point] + out).tolist()))
            for end in (0, 1):  # one segment begins here, and one ends: both go on to the corner
                for row in np.flatnonzero(self.ends[:, end] == point).tolist():
                    outer = int(self.outer[row, end])
                    pairs.append((corner, outer) if end == 0 else (outer, corner))
                    faces.append(self.faces[row].tolist())
        return (
            np.array(pairs, dtype=np.int64).reshape(-1, 2),
            np.array(faces, dtype=np.int64).reshape(-1, 2),
        )
