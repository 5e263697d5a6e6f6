"""Options of methods."""

from __future__ import annotations

from vorotool.products.options.row import SKELETONS, Option

_TRIANGULATING = "choice:exact digital digital-valid"
_ALONG = "points transects"
_CENTERLINES = "centerline along=centerline"
# Rows stay rows: one argument a line would hide the table.
# fmt: off
METHOD = (
    Option("--method", "tessellate", "exact, or propagation: the two passes of the paper, nearly exact.",
        "choice:exact propagation", "exact"),
    Option("--method", "delaunay", "digital: the rule of the paper, on the digital tessellation of a frame; "
        "digital-valid: its certified repair, which gives the exact triangulation.", _TRIANGULATING, "exact"),
    Option("--method", "alphashape", "How points are triangulated, as in delaunay.", _TRIANGULATING, "exact"),
    Option("--passes N", "tessellate", "Passes of the propagation; default 2.", "int:1:2"),
    Option("--max-distance D", "tessellate", "Label only pixels within this distance of a seed: others get 0; "
        "distances are not cut.", "lengths.exact_length"),
    Option("--graph", "delaunay", "Edges to write: all, those of the Gabriel graph, of relative neighbors, or of the "
        "minimum spanning tree.", "choice:delaunay gabriel relative mst", "delaunay", acts_on="edges layer:edges"),
    # ---- alpha shapes
    Option("-r R", "alphashape", "Radius, in units of the input; inf gives the convex hull.", "lengths.radius"),
    Option("--alpha A", "alphashape", "The paper's alpha = -1/r, negative.", "numbers.decimal"),
    Option("--auto", "alphashape", "The smallest r whose shape is one region with every point: the default."),
    Option("--regions K", "alphashape", "Number of regions that --auto allows; default 1.", "int:1:"),
    Option("--rule", "alphashape", "printed: r_min and open intervals as the paper prints them.",
        "choice:corrected printed", "corrected"),
    Option("--hole-threshold AREA", "alphashape", "Fill holes (cavities) up to this area.", "lengths.area_or_zero"),
    Option("--region-threshold AREA", "alphashape", "Then drop regions of at most this area.",
        "lengths.area_or_zero"),
    # ---- Voronoi diagrams of shapes
    Option("--by COLUMN", "voronoi", "Join features with the same value in this column into one site."),
    Option("--max-distance D", "voronoi", "Leave places farther than D from every site unassigned.", "lengths.length"),
    Option("--count N", "voronoi", "Number of --what discs: the largest, then the largest that is disjoint from those "
        "before (default 1).", "int:1:", acts_on="discs"),
    Option("--boundary", "distance", "Treat polygons as outlines; by default they are filled."),
    # ---- skeletons
    Option("--step H", "skeleton-approx", "Sample the edges at this distance.", "lengths.length"),
    Option("--tolerance E", "skeleton-approx", "Instead of a step: sample as finely as it takes for all errors to be "
        "at most E.", "lengths.length"),
    Option("--sampling", "skeleton-approx", "Sample from the first end of each edge (default with --step), or "
        "symmetrically from both ends (with --tolerance).", "choice:paper symmetric"),
    Option("--complete/--no-complete", "skeleton-approx", "Join corners by lines along their bisectors; default with "
        "--tolerance."),
    Option("--compare", "skeleton-approx", "Report the distance from the exact skeleton, both ways; in --stats, too."),
    Option("--side", SKELETONS, "Inside polygons, outside all of them, or both.", "choice:interior exterior both",
        "interior"),
    Option("--gap STEP", "skeleton-exact", "Shorten each edge by STEP at both ends, as the paper does; default 0, "
        "which is exact.", "lengths.length_or_zero", 0.0),
    Option("--complete/--no-complete", "skeleton-exact", "With a gap, add the straight portions that lead to the "
        "corners (default) or leave them out."),
    Option("--features", SKELETONS, "Treat each feature separately, whatever lies in or over it (default), or all "
        "together as one drawing.", "choice:separate together", "separate"),
    Option("--prune CRITERION=X", SKELETONS, "Remove side branches whose significance is below a threshold: angle=DEG, "
        "chord=D, scale=S, length=D, ratio=Q, mask or none. Default mask for images, none for polygons.",
        "lengths.pruning", complete="words:angle= chord= scale= length= ratio= mask none"),
    Option("--join-junctions", SKELETONS, "Merge junctions that are joined by branches shorter than the radius at the "
        "largest: >-< becomes ><.", acts_on="skeleton branches table"),
    Option("--from X,Y", SKELETONS, "Begin the centerline at the point of the skeleton nearest to X,Y.",
        "lengths.place", name="start", acts_on=_CENTERLINES),
    Option("--to X,Y", SKELETONS, "End the centerline at the point of the skeleton nearest to X,Y.", "lengths.place",
        name="end", acts_on=_CENTERLINES),
    Option("--ends", SKELETONS, "Where centerlines end: in the middle of the piece of outline between both sides "
        "(default), in a corner, or where that piece begins. With middle, skeletons are also extended to the ends of "
        "strokes; otherwise they end where pruning leaves them.", "choice:middle corner none",
        acts_on=f"skeleton table {_CENTERLINES}"),
    Option("--smooth TOLERANCE", SKELETONS, "Fit cubic Bezier curves to skeletons and centerlines that are nowhere "
        "farther from them than this.", "lengths.length", acts_on="skeleton centerline"),
    Option("-d --distance D[,D...]|START:STOP:STEP", "skeleton-exact", "Distances of --what offset, separated by "
        "commas: positive outwards, negative inwards; START:STOP:STEP is a range of them, such as 1:5:0.5 or "
        "-10:-1:1mm.", "lengths.distances", repeats="joined", acts_on="offset"),
    Option("--every D", SKELETONS, "Step along branches or the centerline, for --what points and transects.",
        "lengths.length", acts_on=_ALONG),
    Option("--along", SKELETONS, "What points and transects follow: each branch of the skeleton (default), so that "
        "distances begin anew at junctions, or the centerline of each polygon from end to end, with transects straight "
        "across it up to the outline.", "choice:branches centerline", acts_on=_ALONG),
    Option("--count N", "skeleton-exact", "Number of --what discs of each feature: the largest, then the largest that "
        "is disjoint from those before (default 1); with --local the largest ones.", "int:1:", acts_on="discs"),
    Option("--local", "skeleton-exact", "With --what discs: every locally largest disc.", acts_on="discs"),
    Option("--neck RATIO", "skeleton-exact", "Necks of --what necks, and cuts of --what parts: where half the width is "
        "at most RATIO times the largest clearance on either side (default 0.95 for necks, 0.5 for parts).",
        "float:0:1", acts_on="necks parts"),
)
# fmt: on
