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
    "CellSet": "vorotool.geometry.cells",
    "Frame": "vorotool.geometry.frame",
    "LabelImage": "vorotool.geometry.label_image",
    "PlanarGraph": "vorotool.geometry.planar_graph",
    "PointSet": "vorotool.geometry.points",
    "PolygonSet": "vorotool.geometry.polygons",
    "Raster": "vorotool.geometry.raster",
    "SeedSet": "vorotool.geometry.seeds",
    "Skeleton": "vorotool.geometry.skeleton",
    "Table": "vorotool.geometry.table",
    "Triangulation": "vorotool.geometry.triangulation",
    "read": "vorotool.formats",
    "to_geojson": "vorotool.formats",
    "write": "vorotool.writing",
    "seeds_from_points": "vorotool.engines.seeding",
    "seeds_from_raster": "vorotool.engines.seeding",
    "tessellate": "vorotool.engines.tessellate",
    "verify_tessellation": "vorotool.engines.tessellate",
    "region_table": "vorotool.engines.regions",
    "neighbour_table": "vorotool.engines.regions",
    "voronoi_diagram": "vorotool.engines.regions",
    "delaunay": "vorotool.engines.delaunay",
    "edge_table": "vorotool.geometry.mesh_tables",
    "triangle_table": "vorotool.geometry.mesh_tables",
    "point_table": "vorotool.geometry.mesh_tables",
    "insert_points": "vorotool.engines.insertion",
    "verify_triangulation": "vorotool.engines.delaunay",
    "DigitalTriangulation": "vorotool.geometry.digital_triangulation",
    "digital_triangulation": "vorotool.engines.digital_triangulation",
    "digital_delaunay": "vorotool.engines.digital_triangulation",
    "repair_digital": "vorotool.engines.digital_triangulation",
    "verify_digital_triangulation": "vorotool.engines.verify_digital",
    "DigitalComparison": "vorotool.geometry.digital_comparison",
    "compare_digital": "vorotool.engines.digital_comparison",
    "site_table": "vorotool.engines.site_table",
    "cell_colours": "vorotool.engines.cells",
    "voronoi_cells": "vorotool.engines.cells",
    "verify_cells": "vorotool.engines.cells",
    "outlines": "vorotool.engines.outlines",
    "planar_graph": "vorotool.engines.planar_graph",
    "verify_planar_graph": "vorotool.engines.planar_graph",
    "Centerlines": "vorotool.geometry.centerline",
    "centerline": "vorotool.engines.centerline",
    "CriticalValues": "vorotool.geometry.critical_values",
    "arc_profiles": "vorotool.engines.pruning",
    "critical_values": "vorotool.engines.pruning",
    "prune": "vorotool.engines.pruning",
    "verify_pruning": "vorotool.engines.pruning_verification",
    "skeleton_approx": "vorotool.engines.skeletons",
    "skeleton_exact": "vorotool.engines.skeletons",
    "verify_skeleton": "vorotool.engines.skeleton_verification",
    "Offsets": "vorotool.geometry.offsets",
    "offset": "vorotool.engines.offsets",
    "verify_offsets": "vorotool.engines.offset_verification",
    "rebuild": "vorotool.engines.rebuilding",
    "SkeletonPoints": "vorotool.geometry.skeleton_points",
    "points_along": "vorotool.engines.skeleton_points",
    "to_networkx": "vorotool.geometry.network_conversion",
    "arc_table": "vorotool.geometry.skeleton_tables",
    "branch_table": "vorotool.geometry.skeleton_tables",
    "element_table": "vorotool.geometry.skeleton_tables",
    "polygon_table": "vorotool.geometry.skeleton_tables",
    "table": "vorotool.geometry.value_tables",
    "colour_regions": "vorotool.engines.regions",
    "AlphaComplex": "vorotool.geometry.alpha_complex",
    "AlphaShape": "vorotool.geometry.alpha_shape",
    "alpha_complex": "vorotool.engines.alphashape",
    "alpha_curves": "vorotool.engines.alphashape",
    "alpha_edges": "vorotool.engines.alphashape",
    "AlphaHull": "vorotool.geometry.alpha_hull",
    "alpha_hull": "vorotool.engines.alpha_hull",
    "alpha_shape": "vorotool.engines.alphashape",
    "verify_alpha_shape": "vorotool.engines.verify_alpha",
}

__all__ = ["__version__", *_HOME]  # noqa: PLE0604 - the keys are strings


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module 'vorotool' has no attribute {name!r}")
    from importlib import import_module

    return getattr(import_module(_HOME[name]), name)


def __dir__() -> list[str]:
    return sorted(__all__)
