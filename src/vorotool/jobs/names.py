"""Names that a command and what makes its results share; nothing heavy is imported for them."""

from __future__ import annotations

METHODS = ("exact", "digital", "digital-valid")
"""Ways of triangulating."""
GRAPHS = ("delaunay", "gabriel", "relative", "mst")
"""Edges of a triangulation that `delaunay` writes."""
OF_ONE_SHAPE = frozenset({"edges", "polygons", "complex", "general", "hull", "points", "table"})
"""Results of `alphashape` that are of one radius; the others are of all."""
PLOTS = ("curves", "persistence")
"""Those whose picture is a plot over the radius."""
DERIVED = {
    "offset": "jobs.skeletons.offset_curves:OffsetCurves",
    "shape": "jobs.skeletons.rebuilt_shape:RebuiltShape",
    "discs": "jobs.skeletons.inscribed_discs:InscribedDiscs",
    "points": "jobs.skeletons.steps:Steps",
    "transects": "jobs.skeletons.steps:Steps",
    "thickness": "jobs.skeletons.thickness:Thickness",
    "necks": "jobs.skeletons.neck_cuts:NeckCuts",
    "parts": "jobs.skeletons.neck_cuts:CutParts",
}
"""Results of the skeleton commands that follow from a skeleton or its diagram, and what makes each."""
