"""The diagrams of skeletons: of single features or all of them, with or without a gap, inside, outside or both."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Generic, TypeAlias, TypeVar, Unpack

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.arrangement.planar_graph import arranged, graph_for_skeletons, placed_vertices
from vorotool.engines.arrangement.repaired_polygons import PlacedShapes, given_shapes, placed_shapes
from vorotool.engines.features.batches import BatchShapes, FeatureShapes, are_apart, in_batches, together
from vorotool.engines.features.order import InputOrder, Places, stacked
from vorotool.engines.segment_voronoi.segment_voronoi import NEITHER, segment_voronoi
from vorotool.engines.skeleton.exact import (
    ShapeDiagram,
    around,
    diagram_of_graph,
    diagram_of_placed,
    interior_skeleton,
    opened,
    sides_not_interior,
    skeleton_of,
    warn_all_cut,
    warn_empty,
    whole_diagram,
)
from vorotool.engines.skeleton.parts import PER_ARC, without_equal_nodes
from vorotool.errors import silent
from vorotool.frozen import frozen
from vorotool.numeric.arrays import starts_of
from vorotool.numeric.numbers import distinct
from vorotool.numeric.parallel import Run
from vorotool.products.formats import resolved
from vorotool.types.box import Extent, bounds
from vorotool.types.fields import with_fitting
from vorotool.types.polygons.planar_graph import PlanarGraph
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.skeleton.segment_voronoi import EDGE, SiteTable
from vorotool.types.skeleton.skeleton import Skeleton

if TYPE_CHECKING:
    from vorotool.engines.skeleton.shortened_edges import ElementDiagram, ShortEdges

_SHORTENED = "engines.skeleton.shortened_edges"
"""What is only needed with a gap."""

Seen = TypeVar("Seen")


@frozen(eq=False)
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
    **run: Unpack[Run],
) -> FeatureSkeleton[Seen]:
    """Compute the skeleton inside polygons, in which each feature is what it would be alone on the lattice of all."""

    def work(shapes: BatchShapes, run: Run) -> tuple[Skeleton, list[Seen]]:
        diagram = batch_diagram(shapes, border=border, is_whole=look is not None, **run)
        made = interior_skeleton(diagram, **run)
        own = made if border is not None else _without_beyond(made, shapes)
        return own, [] if look is None else [look(diagram, made)]

    room = None if border is None else around(border)
    whole, made = in_batches(polygons, work, around=room, strict=strict, **run)
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
    **run: Unpack[Run],
) -> ShapeDiagram:
    """Compute the diagram of a batch; the corners of the bounds of all are sites of it, after its other points."""
    if border is not None:
        return _opened_diagram(shapes, border, is_whole, **run)
    graph, beyond = shapes.graph, shapes.batch.beyond
    count = len(graph.points)
    points = np.concatenate([graph.points, beyond])
    unwanted = None if is_whole else sides_not_interior(graph)
    if unwanted is not None:
        unwanted = np.insert(unwanted, count, np.full(len(beyond), NEITHER, dtype=np.uint8))
    diagram = segment_voronoi(points, graph.segments, unwanted=unwanted, **run)
    return ShapeDiagram(graph, diagram, shapes.placed)


def _opened_diagram(shapes: BatchShapes, border: Extent, is_whole: bool, **run: Unpack[Run]) -> ShapeDiagram:
    opening = opened(shapes.graph, border)
    graph = opening.graph
    diagram = segment_voronoi(
        graph.points,
        graph.segments,
        unwanted=None if is_whole else sides_not_interior(graph),
        within=opening.within,
        **run,
    )
    return ShapeDiagram(graph, opening.snapped(diagram), shapes.placed, opening)


def _without_beyond(made: Skeleton, shapes: BatchShapes) -> Skeleton:
    """Give sites the numbers of the graph: no arc inside is beside what is beyond everything."""
    if not len(shapes.batch.beyond):
        return made
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
        return with_fitting(skeletons[0], site_table=order.site_table, polygons=order.polygons), Places(None)
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


AnyDiagram: TypeAlias = "ShapeDiagram | ElementDiagram"


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
    **run: Unpack[Run],
) -> FeatureSkeleton[Seen]:
    """Compute the skeleton inside each feature by itself."""
    found = skeleton_of_features(polygons, gap, complete=complete, border=border, look=look, strict=strict, **run)
    return replace(found, skeleton=without_equal_nodes(found.skeleton))


def skeleton_of_features(
    polygons: PolygonSet, gap: float, *, complete: bool, border: Extent | None = None, **common: Any
) -> FeatureSkeleton[Any]:
    """Compute what `skeleton_inside` gives, with the arcs that rounding leaves no length of."""
    if gap:
        return feature_elements(polygons, gap, complete=complete, **common)
    return feature_skeleton(polygons, border=border, **common)


def diagram_of_all(
    polygons: PolygonSet,
    gap: float = 0.0,
    *,
    features: str,
    interior_only: bool = False,
    strict: bool = False,
    **run: Unpack[Run],
) -> AnyDiagram:
    """Compute the diagram of all features; arguments, errors and warnings as of `vorotool.skeleton_exact`."""
    graph_of = graph_for_skeletons if features == "together" else together
    graph = graph_of(polygons, strict=strict, **run)
    if gap:
        return resolved(f"{_SHORTENED}:elements_of_graph")(graph, gap, **run)
    return diagram_of_graph(graph, interior_only=interior_only, **run)


def skeleton_in(
    diagram: AnyDiagram,
    *,
    side: str,
    features: str,
    complete: bool = True,
    frame: Extent | None = None,
    **run: Unpack[Run],
) -> Skeleton:
    """Take the skeleton out of the diagram of all features; arguments as of `vorotool.skeleton_exact`."""
    wanted: dict[str, Any] = {"side": side, "complete": complete, "frame": frame}
    of_diagram = _skeleton_of if features == "together" else sides_of
    return without_equal_nodes(of_diagram(diagram, **wanted, **run))


def _skeleton_of(diagram: AnyDiagram, *, complete: bool, **wanted: Any) -> Skeleton:
    if isinstance(diagram, ShapeDiagram):
        return skeleton_of(diagram, **wanted)
    return resolved(f"{_SHORTENED}:skeleton_of_elements")(diagram, complete=complete, **wanted)


def all_edges(diagram: AnyDiagram, *, frame: Extent | None = None, threads: int = 0) -> Skeleton:
    """Give all edges of a diagram as arcs, cut by a frame: what it is before anything is deleted."""
    if isinstance(diagram, ShapeDiagram):
        return without_equal_nodes(whole_diagram(diagram, frame=frame, threads=threads))
    whole_element_diagram = resolved(f"{_SHORTENED}:whole_element_diagram")
    return without_equal_nodes(whole_element_diagram(diagram, frame=frame, threads=threads))


def feature_elements(
    polygons: PolygonSet,
    gap: float,
    *,
    complete: bool = True,
    look: Callable[[ElementDiagram, Skeleton], Seen] | None = None,
    strict: bool = False,
    **run: Unpack[Run],
) -> FeatureSkeleton[Seen]:
    """Compute the skeleton inside polygons by the paper's decomposition of each feature alone."""
    from vorotool.engines.skeleton.shortened_edges import ShortEdges, elements_of_shapes, skeleton_of_elements

    def work(shapes: BatchShapes, run: Run) -> tuple[ShortEdges, list[tuple[Skeleton, list[Seen]]]]:
        short = ShortEdges.of(shapes.graph, gap)
        if len(short):  # which of all is the first is known when all are there
            return short, []
        batch = shapes.batch
        within = np.stack(bounds(np.concatenate([batch.placement.vertices, batch.beyond])))
        feature = None if look is not None else shapes.feature_of_point
        elements = elements_of_shapes(shapes.graph, shapes.placed, gap, within=within, feature=feature, **run)
        made = skeleton_of_elements(elements, complete=complete, **run)
        return short, [(made, [] if look is None else [look(elements, made)])]

    alone = look is not None
    whole, made = in_batches(polygons, work, alone=alone, strict=strict, **run)
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
    from vorotool.engines.skeleton.shortened_edges import ShortEdges

    order = InputOrder.of(whole, [shapes for shapes, _ in parts])
    numbers = [own[short.site] for own, (_, short) in zip(order.site_numbers, parts, strict=True)]
    short = ShortEdges(
        np.concatenate(numbers),
        np.concatenate([short.ends for _, short in parts]),
        np.concatenate([short.length for _, short in parts]),
    )
    short.refuse(order.polygons, order.site_table, gap)


def sides_of(
    diagram: AnyDiagram,
    *,
    side: str,
    complete: bool = True,
    frame: Extent | None = None,
    **run: Unpack[Run],
) -> Skeleton:
    """Give what is outside of the features of one arrangement, and what is inside each of them by itself."""
    wanted: dict[str, Any] = {"complete": complete, "frame": frame, **run}
    if side == "exterior" or _are_alone(diagram):
        return replace(_skeleton_of(diagram, side=side, **wanted), features="separate")
    gap, of_shapes = (0.0, diagram.graph) if isinstance(diagram, ShapeDiagram) else (diagram.gap, diagram.shapes)
    polygons, _ = given_shapes(of_shapes)
    with silent():  # repairs were told where all were put together
        inside = skeleton_of_features(polygons, gap, complete=complete, **run).skeleton
    if not len(inside):
        warn_empty(polygons, side)
    graph = arranged(inside.polygons, placed_vertices(inside.polygons, **run), progress=run.get("progress")).graph
    placed = placed_shapes(graph)
    # outlines of pixels are cut where only neighbors meet, and stay outlines of pixels
    placed = replace(placed, polygons=replace(placed.polygons, connectivity=inside.polygons.connectivity))
    again: AnyDiagram
    if gap:
        from vorotool.engines.skeleton.shortened_edges import ShortEdges, elements_of_shapes

        ShortEdges.of(graph, gap).refuse(placed.polygons, placed.sites, gap)
        again = elements_of_shapes(graph, placed, gap, **run)
    else:
        again = diagram_of_placed(graph, placed, **run)
    return joined_sides(inside, _skeleton_of(again, side="exterior", **wanted), placed, graph)


def _are_alone(diagram: AnyDiagram) -> bool:
    """Whether each feature is as if there were no others."""
    if isinstance(diagram, ShapeDiagram):
        return are_apart(diagram.graph)
    return len(distinct(given_shapes(diagram.shapes)[0].feature)) < 2


def joined_sides(inside: Skeleton, outside: Skeleton, placed: PlacedShapes, graph: PlanarGraph) -> Skeleton:
    """Put what is inside features and what is outside of all into one skeleton."""
    sites, shift = joined_sites(inside.polygons, inside.site_table, placed, graph)
    nodes, branches = len(inside.vertices), int(inside.branch.max(initial=-1)) + 1
    moved = {
        "arcs": outside.arcs + np.int32(nodes),
        "sites": outside.sites + np.int32(shift),
        "branch": outside.branch + np.int32(branches),
    }
    columns: dict[str, Any] = {
        name: np.concatenate([getattr(inside, name), moved.get(name, getattr(outside, name))])
        for name in (*PER_ARC, "vertices", "radius")
    }
    return replace(inside, **columns, site_table=sites, frame=outside.frame)


def joined_sites(
    polygons: PolygonSet, table: SiteTable, placed: PlacedShapes, graph: PlanarGraph
) -> tuple[SiteTable, int]:
    """Sites of features, followed by those of an arrangement of their polygons if these are others."""
    if placed.polygons.xy.tobytes() == polygons.xy.tobytes() and _are_equal(placed.sites, table):
        return table, 0
    own = _on_polygons(polygons, table, graph)
    ends = np.full((len(table), 2, 2), np.nan)
    assert own.ends is not None
    columns: dict[str, Any] = {
        name: np.concatenate([getattr(table, name), getattr(own, name)])
        for name in ("kind", "polygon", "ring", "index", "source_ring", "source_index")
    }
    return SiteTable(**columns, ends=np.concatenate([ends, own.ends])), len(table)


def _are_equal(one: SiteTable, other: SiteTable) -> bool:
    return all(
        np.array_equal(getattr(one, name), getattr(other, name)) for name in ("kind", "polygon", "ring", "index")
    )


def _on_polygons(polygons: PolygonSet, table: SiteTable, graph: PlanarGraph) -> SiteTable:
    """Sites of an arrangement, each at a vertex of its polygons or on the edge after it, with its ends."""
    count = len(graph.points)
    edge = graph.source_edge[graph.source_starts[:-1]].astype(np.int64)
    beside = np.zeros(count, dtype=np.int64)  # an edge that ends at each point
    beside[graph.segments] = edge[:, None]
    vertex = np.concatenate([np.where(graph.point_vertex >= 0, graph.point_vertex, beside), edge])
    kind = np.repeat([1 - EDGE, EDGE], [count, len(edge)]).astype(np.int8)
    ring = np.searchsorted(polygons.ring_starts, vertex, side="right") - 1
    polygon = polygons.ring_polygon[ring]
    index = (vertex - polygons.ring_starts[ring]).astype(np.int32)
    places = graph.coordinates()
    ends = np.concatenate([np.repeat(places[:, None], 2, axis=1), places[graph.segments]])
    source = _sources(polygons, table)[kind, vertex]
    source[:count][graph.point_vertex < 0] = -1
    first = polygons.polygon_starts[polygon]
    return SiteTable(kind, polygon, (ring - first).astype(np.int32), index, source[:, 0], source[:, 1], ends)


def _sources(polygons: PolygonSet, table: SiteTable) -> NDArray[np.int32]:
    """(2, n, 2) the ring and index in the input of each vertex of used polygons, and of the edge after it; or -1."""
    source = np.full((2, len(polygons.xy), 2), -1, dtype=np.int32)
    vertex = table.vertices(polygons)
    source[table.kind, vertex] = np.stack([table.source_ring, table.source_index], axis=1)
    return source
