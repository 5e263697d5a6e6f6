"""Which options, results and formats exclude or need each other.

A rule is about conditions, each written as: ``option`` (it is given), ``option=value``, ``what:RESULT`` (the result is
asked for), ``only:RESULT,RESULT`` (nothing but these), ``RESULT.FORMAT`` and ``.KIND`` (an output is such),
``layer:NAME``, or ``?property`` of `vorotool.jobs.options.Options`; ``a+b`` holds where both do.
"""

from __future__ import annotations

from typing import NamedTuple

from vorotool.products.options.row import ALL, BATCHES, SITES, SKELETONS
from vorotool.products.registry import PRODUCTS


class Rule(NamedTuple):
    """Conditions of one kind that exclude, or need, one of another."""

    commands: str
    these: str
    others: str
    why: str = ""
    instead: str = "leave out one of the two"


_OF_TRIANGULATIONS = " ".join(
    f"what:{each.what}"
    for each in PRODUCTS["delaunay"].values()
    if each.types and not {"DigitalTriangulation", "Tetrahedralization"} & set(each.types)
)
_NO_TRIANGULATION = "the digital rule finds edges and triangles that may not form a triangulation"
# Rows stay rows: one argument a line would hide the table.
# fmt: off
EXCLUDING = (
    Rule(ALL, "size", "window", "both are the frame"),
    # ---- pictures
    Rule(ALL, "scale drawing_unit", "width overlay aspect .png-picture", "a picture to scale is an SVG, whose size "
        "follows from the scale"),
    Rule(ALL, "aspect extent width y_up", "overlay", "a picture over an image has its size, and y downwards"),
    Rule(ALL, "background", "overlay", "the image itself is the background"),
    Rule(ALL, "?scale_in_millimeters", "drawing_unit", "--scale S is in millimeters per unit"),
    Rule("skeleton-exact", "thickness.png", "width overlay layers colors line_widths label_by aspect extent",
        "a picture of thickness has the pixels of the image, and colors of its own"),
    # ---- tessellations
    Rule("tessellate", "method=propagation", "max_distance spacing what:distance what:distance2 .animation "
        "?has_bands_on_cluster", "the paper's propagation computes labels of square pixels only"),
    Rule("tessellate", "like", "size window cell_size spacing", "the raster sets the frame and its pixels"),
    Rule("tessellate", "cell_size", "spacing", "the cells are squares in the units of the map"),
    Rule("tessellate", "cell_size", "size", "--size is in pixels", "give --window X,Y,W,H in the units of the map"),
    Rule("tessellate", "?is_of_space", "method=propagation passes tiled like overlay y_up animate frames fps "
        "connectivity=8 connectivity=4", "the option applies to images"),
    Rule("tessellate", "?is_of_space", "cell_size input_layer input_crs crs", "the option applies to maps"),
    Rule("tessellate", "?is_of_space", "page", "all pages form the volume"),
    Rule("tessellate", "?is_of_space", "?has_pixel_size", "voxels have three sides",
        "give --spacing SX,SY,SZ or --spacing auto"),
    Rule(SITES, "connectivity", "seeds=pixels seeds=labels", "--connectivity applies to components"),
    # ---- triangulations and alpha shapes
    Rule("delaunay", "what:compare", "method=digital-valid", "the comparison is about the digital rule",
        "use --method digital"),
    Rule("delaunay", "what:compare+method=exact", "?has_several_results", "the comparison is about the digital rule",
        "use --method digital"),
    Rule("delaunay", "what:compare", "spacing", "differences are explained by the sides of square pixels"),
    Rule("delaunay", "?is_digital", f"layer:cells layer:diagram graph {_OF_TRIANGULATIONS} edges.edge triangles.ele",
        _NO_TRIANGULATION, "use --method exact or digital-valid"),
    Rule("delaunay", "?is_of_space", "method=digital method=digital-valid graph clip size window page spacing "
        "seeds connectivity threshold invert min_area fill_holes y_up input_layer input_crs crs overlay "
        "scale scale_bar",
        "the option applies to points in the plane, or to images"),
    Rule("alphashape", "?is_of_space", "method=digital method=digital-valid rule=printed hole_threshold "
        "region_threshold frame size window page seeds connectivity threshold invert min_area fill_holes y_up "
        "input_layer input_crs crs overlay scale scale_bar",
        "the option applies to points in the plane, or to images"),
    Rule("alphashape", "regions", "r alpha", "--regions applies to the automatic choice of r"),
    Rule("alphashape", "what:hull", "hole_threshold region_threshold", "the hull has no thresholds"),
    Rule("alphashape", "rule=printed", "verify ?is_automatic what:curves what:persistence .html",
        "the printed rule follows the text of the paper, for a single -r", "use --rule corrected"),
    Rule("alphashape", "method=digital", "what:polygons what:general what:hull what:points what:table "
        "what:curves what:persistence .html .animation hole_threshold region_threshold verify", _NO_TRIANGULATION,
        "use --method exact or digital-valid"),
    Rule("alphashape", "method=digital", "?is_automatic", _NO_TRIANGULATION,
        "give -r, or use --method exact or digital-valid"),
    # ---- skeletons and Voronoi maps
    Rule("skeleton-approx", "step", "tolerance", "each sets how finely edges are sampled"),
    Rule("skeleton-approx", "tolerance", "sampling=paper", "the paper's sampling has a constant step"),
    Rule(SKELETONS, "side=exterior", "what:shape what:centerline along=centerline what:discs what:thickness",
        "shapes, centerlines, discs and thickness lie inside polygons", "use --side interior or both"),
    Rule(SKELETONS, "ends=middle+what:skeleton", "side=exterior side=both", "ends are extended only inside polygons"),
    Rule(SKELETONS, "smooth ends=middle", "skeleton.graphml skeleton.html", "smoothed or extended lines are not a "
        "graph"),
    Rule(SKELETONS, "join_junctions", "skeleton.html", "the page shows all prunings"),
    Rule("skeleton-exact", "what:necks what:parts", "side=exterior side=both", "necks lie inside polygons",
        "use --side interior"),
    Rule("skeleton-exact", "what:necks what:parts what:shape what:thickness", "gap", "a gap leaves the corners out"),
    Rule("skeleton-exact", "only:offset,discs,necks,parts,thickness", "prune", "the result depends on the shapes only"),
    Rule("skeleton-exact", "only:offset,discs", "gap", "the result depends on the shapes only"),
    Rule("skeleton-exact", "only:offset", "side=exterior side=both", "offset curves depend on the shapes only"),
    Rule("skeleton-exact", "border=open", "side=exterior side=both features=together gap simplify frame what:diagram "
        "what:elements what:offset what:shape what:discs what:thickness what:necks what:parts",
        "an open border applies to the interior of each unchanged object",
        "use --what skeleton, branches, table, centerline, points or transects alone"),
    Rule("voronoi", "by", "no_properties", "features are joined by a column"),
    Rule("voronoi", "only:discs", "max_distance enclosures by", "discs avoid all features, and stay in the frame or "
        "the clip"),
)
# fmt: on
"""Of each rule, no condition of the first kind may hold with one of the second."""
ONLY = {
    each: frozenset(each.removeprefix("only:").split(","))
    for rule in EXCLUDING
    for each in rule.these.split()
    if each.startswith("only:")
}
"""The results of conditions that nothing else is asked for."""

_NO_TRIANGULATION = "the digital rule finds edges and triangles that may not form a triangulation"
# Rows stay rows: one argument a line would hide the table.
# fmt: off
NEEDING = (
    Rule("tessellate", "passes", "method=propagation"),
    Rule("tessellate", "slice levels connectivity=26 connectivity=6", "volume ?is_of_space"),
    Rule("delaunay", "what:tetrahedra what:hull", "space ?is_of_space", "they are of points in space"),
    Rule("alphashape", "what:surface what:tetrahedra what:triangles", "space ?is_of_space",
        "they are of points in space"),
    Rule("delaunay", "frame+?is_of_space", "what:cells", "in space only cells have a frame"),
    Rule("delaunay", "size window", "method=digital method=digital-valid ?is_digital",
        "the frame is of the digital tessellation"),
    Rule("alphashape", "size window", "method=digital method=digital-valid",
        "the frame is of the digital tessellation"),
    Rule(SKELETONS, "what:points what:transects", "every"),
    Rule("skeleton-approx", "inputs", "step tolerance"),
    Rule("skeleton-exact", "what:offset", "distance"),
    Rule("skeleton-exact", "complete", "gap", "without a gap no corner is missing"),
    Rule(BATCHES, "null", "files_from", "NUL bytes end the names of that list"),
    Rule(BATCHES, "fields", "table table_inputs", "they have its columns"),
)
# fmt: on
"""Of each rule, a condition of the first kind needs one of the second."""
