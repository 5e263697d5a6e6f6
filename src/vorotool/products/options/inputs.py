"""Options of inputs, of the frame that they are computed in, and of methods."""

from __future__ import annotations

from vorotool.products.options.row import ALL, BATCHES, COMPUTING, SHAPES, SITES, SKELETONS, Option

_OTHERS = "delaunay alphashape"
# Rows stay rows: one argument a line would hide the table.
# fmt: off
INPUT = (
    Option("--columns X,Y[,LABEL]", f"{SITES} voronoi distance info", "Columns of a point list, by name or number "
        "(from 1)."),
    Option("--input-format FORMAT", f"{ALL} info", "Format of the input, where it is unclear.", complete="inputs"),
    Option("--input-layer NAME", ALL, "Layer of an input that has several; FILE:LAYER, such as map.gpkg:roads, works "
        "for every file."),
    Option("--input-crs CRS", f"{COMPUTING} info", "Coordinate reference system of an input that states none, such as "
        "EPSG:3857; nothing is reprojected.", "names.crs"),
    Option("--crs CRS", COMPUTING, "Coordinate reference system to work and write in: inputs in another one are "
        "reprojected.", "names.crs"),
    Option("--y-up/--y-down", ALL, "Direction of y in the input; default: up on maps and in DXF, down in images and "
        "SVG."),
    Option("--page N|all", f"{ALL} info", "Page of an image stack, from 0; all makes each page an input of a batch.",
        "numbers.page"),
    Option("--volume", "tessellate", "Read all pages of a stack, or an array with three axes, as one volume (z, y, x), "
        "and points with their z."),
    Option("--space", "delaunay alphashape", "Take points in space, by their x, y and z; --columns X,Y,z=Z names the "
        "columns."),
    Option("--pixel-size SIZE|auto", BATCHES, "Side of a pixel, or unit of the coordinates, such as 0.325um: scales "
        "what is written in tables and vectors, and lengths with a unit, such as --max-distance 5um, where the input "
        "states none; auto takes the unit that the input states.", "lengths.pixel_size"),
    Option("--pixel-size SIZE|auto", "draw", "Side of a pixel, or unit of the coordinates, such as 0.325um, for "
        "--scale-bar and --scale 1:N; auto takes what the input states.", "lengths.pixel_size"),
    Option("--spacing SX,SY[,SZ]|auto", f"tessellate delaunay {SHAPES}", "Sides of a pixel, or of a voxel, such as "
        "0.325,0.5um: distances, lengths and results are in their unit; auto takes what the image states.",
        "lengths.spacing"),
    Option("--seeds", SITES, "What the seeds of an image are; default: components of a mask (0, and 1 or 255 or all "
        "bits), else labels.", "choice:pixels components labels centroids"),
    Option("--seeds", SHAPES, "What the objects of an image are; default: components of a mask (0, and 1 or 255 or all "
        "bits), else labels.", "choice:components labels"),
    Option("--connectivity", "tessellate", "Connectivity of the components of an image, default 8, or of a volume, "
        "default 26.", "choice:8 4 26 6"),
    Option("--connectivity", f"{_OTHERS} {SHAPES}", "Connectivity of the components of an image; default 8.",
        "choice:8 4"),
    Option("--threshold T|otsu", BATCHES, "Pixels brighter than this are foreground.", "numbers.threshold"),
    Option("--invert", BATCHES, "Swap foreground and background."),
    Option("--min-area AREA", BATCHES, "Drop objects of a mask smaller than AREA: pixels or 5um2, in volumes voxels or "
        "5um3.", "lengths.area"),
    Option("--fill-holes [AREA]", BATCHES, "Fill the holes of the objects of a mask first: all, or those of at most "
        "AREA.", "lengths.holes", False),
    Option("--outline", SHAPES, "Outline of the objects of an image: around pixels (default), or half-way between the "
        "centers of pixels.", "choice:crack contour"),
    Option("--border", "skeleton-exact", "Whether objects end at the border of an image (closed, default) or continue "
        "beyond it (open), so that the skeleton runs to the border and does not fork.", "choice:closed open"),
    Option("--simplify TOLERANCE", SHAPES, "Remove vertices of outlines first, which then move by at most this; "
        "outlines that touch still touch.", "lengths.length"),
    Option("--join-tolerance D", SHAPES, "Largest gap between ends of lines of a DXF input that are joined; default "
        "0.005 mm, or 1/100000 of the extent if the unit is unknown.", "lengths.length_or_zero",
        acts_on="?may_be_drawn"),
)
# fmt: on

_BOUNDS = (
    ", in the units of the input or with a unit, such as 0,0,20,10mm; default: the image, or the bounds and a tenth "
    "around them."
)
_PAGE = "Rectangle that pictures show, and the page of SVG to scale; default: everything, or the page of an SVG input."
_CELLS = "cells table statistics measures layer:cells layer:diagram"
# Rows stay rows: one argument a line would hide the table.
# fmt: off
FRAME = (
    Option("--size WxH", _OTHERS, "Frame of W x H pixels from pixel (0, 0).", "numbers.size"),
    Option("--size WxH[xD]", "tessellate", "Frame of W x H pixels from pixel (0, 0), or of W x H x D voxels.",
        "numbers.size_or_volume"),
    Option("--window X,Y,W,H", _OTHERS, "Frame whose first pixel is (X, Y).", "numbers.window"),
    Option("--window X,Y[,Z],W,H[,D]", "tessellate", "Frame whose first pixel is (X, Y), or voxel (X, Y, Z).",
        "numbers.window_or_volume"),
    Option("--cell-size SIDE", "tessellate", "Side of a pixel in the units of points, lines or polygons on a map, or "
        "with a unit; --window, --max-distance and distances are in the units of the map, too.",
        "lengths.exact_length"),
    Option("--like RASTER", "tessellate", "Use the frame and the pixels of this image, whose header alone is read: "
        "results overlay it pixel by pixel, also on a map.", "names.image", complete="inputs:image"),
    Option("--frame X,Y[,Z],W,H[,D]", "delaunay", f"Rectangle that cells are clipped to{_BOUNDS} With Z and D the box, "
        "in space; default there: the bounds of the points.", "lengths.rectangle_or_box",
        acts_on=f"{_CELLS} .page"),
    Option("--frame X,Y,W,H", "voronoi", f"Rectangle that cells are clipped to{_BOUNDS}", "lengths.rectangle"),
    Option("--frame X,Y,W,H", SKELETONS, f"Rectangle that skeletons outside polygons are clipped to{_BOUNDS}",
        "lengths.rectangle", acts_on="diagram side=exterior side=both .page"),
    Option("--frame X,Y,W,H", "alphashape distance", _PAGE, "lengths.rectangle", acts_on=".page"),
    Option("--frame X,Y,W,H", "draw", _PAGE, "lengths.rectangle"),
    Option("--clip POLYGONS", "delaunay", "File of polygons that cells are clipped to as well.",
        complete="inputs:polygons", acts_on=_CELLS),
    Option("--clip POLYGONS", "voronoi", "File of polygons that cells are clipped to as well; the frame is then around "
        "these.", complete="inputs:polygons"),
    Option("--enclosures LINES", "voronoi", "File of lines or polygons that divide the plane: each face is divided "
        "among the sites that meet it.", complete="inputs:polygons"),
)
# fmt: on


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
