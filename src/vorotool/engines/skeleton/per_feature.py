"""Skeletons inside features, each as if it were alone: made batch by batch, and put together in the order of all."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.features.batches import BatchShapes, FeatureShapes, in_batches
from vorotool.engines.features.order import InputOrder, Places, stacked
from vorotool.engines.segment_voronoi.segment_voronoi import NEITHER, segment_voronoi
from vorotool.engines.skeleton.exact import (
    ShapeDiagram,
    interior_skeleton,
    sides_not_interior,
    warn_all_cut,
    warn_empty,
)
from vorotool.engines.skeleton.open_border import around, opened
from vorotool.numeric.arrays import starts_of
from vorotool.numeric.parallel import Progress
from vorotool.plain import plain
from vorotool.types.box import Extent
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.skeleton.skeleton import Skeleton

Seen = TypeVar("Seen")


@plain(eq=False)
class FeatureSkeleton(Generic[Seen]):
    """The skeleton inside features."""

    skeleton: Skeleton  # of all of them, in their order
    shapes: FeatureShapes
    seen: list[Seen]  # what was seen of the diagram of each batch, if anybody looked


def feature_skeleton(
    polygons: PolygonSet,
    *,
    look: Callable[[ShapeDiagram, Skeleton], Seen] | None = None,
    border: Extent | None = None,
    strict: bool = False,
    threads: int = 0,
    progress: Progress = None,
) -> FeatureSkeleton[Seen]:
    """Compute the skeleton inside polygons, in which each feature is what it would be alone on the lattice of all."""

    def work(shapes: BatchShapes, threads: int, poll: Progress) -> tuple[Skeleton, list[Seen]]:
        diagram = batch_diagram(shapes, border=border, is_whole=look is not None, threads=threads, progress=poll)
        made = interior_skeleton(diagram, threads=threads, progress=poll)
        own = made if border is not None else _without_beyond(made, shapes)
        return own, [] if look is None else [look(diagram, made)]

    room = None if border is None else around(border)
    whole, made = in_batches(polygons, work, around=room, strict=strict, threads=threads, progress=progress)
    if not whole.polygon_count:
        warn_empty(polygons, "interior")
    skeleton = joined_skeletons(whole, [(shapes, skeleton) for shapes, (skeleton, _) in made])
    if border is not None:
        skeleton = replace(skeleton, frame=border, border="open")
        if whole.polygon_count and not len(skeleton):
            warn_all_cut()
    return FeatureSkeleton(skeleton, whole, [one for _, (_, seen) in made for one in seen])


def batch_diagram(
    shapes: BatchShapes,
    *,
    border: Extent | None = None,
    is_whole: bool = False,
    threads: int = 0,
    progress: Progress = None,
) -> ShapeDiagram:
    """Compute the diagram of a batch; the corners of the bounds of all are sites of it, after its other points."""
    if border is not None:
        return _opened_diagram(shapes, border, is_whole, threads, progress)
    graph, beyond = shapes.graph, shapes.batch.beyond
    count = len(graph.points)
    points = np.concatenate([graph.points, beyond])
    unwanted = None if is_whole else sides_not_interior(graph)
    if unwanted is not None:
        unwanted = np.insert(unwanted, count, np.full(len(beyond), NEITHER, dtype=np.uint8))
    diagram = segment_voronoi(points, graph.segments, unwanted=unwanted, threads=threads, progress=progress)
    return ShapeDiagram(graph, diagram, shapes.placed)


def _opened_diagram(
    shapes: BatchShapes, border: Extent, is_whole: bool, threads: int, progress: Progress
) -> ShapeDiagram:
    opening = opened(shapes.graph, border)
    graph = opening.graph
    diagram = segment_voronoi(
        graph.points,
        graph.segments,
        unwanted=None if is_whole else sides_not_interior(graph),
        within=opening.within,
        threads=threads,
        progress=progress,
    )
    return ShapeDiagram(graph, opening.snapped(diagram), shapes.placed, opening)


def _without_beyond(made: Skeleton, shapes: BatchShapes) -> Skeleton:
    """Give sites the numbers of the graph: no arc inside is beside what is beyond everything."""
    is_segment = made.sites >= len(shapes.graph.points)
    return replace(made, sites=made.sites - is_segment * np.int32(len(shapes.batch.beyond)))


def joined_skeletons(whole: FeatureShapes, parts: Sequence[tuple[BatchShapes, Skeleton]]) -> Skeleton:
    """Put the skeletons of all batches together: arcs polygon by polygon, sites in the order of the input."""
    return joined_with_places(whole, parts)[0]


def joined_with_places(whole: FeatureShapes, parts: Sequence[tuple[BatchShapes, Skeleton]]) -> tuple[Skeleton, Places]:
    """Put the skeletons of all batches together, and tell where the arcs come."""
    order = InputOrder.of(whole, [shapes for shapes, _ in parts])
    skeletons = [skeleton for _, skeleton in parts]
    if len(parts) == 1 and not any(whole.repairs.values()):  # in order already
        return replace(skeletons[0], site_table=order.site_table, polygons=order.polygons), Places(None)
    own = [numbers[skeleton.polygon] for numbers, skeleton in zip(order.polygon_numbers, skeletons, strict=True)]
    polygon = stacked(own).astype(np.int32)
    arcs, nodes = Places.by(polygon), Places.by(stacked(_node_polygons(skeletons, own)))
    columns: dict[str, Any] = {
        name: places.arranged([_empty_like(name), *(getattr(skeleton, name) for skeleton in skeletons)])
        for places, names in ((arcs, ("control", "side", "length", "error_bound")), (nodes, ("vertices", "radius")))
        for name in names
    }
    first = starts_of([len(skeleton.radius) for skeleton in skeletons]).tolist()
    pairs = np.empty((0, 2), dtype=np.int32)
    ends = [pairs, *(skeleton.arcs + np.int32(node) for skeleton, node in zip(skeletons, first, strict=False))]
    sites = [numbers[skeleton.sites] for numbers, skeleton in zip(order.site_numbers, skeletons, strict=True)]
    made = Skeleton(
        **columns,
        arcs=nodes.numbers(arcs.arranged(ends)),
        sites=arcs.arranged([pairs, *sites]),
        site_table=order.site_table,
        polygon=arcs.arranged([polygon]),
        branch=_branches(arcs, skeletons),
        polygons=order.polygons,
        **{name: getattr(skeleton, name) for name in ("origin", "scale") for skeleton in skeletons[:1]},
    )
    return made, arcs


def _empty_like(name: str) -> NDArray[Any]:
    """No values: where there are no batches there is nothing else."""
    shape = (0, 2) if name in ("control", "vertices") else (0,)
    return np.empty(shape, dtype=np.int8 if name == "side" else np.float64)


def _node_polygons(skeletons: Sequence[Skeleton], polygons: Sequence[NDArray[np.int32]]) -> list[NDArray[np.int32]]:
    """The polygon of each node of each batch."""
    found = []
    for skeleton, polygon in zip(skeletons, polygons, strict=True):
        own = np.zeros(len(skeleton.radius), dtype=np.int32)
        own[skeleton.arcs] = polygon[:, None]
        found.append(own)
    return found


def _branches(arcs: Places, skeletons: Sequence[Skeleton]) -> NDArray[np.int32]:
    """(a,) branches in their new order: none is in two polygons."""
    begins = [np.diff(skeleton.branch, prepend=-1) != 0 for skeleton in skeletons]
    return (np.cumsum(arcs.arranged([np.empty(0, dtype=bool), *begins])) - 1).astype(np.int32)
