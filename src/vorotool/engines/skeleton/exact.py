"""Exact skeletons from the Voronoi diagram of line segments (paper, section 3.2)."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Unpack

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.arrangement.planar_graph import graph_for_skeletons
from vorotool.engines.arrangement.repaired_polygons import PlacedShapes, placed_shapes
from vorotool.engines.segment_voronoi.segment_voronoi import core_diagram, segment_voronoi, unwanted_sides
from vorotool.errors import InputError, Kind, Message, UsageError, VorotoolWarning, option, warn
from vorotool.frozen import frozen
from vorotool.numeric.arrays import Indices, crosses, ranks_of
from vorotool.numeric.checks import checked_threads, is_choice
from vorotool.numeric.numbers import finite_double, shown_number
from vorotool.numeric.parallel import Progress, Run
from vorotool.types.box import Extent, check_lengths, default_frame, is_extent
from vorotool.types.polygons.planar_graph import PlanarGraph
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.skeleton.segment_voronoi import SegmentVoronoiDiagram
from vorotool.types.skeleton.skeleton import EXTERIOR, INTERIOR, Skeleton

SIDE_NAMES = ("interior", "exterior", "both")
FEATURES = ("separate", "together")
EVERY_GROUP = -1
"""Of arcs that a frame clips, as the core has it."""


def check_skeleton_options(side: str, gap: float, frame: Extent | None) -> None:
    """Raise UsageError for what is no side, gap or frame."""
    if not is_choice(side, SIDE_NAMES):
        raise UsageError(f"the side is {shown_number(side)}: use {', '.join(SIDE_NAMES)}")
    if finite_double(gap, "the gap") < 0:
        raise UsageError(f"the gap is {shown_number(gap)}: use a length of 0 or more")
    if frame is not None and not is_extent(frame):
        raise UsageError(f"the frame is {frame}: use X, Y, W, H with W and H above 0")


def check_features(features: str) -> None:
    """Raise UsageError for what tells not how features are taken."""
    if not is_choice(features, FEATURES):
        raise UsageError(f"features is {shown_number(features)}: use {' or '.join(FEATURES)}")


@frozen(eq=False)
class ShapeDiagram:
    """Polygons made a planar graph, and the Voronoi diagram of its points and open segments."""

    graph: PlanarGraph  # of the polygons
    diagram: SegmentVoronoiDiagram
    placed: PlacedShapes  # the rings as the graph has them, and what the sites of the diagram are there
    opening: Opening | None = None  # with an open border: the graph is this one's, and what its sites are there


def shape_diagram(polygons: Any, *, strict: bool = False, **run: Unpack[Run]) -> ShapeDiagram:
    """Place polygons and compute their segment Voronoi diagram; arguments and errors as of `skeleton_exact`."""
    return diagram_of_graph(graph_for_skeletons(polygons, strict=strict, **run), **run)


def diagram_of_graph(graph: PlanarGraph, *, interior_only: bool = False, **run: Unpack[Run]) -> ShapeDiagram:
    """Compute the segment Voronoi diagram of polygons that are placed."""
    unwanted = sides_not_interior(graph) if interior_only else None
    return diagram_of_placed(graph, placed_shapes(graph), unwanted=unwanted, **run)


def diagram_of_placed(graph: PlanarGraph, placed: PlacedShapes, **options: Any) -> ShapeDiagram:
    """Compute what `diagram_of_graph` gives; options as of `segment_voronoi`."""
    return ShapeDiagram(graph, segment_voronoi(graph.points, graph.segments, **options), placed)


def sides_not_interior(graph: PlanarGraph) -> NDArray[np.uint8] | None:
    """Tell where there is nothing inside; None if that is not known of a point: a line of one place."""
    is_known = np.bincount(graph.segments.ravel(), minlength=len(graph.points)) > 0
    is_known[graph.point_holes[:, 0]] = True
    if not is_known.all():
        return None
    unwanted = unwanted_sides(graph, graph.is_inside)
    unwanted[graph.point_holes[:, 0]] = 0
    return unwanted


def skeleton_of(
    shapes: ShapeDiagram,
    *,
    side: str = "interior",
    frame: Extent | None = None,
    **run: Unpack[Run],
) -> Skeleton:
    """Delete what is not the skeleton's from the diagram of shapes; arguments as of `skeleton_exact`."""
    check_skeleton_options(side, 0, frame)
    if side != "exterior" and not shapes.graph.is_inside.any():
        warn_empty(shapes.placed.polygons, side)
    made = _on_side(shapes, side, frame, **run)
    return made if side == "exterior" else of_one_arrangement(made)


def of_one_arrangement(skeleton: Skeleton) -> Skeleton:
    """Say that features were taken together, where there are several."""
    feature = skeleton.polygons.feature
    has_several = len(feature) > 0 and feature[0] != feature[-1]
    return replace(skeleton, features="together") if has_several else skeleton


def interior_skeleton(shapes: ShapeDiagram, **run: Unpack[Run]) -> Skeleton:
    """Give the skeleton inside shapes, and no word about it if there is none."""
    return _on_side(shapes, "interior", None, **run)


def _on_side(shapes: ShapeDiagram, side: str, frame: Extent | None, **run: Unpack[Run]) -> Skeleton:
    edges, faces = kept_edges(shapes, **run)
    group = face_groups(shapes.placed, side)[faces]
    kept, clips = group >= 0, side != "interior"
    if shapes.opening is not None:
        kept &= (shapes.opening.site[shapes.diagram.edge_sites[edges]] >= 0).all(axis=1)
    return assembled(shapes, edges[kept], group[kept], frame=frame, clips=clips, **run)


def kept_edges(
    shapes: ShapeDiagram, *, threads: int = 0, progress: Progress = None
) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """Edges of the diagram that are not deleted, and the face of the graph that each is in."""
    return _core.skeleton.skeleton_edges(
        core_diagram(shapes.diagram, shapes.graph.segment_faces), checked_threads(threads), progress
    )


def whole_diagram(shapes: ShapeDiagram, *, frame: Extent | None = None, threads: int = 0) -> Skeleton:
    """Give all edges of the diagram as arcs, cut by a frame: what it is before anything is deleted."""
    check_skeleton_options("both", 0, frame)
    count = len(shapes.diagram.edges)
    everything = assembled(
        shapes,
        np.arange(count, dtype=np.int32),
        np.full(count, len(shapes.placed.polygons), dtype=np.int32),
        frame=frame,
        clips=True,
        joins=False,
        threads=threads,
    )
    return replace(everything, side=np.full(len(everything), -1))


def face_groups(placed: PlacedShapes, side: str) -> NDArray[np.int32]:
    """(f,) the first polygon of each face, their number for faces outside; -1 for those on another side."""
    inside = placed.face_polygon >= 0
    group = np.where(inside, placed.face_polygon, len(placed.polygons)).astype(np.int32)
    if side == "interior":
        group[~inside] = -1
    elif side == "exterior":
        group[inside] = -1
    return group


def joined_groups(placed: PlacedShapes) -> tuple[int, int]:
    """First group of `face_groups` in which arcs that end in one corner are connected there, and the one after last."""
    outside = len(placed.polygons)
    return {8: (0, outside), 4: (outside, outside + 1)}.get(placed.polygons.connectivity or 0, (0, 0))


def assembled(
    shapes: ShapeDiagram,
    edges: NDArray[np.int32],
    group: NDArray[np.int32],
    *,
    frame: Extent | None,
    clips: bool,
    joins: bool = True,
    threads: int = 0,
    progress: Progress = None,
) -> Skeleton:
    """Make a skeleton of edges of a diagram, each in the group of its polygon; those outside are the last group."""
    graph, placed = shapes.graph, shapes.placed
    outside, opening = len(placed.polygons), shapes.opening
    frame = (frame or default_frame(placed.polygons)) if clips else None
    clipped = None if frame is None else (outside, on_lattice(frame, graph))
    if opening is not None:
        frame, clipped = opening.frame, (EVERY_GROUP, opening.box)
    made: dict[str, Any] = _core.skeleton.extract_skeleton(
        core_diagram(shapes.diagram),
        edges,
        group,
        clipped,
        joined_groups(placed) if joins else (0, 0),
        *graph.origin,
        graph.scale,
        checked_threads(threads),
        progress,
    )
    if opening is not None:
        made["sites"] = opening.site[made["sites"]]
    skeleton = skeleton_of_arrays({**made, "error_bound": np.zeros(len(made["arcs"]))}, graph, placed, frame)
    return skeleton if opening is None else replace(skeleton, border="open")


def skeleton_of_arrays(
    made: dict[str, Any], graph: PlanarGraph, placed: PlacedShapes, frame: Extent | None
) -> Skeleton:
    """Put a skeleton together from the arrays of the core, in which the polygons of arcs are groups."""
    outside = len(placed.polygons)
    vertices, cut = made["vertices"], made.pop("frame_side")
    if frame is not None:  # rounding must not move what was cut off the frame
        x, y, w, h = frame
        for number, (axis, value) in enumerate(((0, x), (0, x + w), (1, y), (1, y + h))):
            vertices[cut == number, axis] = value
    polygon = made.pop("group")
    is_outside = polygon == outside
    polygon[is_outside] = -1
    return Skeleton(
        **made,
        site_table=placed.sites,
        polygon=polygon,
        side=np.where(is_outside, EXTERIOR, INTERIOR).astype(np.int8),
        polygons=placed.polygons,
        frame=frame,
        origin=graph.origin,
        scale=graph.scale,
    )


def on_lattice(frame: Extent, graph: PlanarGraph) -> tuple[float, float, float, float]:
    """Least and most x, then least and most y."""
    x, y, w, h = frame
    (origin_x, origin_y), scale = graph.origin, graph.scale
    return (
        (x - origin_x) / scale,
        (x + w - origin_x) / scale,
        (y - origin_y) / scale,
        (y + h - origin_y) / scale,
    )


def warn_empty(polygons: PolygonSet, side: str) -> None:
    """Say why there is no interior; with both sides, that of open lines is not missed."""
    if not len(polygons):
        reason = "the input holds no polygons"
    elif polygons.is_line.all():
        if side == "both":
            return
        exterior = option("--side exterior", 'side="exterior"')
        reason = f"open lines have no interior: close them, or use {exterior} for the skeleton around them"
    else:
        reason = "no polygon has an area"
    message = Message(f"the interior skeleton is empty: {reason}", Kind.EMPTY_RESULT)
    warn(VorotoolWarning(message))


def warn_all_cut() -> None:
    """Say that there is no axis in the rectangle whose border is open."""
    reason = "no point inside the open border lies between two parts of an outline"
    warn(VorotoolWarning(Message(f"the interior skeleton is empty: {reason}", Kind.EMPTY_RESULT)))


ROOM = 1.25
"""Of the sides of the rectangle together: how far around it the lattice has places. What is put away is as far as both
sides, so that no place in the rectangle is nearer to it than to anything else."""

SNAP = 2.0**-19
"""Of a step of the lattice: vertices of a diagram are right to fewer of its last places, so that those as near to the
border are on it. Where an outline ends, the axis has one there."""

OUTWARDS = np.array([[-1, 0], [1, 0], [0, -1], [0, 1]], dtype=np.int64)
"""From the sides of least and most x, then y."""


@frozen(eq=False)
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
    number = ranks_of(kept_points, count)
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
            hand = np.where(crosses(out, along) > 0, 0, 1)
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
