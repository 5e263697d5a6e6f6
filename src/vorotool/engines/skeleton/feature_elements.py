"""Skeletons with a gap: what is inside each feature as if it were alone, what is outside of all together."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from vorotool.engines.arrangement.lattice_rings import placed_shapes
from vorotool.engines.arrangement.planar_graph import arranged, placed_vertices
from vorotool.engines.features.batches import BatchShapes, FeatureShapes, in_batches
from vorotool.engines.features.order import InputOrder
from vorotool.engines.skeleton.both_sides import joined_sides
from vorotool.engines.skeleton.exact import warn_empty
from vorotool.engines.skeleton.per_feature import FeatureSkeleton, Seen, joined_skeletons
from vorotool.engines.skeleton.short_edges import ShortEdges
from vorotool.engines.skeleton.shortened_edges import (
    ElementDiagram,
    elements_of_shapes,
    skeleton_of_elements,
)
from vorotool.errors import VorotoolWarning
from vorotool.numeric.progress import Progress
from vorotool.numeric.sorted_sets import distinct
from vorotool.types.box import Extent, bounds
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.skeleton.skeleton import Skeleton


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
