"""Exact Voronoi diagrams of images, points and polygons.

Importing this package imports nothing heavy: every public name is loaded when it is first used.
"""

from __future__ import annotations

TYPE_CHECKING = False
if TYPE_CHECKING:  # typing takes longer to import than all that is here
    from typing import Any

__version__ = "0.1.0"

_HOME = {
    "InputError": "vorotool.errors",
    "LimitError": "vorotool.errors",
    "OutputError": "vorotool.errors",
    "UsageError": "vorotool.errors",
    "VerificationError": "vorotool.errors",
    "VorotoolError": "vorotool.errors",
    "VorotoolWarning": "vorotool.errors",
    "Box": "vorotool.geometry.box",
    "CellSet": "vorotool.geometry.mesh.cells",
    "Frame": "vorotool.geometry.pixel_frame",
    "LabelImage": "vorotool.geometry.points.label_image",
    "PixelGrid": "vorotool.geometry.pixel_grid",
    "PlanarGraph": "vorotool.geometry.polygons.planar_graph",
    "PointSet": "vorotool.geometry.points.point_set",
    "PolygonSet": "vorotool.geometry.polygons.polygon_set",
    "Raster": "vorotool.geometry.points.raster",
    "SeedSet": "vorotool.geometry.points.seed_set",
    "Skeleton": "vorotool.geometry.skeleton.skeleton",
    "Table": "vorotool.geometry.table",
    "Triangulation": "vorotool.geometry.mesh.triangulation",
    "LabelVolume": "vorotool.geometry.volumes.label_volume",
    "Volume": "vorotool.geometry.volumes.volume",
    "VolumePoints": "vorotool.geometry.volumes.volume_points",
    "VolumeSeeds": "vorotool.geometry.volumes.volume_seeds",
    "VoxelFrame": "vorotool.geometry.volumes.voxel_frame",
    "VoxelGrid": "vorotool.geometry.volumes.voxel_grid",
    "read": "vorotool.formats",
    "sample": "vorotool.formats.samples",
    "to_geojson": "vorotool.jobs.writing",
    "write": "vorotool.jobs.writing",
    "seeds_from_points": "vorotool.engines.tessellation.seeding",
    "seeds_from_raster": "vorotool.engines.tessellation.seeding",
    "seeds_from_volume": "vorotool.engines.volumes.volume_seeding",
    "seeds_from_xyz": "vorotool.engines.volumes.volume_seeding",
    "tessellate": "vorotool.engines.tessellation.tessellate",
    "verify_tessellation": "vorotool.engines.tessellation.tessellate",
    "region_table": "vorotool.engines.label_images.regions",
    "neighbour_table": "vorotool.engines.label_images.regions",
    "voronoi_diagram": "vorotool.engines.label_images.regions",
    "delaunay": "vorotool.engines.delaunay.delaunay",
    "edge_table": "vorotool.geometry.mesh.tables",
    "triangle_table": "vorotool.geometry.mesh.tables",
    "point_table": "vorotool.geometry.mesh.tables",
    "insert_points": "vorotool.engines.delaunay.insertion",
    "verify_triangulation": "vorotool.engines.delaunay.delaunay",
    "DigitalTriangulation": "vorotool.geometry.mesh.digital_triangulation",
    "digital_triangulation": "vorotool.engines.digital.triangulation",
    "digital_delaunay": "vorotool.engines.digital.triangulation",
    "repair_digital": "vorotool.engines.digital.triangulation",
    "verify_digital_triangulation": "vorotool.engines.digital.verify_digital",
    "DigitalComparison": "vorotool.geometry.mesh.digital_comparison",
    "compare_digital": "vorotool.engines.digital.comparison",
    "site_table": "vorotool.engines.delaunay.site_table",
    "cell_colours": "vorotool.engines.delaunay.cells",
    "voronoi_cells": "vorotool.engines.delaunay.cells",
    "verify_cells": "vorotool.engines.delaunay.cells",
    "outlines": "vorotool.engines.label_images.outlines",
    "planar_graph": "vorotool.engines.arrangement.planar_graph",
    "verify_planar_graph": "vorotool.engines.arrangement.planar_graph",
    "Centerlines": "vorotool.geometry.skeleton.centerline",
    "centerline": "vorotool.engines.centerlines.centerline",
    "CriticalValues": "vorotool.geometry.skeleton.critical_values",
    "arc_profiles": "vorotool.engines.pruning.pruning",
    "critical_values": "vorotool.engines.pruning.pruning",
    "prune": "vorotool.engines.pruning.pruning",
    "verify_pruning": "vorotool.engines.pruning.verify_pruning",
    "skeleton_approx": "vorotool.engines.skeleton_api",
    "skeleton_exact": "vorotool.engines.skeleton_api",
    "verify_skeleton": "vorotool.engines.skeleton.verify_skeleton",
    "Offsets": "vorotool.geometry.skeleton.offsets",
    "offset": "vorotool.engines.offsets.offsets",
    "verify_offsets": "vorotool.engines.offsets.verify_offsets",
    "VoronoiMap": "vorotool.geometry.voronoi.voronoi_map",
    "voronoi": "vorotool.engines.voronoi.voronoi",
    "verify_voronoi": "vorotool.engines.voronoi.verify_voronoi",
    "Distances": "vorotool.geometry.distances.distances",
    "PlacePair": "vorotool.geometry.distances.distances",
    "hausdorff": "vorotool.engines.distances.hausdorff",
    "distance": "vorotool.engines.distances.smallest",
    "verify_distances": "vorotool.engines.distances.verify_distances",
    "rebuild": "vorotool.engines.from_skeleton.reconstruction",
    "SkeletonPoints": "vorotool.geometry.skeleton.points_along",
    "points_along": "vorotool.engines.from_skeleton.points_along",
    "to_networkx": "vorotool.geometry.any.graphs",
    "arc_table": "vorotool.geometry.skeleton.tables",
    "branch_table": "vorotool.geometry.skeleton.tables",
    "element_table": "vorotool.geometry.skeleton.tables",
    "polygon_table": "vorotool.geometry.skeleton.tables",
    "table": "vorotool.geometry.any.tables",
    "colour_regions": "vorotool.engines.label_images.regions",
    "AlphaComplex": "vorotool.geometry.alpha.complex",
    "AlphaShape": "vorotool.geometry.alpha.shape",
    "alpha_complex": "vorotool.engines.alpha.alpha_shape",
    "alpha_curves": "vorotool.engines.alpha.alpha_shape",
    "alpha_edges": "vorotool.engines.alpha.alpha_shape",
    "AlphaHull": "vorotool.geometry.alpha.hull",
    "alpha_hull": "vorotool.engines.alpha.alpha_hull",
    "alpha_shape": "vorotool.engines.alpha.alpha_shape",
    "verify_alpha_shape": "vorotool.engines.alpha.verify_alpha",
    "distance_transform": "vorotool.engines.peers.distance_transform",
    "expand_labels": "vorotool.engines.peers.expand_labels",
    "medial_axis": "vorotool.engines.peers.medial_axis",
    "voronoi_polygons": "vorotool.engines.peers.voronoi_polygons",
}

__all__ = ["__version__", *_HOME]  # noqa: PLE0604 - the keys are strings


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module 'vorotool' has no attribute {name!r}")
    from importlib import import_module

    return getattr(import_module(_HOME[name]), name)


def __dir__() -> list[str]:
    return sorted(__all__)
