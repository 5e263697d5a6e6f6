"""Values as graphs of networkx: skeletons, triangulations, neighboring regions, planar graphs."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from vorotool.convert.extras import needed
from vorotool.convert.frames import lines
from vorotool.numeric.numbers import Flatten, checked_flatten
from vorotool.products.formats import resolved
from vorotool.types.features import Lines
from vorotool.types.images import LabelImage
from vorotool.types.mesh.cells import ProximityGraph
from vorotool.types.mesh.triangulation import AnyTriangulation, DigitalTriangulation, Triangulation
from vorotool.types.polygons.planar_graph import PlanarGraph
from vorotool.types.skeleton.skeleton import Skeleton
from vorotool.types.skeleton.tables import skeleton_graph
from vorotool.types.table import Table
from vorotool.types.volumes.volume import LabelVolume
from vorotool.types.voronoi.tables import neighbor_pairs
from vorotool.types.voronoi.voronoi_map import VoronoiMap

if TYPE_CHECKING:
    import networkx

GraphLike = (
    Skeleton
    | Triangulation
    | DigitalTriangulation
    | ProximityGraph
    | LabelImage
    | LabelVolume
    | PlanarGraph
    | VoronoiMap
)
"""What there are graphs of."""


def to_networkx(
    value: GraphLike, *, by: str | None = None, flatten: Flatten = None
) -> networkx.Graph[int] | networkx.MultiGraph[int]:
    """Return a result as an undirected graph of networkx: see `vorotool.types.values`."""
    flatten = checked_flatten(flatten)
    if isinstance(value, Skeleton):
        return _of_skeleton(_library(), value, "branch" if by is None else by, flatten)
    makers: list[tuple[Any, Callable[[Any, Any], Any]]] = [
        (Triangulation | DigitalTriangulation | ProximityGraph, _of_mesh),
        (LabelImage | LabelVolume, _of_labels),
        (PlanarGraph, _of_planar_graph),
        (VoronoiMap, _of_voronoi),
    ]
    maker = next(maker for kind, maker in makers if isinstance(value, kind))
    made: networkx.Graph[int] = maker(_library(), value)
    return made


def _library() -> Any:
    return needed("networkx", "graphs", "graphs")


def _named(crs: Any) -> dict[str, Any]:
    return {} if crs is None else {"crs": crs}


def _rows(columns: Mapping[str, Any]) -> list[dict[str, Any]]:
    """One mapping a row, without what does not exist."""
    lists = {
        name: column.tolist() if isinstance(column, np.ndarray) else list(column) for name, column in columns.items()
    }
    rows = zip(*lists.values(), strict=True)
    return [{name: value for name, value in zip(lists, row, strict=True) if value is not None} for row in rows]


def _of_skeleton(library: Any, skeleton: Skeleton, by: str, flatten: float | None) -> Any:
    parts = skeleton_graph(skeleton, by=by, flatten=flatten)
    polygons = skeleton.polygons
    graph = library.MultiGraph(**_named(polygons.crs))
    x, y = skeleton.as_given.vertices[parts.nodes].T
    nodes = _rows({"x": x, "y": y, "r": skeleton.radius[parts.nodes], "degree": skeleton.degree[parts.nodes]})
    graph.add_nodes_from(zip(parts.nodes.tolist(), nodes, strict=True))
    geometry = lines(Lines(parts.points, parts.start))
    ends = zip(parts.source.tolist(), parts.target.tolist(), strict=True)
    for (a, b), own, line, polygon in zip(ends, _rows(parts.edges), geometry, parts.polygon.tolist(), strict=True):
        described: dict[str, Any] = {}
        if polygon >= 0:
            described = {key: values[polygon] for key, values in polygons.other_columns.items()}
        own["geometry"] = line
        attributes = {**described, **{f"voro_{key}" if key in described else key: item for key, item in own.items()}}
        graph.add_edge(a, b, key=own[by], **attributes)
    return graph


def _of_mesh(library: Any, mesh: AnyTriangulation | ProximityGraph) -> Any:
    x, y = mesh.points.T
    nodes = _rows(Table({"label": mesh.label_array, "x": x, "y": y}).with_properties(mesh.properties))
    graph = library.Graph(**_named(mesh.crs))
    graph.add_nodes_from(enumerate(nodes))
    a, b = mesh.edges.T.tolist()
    graph.add_edges_from(zip(a, b, _rows({"length": mesh.edge_lengths()}), strict=True))
    return graph


def _of_labels(library: Any, image: LabelImage | LabelVolume) -> Any:
    room = "engines.label_images.regions"
    measures = resolved(f"{room}:measure_regions")(image)
    regions = resolved(f"{room}:region_table")(image, measures=measures)
    borders = dict(resolved(f"{room}:neighbor_table")(image, measures=measures))
    own = {} if image.seeds is None else image.seeds.properties
    labels = regions["voro_label" if "label" in own else "label"]
    graph = library.Graph(**_named(getattr(image.grid, "crs", None)))
    graph.add_nodes_from(zip(labels.tolist(), _rows(regions), strict=True))
    a, b = borders.pop("label_a").tolist(), borders.pop("label_b").tolist()
    graph.add_edges_from(zip(a, b, _rows(borders), strict=True))
    return graph


def _of_voronoi(library: Any, cells: VoronoiMap) -> Any:
    graph = library.Graph(**_named(cells.crs))
    table = dict(cells.table())
    reach = "voro_max_distance" if "max_distance" in cells.properties else "max_distance"
    table[reach] = np.ma.masked_invalid(table[reach])
    graph.add_nodes_from(enumerate(_rows(table)))
    borders = {name: column for name, column in cells.neighbors.items() if name not in ("label_a", "label_b")}
    a, b = neighbor_pairs(cells)[0].T.tolist()
    graph.add_edges_from(zip(a, b, _rows(borders), strict=True))
    return graph


def _of_planar_graph(library: Any, value: PlanarGraph) -> Any:
    points = value.coordinates()
    x, y = points.T
    graph = library.Graph(**_named(None if value.polygons is None else value.polygons.crs))
    graph.add_nodes_from(enumerate(_rows({"x": x, "y": y})))
    (a, b), (left, right) = value.segments.T.tolist(), value.segment_faces.T
    way = points[value.segments[:, 1]] - points[value.segments[:, 0]]
    length = np.sqrt((way * way).sum(axis=1))
    columns = {"segment": np.arange(len(value)), "length": length, "face_left": left, "face_right": right}
    graph.add_edges_from(zip(a, b, _rows(columns), strict=True))
    return graph
