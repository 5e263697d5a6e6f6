"""Exact Voronoi diagrams of images, points and polygons: the types of all public names."""

# Made of the table in __init__.py by tools/public_names.py; `make lint` compares both.

from vorotool.engines.alpha.alpha_complex import (
    alpha_complex as alpha_complex,
)
from vorotool.engines.alpha.alpha_complex import (
    alpha_curves as alpha_curves,
)
from vorotool.engines.alpha.alpha_complex import (
    alpha_edges as alpha_edges,
)
from vorotool.engines.alpha.alpha_hull import (
    alpha_hull as alpha_hull,
)
from vorotool.engines.alpha.alpha_shape import (
    alpha_shape as alpha_shape,
)
from vorotool.engines.alpha.alpha_shape import (
    persistence as persistence,
)
from vorotool.engines.alpha.verify_alpha import (
    verify_alpha_shape as verify_alpha_shape,
)
from vorotool.engines.arrangement.planar_graph import (
    planar_graph as planar_graph,
)
from vorotool.engines.arrangement.planar_graph import (
    verify_planar_graph as verify_planar_graph,
)
from vorotool.engines.centerlines.centerline import (
    centerline as centerline,
)
from vorotool.engines.centerlines.extended_ends import (
    extend_ends as extend_ends,
)
from vorotool.engines.centerlines.verify_extended import (
    verify_extended as verify_extended,
)
from vorotool.engines.delaunay.cells import (
    cell_colors as cell_colors,
)
from vorotool.engines.delaunay.cells import (
    verify_cells as verify_cells,
)
from vorotool.engines.delaunay.cells import (
    voronoi_cells as voronoi_cells,
)
from vorotool.engines.delaunay.delaunay import (
    delaunay as delaunay,
)
from vorotool.engines.delaunay.delaunay import (
    insert_points as insert_points,
)
from vorotool.engines.delaunay.delaunay import (
    verify_triangulation as verify_triangulation,
)
from vorotool.engines.delaunay.proximity import (
    cell_statistics as cell_statistics,
)
from vorotool.engines.delaunay.proximity import (
    proximity_graph as proximity_graph,
)
from vorotool.engines.delaunay.proximity import (
    site_table as site_table,
)
from vorotool.engines.delaunay.proximity import (
    verify_proximity_graph as verify_proximity_graph,
)
from vorotool.engines.digital.comparison import (
    compare_digital as compare_digital,
)
from vorotool.engines.digital.triangulation import (
    digital_delaunay as digital_delaunay,
)
from vorotool.engines.digital.triangulation import (
    digital_triangulation as digital_triangulation,
)
from vorotool.engines.digital.triangulation import (
    repair_digital as repair_digital,
)
from vorotool.engines.digital.triangulation import (
    verify_digital_triangulation as verify_digital_triangulation,
)
from vorotool.engines.distances.hausdorff import (
    distance as distance,
)
from vorotool.engines.distances.hausdorff import (
    hausdorff as hausdorff,
)
from vorotool.engines.distances.hausdorff import (
    verify_distances as verify_distances,
)
from vorotool.engines.from_skeleton.empty_discs import (
    largest_empty_discs as largest_empty_discs,
)
from vorotool.engines.from_skeleton.largest_discs import (
    largest_discs as largest_discs,
)
from vorotool.engines.from_skeleton.points_along import (
    points_along as points_along,
)
from vorotool.engines.from_skeleton.reconstruction import (
    rebuild as rebuild,
)
from vorotool.engines.from_skeleton.thickness import (
    verify_thickness as verify_thickness,
)
from vorotool.engines.from_skeleton.verify_discs import (
    verify_discs as verify_discs,
)
from vorotool.engines.label_images.outlines import (
    outlines as outlines,
)
from vorotool.engines.label_images.regions import (
    color_regions as color_regions,
)
from vorotool.engines.label_images.regions import (
    neighbor_table as neighbor_table,
)
from vorotool.engines.label_images.regions import (
    region_table as region_table,
)
from vorotool.engines.label_images.regions import (
    voronoi_diagram as voronoi_diagram,
)
from vorotool.engines.masks import (
    local_thickness as local_thickness,
)
from vorotool.engines.necks.necks import (
    necks as necks,
)
from vorotool.engines.necks.parts import (
    parts as parts,
)
from vorotool.engines.necks.verify_necks import (
    verify_necks as verify_necks,
)
from vorotool.engines.necks.verify_necks import (
    verify_parts as verify_parts,
)
from vorotool.engines.offsets.offsets import (
    offset as offset,
)
from vorotool.engines.offsets.verify_offsets import (
    verify_offsets as verify_offsets,
)
from vorotool.engines.pruning.joining import (
    join_junctions as join_junctions,
)
from vorotool.engines.pruning.pruning import (
    arc_profiles as arc_profiles,
)
from vorotool.engines.pruning.pruning import (
    critical_values as critical_values,
)
from vorotool.engines.pruning.pruning import (
    prune as prune,
)
from vorotool.engines.pruning.verify_pruning import (
    verify_joining as verify_joining,
)
from vorotool.engines.pruning.verify_pruning import (
    verify_pruning as verify_pruning,
)
from vorotool.engines.skeleton.verify_skeleton import (
    verify_skeleton as verify_skeleton,
)
from vorotool.engines.skeleton_api import (
    skeleton_approx as skeleton_approx,
)
from vorotool.engines.skeleton_api import (
    skeleton_exact as skeleton_exact,
)
from vorotool.engines.smoothing.smooth import (
    smooth as smooth,
)
from vorotool.engines.smoothing.verify_smooth import (
    verify_smooth as verify_smooth,
)
from vorotool.engines.tessellation.seeding import (
    seeds_from_points as seeds_from_points,
)
from vorotool.engines.tessellation.seeding import (
    seeds_from_raster as seeds_from_raster,
)
from vorotool.engines.tessellation.tessellate import (
    tessellate as tessellate,
)
from vorotool.engines.tessellation.tessellate import (
    verify_tessellation as verify_tessellation,
)
from vorotool.engines.tessellation.volume_seeding import (
    seeds_from_volume as seeds_from_volume,
)
from vorotool.engines.tessellation.volume_seeding import (
    seeds_from_xyz as seeds_from_xyz,
)
from vorotool.engines.voronoi.verify_voronoi import (
    verify_voronoi as verify_voronoi,
)
from vorotool.engines.voronoi.voronoi import (
    voronoi as voronoi,
)
from vorotool.errors import (
    InputError as InputError,
)
from vorotool.errors import (
    LimitError as LimitError,
)
from vorotool.errors import (
    OutputError as OutputError,
)
from vorotool.errors import (
    RepairWarning as RepairWarning,
)
from vorotool.errors import (
    UsageError as UsageError,
)
from vorotool.errors import (
    VerificationError as VerificationError,
)
from vorotool.errors import (
    VorotoolError as VorotoolError,
)
from vorotool.errors import (
    VorotoolWarning as VorotoolWarning,
)
from vorotool.formats import (
    read as read,
)
from vorotool.formats import (
    sample as sample,
)
from vorotool.jobs.writing import (
    to_geojson as to_geojson,
)
from vorotool.jobs.writing import (
    write as write,
)
from vorotool.types.alpha.complex import (
    AlphaComplex as AlphaComplex,
)
from vorotool.types.alpha.complex import (
    RegionPersistence as RegionPersistence,
)
from vorotool.types.alpha.shape import (
    AlphaHull as AlphaHull,
)
from vorotool.types.alpha.shape import (
    AlphaShape as AlphaShape,
)
from vorotool.types.alpha.space import (
    SpaceAlphaComplex as SpaceAlphaComplex,
)
from vorotool.types.alpha.space import (
    SpaceAlphaShape as SpaceAlphaShape,
)
from vorotool.types.box import (
    Box as Box,
)
from vorotool.types.distances.distances import (
    Distances as Distances,
)
from vorotool.types.distances.distances import (
    PlacePair as PlacePair,
)
from vorotool.types.images import (
    LabelImage as LabelImage,
)
from vorotool.types.images import (
    Raster as Raster,
)
from vorotool.types.mesh.cells import (
    CellSet as CellSet,
)
from vorotool.types.mesh.cells import (
    ProximityGraph as ProximityGraph,
)
from vorotool.types.mesh.tables import (
    CellStatistics as CellStatistics,
)
from vorotool.types.mesh.tables import (
    edge_table as edge_table,
)
from vorotool.types.mesh.tables import (
    point_table as point_table,
)
from vorotool.types.mesh.tables import (
    triangle_table as triangle_table,
)
from vorotool.types.mesh.tetrahedralization import (
    SpaceCellSet as SpaceCellSet,
)
from vorotool.types.mesh.tetrahedralization import (
    Tetrahedralization as Tetrahedralization,
)
from vorotool.types.mesh.triangulation import (
    DigitalComparison as DigitalComparison,
)
from vorotool.types.mesh.triangulation import (
    DigitalTriangulation as DigitalTriangulation,
)
from vorotool.types.mesh.triangulation import (
    Triangulation as Triangulation,
)
from vorotool.types.pixels import (
    Frame as Frame,
)
from vorotool.types.pixels import (
    PixelGrid as PixelGrid,
)
from vorotool.types.points.point_set import (
    PointSet as PointSet,
)
from vorotool.types.points.point_set import (
    VolumePoints as VolumePoints,
)
from vorotool.types.points.seed_set import (
    SeedSet as SeedSet,
)
from vorotool.types.polygons.planar_graph import (
    PlanarGraph as PlanarGraph,
)
from vorotool.types.polygons.polygon_set import (
    PolygonSet as PolygonSet,
)
from vorotool.types.skeleton.discs import (
    Discs as Discs,
)
from vorotool.types.skeleton.lines import (
    Centerlines as Centerlines,
)
from vorotool.types.skeleton.lines import (
    ExtendedSkeleton as ExtendedSkeleton,
)
from vorotool.types.skeleton.lines import (
    SmoothLines as SmoothLines,
)
from vorotool.types.skeleton.necks import (
    Necks as Necks,
)
from vorotool.types.skeleton.necks import (
    Parts as Parts,
)
from vorotool.types.skeleton.offsets import (
    Offsets as Offsets,
)
from vorotool.types.skeleton.points_along import (
    SkeletonPoints as SkeletonPoints,
)
from vorotool.types.skeleton.skeleton import (
    CriticalValues as CriticalValues,
)
from vorotool.types.skeleton.skeleton import (
    Skeleton as Skeleton,
)
from vorotool.types.skeleton.tables import (
    arc_table as arc_table,
)
from vorotool.types.skeleton.tables import (
    branch_table as branch_table,
)
from vorotool.types.skeleton.tables import (
    element_table as element_table,
)
from vorotool.types.skeleton.tables import (
    polygon_table as polygon_table,
)
from vorotool.types.table import (
    Table as Table,
)
from vorotool.types.volumes.volume import (
    LabelVolume as LabelVolume,
)
from vorotool.types.volumes.volume import (
    Volume as Volume,
)
from vorotool.types.volumes.volume import (
    VolumeSeeds as VolumeSeeds,
)
from vorotool.types.volumes.volume import (
    VoxelFrame as VoxelFrame,
)
from vorotool.types.volumes.volume import (
    VoxelGrid as VoxelGrid,
)
from vorotool.types.voronoi.voronoi_map import (
    VoronoiMap as VoronoiMap,
)

_HOME: dict[str, str]
__version__: str
__all__: list[str]
