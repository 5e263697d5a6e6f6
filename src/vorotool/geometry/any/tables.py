"""The table of any value, for a data frame."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import UsageError
from vorotool.geometry.alpha.complex import AlphaComplex
from vorotool.geometry.alpha.hull import AlphaHull
from vorotool.geometry.alpha.persistence import RegionPersistence
from vorotool.geometry.alpha.shape import AlphaShape
from vorotool.geometry.alpha.tables import family_table, region_table
from vorotool.geometry.any.features import features_of
from vorotool.geometry.distances.distances import Distances
from vorotool.geometry.mesh.cells import CellSet
from vorotool.geometry.mesh.digital_comparison import DigitalComparison
from vorotool.geometry.mesh.digital_triangulation import DigitalTriangulation
from vorotool.geometry.mesh.proximity import ProximityGraph
from vorotool.geometry.mesh.statistics import CellStatistics
from vorotool.geometry.mesh.tables import edge_table
from vorotool.geometry.mesh.triangulation import Triangulation
from vorotool.geometry.points.label_image import LabelImage
from vorotool.geometry.points.point_set import PointSet
from vorotool.geometry.points.seed_set import SeedSet
from vorotool.geometry.polygons.planar_graph import PlanarGraph
from vorotool.geometry.polygons.polygon_set import PolygonSet
from vorotool.geometry.skeleton.centerline import Centerlines, centerline_table
from vorotool.geometry.skeleton.critical_values import CriticalValues
from vorotool.geometry.skeleton.discs import Discs
from vorotool.geometry.skeleton.extended import ExtendedSkeleton, extended_table
from vorotool.geometry.skeleton.necks import Necks
from vorotool.geometry.skeleton.offsets import Offsets
from vorotool.geometry.skeleton.parts import Parts
from vorotool.geometry.skeleton.points_along import SkeletonPoints
from vorotool.geometry.skeleton.skeleton import Skeleton
from vorotool.geometry.skeleton.smooth_lines import SmoothLines
from vorotool.geometry.skeleton.tables import arc_table
from vorotool.geometry.table import Table
from vorotool.geometry.volumes.label_volume import LabelVolume
from vorotool.geometry.voronoi.voronoi_map import VoronoiMap
from vorotool.products.formats import resolved


class IndexedTable(NamedTuple):
    """A table, and the row of the input that each of its rows comes from: -1 for none; None if from several."""

    table: Table
    source: Any = None
    item: NDArray[np.integer] | None = None


def indexed_table(value: Any) -> IndexedTable:
    """Give the table of a value, with the rows of the input behind its rows."""
    maker = _MAKERS.get(type(value))
    if maker is None:
        *others, last = (kind.__name__ for kind in _MAKERS)
        raise UsageError(f"there is no table of a {type(value).__name__}: give a {', '.join(others)} or {last}")
    return maker(value)


def _of_points(points: PointSet) -> IndexedTable:
    x, y = np.ascontiguousarray(points.xy.T)
    own = Table({"label": points.label_array, "x": x, "y": y}).with_properties(points.properties)
    return IndexedTable(own, points, np.arange(len(points)))


def _of_seeds(seeds: SeedSet) -> IndexedTable:
    assert seeds.sites is not None
    x, y = np.ascontiguousarray(seeds.sites.T)
    columns: dict[str, Any] = {"label": seeds.site_labels, "x": x, "y": y}
    if seeds.object_area is not None:
        columns["object_area"] = seeds.object_area
    return IndexedTable(Table(columns).with_properties(seeds.properties), seeds, np.arange(len(x)))


def _of_labels(image: LabelImage | LabelVolume) -> IndexedTable:
    own: Table = resolved("engines.label_images.regions:region_table")(image)
    seeds = image.seeds
    if seeds is None or seeds.site_labels is None:
        return IndexedTable(own)
    labels = own["voro_label" if "label" in seeds.properties else "label"]
    return IndexedTable(own, seeds, np.searchsorted(seeds.site_labels, labels))


def _of_skeleton(skeleton: Skeleton) -> IndexedTable:
    return IndexedTable(arc_table(skeleton), skeleton.polygons, skeleton.polygon)


def _of_centerlines(lines: Centerlines) -> IndexedTable:
    return IndexedTable(centerline_table(lines), lines.path.polygons, lines.polygon[lines.line_of_row])


def _of_extended(extended: ExtendedSkeleton) -> IndexedTable:
    return IndexedTable(extended_table(extended), extended.path.polygons, extended.polygon[extended.line_of_row])


def _of_smooth(smoothed: SmoothLines) -> IndexedTable:
    return IndexedTable(smoothed.table(), smoothed.path.polygons, smoothed.polygon[smoothed.line])


def _of_points_along(points: SkeletonPoints) -> IndexedTable:
    return IndexedTable(points.table(), points.skeleton.polygons, points.polygon)


def _of_necks(necks: Necks) -> IndexedTable:
    return IndexedTable(necks.table(), necks.skeleton.polygons, necks.polygon)


def _of_parts(parts: Parts) -> IndexedTable:
    return IndexedTable(parts.table(), parts.necks.skeleton.polygons, parts.source)


def _of_offsets(offsets: Offsets) -> IndexedTable:
    return IndexedTable(
        offsets.table(), offsets.polygons, offsets.polygon[offsets.shape_of_ring[offsets.ring_of_piece]]
    )


def _of_discs(discs: Discs) -> IndexedTable:
    return IndexedTable(discs.table(), discs.polygons, discs.polygon)


def _of_voronoi(cells: VoronoiMap) -> IndexedTable:
    return IndexedTable(cells.table(), cells, np.arange(len(cells)))


def _of_features(value: Any) -> IndexedTable:
    features = features_of(value)
    return IndexedTable(features.columns, features.source, features.item)


def _of_values(values: CriticalValues) -> IndexedTable:
    source, target = np.ascontiguousarray(values.ends.T)
    columns = {"arc": np.arange(len(values)), "at_source": source, "at_target": target, "most": values.most}
    return IndexedTable(Table(columns))


_MAKERS: dict[type, Callable[[Any], IndexedTable]] = {
    Table: IndexedTable,
    PointSet: _of_points,
    SeedSet: _of_seeds,
    LabelImage: _of_labels,
    LabelVolume: _of_labels,
    Triangulation: lambda mesh: IndexedTable(edge_table(mesh)),
    DigitalTriangulation: lambda mesh: IndexedTable(edge_table(mesh)),
    ProximityGraph: lambda graph: IndexedTable(edge_table(graph)),
    CellStatistics: lambda found: IndexedTable(found.summary),
    RegionPersistence: lambda found: IndexedTable(found.table()),
    DigitalComparison: lambda found: IndexedTable(found.differences),
    CellSet: _of_features,
    AlphaComplex: lambda family: IndexedTable(family_table(family)),
    AlphaShape: lambda shape: IndexedTable(region_table(shape)),
    AlphaHull: lambda hull: IndexedTable(hull.table()),
    PolygonSet: _of_features,
    PlanarGraph: _of_features,
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
    CriticalValues: _of_values,
    Distances: lambda found: IndexedTable(found.table()),
}
