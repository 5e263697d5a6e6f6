"""The diagrams of skeletons: of single features or of all of them, with or without a gap."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from vorotool.engines.arrangement.planar_graph import arranged, graph_for_skeletons, placed_vertices
from vorotool.engines.arrangement.repaired_polygons import placed_shapes
from vorotool.engines.features.batches import BatchShapes, FeatureShapes, in_batches, together
from vorotool.engines.features.order import InputOrder
from vorotool.engines.skeleton.both_sides import joined_sides, sides_of
from vorotool.engines.skeleton.contraction import without_equal_nodes
from vorotool.engines.skeleton.exact import ShapeDiagram, diagram_of_graph, skeleton_of, warn_empty, whole_diagram
from vorotool.engines.skeleton.per_feature import FeatureSkeleton, Seen, feature_skeleton, joined_skeletons
from vorotool.engines.skeleton.shortened_edges import (
    ElementDiagram,
    ShortEdges,
    elements_of_graph,
    elements_of_shapes,
    skeleton_of_elements,
    whole_element_diagram,
)
from vorotool.errors import VorotoolWarning
from vorotool.numeric.numbers import distinct
from vorotool.numeric.parallel import Progress
from vorotool.types.box import Extent, bounds
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


def feature_elements(
    polygons: PolygonSet,
    gap: float,
    *,
    complete: bool = True,
    look: Callable[[ElementDiagram, Skeleton], Seen] | None = None,
    strict: bool = False,
    threads: int = 0,
    progress: Progress = None,
) -> FeatureSkeleton[Seen]:
    """Compute the skeleton inside polygons by the paper's decomposition of each feature alone."""

    def work(shapes: BatchShapes, threads: int, poll: Progress) -> tuple[ShortEdges, list[tuple[Skeleton, list[Seen]]]]:
        short = ShortEdges.of(shapes.graph, gap)
        if len(short):  # which of all is the first is known when all are there
            return short, []
        batch = shapes.batch
        within = np.stack(bounds(np.concatenate([batch.placement.vertices, batch.beyond])))
        common: dict[str, Any] = {"threads": threads, "progress": poll}
        feature = None if look is not None else shapes.feature_of_point
        elements = elements_of_shapes(shapes.graph, shapes.placed, gap, within=within, feature=feature, **common)
        made = skeleton_of_elements(elements, complete=complete, **common)
        return short, [(made, [] if look is None else [look(elements, made)])]

    alone = look is not None
    whole, made = in_batches(polygons, work, alone=alone, strict=strict, threads=threads, progress=progress)
    _refuse(whole, [(shapes, short) for shapes, (short, _) in made], gap)
    if not whole.polygon_count:
        warn_empty(polygons, "interior")
    parts = [(shapes, *found) for shapes, (_, results) in made for found in results]
    skeleton = joined_skeletons(whole, [(shapes, skeleton) for shapes, skeleton, _ in parts])
    return FeatureSkeleton(
        replace(skeleton, gap=gap, features="separate"), whole, [one for _, _, seen in parts for one in seen]
    )


def _refuse(whole: FeatureShapes, parts: Sequence[tuple[BatchShapes, ShortEdges]], gap: float) -> None:
    """Raise InputError if features have edges that nothing would be left of, naming the first along the input."""
    if not any(len(short) for _, short in parts):
        return
    order = InputOrder.of(whole, [shapes for shapes, _ in parts])
    numbers = [own[short.site] for own, (_, short) in zip(order.site_numbers, parts, strict=True)]
    short = ShortEdges(
        np.concatenate(numbers),
        np.concatenate([short.ends for _, short in parts]),
        np.concatenate([short.length for _, short in parts]),
    )
    short.refuse(order.polygons, order.site_table, gap)


def sides_of_elements(
    elements: ElementDiagram,
    *,
    side: str,
    complete: bool = True,
    frame: Extent | None = None,
    threads: int = 0,
    progress: Progress = None,
) -> Skeleton:
    """Give what is outside of the features of one arrangement, and what is inside each of them by itself."""
    common: dict[str, Any] = {"threads": threads, "progress": progress}
    polygons = elements.shapes.polygons
    assert polygons is not None
    assert polygons.feature is not None
    if side == "exterior" or len(distinct(polygons.feature)) < 2:
        made = skeleton_of_elements(elements, side=side, complete=complete, frame=frame, **common)
        return replace(made, features="separate")
    with warnings.catch_warnings(
        action="ignore", category=VorotoolWarning
    ):  # repairs were told where all were put together
        inside = feature_elements(polygons, elements.gap, complete=complete, **common).skeleton
    if not len(inside):
        warn_empty(polygons, side)
    graph = arranged(inside.polygons, placed_vertices(inside.polygons, **common), progress=progress).graph
    placed = placed_shapes(graph, threads=threads)
    # outlines of pixels are cut where only neighbors meet, and stay outlines of pixels
    placed = replace(placed, polygons=replace(placed.polygons, connectivity=inside.polygons.connectivity))
    ShortEdges.of(graph, elements.gap).refuse(placed.polygons, placed.sites, elements.gap)
    again = elements_of_shapes(graph, placed, elements.gap, **common)
    outside = skeleton_of_elements(again, side="exterior", complete=complete, frame=frame, **common)
    return joined_sides(inside, outside, placed, graph)
