"""Any value as features: the geometry of each row as of shapely, its columns, and the row of the input behind it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from vorotool.errors import UsageError
from vorotool.geometry.alpha.complex import AlphaComplex
from vorotool.geometry.alpha.hull import AlphaHull
from vorotool.geometry.alpha.shape import AlphaShape
from vorotool.geometry.alpha.tables import described_polygons, family_table, shape_edge_table, shape_point_table
from vorotool.geometry.any.scaling import AREAS, LENGTHS, scaled_table
from vorotool.geometry.distances.distances import Distances
from vorotool.geometry.identity import names_of, with_columns_of
from vorotool.geometry.mesh.cells import CellSet
from vorotool.geometry.mesh.digital_triangulation import AnyTriangulation, DigitalTriangulation
from vorotool.geometry.mesh.proximity import ProximityGraph
from vorotool.geometry.mesh.tables import edge_table, point_table, triangle_table
from vorotool.geometry.mesh.triangulation import Triangulation
from vorotool.geometry.numbers import checked_flatten
from vorotool.geometry.points.label_image import LabelImage
from vorotool.geometry.points.point_set import PointSet
from vorotool.geometry.points.seed_set import SeedSet
from vorotool.geometry.polygons.conversion import to_shapely
from vorotool.geometry.polygons.planar_graph import PlanarGraph
from vorotool.geometry.polygons.polygon_set import PolygonSet
from vorotool.geometry.ragged import with_length
from vorotool.geometry.skeleton.centerline import Centerlines
from vorotool.geometry.skeleton.discs import Discs
from vorotool.geometry.skeleton.extended import ExtendedSkeleton
from vorotool.geometry.skeleton.graph import skeleton_graph
from vorotool.geometry.skeleton.led_on import LedOn
from vorotool.geometry.skeleton.necks import Necks
from vorotool.geometry.skeleton.offsets import Offsets
from vorotool.geometry.skeleton.parts import Parts
from vorotool.geometry.skeleton.points_along import SkeletonPoints
from vorotool.geometry.skeleton.skeleton import Skeleton
from vorotool.geometry.skeleton.smooth_lines import SmoothLines
from vorotool.geometry.spacing import SQUARE, PixelSides
from vorotool.geometry.table import Table
from vorotool.geometry.voronoi.shapes import cell_polygons
from vorotool.geometry.voronoi.tables import cell_table
from vorotool.geometry.voronoi.voronoi_map import VoronoiMap
from vorotool.products.formats import resolved

Rows = NDArray[np.integer]


@dataclass(frozen=True, eq=False)
class Features:
    """Geometry with columns, one row a feature."""

    geometry: NDArray[Any]  # (n,) array of shapely geometry: of each row; None where there is none
    columns: Table  # of n rows, those of the input too
    source: Any  # the points or polygons that the rows come from: their `crs` and `index` are of the rows, too
    # (n,) integer array: the row of the input that each comes from, -1 for none; None: they come from several
    item: Rows | None = None


def features_of(value: Any, **options: Any) -> Features:
    """Give the features of a value."""
    maker = _MAKERS.get(type(value))
    if maker is None:
        raise UsageError(f"there is no geometry of a {type(value).__name__}")
    return maker(value, **options)


def _chosen(value: Any, what: str | None, parts: Mapping[str, Callable[[Any], Features]]) -> Features:
    """Make the features of a part, the first one by default."""
    name = what or next(iter(parts))
    if name not in parts:
        raise UsageError(f"invalid what {what!r}: expected {', '.join(parts)} of a {type(value).__name__}")
    return parts[name](value)


# ---- geometry of arrays --------------------------------------------------------------------------
def lines(points: NDArray[np.float64], start: Rows) -> NDArray[Any]:
    """(n,) lines through places that follow one another; empty where these all are one place."""
    points, start, has_length = with_length(points, start)
    made: NDArray[Any] = np.full(len(has_length), shapely.LineString(), dtype=object)
    made[has_length] = _joined(points, start)
    return made


def _joined(points: NDArray[np.float64], start: Rows) -> NDArray[Any]:
    """(n,) lines, whether their places are different or not."""
    made: NDArray[Any] = shapely.from_ragged_array(
        shapely.GeometryType.LINESTRING, np.ascontiguousarray(points), (np.ascontiguousarray(start, dtype=np.int64),)
    )
    return made


def _pairs(points: NDArray[np.float64], pairs: Rows) -> NDArray[Any]:
    """(n,) lines between two points each."""
    return lines(points[pairs].reshape(-1, 2), np.arange(0, 2 * len(pairs) + 1, 2))


def _triangles(points: NDArray[np.float64], triangles: Rows) -> NDArray[Any]:
    made: NDArray[Any] = shapely.from_ragged_array(
        shapely.GeometryType.POLYGON,
        np.ascontiguousarray(points[triangles[:, [0, 1, 2, 0]]].reshape(-1, 2)),
        (np.arange(0, 4 * len(triangles) + 1, 4), np.arange(len(triangles) + 1)),
    )
    return made


def _points(xy: NDArray[np.float64]) -> NDArray[Any]:
    made: NDArray[Any] = shapely.points(np.ascontiguousarray(xy))
    return made


# ---- points and meshes ---------------------------------------------------------------------------
def _every(count: int) -> Rows:
    return np.arange(count)


def _of_points(points: PointSet) -> Features:
    columns = Table({"label": points.label_array}).with_properties(points.properties)
    return Features(_points(points.xy), columns, points, _every(len(points)))


def _of_seeds(seeds: SeedSet) -> Features:
    assert seeds.sites is not None
    columns: dict[str, Any] = {"label": seeds.site_labels}
    if seeds.object_area is not None:
        columns["object_area"] = seeds.object_area
    made = Table(columns).with_properties(seeds.properties)
    return Features(_points(seeds.sites), made, seeds, _every(len(seeds.sites)))


def _of_mesh(mesh: AnyTriangulation, what: str | None = None) -> Features:
    return _chosen(mesh, what, {"triangles": _mesh_triangles, "edges": _mesh_edges, "points": _mesh_points})


def _of_proximity(graph: ProximityGraph) -> Features:
    return _mesh_edges(graph)


def _mesh_triangles(mesh: AnyTriangulation) -> Features:
    return Features(_triangles(mesh.points, mesh.triangles), triangle_table(mesh), mesh)


def _mesh_edges(mesh: AnyTriangulation | ProximityGraph) -> Features:
    return Features(_pairs(mesh.points, mesh.edges), without_places(edge_table(mesh)), mesh)


def _mesh_points(mesh: AnyTriangulation) -> Features:
    own = Table({"label": mesh.label_array}).with_properties(mesh.properties)
    columns = without_places(point_table(mesh), mesh.properties) if isinstance(mesh, Triangulation) else own
    return Features(_points(mesh.points), columns, mesh, _every(len(mesh.points)))


def without_places(table: Table, properties: Mapping[str, Any] | None = None) -> Table:
    """Leave out the columns of coordinates, which geometry has; those of the input stay."""
    own = properties or {}
    kept = {name: column for name, column in table.stored().items() if name in own or not _is_place(name)}
    return Table(kept)


def _is_place(name: str) -> bool:
    return name.removeprefix("voro_") in {"x", "y", "x_a", "y_a", "x_b", "y_b"}


def _of_cells(cells: CellSet) -> Features:
    x, y = np.ascontiguousarray(cells.sites.T)
    columns = {"label": cells.label_array, "x": x, "y": y, "area": cells.areas, "perimeter": cells.perimeters}
    made = Table(columns).with_properties(cells.properties)
    return Features(cells.to_shapely(), made, cells, _every(len(cells)))


# ---- alpha shapes --------------------------------------------------------------------------------
def _of_complex(family: AlphaComplex) -> Features:
    return Features(_pairs(family.points, family.edges), family_table(family), family.mesh)


def _of_shape(shape: AlphaShape, what: str | None = None) -> Features:
    return _chosen(shape, what, {"polygons": _shape_polygons, "edges": _shape_edges, "points": _shape_points})


def _shape_polygons(shape: AlphaShape) -> Features:
    polygons = described_polygons(shape)
    columns = {"region": np.arange(1, len(polygons) + 1), **polygons.properties}
    return Features(to_shapely(polygons), Table(columns), shape.family.mesh)


def _shape_edges(shape: AlphaShape) -> Features:
    return Features(_pairs(shape.points, shape.edges), without_places(shape_edge_table(shape)), shape.family.mesh)


def _shape_points(shape: AlphaShape) -> Features:
    mesh = shape.family.mesh
    columns = without_places(shape_point_table(shape), mesh.properties)
    return Features(_points(mesh.points), columns, mesh, _every(len(mesh.points)))


def _of_hull(hull: AlphaHull) -> Features:
    mesh = hull.shape.family.mesh
    polygons = [shapely.Polygon(shell, holes) for shell, *holes in hull.polygons()]
    geometry = np.array([*polygons, *_points(mesh.points[hull.points])], dtype=object)
    rows = len(polygons), len(hull.points)
    label = np.concatenate([np.zeros(rows[0], np.int64), mesh.label_array[hull.points]])
    is_polygon = np.arange(len(geometry)) < rows[0]
    item = np.concatenate([np.full(rows[0], -1), hull.points])
    columns = {"class": ["hull"] * rows[0] + ["point"] * rows[1], "label": np.ma.array(label, mask=is_polygon)}
    return Features(geometry, Table(columns), mesh, item)


# ---- polygons and skeletons ----------------------------------------------------------------------
def _of_polygons(polygons: PolygonSet) -> Features:
    count = len(polygons)
    columns = names_of(polygons, _every(count))
    if polygons.ids is None:
        del columns["id"]
    made = Table(columns).with_properties(polygons.other_columns)
    return Features(to_shapely(polygons), made, polygons, _every(count))


def _of_graph(graph: PlanarGraph) -> Features:
    left, right = np.ascontiguousarray(graph.segment_faces.T)
    a, b = np.ascontiguousarray(graph.segments.T)
    columns = {"point_a": a, "point_b": b, "face_left": left, "face_right": right}
    return Features(_pairs(graph.coordinates(), graph.segments), Table(columns), graph.polygons)


def _of_skeleton(skeleton: Skeleton, by: str = "arc", flatten: float | None = None) -> Features:
    graph = skeleton_graph(skeleton, by=by, flatten=flatten)
    polygons = skeleton.polygons
    arcs = np.flatnonzero(np.diff(skeleton.branch, prepend=-1)) if by == "branch" else slice(None)
    item = skeleton.polygon[arcs]
    columns = with_columns_of(graph.edges.stored(), polygons, item)
    return Features(lines(graph.points, graph.start), columns, polygons, item)


def _of_centerlines(paths: LedOn, flatten: float | None = None) -> Features:
    polygons = paths.path.polygons
    least, most = paths.width_range
    own = {"length": paths.length, "width_mean": paths.width_mean, "width_min": least, "width_max": most}
    columns = {**names_of(polygons, paths.polygon), **own}
    geometry = lines(*paths.as_given.flattened(flatten))
    return Features(geometry, with_columns_of(columns, polygons, paths.polygon), polygons, paths.polygon)


def _of_extended(extended: ExtendedSkeleton, flatten: float | None = None) -> Features:
    made = _of_centerlines(extended, flatten)
    columns = Table({"branch": np.arange(len(extended)), **made.columns.stored()})
    return Features(made.geometry, columns, made.source, made.item)


def _of_smooth(smoothed: SmoothLines, flatten: float | None = None) -> Features:
    polygons, polygon, start = smoothed.path.polygons, smoothed.polygon, smoothed.start
    columns = {
        "branch": np.arange(len(smoothed)),
        **names_of(polygons, polygon),
        "curves": np.diff(start),
        "error": smoothed.error,
    }
    geometry = lines(*smoothed.as_given.flattened(flatten))
    return Features(geometry, with_columns_of(columns, polygons, polygon), polygons, polygon)


def _of_points_along(points: SkeletonPoints, what: str | None = None) -> Features:
    return _chosen(points, what, {"points": _skeleton_points, "transects": _transects})


def _skeleton_points(points: SkeletonPoints) -> Features:
    return _along(points, _points(points.as_given.xy), {"x", "y"})


def _transects(points: SkeletonPoints) -> Features:
    kept = points.transects()
    count = len(kept)
    feet = lines(kept.as_given.feet.reshape(-1, 2), np.arange(0, 2 * count + 1, 2))
    return _along(kept, feet, {"x_a", "y_a", "x_b", "y_b"})


def _of_distances(found: Distances) -> Features:
    places = found.places
    columns = {name: column for name, column in found.table().stored().items() if name in ("what", "distance")}
    return Features(_joined(places.reshape(-1, 2), np.arange(0, 2 * len(places) + 1, 2)), Table(columns), found)


def _along(points: SkeletonPoints, geometry: NDArray[Any], left_out: set[str]) -> Features:
    polygons = points.skeleton.polygons
    columns = {name: column for name, column in points.table().stored().items() if name not in left_out}
    return Features(geometry, with_columns_of(columns, polygons, points.polygon), polygons, points.polygon)


def _of_necks(necks: Necks) -> Features:
    polygons, feet = necks.skeleton.polygons, necks.feet.reshape(-1, 2)
    columns = without_places(necks.table()).stored()
    geometry = lines(feet, np.arange(0, len(feet) + 1, 2))
    return Features(geometry, with_columns_of(columns, polygons, necks.polygon), polygons, necks.polygon)


def _of_parts(parts: Parts) -> Features:
    polygons = parts.necks.skeleton.polygons
    columns = without_places(parts.table(), polygons.properties)
    return Features(to_shapely(parts.polygons), columns, polygons, parts.source)


def _of_offsets(offsets: Offsets, flatten: float | None = None) -> Features:
    polygons, of = offsets.polygons, offsets.polygon
    shapes = offsets.flattened(flatten)
    columns = {
        **names_of(polygons, of),
        "distance": offsets.distance,
        "area": offsets.area,
    }
    return Features(to_shapely(shapes), with_columns_of(columns, polygons, of), polygons, of)


def _of_discs(discs: Discs, flatten: float | None = None) -> Features:
    polygons = discs.polygons
    shapes = discs.flattened(flatten)
    columns = discs.table()
    return Features(to_shapely(shapes), columns, polygons, discs.polygon)


def _of_voronoi(cells: VoronoiMap, flatten: float | None = None) -> Features:
    geometry = cell_polygons(cells, checked_flatten(flatten))
    return Features(geometry, cell_table(cells), cells, _every(len(cells)))


# ---- label images --------------------------------------------------------------------------------
@dataclass(frozen=True, eq=False)
class _Map:
    """What the regions of a label image come from: its seeds, in the coordinate reference system of its grid."""

    index: Any
    crs: Any


def _of_labels(image: LabelImage) -> Features:
    """Regions: a polygon, or several, a label, in the order of the table."""
    table = resolved("engines.label_images.regions:region_table")(image)
    own = {} if image.seeds is None else image.seeds.properties
    labels = np.asarray(table["voro_label" if "label" in own else "label"])
    table = _on_map(table, image, own)
    seeds, item = image.seeds, None
    if seeds is not None and seeds.site_labels is not None:
        item = np.searchsorted(seeds.site_labels, labels)
    source = _Map(getattr(seeds, "index", None), None if image.grid is None else image.grid.crs)
    return Features(_regions(image, labels), table, source, item)


def _on_map(table: Table, image: LabelImage, own: Mapping[str, Any]) -> Table:
    """A table of regions in the unit of the map, without boxes; as it is where the image lies on none."""
    left_out = {"bbox_x", "bbox_y", "bbox_w", "bbox_h"}
    grid = image.grid
    if grid is not None and grid.transform is not None:
        if grid.is_square and grid.is_upright and image.sides == SQUARE:
            table = scaled_table(table, grid.width, properties=own, origin=grid.center, y_up=grid.is_north_up)
        else:  # a length in pixels, or in the unit of a spacing, is none on the map
            left_out |= LENGTHS | AREAS
    columns = table.stored().items()
    return Table(
        {name: column for name, column in columns if name in own or name.removeprefix("voro_") not in left_out}
    )


def _regions(image: LabelImage, labels: NDArray[Any]) -> NDArray[Any]:
    """(n,) outlines of the pixels of each label, on the map where the image lies on one, else in pixels."""
    geometry = np.full(len(labels), None, dtype=object)
    if not image.labels.any():
        return geometry
    outlines = resolved("engines.label_images.outlines:outlines")(image, connectivity=4)
    parts, row = to_shapely(outlines), np.searchsorted(labels, np.array(outlines.ids))
    first = np.flatnonzero(np.diff(row, prepend=-1))
    several = np.diff(np.append(first, len(row))) > 1
    geometry[row[first]] = parts[first]
    within = np.isin(row, row[first[several]])
    if several.any():
        numbers = np.cumsum(np.diff(row[within], prepend=-1) > 0) - 1
        geometry[row[first[several]]] = shapely.multipolygons(parts[within], indices=numbers)
    grid = image.grid
    if grid is None or grid.transform is None:
        return _in_unit(geometry, image.sides)
    assert image.frame is not None
    a, b, c, d, e, f = grid.transform
    left, top = image.frame.x - 0.5, image.frame.y - 0.5

    def on_map(xy: NDArray[np.float64]) -> NDArray[np.float64]:
        column, row = xy[:, 0] - left, xy[:, 1] - top
        return np.stack([a * column + b * row + c, d * column + e * row + f], axis=1)

    made: NDArray[Any] = shapely.transform(geometry, on_map)
    return made


def _in_unit(geometry: NDArray[Any], sides: PixelSides) -> NDArray[Any]:
    """Shapes of pixels in the unit of their sides."""
    if sides == SQUARE:
        return geometry
    height, width = (float(side) for side in sides.lengths)
    made: NDArray[Any] = shapely.transform(geometry, lambda xy: xy * (width, height))
    return made


_MAKERS: dict[type, Callable[..., Features]] = {
    PointSet: _of_points,
    SeedSet: _of_seeds,
    LabelImage: _of_labels,
    Triangulation: _of_mesh,
    DigitalTriangulation: _of_mesh,
    ProximityGraph: _of_proximity,
    CellSet: _of_cells,
    AlphaComplex: _of_complex,
    AlphaShape: _of_shape,
    AlphaHull: _of_hull,
    PolygonSet: _of_polygons,
    PlanarGraph: _of_graph,
    Skeleton: _of_skeleton,
    Centerlines: _of_centerlines,
    ExtendedSkeleton: _of_extended,
    SmoothLines: _of_smooth,
    SkeletonPoints: _of_points_along,
    Necks: _of_necks,
    Parts: _of_parts,
    Offsets: _of_offsets,
    Discs: _of_discs,
    VoronoiMap: _of_voronoi,
    Distances: _of_distances,
}
