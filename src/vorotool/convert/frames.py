"""Values for pandas, geopandas and networkx: tables and features with the index of the input, and graphs."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import shapely
from numpy.typing import NDArray

from vorotool.convert.extras import needed
from vorotool.numeric.arrays import norms, with_length
from vorotool.numeric.checks import index_of_rows
from vorotool.numeric.crs import crs_text
from vorotool.numeric.numbers import Flatten, checked_flatten
from vorotool.products.formats import resolved
from vorotool.types.features import Areas, Corners, Geometry, Lines, Mixture, Rows, features_of, parts_of, rows_of
from vorotool.types.images import LabelImage
from vorotool.types.mesh.cells import ProximityGraph
from vorotool.types.mesh.triangulation import AnyTriangulation, DigitalTriangulation, Triangulation
from vorotool.types.polygons.planar_graph import PlanarGraph
from vorotool.types.polygons.shapely_geometry import to_shapely
from vorotool.types.skeleton.skeleton import Skeleton
from vorotool.types.skeleton.tables import skeleton_graph
from vorotool.types.table import Table
from vorotool.types.volumes.volume import LabelVolume
from vorotool.types.voronoi.tables import neighbor_pairs
from vorotool.types.voronoi.voronoi_map import VoronoiMap

if TYPE_CHECKING:
    import networkx


def to_pandas(value: Any) -> Any:
    """Give the table of a value as a data frame, with the index of the input where rows come from its rows."""
    pandas = needed("pandas", "frames", "data frames")
    rows = rows_of(value)
    return pandas.DataFrame(_series(pandas, rows.table()), index=_index(pandas, rows.source, rows.item))


def to_geopandas(value: Any, what: str | None = None, *, flatten: Flatten = None) -> Any:
    """Give the rows of a value with their geometry as a data frame of geopandas; see `vorotool.types.values`."""
    geopandas = needed("geopandas", "frames", "data frames of geometry")
    pandas = needed("pandas", "frames", "data frames of geometry")
    features = features_of(value, what, flatten=flatten)
    geometry, (table, source, item) = geometry_of_rows(features), _joined(features)
    index = _index(pandas, source, item)
    frame = pandas.DataFrame(_series(pandas, table), index=pandas.RangeIndex(len(geometry)) if index is None else index)
    name = "voro_geometry" if "geometry" in frame else "geometry"
    frame[name] = geopandas.GeoSeries(geometry, index=frame.index)
    return geopandas.GeoDataFrame(frame, geometry=name, crs=crs_text(getattr(source, "crs", None)))


def _joined(features: Rows | Mixture) -> tuple[Table, Any, Any]:
    """Give the columns of all rows, masked where a kind has none, their source, and the row of it behind each."""
    parts = list(parts_of(features))
    if len(parts) == 1:
        return parts[0].table(), parts[0].source, parts[0].item
    tables = [rows.table() for rows in parts]
    names = dict.fromkeys(name for table in tables for name in table)
    columns = {name: _one_column([(table.get(name), table.rows) for table in tables]) for name in names}
    items = [
        np.full(table.rows, -1) if rows.item is None else rows.item for rows, table in zip(parts, tables, strict=True)
    ]
    return Table(columns), parts[0].source, np.concatenate(items)


def _one_column(parts: list[tuple[Any, int]]) -> Any:
    """Put columns one after the other; None stands for so many rows without a value."""
    kind = np.result_type(*(np.asanyarray(column) for column, _ in parts if column is not None))
    whole = [np.ma.array(np.zeros(rows, kind), mask=True) if column is None else column for column, rows in parts]
    return np.ma.concatenate(whole)  # type: ignore[no-untyped-call]


def adjacency(cells: VoronoiMap) -> Any:
    """Give pairs of neighbors both ways as a data frame, cells without any with themselves."""
    pandas = needed("pandas", "frames", "data frames")
    pairs, length = neighbor_pairs(cells)
    lone = np.setdiff1d(np.arange(len(cells)), pairs)
    focal = np.concatenate([pairs[:, 0], pairs[:, 1], lone])
    neighbor = np.concatenate([pairs[:, 1], pairs[:, 0], lone])
    weights = np.concatenate([length, length, np.zeros(len(lone))])
    order = np.lexsort((neighbor, focal))
    index = _index(pandas, cells, np.arange(len(cells)))
    names = pandas.RangeIndex(len(cells)) if index is None else index
    return pandas.DataFrame(
        {"focal": names[focal[order]], "neighbor": names[neighbor[order]], "weight": weights[order]}
    )


def _series(pandas: Any, columns: Mapping[str, Any]) -> dict[str, Any]:
    return {name: _column(pandas, column) for name, column in columns.items()}


def _column(pandas: Any, column: Any) -> Any:
    """A column in a type that has a place for what does not exist."""
    if isinstance(column, np.ma.MaskedArray) and column.dtype.kind in "biu":
        mask = np.ma.getmaskarray(column)
        if not mask.any():
            return column.data.copy()
        kind = "boolean" if column.dtype.kind == "b" else "Int64"
        made = pandas.array(column.filled(0), dtype=kind)
        made[mask] = pandas.NA
        return made
    if isinstance(column, np.ma.MaskedArray):
        return column.filled(np.nan) if column.dtype.kind == "f" else column.filled(None)
    if isinstance(column, np.ndarray) and column.dtype != object:
        return column if column.dtype.isnative else column.astype(column.dtype.newbyteorder("="))
    return pandas.Series(list(column)).array  # the type that its values have


def _index(pandas: Any, source: Any, item: Any) -> Any:
    """The index of the rows: the input's own for each row that comes from one of its rows."""
    own = getattr(source, "index", None)
    if own is None or item is None:
        return None
    name = getattr(own, "names", [None]) if getattr(own, "nlevels", 1) > 1 else [getattr(own, "name", None)]
    taken = own if np.array_equal(item, np.arange(len(own))) else index_of_rows(own, item)
    return taken if isinstance(taken, pandas.Index) else pandas.Index(taken, name=name[0])


def geometry_of(value: Any, what: str | None = None, *, flatten: Flatten = None) -> NDArray[Any]:
    """(n,) geometry of each row of a value; None where there is none."""
    return geometry_of_rows(features_of(value, what, flatten=flatten))


def geometry_of_rows(features: Rows | Mixture) -> NDArray[Any]:
    """(n,) geometry of rows, one kind after the other."""
    return np.concatenate([shapely_of(rows.geometry) for rows in parts_of(features)])


def shapely_of(geometry: Geometry | NDArray[Any] | None) -> NDArray[Any]:
    """(n,) the same as shapely has it."""
    made: NDArray[Any]
    if isinstance(geometry, Corners):
        made = _of_corners(geometry)
    elif isinstance(geometry, Lines):
        made = lines(geometry)
    elif isinstance(geometry, Areas):
        valid = resolved("formats.text.rings:valid_coverage")  # as it would be written without decimals
        made = valid(geometry.xy, geometry.nesting, in_box=geometry.in_box)
    elif isinstance(geometry, np.ndarray):
        made = geometry
    else:
        assert geometry is not None
        made = to_shapely(geometry)
    return made


def lines(geometry: Lines) -> NDArray[Any]:
    """(n,) lines through places that follow one another; empty where these all are one place."""
    points, start, has_length = with_length(geometry.xy, geometry.starts)
    made: NDArray[Any] = np.full(len(has_length), shapely.LineString(), dtype=object)
    kind = shapely.GeometryType.LINESTRING
    made[has_length] = shapely.from_ragged_array(kind, np.ascontiguousarray(points), (start,))
    return made


def _of_corners(geometry: Corners) -> NDArray[Any]:
    places, count = geometry.xy[geometry.corners], len(geometry.corners)
    made: NDArray[Any]
    if geometry.corners.shape[1] == 1:
        made = shapely.points(np.ascontiguousarray(places[:, 0]))
    elif geometry.corners.shape[1] == 2:
        made = shapely.linestrings(np.ascontiguousarray(places))
    else:
        rings = np.ascontiguousarray(places[:, [0, 1, 2, 0]].reshape(-1, 2))
        starts = np.arange(0, 4 * count + 1, 4), np.arange(count + 1)
        made = shapely.from_ragged_array(shapely.GeometryType.POLYGON, rings, starts)
    return made


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
    return maker(_library(), value)


def _library() -> Any:
    return needed("networkx", "graphs", "graphs")


def _of_system(crs: Any) -> dict[str, Any]:
    return {} if crs is None else {"crs": crs}


def _attributes(columns: Mapping[str, Any]) -> list[dict[str, Any]]:
    """One mapping a row, without what does not exist."""
    lists = {
        name: column.tolist() if isinstance(column, np.ndarray) else list(column) for name, column in columns.items()
    }
    rows = zip(*lists.values(), strict=True)
    return [{name: value for name, value in zip(lists, row, strict=True) if value is not None} for row in rows]


def _of_skeleton(library: Any, skeleton: Skeleton, by: str, flatten: float | None) -> Any:
    parts = skeleton_graph(skeleton, by=by, flatten=flatten)
    polygons = skeleton.polygons
    graph = library.MultiGraph(**_of_system(polygons.crs))
    x, y = skeleton.as_given.vertices[parts.nodes].T
    nodes = _attributes({"x": x, "y": y, "r": skeleton.radius[parts.nodes], "degree": skeleton.degree[parts.nodes]})
    graph.add_nodes_from(zip(parts.nodes.tolist(), nodes, strict=True))
    geometry = lines(Lines(parts.points, parts.start))
    ends = zip(parts.source.tolist(), parts.target.tolist(), strict=True)
    for (a, b), own, line, polygon in zip(
        ends, _attributes(parts.edges), geometry, parts.polygon.tolist(), strict=True
    ):
        described: dict[str, Any] = {}
        if polygon >= 0:
            described = {key: values[polygon] for key, values in polygons.other_columns.items()}
        own["geometry"] = line
        attributes = {**described, **{f"voro_{key}" if key in described else key: item for key, item in own.items()}}
        graph.add_edge(a, b, key=own[by], **attributes)
    return graph


def _of_mesh(library: Any, mesh: AnyTriangulation | ProximityGraph) -> Any:
    x, y = mesh.points.T
    nodes = _attributes(Table({"label": mesh.label_array, "x": x, "y": y}).with_properties(mesh.properties))
    graph = library.Graph(**_of_system(mesh.crs))
    graph.add_nodes_from(enumerate(nodes))
    a, b = mesh.edges.T.tolist()
    graph.add_edges_from(zip(a, b, _attributes({"length": mesh.edge_lengths()}), strict=True))
    return graph


def _of_labels(library: Any, image: LabelImage | LabelVolume) -> Any:
    room = "engines.label_images.regions"
    measures = resolved(f"{room}:measure_regions")(image)
    regions = resolved(f"{room}:region_table")(image, measures=measures)
    borders = dict(resolved(f"{room}:neighbor_table")(image, measures=measures))
    own = {} if image.seeds is None else image.seeds.properties
    labels = regions["voro_label" if "label" in own else "label"]
    graph = library.Graph(**_of_system(getattr(image.grid, "crs", None)))
    graph.add_nodes_from(zip(labels.tolist(), _attributes(regions), strict=True))
    a, b = borders.pop("label_a").tolist(), borders.pop("label_b").tolist()
    graph.add_edges_from(zip(a, b, _attributes(borders), strict=True))
    return graph


def _of_voronoi(library: Any, cells: VoronoiMap) -> Any:
    graph = library.Graph(**_of_system(cells.crs))
    table = dict(cells.table())
    reach = "voro_max_distance" if "max_distance" in cells.properties else "max_distance"
    table[reach] = np.ma.masked_invalid(table[reach])
    graph.add_nodes_from(enumerate(_attributes(table)))
    borders = {name: column for name, column in cells.neighbors.items() if name not in ("label_a", "label_b")}
    a, b = neighbor_pairs(cells)[0].T.tolist()
    graph.add_edges_from(zip(a, b, _attributes(borders), strict=True))
    return graph


def _of_planar_graph(library: Any, value: PlanarGraph) -> Any:
    points = value.coordinates()
    x, y = points.T
    graph = library.Graph(**_of_system(None if value.polygons is None else value.polygons.crs))
    graph.add_nodes_from(enumerate(_attributes({"x": x, "y": y})))
    (a, b), (left, right) = value.segments.T.tolist(), value.segment_faces.T
    way = points[value.segments[:, 1]] - points[value.segments[:, 0]]
    length = norms(way)
    columns = {"segment": np.arange(len(value)), "length": length, "face_left": left, "face_right": right}
    graph.add_edges_from(zip(a, b, _attributes(columns), strict=True))
    return graph
