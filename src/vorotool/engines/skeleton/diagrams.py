"""What skeletons are made of: the diagrams of single features, or that of all of them, with or without a gap."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from vorotool.engines.arrangement.planar_graph import graph_for_skeletons
from vorotool.engines.features.batches import together
from vorotool.engines.skeleton.both_sides import sides_of
from vorotool.engines.skeleton.contraction import without_equal_nodes
from vorotool.engines.skeleton.exact import ShapeDiagram, diagram_of_graph, skeleton_of, whole_diagram
from vorotool.engines.skeleton.feature_elements import feature_elements, sides_of_elements
from vorotool.engines.skeleton.per_feature import FeatureSkeleton, Seen, feature_skeleton
from vorotool.engines.skeleton.shortened_edges import (
    ElementDiagram,
    elements_of_graph,
    skeleton_of_elements,
    whole_element_diagram,
)
from vorotool.numeric.progress import Progress
from vorotool.types.box import Extent
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.skeleton.skeleton import Skeleton

AnyDiagram = ShapeDiagram | ElementDiagram


def is_of_single_features(side: str, features: str) -> bool:
    """Whether a skeleton takes no diagram of all features: `skeleton_inside` makes it."""
    return side == "interior" and features == "separate"


def skeleton_inside(
    polygons: PolygonSet,
    gap: float = 0.0,
    *,
    complete: bool = True,
    look: Callable[[AnyDiagram, Skeleton], Seen] | None = None,
    border: Extent | None = None,
    strict: bool = False,
    threads: int = 0,
    progress: Progress = None,
) -> FeatureSkeleton[Seen]:
    """Compute the skeleton inside each feature by itself."""
    common: dict[str, Any] = {"look": look, "strict": strict, "threads": threads, "progress": progress}
    if gap:
        found = feature_elements(polygons, gap, complete=complete, **common)
    else:
        found = feature_skeleton(polygons, border=border, **common)
    return replace(found, skeleton=without_equal_nodes(found.skeleton))


def diagram_of_all(
    polygons: PolygonSet,
    gap: float = 0.0,
    *,
    features: str,
    interior_only: bool = False,
    strict: bool = False,
    threads: int = 0,
    progress: Progress = None,
) -> AnyDiagram:
    """Compute the diagram of all features; arguments, errors and warnings as of `vorotool.skeleton_exact`."""
    graph_of = graph_for_skeletons if features == "together" else together
    graph = graph_of(polygons, strict=strict, threads=threads, progress=progress)
    if gap:
        return elements_of_graph(graph, gap, threads=threads, progress=progress)
    return diagram_of_graph(graph, interior_only=interior_only, threads=threads, progress=progress)


def skeleton_in(
    diagram: AnyDiagram,
    *,
    side: str,
    features: str,
    complete: bool = True,
    frame: Extent | None = None,
    threads: int = 0,
    progress: Progress = None,
) -> Skeleton:
    """Take the skeleton out of the diagram of all features; arguments as of `vorotool.skeleton_exact`."""
    is_one = features == "together"
    if isinstance(diagram, ShapeDiagram):
        of_shapes = skeleton_of if is_one else sides_of
        made = of_shapes(diagram, side=side, frame=frame, threads=threads, progress=progress)
    else:
        of_elements = skeleton_of_elements if is_one else sides_of_elements
        made = of_elements(diagram, side=side, complete=complete, frame=frame, threads=threads, progress=progress)
    return without_equal_nodes(made)


def all_edges(diagram: AnyDiagram, *, frame: Extent | None = None, threads: int = 0) -> Skeleton:
    """Give all edges of a diagram as arcs, cut by a frame: what it is before anything is deleted."""
    if isinstance(diagram, ShapeDiagram):
        return without_equal_nodes(whole_diagram(diagram, frame=frame, threads=threads))
    return without_equal_nodes(whole_element_diagram(diagram, frame=frame, threads=threads))
