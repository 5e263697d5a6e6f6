"""Exact skeletons from the Voronoi diagram of line segments (paper, section 3.2)."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.arrangement.planar_graph import graph_for_skeletons
from vorotool.engines.arrangement.repaired_polygons import PlacedShapes, placed_shapes
from vorotool.engines.segment_voronoi.segment_voronoi import core_diagram, segment_voronoi, unwanted_sides
from vorotool.engines.skeleton.open_border import Opening
from vorotool.errors import Kind, Message, UsageError, VorotoolWarning, option, warn
from vorotool.numeric.checks import checked_threads, is_choice
from vorotool.numeric.numbers import finite_double, shown_number
from vorotool.numeric.parallel import Progress
from vorotool.plain import plain
from vorotool.types.box import Extent, default_frame, is_extent
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
        raise UsageError(f"the side is {side!r}: use {', '.join(SIDE_NAMES)}")
    if finite_double(gap, "the gap") < 0:
        raise UsageError(f"the gap is {shown_number(gap)}: use a length of 0 or more")
    if frame is not None and not is_extent(frame):
        raise UsageError(f"the frame is {frame}: use X, Y, W, H with W and H above 0")


def check_features(features: str) -> None:
    """Raise UsageError for what tells not how features are taken."""
    if not is_choice(features, FEATURES):
        raise UsageError(f"features is {features!r}: use {' or '.join(FEATURES)}")


@plain(eq=False)
class ShapeDiagram:
    """Polygons made a planar graph, and the Voronoi diagram of its points and open segments."""

    graph: PlanarGraph  # of the polygons
    diagram: SegmentVoronoiDiagram
    placed: PlacedShapes  # the rings as the graph has them, and what the sites of the diagram are there
    opening: Opening | None = None  # with an open border: the graph is this one's, and what its sites are there


def shape_diagram(polygons: Any, *, strict: bool = False, threads: int = 0, progress: Progress = None) -> ShapeDiagram:
    """Place polygons and compute their segment Voronoi diagram; arguments and errors as of `skeleton_exact`."""
    threads = checked_threads(threads)
    graph = graph_for_skeletons(polygons, strict=strict, threads=threads, progress=progress)
    return diagram_of_graph(graph, threads=threads, progress=progress)


def diagram_of_graph(
    graph: PlanarGraph, *, interior_only: bool = False, threads: int = 0, progress: Progress = None
) -> ShapeDiagram:
    """Compute the segment Voronoi diagram of polygons that are placed."""
    threads = checked_threads(threads)
    unwanted = sides_not_interior(graph) if interior_only else None
    placed = placed_shapes(graph, threads=threads)
    return diagram_of_placed(graph, placed, unwanted=unwanted, threads=threads, progress=progress)


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
    threads: int = 0,
    progress: Progress = None,
) -> Skeleton:
    """Delete what is not the skeleton's from the diagram of shapes; arguments as of `skeleton_exact`."""
    check_skeleton_options(side, 0, frame)
    threads = checked_threads(threads)
    if side != "exterior" and not shapes.graph.is_inside.any():
        warn_empty(shapes.placed.polygons, side)
    made = _on_side(shapes, side, frame, threads, progress)
    return made if side == "exterior" else of_one_arrangement(made)


def of_one_arrangement(skeleton: Skeleton) -> Skeleton:
    """Say that features were taken together, where there are several."""
    feature = skeleton.polygons.feature
    assert feature is not None
    has_several = len(feature) > 0 and feature[0] != feature[-1]
    return replace(skeleton, features="together") if has_several else skeleton


def interior_skeleton(shapes: ShapeDiagram, *, threads: int = 1, progress: Progress = None) -> Skeleton:
    """Give the skeleton inside shapes, and no word about it if there is none."""
    return _on_side(shapes, "interior", None, threads, progress)


def _on_side(shapes: ShapeDiagram, side: str, frame: Extent | None, threads: int, progress: Progress) -> Skeleton:
    edges, faces = kept_edges(shapes, threads=threads, progress=progress)
    group = face_groups(shapes.placed, side)[faces]
    kept, clips = group >= 0, side != "interior"
    if shapes.opening is not None:
        kept &= (shapes.opening.site[shapes.diagram.edge_sites[edges]] >= 0).all(axis=1)
    return assembled(shapes, edges[kept], group[kept], frame=frame, clips=clips, threads=threads, progress=progress)


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
        threads=checked_threads(threads),
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
    threads: int,
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
        threads,
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
        reason = "open lines have no interior: use " + option("--side exterior", 'side="exterior"')
    else:
        reason = "no polygon has an area"
    message = Message(f"the interior skeleton is empty: {reason}", Kind.EMPTY_RESULT)
    warn(VorotoolWarning(message))


def warn_all_cut() -> None:
    """Say that there is no axis in the rectangle whose border is open."""
    reason = "no point inside the open border lies between two parts of an outline"
    warn(VorotoolWarning(Message(f"the interior skeleton is empty: {reason}", Kind.EMPTY_RESULT)))
